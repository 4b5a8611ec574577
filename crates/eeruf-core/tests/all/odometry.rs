//! Odometry and the promise: a ring that knows the expected change of a good reading accepts every wall that it drives
//! towards, and no path of foreign sound.

use eeruf_core::tables::PAPER_12;
use eeruf_core::{Instant, Micros, Phase, ReadingKind, Ring, RingConfig, RingEvent};

const SENSORS: usize = 12;
const PERIOD: i64 = 100_000;
/// Change of an echo at 1 m/s towards a wall, in nanoseconds a millisecond.
const AT_1_M_S: i64 = 5_828;

/// Drives at `mm_s`, polling on time with odometry. Each sensor hears the sensor `further` places on (0 for its own
/// wall) along a path of `length` in the middle of the run, shortening at `path_mm_s`. Returns the numbers of receivers
/// that accepted anything, of accepted readings, and of compared readings.
fn run(mm_s: i64, path_mm_s: i64, further: usize, length: i64) -> (usize, u32, u32) {
    let fires = |x: usize, number: i64| {
        let t_fire = PAPER_12.t_fire(Phase((number % 2) as u8), x).unwrap();
        number * PERIOD + i64::from(t_fire.as_micros())
    };
    let arrives = |x: usize, number: i64| {
        let sent = fires(x, number);
        sent + length - path_mm_s * AT_1_M_S * (sent / 1_000 - 20 * PERIOD / 1_000) / 1_000_000
    };
    let mut ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::from_micros(0)).unwrap();
    let (mut fired, mut changes) = ([0_i64; SENSORS], [0; SENSORS]);
    let (mut accepted, mut compared) = ([0; SENSORS], 0);
    // The pending edge of each sensor.
    let mut edges = [i64::MAX; SENSORS];
    loop {
        let due = i64::from(ring.next_deadline().as_micros());
        let at = edges.iter().fold(due, |due, &edge| due.min(edge));
        if at >= 40 * PERIOD {
            break;
        }
        let now = Instant::from_micros(at as u32);
        for (y, edge) in edges.iter_mut().enumerate().filter(|(_, edge)| **edge == at) {
            ring.echo(y as u8, now).unwrap();
            *edge = i64::MAX;
        }
        while let Some(event) = ring.poll_expecting(now, |sensor| changes[usize::from(sensor)]) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let y = usize::from(sensor);
                    changes[y] = (-mm_s * AT_1_M_S * (at - fired[y]) / 1_000_000_000) as i32;
                    fired[y] = at;
                    let x = (y + further) % SENSORS;
                    edges[y] = (0..40).map(|number| arrives(x, number)).find(|&heard| heard > at).unwrap_or(i64::MAX);
                }
                RingEvent::Reading(reading) => {
                    compared += u32::from(reading.previous.is_some() && reading.t_echo.is_some());
                    accepted[usize::from(reading.sensor)] += u32::from(reading.kind == ReadingKind::Accepted);
                }
                RingEvent::PeriodEnded(stats) => assert_eq!(stats.sum_late, Micros::ZERO),
            }
        }
    }
    (accepted.iter().filter(|&&accepted| accepted > 0).count(), accepted.iter().sum(), compared)
}

#[test]
fn odometry_accepts_no_single_path_on_time() {
    let mut all = 0;
    // Fixed paths, and paths that change like a sensor's own wall while that is within P: up to 1.38 m/s.
    let fixed = [750, 1_000, 1_500, 2_000, 3_000].map(|mm_s| (mm_s, 0));
    for (mm_s, path_mm_s) in fixed.into_iter().chain([500, 750, 1_000, 1_300].map(|mm_s| (mm_s, mm_s))) {
        let (mut pairs, mut readings) = (0, 0);
        for further in 1..SENSORS {
            for length in (9_000..70_000).step_by(20_000) {
                let (receivers, accepted, compared) = run(mm_s, path_mm_s, further, length);
                (pairs, readings, all) = (pairs + receivers, readings + accepted, all + compared);
            }
        }
        println!("{mm_s} mm/s, path {path_mm_s} mm/s: {readings} readings of {pairs} pairs and lengths accepted");
        assert_eq!((pairs, readings), (0, 0), "{mm_s} mm/s, path {path_mm_s} mm/s");
    }
    assert!(all > 20_000, "{all} compared");
}

#[test]
fn odometry_loses_no_wall_at_a_metre_a_second() {
    for mm_s in [-1_000, 500, 1_000, 1_200] {
        for length in [20_000, 25_000, 33_000] {
            let (receivers, accepted, compared) = run(mm_s, mm_s, 0, length);
            assert_eq!((receivers, accepted), (SENSORS, compared), "{mm_s} mm/s, {length} us");
        }
    }
}
