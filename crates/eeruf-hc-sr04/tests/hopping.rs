//! A hopping ring behind real wiring: pulses are echoes, solo periods trigger one sensor alone, a fault costs only the
//! sensor that has it.

use eeruf_core::{
    Edge, Instant, Micros, ReadingKind, RingEvent, Tally,
    hopping::{HoppingCode, HoppingListening, HoppingRing, HoppingSchedule, HoppingSettings},
};
use eeruf_hc_sr04::{HcSr04Ring, Health, Pins, Settings, SetupError};
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::digital::{Mock, State, Transaction};

const K: usize = 3;
const WINDOW: Micros = Micros::from_millis(40);

fn ring() -> HoppingRing<K> {
    let code = HoppingCode::new(K, 5, Micros::new(240)).unwrap();
    let schedule = HoppingSchedule::spread(code, Micros::from_millis(60)).unwrap();
    let settings = HoppingSettings::BALANCED.with_shift_after(0);
    HoppingRing::hopping(&schedule, settings, HoppingListening::new(WINDOW), 1, Instant::default()).unwrap()
}

/// Mocks that are triggered so often, with lines that are low, or of which one is always high.
fn pins(firings: [usize; K], high: Option<usize>) -> [Pins<Mock, Mock>; K] {
    std::array::from_fn(|x| {
        let (stuck, pulse) = (high == Some(x), [Transaction::set(State::High), Transaction::set(State::Low)]);
        let trigger = if stuck { vec![] } else { pulse.iter().cloned().cycle().take(2 * firings[x]).collect() };
        let line = Transaction::get(if stuck { State::High } else { State::Low });
        Pins { trigger: Mock::new(&trigger), echo: Mock::new(&vec![line; firings[x]]) }
    })
}

/// Runs some periods; an echo of each sensor is this many microseconds wide, if it has one.
fn run(
    periods: u32,
    pins: [Pins<Mock, Mock>; K],
    widths: [Option<u32>; K],
) -> ([Tally<u32>; K], [Health; K], [usize; K]) {
    let mut settings = Settings::default();
    settings.min_retrigger = WINDOW;
    let mut driver = HcSr04Ring::new(ring(), pins.clone(), NoopDelay, settings).unwrap();
    let (mut edges, mut tallies, mut fired, mut ended) = (Vec::<Edge>::new(), [Tally::default(); K], [0; K], 0);
    while ended < periods {
        let deadline = driver.next_deadline();
        edges.sort_by_key(|edge| edge.at.as_micros());
        let now = edges.first().map_or(deadline, |edge| if deadline.has_reached(edge.at) { edge.at } else { deadline });
        while edges.first().is_some_and(|edge| now.has_reached(edge.at)) {
            driver.edge(edges.remove(0)).unwrap();
        }
        while ended < periods {
            match driver.poll(now) {
                Some(RingEvent::Fire { sensor, .. }) => {
                    let x = usize::from(sensor);
                    fired[x] += 1;
                    if let Some(width) = widths[x] {
                        let rises = now + Micros::new(450);
                        edges.push(Edge { sensor, high: true, at: rises });
                        edges.push(Edge { sensor, high: false, at: rises + Micros::new(width) });
                    }
                }
                Some(RingEvent::Reading(reading)) => tallies[usize::from(reading.sensor)].count(reading.kind),
                Some(RingEvent::PeriodEnded(_)) => ended += 1,
                None => break,
            }
        }
    }
    let health = std::array::from_fn(|x| driver.health(x as u8));
    drop(driver);
    for Pins { mut trigger, mut echo } in pins {
        trigger.done();
        echo.done();
    }
    (tallies, health, fired)
}

// The width of the pulse is the echo time and five phases that agree confirm it.
#[test]
fn pulse_width_is_the_echo_time_and_five_phases_confirm() {
    let (tallies, health, _) = run(20, pins([20; K], None), [Some(5_000), Some(12_000), Some(20_000)]);
    for x in 0..K {
        let of = |kind| tallies[x].of(kind);
        assert_eq!((of(ReadingKind::First), of(ReadingKind::Tentative), health[x]), (1, 3, Health::Well));
        assert!(of(ReadingKind::Accepted) >= 15, "{}", of(ReadingKind::Accepted));
    }
}

// A line stuck high is never triggered and costs the others nothing.
#[test]
fn stuck_line_is_never_triggered() {
    let (tallies, health, fired) = run(40, pins([40; K], Some(1)), [Some(5_000), None, Some(20_000)]);
    // No period is given to the stuck sensor alone.
    assert_eq!(fired, [40; K]);
    assert_eq!(health, [Health::Well, Health::StuckHigh, Health::Well]);
    assert!(tallies[1].of(ReadingKind::Stuck) >= 39 && tallies[1].of(ReadingKind::Accepted) == 0);
    assert!([0, 2].iter().all(|&x| tallies[x].of(ReadingKind::Accepted) >= 34), "{tallies:?}");
}

#[test]
fn a_window_shorter_than_the_sensors_rest_is_refused() {
    let idle = pins([0; K], None);
    let driver = HcSr04Ring::new(ring(), idle.clone(), NoopDelay, Settings::default());
    let expected = SetupError::Retrigger { min_refire: WINDOW, min_retrigger: Micros::from_millis(60) };
    assert_eq!(driver.err(), Some(expected));
    for Pins { mut trigger, mut echo } in idle {
        trigger.done();
        echo.done();
    }
}
