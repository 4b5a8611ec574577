//! Settings of a driver that can change while it runs.

use core::convert::Infallible;

use eeruf_core::tables::{PAPER_12, TABLE_I_D};
use eeruf_core::{
    EchoFilter, Edge, Instant, Micros, ReadingKind, Requirements, Ring, RingConfig, RingEvent, SensorError, Tally,
    adaptation::Adaptation, plan::Plan,
};
use eeruf_hc_sr04::{HcSr04Ring, Pins, Settings, SetupError};
use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use embedded_hal_mock::eh1::delay::NoopDelay;

/// The sensor that an event fires.
fn fired(event: Option<RingEvent>) -> Option<u8> {
    match event {
        Some(RingEvent::Fire { sensor, .. }) => Some(sensor),
        _ => None,
    }
}

/// A driver on dummy pins.
fn on_no_pins<P: Plan, const N: usize>(
    ring: Ring<P, EchoFilter<N>, N>,
) -> Result<HcSr04Ring<Ring<P, EchoFilter<N>, N>, NoPin, NoPin, NoopDelay, N>, SetupError> {
    HcSr04Ring::new(ring, std::array::from_fn(|_| Pins { trigger: NoPin, echo: NoPin }), NoopDelay, Settings::default())
}

/// A pin that is low and stays low.
struct NoPin;

impl ErrorType for NoPin {
    type Error = Infallible;
}

impl OutputPin for NoPin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

impl InputPin for NoPin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(false)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(true)
    }
}

// An adaptation changes the schedule of the driver, and keeps its rung if that is refused.
#[test]
fn adaptation_changes_the_drivers_schedule() {
    let requirements = Requirements::new(Micros::new(500));
    let rung = |scale| TABLE_I_D.scaled(scale, 10).unwrap().verified(&requirements).unwrap();
    // The third fires a sensor again after 53 ms, sooner than an HC-SR04 may be triggered.
    for (rungs, allowed) in [([rung(9), rung(10)], true), ([rung(7), rung(8)], false)] {
        let ring = Ring::new(
            &rungs[usize::from(!allowed)],
            RingConfig::new().with_window(Micros::from_millis(40)),
            Instant::default(),
        );
        let mut driver = on_no_pins(ring.unwrap()).unwrap();
        let mut adaptation = Adaptation::new(&rungs).unwrap();
        let mut stats = loop {
            if let Some(RingEvent::PeriodEnded(stats)) = driver.poll(driver.next_deadline()) {
                break stats;
            }
        };
        (0..10).for_each(|_| stats.tally.count(ReadingKind::Rejected));
        let mut change = || {
            (0..16).map(|_| adaptation.adapt(&stats, |schedule| driver.change_schedule(schedule))).collect::<Vec<_>>()
        };
        assert_eq!(change()[15], Ok(true));
        if !allowed {
            // Down again, to the rung that is too fast.
            let mut calm = stats;
            calm.tally = Tally::default();
            calm.tally.count(ReadingKind::Accepted);
            let refused = (0..64)
                .map(|_| adaptation.adapt(&calm, |schedule| driver.change_schedule(schedule)))
                .find(Result::is_err);
            assert!(matches!(refused, Some(Err(SetupError::Retrigger { .. }))));
            assert_eq!(adaptation.rung(), 1);
        }
    }
}

#[test]
fn an_edge_or_a_firing_of_a_line_that_is_not_there_is_refused() {
    let ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::default()).unwrap();
    let mut driver = on_no_pins(ring).unwrap();
    let refused = Err(SensorError { sensor: 12, sensors: 12 });
    assert_eq!(driver.edge(Edge { sensor: 12, high: true, at: Instant::default() }), refused);
    assert_eq!(driver.fired(12, Instant::default()), refused);
    assert_eq!(driver.disable(12), refused);
    assert_eq!(driver.edge(Edge { sensor: 11, high: true, at: Instant::default() }), Ok(()));
}

#[test]
fn the_width_of_a_pulse_counts_wherever_the_trigger_really_came() {
    let ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::default()).unwrap();
    let mut driver = on_no_pins(ring).unwrap();
    let due = driver.next_deadline();
    let Some(RingEvent::Fire { sensor, .. }) = driver.poll(due) else { panic!("fires") };
    let us = |us| due + Micros::new(us);
    driver.fired(sensor, us(300)).unwrap();
    // A glitch within the deaf time after the true trigger, then the pulse.
    driver.edge(Edge { sensor, high: true, at: us(390) }).unwrap();
    driver.edge(Edge { sensor, high: false, at: us(395) }).unwrap();
    driver.edge(Edge { sensor, high: true, at: us(750) }).unwrap();
    driver.edge(Edge { sensor, high: false, at: us(5_750) }).unwrap();
    // A gap of less than 100 us would not end it.
    let reading = std::iter::from_fn(|| driver.poll(us(5_850))).find_map(|event| match event {
        RingEvent::Reading(reading) => Some(reading),
        _ => None,
    });
    assert_eq!(reading.map(|reading| (reading.sensor, reading.t_echo)), Some((sensor, Some(Micros::new(5_000)))));
}

#[test]
fn a_driver_pauses_resumes_and_restarts_as_its_ring_does() {
    let ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::default()).unwrap();
    let mut driver = on_no_pins(ring).unwrap();
    driver.pause();
    assert!(matches!(driver.poll(driver.next_deadline()), Some(RingEvent::PeriodEnded(_))));
    driver.resume();
    assert!(matches!(driver.poll(driver.next_deadline()), Some(RingEvent::PeriodEnded(_))));
    assert_eq!(fired(driver.poll(driver.next_deadline())), Some(0));
    driver.restart(driver.next_deadline());
    assert_eq!(fired(driver.poll(driver.next_deadline())), Some(0));
    assert_eq!(driver.set_window(Micros::from_millis(30)), Ok(()));
    assert_eq!(driver.set_t_delta(Micros::new(300)), Ok(()));
    assert_eq!(driver.set_blanking(Micros::new(400)), Ok(()));
    let ring = driver.ring();
    assert_eq!([ring.window(), ring.t_delta(), ring.blanking()], [30_000, 300, 400].map(Micros::new));
}
