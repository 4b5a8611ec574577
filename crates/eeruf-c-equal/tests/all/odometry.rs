//! A ring in C whose odometry expects a change that crosstalk shows too: the proof for a punctual table does not apply
//! then, and the ring checks each reading.

use eeruf_c_equal::{C, Do};
use eeruf_core::{Micros, Phase, ReadingKind, Requirements, tables::TABLE_I_D};

const SENSORS: usize = 12;
const PERIOD: u32 = 100_000;

/// Firing time of a sensor in a period.
fn fires(sensor: usize, period: u32) -> u32 {
    let t_fire = TABLE_I_D.t_fire(Phase((period % 2) as u8), sensor).map_or(0, Micros::as_micros);
    period * PERIOD + t_fire
}

/// Numbers of accepted and of ambiguous readings of a sensor that hears another along one fixed path, while odometry
/// expects that path's change.
fn heard_of(emitter: usize, receiver: u8) -> [usize; 2] {
    let mut c = C::new();
    let requirements = Requirements { window: Micros::new(60_000), ..Requirements::new(Micros::new(999)) };
    c.verified_schedule(0, &TABLE_I_D.verified(&requirements).expect("Table I(d) is for T_delta = 1 ms"));
    assert_eq!(c.ring(0, [999, 60_000, 0, 0, 0], 2, 0), 0);
    let (mut kinds, mut changes, mut before, mut edge) = ([0; 2], [0; SENSORS], None, u32::MAX);
    loop {
        let now = c.deadline().min(edge);
        if now > 30 * PERIOD {
            return kinds;
        }
        if now == edge {
            assert_eq!(c.call(Do::Echo, receiver, now), 0);
            edge = u32::MAX;
        }
        while let Ok(event) = c.poll(now, Some(&changes)) {
            let is_own = event[1] == u32::from(receiver);
            if event[0] == 0 && is_own {
                let heard = (0..30).map(|period| fires(emitter, period) + 70_000).find(|&heard| heard > now);
                let echo = heard.map(|heard| heard - now);
                let change = echo.zip(before).map(|(echo, before)| echo as i32 - before as i32);
                changes[usize::from(receiver)] = change.unwrap_or(0);
                (before, edge) = (echo, heard.unwrap_or(u32::MAX));
            } else if event[0] == 1 && is_own {
                kinds[0] += usize::from(event[4] == ReadingKind::Accepted as u32);
                kinds[1] += usize::from(event[4] == ReadingKind::Ambiguous as u32);
            }
        }
    }
}

#[test]
fn crosstalk_that_odometry_expects_is_ambiguous() {
    let mut all = [0; 2];
    for (emitter, receiver) in (0..SENSORS).flat_map(|x| (0..SENSORS as u8).map(move |y| (x, y))) {
        if emitter != usize::from(receiver) {
            let kinds = heard_of(emitter, receiver);
            all = [all[0] + kinds[0], all[1] + kinds[1]];
        }
    }
    assert!(all[0] == 0 && all[1] > 1_000, "{} accepted, {} ambiguous", all[0], all[1]);
}
