//! Modules triggered by a timer while the loop is late. Hardware stamps their edges or measures their pulses, with
//! results that are late, lost or duplicated.

use eeruf_core::{
    Edge, Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, ScheduledRing, SensorError, Tally,
    tables::PAPER_12,
};
use eeruf_hc_sr04::{HcSr04Ring, Health, Settings};
use fastrand::Rng;

const K: usize = 12;
type Driver = HcSr04Ring<ScheduledRing<'static, K>, (), (), (), K>;

/// The answer of a module to a trigger.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Answer {
    /// A pulse of this many microseconds.
    Pulse(u32),
    /// No edge at all.
    Cut,
    /// The line rises, and its fall is lost.
    LostFall,
    /// The line falls, and its rise was lost.
    LostRise,
    /// The hardware reports twice.
    Twice(u32),
}

/// Runs several periods in a loop with a turn every 0 to 5 ms; with `pulses`, hardware measures widths instead of
/// stamping edges.
fn run(pulses: bool, periods: u32, answer: impl Fn(u8, u32) -> Answer) -> ([Tally<u32>; K], [Health; K]) {
    let mut r = Rng::with_seed(20_000);
    let mut now = Instant::from_micros(u32::MAX - 700_000);
    let ring = Ring::new(&PAPER_12, RingConfig::new().with_window(Micros::from_millis(40)), now).unwrap();
    let mut driver: Driver = HcSr04Ring::by_hardware(ring, Settings::default()).unwrap();
    driver.set_report_after(Micros::from_millis(46)).unwrap();
    let (mut edges, mut widths): (Vec<Edge>, Vec<(Instant, u8, u32)>) = (vec![], vec![]);
    let (mut tallies, mut ended) = ([Tally::default(); K], 0);
    while ended < periods {
        now += Micros::new(r.u32(..=5_000));
        loop {
            let timer = driver.upcoming().next().filter(|next| now.has_reached(next.due));
            let until = timer.map_or(now, |next| next.due);
            edges.sort_by_key(|edge| edge.at.since(now).as_micros().wrapping_add(1 << 31));
            let (come, later) = edges.into_iter().partition::<Vec<_>, _>(|edge| until.has_reached(edge.at));
            edges = later;
            come.into_iter().for_each(|edge| driver.edge(edge).unwrap());
            let (come, later) = widths.into_iter().partition::<Vec<_>, _>(|(at, ..)| until.has_reached(*at));
            widths = later;
            come.into_iter().for_each(|(_, sensor, width)| driver.pulse(sensor, Micros::new(width)).unwrap());
            while let Some(event) = driver.poll_triggered(until) {
                match event {
                    RingEvent::Fire { sensor, .. } => {
                        let us = |us| until + Micros::new(us);
                        let jitter = r.u32(..=30);
                        let line = match answer(sensor, ended) {
                            Answer::Pulse(width) => vec![(450, true), (450 + width + jitter, false)],
                            Answer::Twice(width) => {
                                let end = 450 + width + jitter;
                                vec![(450, true), (end, false), (end + 300, true), (end + 700, false)]
                            }
                            Answer::LostFall => vec![(450, true)],
                            Answer::LostRise => vec![(9_000, false)],
                            Answer::Cut => vec![],
                        };
                        if pulses {
                            // The hardware reports a while after the pulse has ended; without an end nothing.
                            let widths_of = match answer(sensor, ended) {
                                Answer::Pulse(width) => vec![width + jitter],
                                Answer::Twice(width) => vec![width + jitter, width + 900],
                                _ => vec![],
                            };
                            widths.extend(widths_of.into_iter().map(|width| (us(width + 5_000), sensor, width)));
                        } else {
                            edges.extend(line.into_iter().map(|(at, high)| Edge { sensor, high, at: us(at) }));
                        }
                    }
                    RingEvent::Reading(reading) => tallies[usize::from(reading.sensor)].count(reading.kind),
                    RingEvent::PeriodEnded(_) => ended += 1,
                }
            }
            if timer.is_none() {
                break;
            }
        }
    }
    (tallies, std::array::from_fn(|x| driver.health(x as u8)))
}

fn fired(tally: &Tally<u32>) -> u32 {
    ReadingKind::ALL.iter().map(|&kind| tally.of(kind)).sum()
}

fn wall(sensor: u8) -> Answer {
    Answer::Pulse(3_000 + 2_000 * u32::from(sensor))
}

#[test]
fn late_loop_accepts_walls_and_clears_space() {
    for pulses in [false, true] {
        // Sensors from 8 on have nothing in range, and hold their lines for 38 ms.
        let space = |sensor, _| if sensor < 8 { wall(sensor) } else { Answer::Pulse(37_900) };
        let (tallies, health) = run(pulses, 300, space);
        for (sensor, tally) in tallies.iter().enumerate() {
            let right = tally.of(if sensor < 8 { ReadingKind::Accepted } else { ReadingKind::Clear });
            assert!(100 * right >= 99 * (fired(tally) - 1), "sensor {sensor}, pulses {pulses}: {tally:?}");
        }
        assert_eq!(health, [Health::Well; K]);
    }
}

#[test]
fn faulty_lines_are_never_clear() {
    let faulty = |sensor, period: u32| match sensor {
        0 => Answer::Cut,
        1 => Answer::LostFall,
        2 => Answer::LostRise,
        // A wall whose result gets lost every other time.
        3 if period % 2 == 0 => Answer::LostFall,
        4 => Answer::Twice(9_000),
        5 if period % 3 == 0 => Answer::Cut,
        sensor => wall(sensor),
    };
    for pulses in [false, true] {
        let (tallies, health) = run(pulses, 100, faulty);
        for (sensor, tally) in tallies.iter().enumerate() {
            assert_eq!(tally.of(ReadingKind::Clear), 0, "sensor {sensor}, pulses {pulses}: {tally:?}");
        }
        let [cut, lost_fall, lost_rise, _, twice, ..] = health;
        assert_eq!(cut, Health::Missing);
        assert_eq!(twice, Health::Chatters, "pulses {pulses}");
        if !pulses {
            assert_eq!([lost_fall, lost_rise], [Health::LosesEdges; 2]);
        }
        assert!(tallies[4].of(ReadingKind::Accepted) > 95, "{:?}", tallies[4]);
        assert!(tallies[6].of(ReadingKind::Accepted) > 95, "{:?}", tallies[6]);
    }
}

#[test]
fn pulse_of_unknown_sensor_is_refused() {
    let now = Instant::from_micros(0);
    let ring = Ring::new(&PAPER_12, RingConfig::new().with_window(Micros::from_millis(40)), now).unwrap();
    let mut driver: Driver = HcSr04Ring::by_hardware(ring, Settings::default()).unwrap();
    assert_eq!(driver.pulse(12, Micros::new(9_000)), Err(SensorError { sensor: 12, sensors: 12 }));
    assert_eq!(driver.pulse(3, Micros::new(9_000)), Ok(()), "of a sensor that was not triggered: ignored");
}
