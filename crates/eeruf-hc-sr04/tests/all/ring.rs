//! Faults of real wiring: each affects only its own sensor, and the driver names it.

use eeruf_core::{
    Edge, EdgeQueue, Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, Schedule, ScheduledRing, Tally,
};
use eeruf_hc_sr04::{HcSr04Ring, Health, Pins, Settings, SetupError};
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::digital::{Mock, State, Transaction};

const K: usize = 3;
type Driver<'s> = HcSr04Ring<ScheduledRing<'s, K>, Mock, Mock, NoopDelay, K>;

fn schedule(period_ms: u32) -> Schedule<K> {
    let ms = |ms: [u32; K]| ms.map(Micros::from_millis);
    Schedule::from_firing(Micros::from_millis(period_ms), [ms([24, 44, 64]), ms([20, 38, 56])]).unwrap()
}

const CONFIG: RingConfig = RingConfig::new().with_t_delta(Micros::new(500)).with_window(Micros::from_millis(40));

/// Response of a sensor to its n-th trigger: edges as (time in us, high).
type Line<'a> = &'a dyn Fn(u32) -> Vec<(u32, bool)>;

fn echo(us: u32) -> impl Fn(u32) -> Vec<(u32, bool)> {
    move |_| vec![(450, true), (450 + us, false)]
}

/// Runs several periods; with `high` the line of sensor 1 is high when the sensor is to be triggered.
fn run(periods: u32, high: bool, lines: [Line<'_>; K]) -> ([Tally<u32>; K], [Health; K]) {
    let schedule = schedule(100);
    let pulses =
        |n| (0..n).flat_map(|_| [Transaction::set(State::High), Transaction::set(State::Low)]).collect::<Vec<_>>();
    // All firings of each sensor until the period after the last has begun.
    let firings = periods as usize;
    let mut mocks = Vec::new();
    let pins: [Pins<Mock, Mock>; K] = std::array::from_fn(|x| {
        let stuck = high && x == 1;
        let state = if stuck { State::High } else { State::Low };
        let trigger = Mock::new(&if stuck { vec![] } else { pulses(firings) });
        let echo = Mock::new(&vec![Transaction::get(state); firings]);
        mocks.extend([trigger.clone(), echo.clone()]);
        Pins { trigger, echo }
    });
    let ring = Ring::unverified(&schedule, CONFIG, Instant::default()).unwrap();
    let mut driver: Driver<'_> = HcSr04Ring::new(ring, pins, NoopDelay, Settings::default()).unwrap();
    let mut edges: Vec<Edge> = Vec::new();
    let mut tallies = [Tally::default(); K];
    let mut ended = 0;
    while ended < periods {
        let deadline = driver.next_deadline();
        edges.sort_by_key(|edge| edge.at.as_micros());
        let now = match edges.first() {
            Some(edge) if deadline.has_reached(edge.at) => edge.at,
            _ => deadline,
        };
        while edges.first().is_some_and(|edge| now.has_reached(edge.at)) {
            driver.edge(edges.remove(0)).unwrap();
        }
        while let Some(event) = driver.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    let line = lines[usize::from(sensor)];
                    let us = |us| now + Micros::new(us);
                    edges.extend(line(ended).into_iter().map(|(at, high)| Edge { sensor, high, at: us(at) }));
                }
                RingEvent::Reading(reading) => tallies[usize::from(reading.sensor)].count(reading.kind),
                RingEvent::PeriodEnded(_) => ended += 1,
            }
        }
    }
    let health = std::array::from_fn(|x| driver.health(x as u8));
    drop(driver);
    // Sensors are triggered as often as fired, and never when stuck.
    for mut mock in mocks {
        mock.done();
    }
    (tallies, health)
}

/// Checks that the other sensors read as if there were no fault.
fn others_are_well(tallies: &[Tally<u32>; K], health: &[Health; K]) {
    for x in [0, 2] {
        assert_eq!(
            (tallies[x].of(ReadingKind::First), tallies[x].of(ReadingKind::Accepted), health[x]),
            (1, 9, Health::Well)
        );
    }
}

// The width of the pulse is the echo time, and two that agree are accepted.
#[test]
fn pulse_width_is_the_echo_time_and_two_are_accepted() {
    let (tallies, health) = run(10, false, [&echo(5_000), &echo(12_000), &echo(20_000)]);
    others_are_well(&tallies, &health);
    assert_eq!((tallies[1].of(ReadingKind::Accepted), health[1]), (9, Health::Well));
}

#[test]
fn edges_within_100_us_of_the_trigger_are_not_echoes() {
    let noisy = |_| vec![(20, true), (60, false), (99, true), (450, true), (12_450, false)];
    let (tallies, health) = run(10, false, [&echo(5_000), &noisy, &echo(20_000)]);
    others_are_well(&tallies, &health);
    assert_eq!((tallies[1].of(ReadingKind::Accepted), health[1]), (9, Health::Well));
}

#[test]
fn a_line_stuck_high_is_not_triggered_and_told_as_stuck() {
    let (tallies, health) = run(10, true, [&echo(5_000), &|_| vec![], &echo(20_000)]);
    others_are_well(&tallies, &health);
    assert_eq!(
        tallies[1].of(ReadingKind::Stuck) + tallies[1].of(ReadingKind::NoEcho) + tallies[1].of(ReadingKind::Clear),
        10
    );
    assert_eq!((tallies[1].of(ReadingKind::Stuck), health[1]), (10, Health::StuckHigh));
}

// A missing sensor is named after three firings without a pulse.
#[test]
fn missing_sensor_is_named_after_three_firings() {
    let none: Line<'_> = &|_| vec![];
    assert_eq!(run(3, false, [&echo(5_000), none, &echo(20_000)]).1[1], Health::Well);
    let (tallies, health) = run(10, false, [&echo(5_000), none, &echo(20_000)]);
    others_are_well(&tallies, &health);
    assert_eq!((tallies[1].of(ReadingKind::Unanswered), health[1]), (10, Health::Missing));
}

#[test]
fn no_line_that_shows_nothing_is_told_as_free_space() {
    let faults: [(&str, Line<'_>, ReadingKind); 6] = [
        ("a cut wire", &|_| vec![], ReadingKind::Unanswered),
        ("a lost rise", &|_| vec![(12_450, false)], ReadingKind::Unanswered),
        ("a lost fall", &|_| vec![(450, true)], ReadingKind::NoEcho),
        ("a glitch", &|_| vec![(3_000, true), (3_005, false)], ReadingKind::Unanswered),
        ("glitches", &|_| vec![(300, true), (360, false), (9_000, true), (9_080, false)], ReadingKind::Unanswered),
        // The line answers only every other firing, and one answer confirms nothing.
        (
            "a loose wire",
            &|n| if n % 2 == 0 { vec![] } else { vec![(450, true), (38_450, false)] },
            ReadingKind::NoEcho,
        ),
    ];
    for (fault, line, kind) in faults {
        let (tallies, health) = run(20, false, [&echo(5_000), line, &echo(20_000)]);
        let of = |kind| tallies[1].of(kind);
        assert_eq!(of(ReadingKind::Clear), 0, "{fault}");
        assert!(of(kind) >= 9 && of(ReadingKind::Accepted) == 0, "{fault}: {:?}", tallies[1]);
        assert_eq!(tallies[0].of(ReadingKind::Accepted), 19, "{fault}");
        assert_eq!(health[0], Health::Well, "{fault}");
    }
}

// A chattering line counts with its first true pulse and is named.
#[test]
fn chattering_line_counts_and_is_named() {
    let chatters = |_| vec![(450, true), (480, false), (500, true), (12_500, false), (13_000, true), (14_000, false)];
    let (tallies, health) = run(10, false, [&echo(5_000), &chatters, &echo(20_000)]);
    others_are_well(&tallies, &health);
    assert_eq!((tallies[1].of(ReadingKind::Accepted), health[1]), (9, Health::Chatters));
}

// A line whose edges get lost is named, and the remaining edges make no pulse.
#[test]
fn line_that_loses_edges_is_named() {
    let rises_lost = |_| vec![(12_450, false)];
    let (tallies, health) = run(10, false, [&echo(5_000), &rises_lost, &echo(20_000)]);
    others_are_well(&tallies, &health);
    assert_eq!((tallies[1].of(ReadingKind::Unanswered), health[1]), (10, Health::LosesEdges));
    let falls_lost = |_| vec![(450, true)];
    let (tallies, health) = run(10, false, [&echo(5_000), &falls_lost, &echo(20_000)]);
    others_are_well(&tallies, &health);
    // Each firing may have had an echo.
    assert_eq!((tallies[1].of(ReadingKind::NoEcho), health[1]), (10, Health::LosesEdges));
}

// The trigger seen across the end of the deaf time is no lost edge.
#[test]
fn trigger_across_deaf_time_is_no_lost_edge() {
    let long_glitch = |_| vec![(20, true), (110, false), (450, true), (12_450, false)];
    let (tallies, health) = run(10, false, [&echo(5_000), &long_glitch, &echo(20_000)]);
    others_are_well(&tallies, &health);
    assert_eq!((tallies[1].of(ReadingKind::Accepted), health[1]), (9, Health::Well));
}

#[test]
fn the_sensors_own_time_out_is_no_echo_and_no_fault() {
    let (tallies, health) = run(10, false, [&echo(5_000), &echo(38_000), &echo(20_000)]);
    others_are_well(&tallies, &health);
    assert_eq!((tallies[1].of(ReadingKind::Clear), health[1]), (9, Health::Well));
}

/// The sensor that an event fires.
fn fired(event: Option<RingEvent>) -> Option<u8> {
    match event {
        Some(RingEvent::Fire { sensor, .. }) => Some(sensor),
        _ => None,
    }
}

// An echo that came in time is heard however long an event took.
#[test]
fn timely_echo_is_heard_however_long_an_event_took() {
    let schedule = schedule(100);
    let pins = || Mock::new(&[Transaction::set(State::High), Transaction::set(State::Low)]);
    let low = || Mock::new(&[Transaction::get(State::Low)]);
    let mut mocks: Vec<Mock> = Vec::new();
    let pins: [Pins<Mock, Mock>; K] = std::array::from_fn(|_| {
        let pair = Pins { trigger: pins(), echo: low() };
        mocks.extend([pair.trigger.clone(), pair.echo.clone()]);
        pair
    });
    let ring = Ring::unverified(&schedule, CONFIG, Instant::default()).unwrap();
    let edges = EdgeQueue::<8>::new();
    let mut driver = HcSr04Ring::with_edges(ring, pins, NoopDelay, Settings::default(), &edges).unwrap();
    let ms = |ms: u32| Instant::from_micros(1000 * ms);
    assert_eq!(fired(driver.poll(ms(24))), Some(0));
    // Here the caller is held up for 50 ms, and its edges wait.
    edges.push(Edge { sensor: 0, high: true, at: ms(25) });
    edges.push(Edge { sensor: 0, high: false, at: ms(31) });
    let events: Vec<_> = std::iter::from_fn(|| driver.poll(ms(74))).take(2).collect();
    assert_eq!(fired(Some(events[0])), Some(1));
    let RingEvent::Reading(reading) = events[1] else { panic!("{events:?}") };
    assert_eq!((reading.sensor, reading.t_echo), (0, Some(Micros::from_millis(6))));
    let third = std::iter::from_fn(|| driver.poll(ms(94))).next();
    assert_eq!(fired(third), Some(2));
    // The same holds for the other way of polling.
    edges.push(Edge { sensor: 2, high: true, at: ms(95) });
    edges.push(Edge { sensor: 2, high: false, at: ms(103) });
    let expecting = std::iter::from_fn(|| driver.poll_expecting(ms(140), |_| 0));
    let echoes = expecting.filter_map(|event| match event {
        RingEvent::Reading(reading) if reading.sensor == 2 => reading.t_echo,
        _ => None,
    });
    assert_eq!(echoes.collect::<Vec<_>>(), [Micros::from_millis(8)]);
    drop(driver);
    for mut mock in mocks {
        mock.done();
    }
}

#[test]
fn a_schedule_that_triggers_a_sensor_too_soon_is_refused() {
    let schedule = schedule(66);
    let mut unused = Mock::new(&[]);
    let pins = || std::array::from_fn(|_| Pins { trigger: unused.clone(), echo: unused.clone() });
    let ring = || Ring::unverified(&schedule, CONFIG, Instant::default()).unwrap();
    let error: Result<Driver<'_>, _> = HcSr04Ring::new(ring(), pins(), NoopDelay, Settings::default());
    let Err(error @ SetupError::Retrigger { .. }) = error else { panic!("not refused") };
    assert_eq!(error.to_string(), "a sensor of this schedule fires again after 58 ms; its module needs at least 60 ms");
    unused.done();
}
