//! The contract of `Scheduler`: what core's own schedulers keep, and that the check finds what is broken.

use eeruf_core::tables::{TABLE_I_A, TABLE_I_D};
use eeruf_core::{
    BrokenPromise, ImmediateRefiring, Instant, Limits, Micros, Phase, ScheduledFiring, Scheduler, check_scheduler,
};

const START: Instant = Instant::from_micros(u32::MAX - 500_000);

#[test]
fn scheduled_firing_keeps_the_contract_whatever_is_done_to_it() {
    for seed in 0..40 {
        check_scheduler(&mut ScheduledFiring::new(&TABLE_I_D, START), START, 2_000, seed).unwrap();
        check_scheduler(&mut ScheduledFiring::new(&TABLE_I_A, START), START, 2_000, seed).unwrap();
    }
}

#[test]
fn immediate_refiring_keeps_the_contract_whatever_is_done_to_it() {
    for seed in 0..40 {
        for min_refire in [0, 30, 300] {
            let mut refiring = ImmediateRefiring::new(&TABLE_I_D, Micros::from_millis(min_refire), START);
            check_scheduler(&mut refiring, START, 2_000, seed).unwrap();
        }
    }
}

/// What is wrong with a scheduler that is right otherwise.
#[derive(Clone, Copy, PartialEq)]
enum Fault {
    FiresTheDisabled,
    FiresSoonAfterARestart,
    ForgetsADelay,
    DeadlineFarAhead,
    NeverRests,
    ForgetsASensor,
    ForgetsWhatIsEnabled,
}

struct Faulty {
    inner: ScheduledFiring<'static, 12>,
    fault: Fault,
}

impl Scheduler for Faulty {
    fn deadline(&self) -> Instant {
        match self.fault {
            Fault::DeadlineFarAhead => self.inner.deadline() + Micros::from_millis(400),
            Fault::NeverRests if self.inner.next_firing().is_none() => START,
            _ => self.inner.deadline(),
        }
    }

    fn next_firing(&self) -> Option<(u8, Phase)> {
        self.inner.next_firing()
    }

    fn fire(&mut self, now: Instant) {
        self.inner.fire(now);
    }

    fn postpone(&mut self, sensor: u8, by: Micros) {
        if self.fault != Fault::ForgetsADelay {
            self.inner.postpone(sensor, by);
        }
    }

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        if self.fault == Fault::NeverRests { (Phase::A, false) } else { self.inner.end_period(now) }
    }

    fn ended(&mut self, sensor: u8, at: Instant) {
        self.inner.ended(sensor, at);
    }

    fn sensors(&self) -> usize {
        self.inner.sensors()
    }

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        match self.fault {
            Fault::FiresTheDisabled => {}
            Fault::ForgetsASensor if sensor == 3 => self.inner.set_enabled(sensor, false),
            _ => self.inner.set_enabled(sensor, enabled),
        }
    }

    fn set_paused(&mut self, paused: bool) {
        self.inner.set_paused(paused);
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        self.fault == Fault::ForgetsWhatIsEnabled || self.inner.is_enabled(sensor)
    }

    fn restart(&mut self, now: Instant) {
        if self.fault == Fault::FiresSoonAfterARestart {
            let before = std::mem::replace(&mut self.inner, ScheduledFiring::new(&TABLE_I_D, now));
            (0..12).for_each(|sensor| self.inner.set_enabled(sensor, before.is_enabled(sensor)));
        } else {
            self.inner.restart(now);
        }
    }

    fn periods_since(&self, phase: Phase) -> u8 {
        self.inner.periods_since(phase)
    }

    fn limits(&self) -> Limits<'_> {
        self.inner.limits()
    }

    fn min_refire(&self) -> Micros {
        self.inner.min_refire()
    }

    fn horizon(&self) -> Micros {
        self.inner.horizon()
    }
}

/// What the check finds with some seed.
fn found(fault: Fault) -> Option<BrokenPromise> {
    (0..40).find_map(|seed| {
        let mut faulty = Faulty { inner: ScheduledFiring::new(&TABLE_I_D, START), fault };
        check_scheduler(&mut faulty, START, 2_000, seed).err()
    })
}

#[test]
fn the_check_finds_each_promise_that_is_broken() {
    assert!(matches!(found(Fault::FiresTheDisabled), Some(BrokenPromise::Enabled { .. })));
    assert!(matches!(found(Fault::ForgetsWhatIsEnabled), Some(BrokenPromise::Enabled { sensor: 12 })));
    assert!(matches!(found(Fault::FiresSoonAfterARestart), Some(BrokenPromise::MinRefire { .. })));
    assert!(matches!(found(Fault::ForgetsADelay), Some(BrokenPromise::MinRefire { .. })));
    assert!(matches!(found(Fault::DeadlineFarAhead), Some(BrokenPromise::Horizon { .. })));
    assert_eq!(found(Fault::NeverRests), Some(BrokenPromise::Endless));
    assert!(matches!(found(Fault::ForgetsASensor), Some(BrokenPromise::Enabled { sensor: 3 })));
}

#[test]
fn a_broken_promise_names_the_sensor_the_value_and_what_is_expected() {
    let broken = BrokenPromise::MinRefire { sensor: 2, after: Micros::from_millis(7) };
    assert_eq!(broken.to_string(), "it fires sensor 3 again after 7 ms; expected min_refire or more");
}
