//! A module that holds its line after a lost echo until it is pulled low, as some clones do.

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use crate::pins::{self, Pin};
use eeruf_core::{
    Edge, Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, ScheduledRing, tables::PAPER_12,
    watch::SensorState, watch::SensorWatch,
};
use eeruf_hc_sr04::{FlexPin, HcSr04Ring, Health, Pins, Settings};
use embedded_hal_mock::eh1::delay::NoopDelay;

const K: usize = 12;
const LATCHED: u8 = 3;

/// The lines, and the driver's actions on them since the last look.
#[derive(Default)]
struct Lines {
    high: [bool; K],
    triggered: Option<u8>,
    is_driven: bool,
    /// Number of times that a line was pulled low.
    pulled: u32,
    /// True if the line stays high even when pulled low.
    is_shorted: bool,
}

impl pins::Lines for Lines {
    fn is_high(&self, sensor: u8) -> bool {
        self.high[usize::from(sensor)]
    }

    fn trigger(&mut self, sensor: u8) {
        self.triggered = Some(sensor);
    }
}

impl FlexPin for Pin<Lines> {
    fn drive_low(&mut self) -> Result<(), Infallible> {
        let lines = &mut *self.0.borrow_mut();
        assert_eq!(self.1, LATCHED);
        lines.high[usize::from(self.1)] &= lines.is_shorted;
        (lines.is_driven, lines.pulled) = (true, lines.pulled + 1);
        Ok(())
    }

    fn release(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().is_driven = false;
        Ok(())
    }
}

/// The result of a run: kinds of the latched sensor's readings, its states after them, its health, and the number of
/// times that its line was pulled low.
type Outcome = (Vec<ReadingKind>, Vec<SensorState>, Health, u32);

/// Runs a ring of modules with walls; one of them hears nothing up to this firing.
fn run(deaf_until: u32, recovers: bool, is_shorted: bool) -> Outcome {
    let lines = Rc::new(RefCell::new(Lines { is_shorted, ..Lines::default() }));
    let begin = Instant::from_micros(u32::MAX - 700_000);
    let config = RingConfig::new().with_window(Micros::from_millis(40));
    let ring: ScheduledRing<'_, K> = Ring::new(&PAPER_12, config, begin).unwrap();
    let pins = std::array::from_fn(|x| {
        let pin = |x| Pin(Rc::clone(&lines), x as u8);
        Pins { trigger: pin(x), echo: pin(x) }
    });
    let mut driver = HcSr04Ring::new(ring, pins, NoopDelay, Settings::default()).unwrap();
    let mut watch = SensorWatch::<K>::new(0, begin);
    let (mut edges, mut now, mut firings): (Vec<Edge>, _, _) = (vec![], begin, 0);
    let (mut kinds, mut states) = (vec![], vec![]);
    while kinds.len() < 100 {
        let deadline = driver.next_deadline();
        let next = edges.iter().map(|edge| edge.at).min_by_key(|at| at.since(now));
        now = next.filter(|at| at.since(now) < deadline.since(now)).unwrap_or(deadline);
        let (come, later) = edges.into_iter().partition::<Vec<_>, _>(|edge| edge.at == now);
        edges = later;
        for edge in come {
            lines.borrow_mut().high[usize::from(edge.sensor)] = edge.high;
            driver.edge(edge).unwrap();
        }
        while let Some(event) = driver.poll(now) {
            watch.observe(&event, now);
            match event {
                RingEvent::Fire { sensor, .. } => {
                    if let Some(sensor) = lines.borrow_mut().triggered.take() {
                        let edge = |us, high| Edge { sensor, high, at: now + Micros::new(us) };
                        edges.push(edge(450, true));
                        firings += u32::from(sensor == LATCHED);
                        if sensor != LATCHED || firings > deaf_until {
                            edges.push(edge(9_450, false));
                        }
                    }
                    let was_pulled = lines.borrow().pulled;
                    let pulls = recovers && driver.recover(sensor);
                    assert_eq!(u32::from(pulls), lines.borrow().pulled - was_pulled);
                    assert!(!lines.borrow().is_driven);
                }
                RingEvent::Reading(reading) if reading.sensor == LATCHED => {
                    kinds.push(reading.kind);
                    states.push(watch.state(LATCHED, now).unwrap());
                }
                RingEvent::Reading(_) | RingEvent::PeriodEnded(_) => {}
            }
        }
    }
    let pulled = lines.borrow().pulled;
    (kinds, states, driver.health(LATCHED), pulled)
}

fn count(kinds: &[ReadingKind], kind: ReadingKind) -> usize {
    kinds.iter().filter(|&&each| each == kind).count()
}

#[test]
fn latched_line_recovers_when_pulled_low() {
    let (kinds, states, health, pulled) = run(1, true, false);
    assert_eq!((health, pulled), (Health::Well, 1));
    assert!(count(&kinds, ReadingKind::Accepted) > 90, "{kinds:?}");
    // Held for up to 250 ms after its trigger it listens; then it is stuck, not free space until an echo counts.
    let stuck = kinds.iter().position(|&kind| kind == ReadingKind::Stuck).unwrap();
    assert!(stuck <= 3, "{kinds:?}");
    assert!(!kinds[stuck..].contains(&ReadingKind::Clear), "{kinds:?}");
    assert!(matches!(states[stuck], SensorState::Unanswered { .. }), "{:?}", states[stuck]);
    assert!(states[stuck + 1..].iter().all(|state| !matches!(state, SensorState::Clear { .. })), "{states:?}");
}

#[test]
fn latched_line_stays_stuck_without_recovery() {
    let (kinds, states, health, pulled) = run(1, false, false);
    assert_eq!((health, pulled), (Health::StuckHigh, 0));
    assert!(count(&kinds, ReadingKind::Stuck) > 95, "{kinds:?}");
    assert!(matches!(states.last(), Some(SensorState::Unanswered { .. })));
}

#[test]
fn shorted_line_is_pulled_each_time_and_stays_stuck() {
    let (kinds, _, health, pulled) = run(1, true, true);
    let stuck = count(&kinds, ReadingKind::Stuck);
    assert!(health == Health::StuckHigh && stuck > 95, "{kinds:?}");
    assert_eq!(pulled as usize, stuck);
}

// Nothing is ever in range: the module latches again each time, and every other firing has evidence.
#[test]
fn module_that_latches_again_is_not_pulled_while_it_listens() {
    let (kinds, _, _, pulled) = run(u32::MAX, true, false);
    assert_eq!(pulled as usize, count(&kinds, ReadingKind::Stuck));
    assert!((25..60).contains(&pulled), "{pulled}: {kinds:?}");
}
