//! The contract of `Plan`: the plans in core keep it, and the check finds plans that break it.

use eeruf_core::tables::{TABLE_I_A, TABLE_I_D};
use eeruf_core::{
    Instant, Micros, Phase,
    judge::FiringContext,
    plan::{BrokenPromise, ImmediateRefiring, Plan, PlanLimits, ScheduledFiring, check_plan},
};

const START: Instant = Instant::from_micros(u32::MAX - 500_000);

#[test]
fn scheduled_firing_keeps_the_contract_whatever_is_done_to_it() {
    for seed in 0..40 {
        check_plan(&mut ScheduledFiring::new(&TABLE_I_D, START), START, 2_000, seed).unwrap();
        check_plan(&mut ScheduledFiring::new(&TABLE_I_A, START), START, 2_000, seed).unwrap();
    }
}

#[test]
fn immediate_refiring_keeps_the_contract_whatever_is_done_to_it() {
    for seed in 0..40 {
        for min_refire in [0, 30, 300] {
            let mut refiring = ImmediateRefiring::new(&TABLE_I_D, Micros::from_millis(min_refire), START);
            check_plan(&mut refiring, START, 2_000, seed).unwrap();
        }
    }
}

/// The fault of a plan that is otherwise correct.
#[derive(Clone, Copy, PartialEq)]
enum Fault {
    FiresTheDisabled,
    FiresSoonAfterARestart,
    ForgetsADelay,
    DeadlineFarAhead,
    NeverRests,
    ForgetsASensor,
    ForgetsWhatIsEnabled,
    FiresWhatItSaysIsDisabled,
    SaysThatASilentOneIsEnabled,
    FiresOneThatIsNotThere,
}

struct Faulty {
    inner: ScheduledFiring<'static, 12>,
    fault: Fault,
    /// Sensors reported as disabled by the ring.
    disabled: [bool; 12],
}

impl Plan for Faulty {
    fn deadline(&self) -> Instant {
        match self.fault {
            Fault::DeadlineFarAhead => self.inner.deadline() + Micros::from_millis(400),
            Fault::NeverRests if self.inner.next_firing().is_none() => START,
            _ => self.inner.deadline(),
        }
    }

    fn next_firing(&self) -> Option<(u8, Phase)> {
        let sensor = |sensor| if self.fault == Fault::FiresOneThatIsNotThere && sensor == 11 { 12 } else { sensor };
        self.inner.next_firing().map(|(next, phase)| (sensor(next), phase))
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
        self.disabled[usize::from(sensor)] = !enabled;
        match self.fault {
            Fault::FiresTheDisabled | Fault::FiresWhatItSaysIsDisabled => {}
            Fault::SaysThatASilentOneIsEnabled | Fault::ForgetsASensor if sensor == 3 => {
                self.inner.set_enabled(sensor, false);
            }
            _ => self.inner.set_enabled(sensor, enabled),
        }
    }

    fn set_paused(&mut self, paused: bool) {
        self.inner.set_paused(paused);
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        match self.fault {
            Fault::ForgetsWhatIsEnabled => true,
            Fault::FiresWhatItSaysIsDisabled | Fault::SaysThatASilentOneIsEnabled => {
                self.disabled.get(usize::from(sensor)) == Some(&false)
            }
            _ => self.inner.is_enabled(sensor),
        }
    }

    fn restart(&mut self, now: Instant) {
        if self.fault == Fault::FiresSoonAfterARestart {
            let before = std::mem::replace(&mut self.inner, ScheduledFiring::new(&TABLE_I_D, now));
            (0..12).for_each(|sensor| self.inner.set_enabled(sensor, before.is_enabled(sensor)));
        } else {
            self.inner.restart(now);
        }
    }

    fn last_firing(&self, sensor: u8, periods_ago: u8) -> FiringContext {
        self.inner.last_firing(sensor, periods_ago)
    }

    fn limits(&self) -> PlanLimits<'_> {
        self.inner.limits()
    }

    fn min_refire(&self) -> Micros {
        self.inner.min_refire()
    }

    fn horizon(&self) -> Micros {
        self.inner.horizon()
    }
}

/// The first finding of the check over several seeds.
fn found(fault: Fault) -> Option<BrokenPromise> {
    (0..40).find_map(|seed| {
        let inner = ScheduledFiring::new(&TABLE_I_D, START);
        let mut faulty = Faulty { inner, fault, disabled: [false; 12] };
        check_plan(&mut faulty, START, 2_000, seed).err()
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
    assert!(matches!(found(Fault::FiresWhatItSaysIsDisabled), Some(BrokenPromise::WrongSensor { sensor: ..12 })));
    assert_eq!(found(Fault::SaysThatASilentOneIsEnabled), Some(BrokenPromise::Silent { sensor: 3 }));
    assert_eq!(found(Fault::FiresOneThatIsNotThere), Some(BrokenPromise::WrongSensor { sensor: 12 }));
}

/// A plan with one sensor that fires as often as it may, and records the calls to it.
struct Metronome {
    due: Instant,
    enabled: bool,
    every: Micros,
    horizon: Micros,
    /// A checksum of all calls that change something (FNV-1a).
    calls: u32,
}

impl Metronome {
    fn new(every: Micros, horizon: Micros) -> Self {
        Self { due: START, enabled: true, every, horizon, calls: 0x811c_9dc5 }
    }

    fn called(&mut self, what: u32, with: u32) {
        for word in [what, with] {
            self.calls = (self.calls ^ word).wrapping_mul(0x0100_0193);
        }
    }
}

impl Plan for Metronome {
    fn deadline(&self) -> Instant {
        self.due
    }

    fn next_firing(&self) -> Option<(u8, Phase)> {
        self.enabled.then_some((0, Phase::A))
    }

    fn fire(&mut self, now: Instant) {
        self.called(0, now.as_micros());
        self.due = now + self.every;
    }

    fn postpone(&mut self, _sensor: u8, by: Micros) {
        self.called(1, by.as_micros());
        self.due += by;
    }

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        self.called(2, now.as_micros());
        self.due = now + self.every;
        (Phase::A, false)
    }

    fn ended(&mut self, _sensor: u8, at: Instant) {
        self.called(3, at.as_micros());
    }

    fn sensors(&self) -> usize {
        1
    }

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        self.called(4, (u32::from(sensor) << 1) + u32::from(enabled));
        self.enabled = enabled;
    }

    fn set_paused(&mut self, _paused: bool) {
        self.called(5, 0);
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        sensor == 0 && self.enabled
    }

    fn restart(&mut self, now: Instant) {
        self.called(6, now.as_micros());
    }

    fn last_firing(&self, _sensor: u8, _periods_ago: u8) -> FiringContext {
        FiringContext::new(Phase::A)
    }

    fn limits(&self) -> PlanLimits<'_> {
        PlanLimits { longest_window: self.every, verified_for: None, audible: None }
    }

    fn min_refire(&self) -> Micros {
        self.every
    }

    fn horizon(&self) -> Micros {
        self.horizon
    }
}

#[test]
fn the_check_allows_exactly_what_is_promised() {
    let every = Micros::from_millis(50);
    for seed in 0..20 {
        check_plan(&mut Metronome::new(every, every), START, 500, seed).unwrap();
        let far = check_plan(&mut Metronome::new(every, Micros::new(49_999)), START, 500, seed);
        assert_eq!(far, Err(BrokenPromise::Horizon { ahead: every }));
    }
}

#[test]
fn the_check_makes_the_same_calls_every_time() {
    let calls = |seed| {
        let mut metronome = Metronome::new(Micros::from_millis(50), Micros::from_millis(50));
        check_plan(&mut metronome, START, 2_000, seed).unwrap();
        metronome.calls
    };
    // A seed reproduces the calls of a failed test.
    assert_eq!([0, 1, 2].map(calls), [3_753_173_269, 3_957_200_330, 1_690_996_254]);
}

// A broken promise names the sensor, the value and the expectation.
#[test]
fn broken_promise_names_sensor_value_and_expectation() {
    let broken = BrokenPromise::MinRefire { sensor: 2, after: Micros::from_millis(7) };
    assert_eq!(broken.to_string(), "it fires sensor 3 again after 7 ms; expected min_refire or more");
}

/// Three enabled sensors that never fire; at each deadline this many periods end at once.
struct Periods {
    due: Instant,
    at_once: u32,
    left: u32,
    every: Micros,
}

impl Periods {
    fn new(at_once: u32, every: Micros) -> Self {
        Self { due: START + every, at_once, left: at_once, every }
    }
}

impl Plan for Periods {
    fn deadline(&self) -> Instant {
        self.due
    }

    fn next_firing(&self) -> Option<(u8, Phase)> {
        None
    }

    fn fire(&mut self, _now: Instant) {}

    fn postpone(&mut self, _sensor: u8, _by: Micros) {}

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        self.left -= 1;
        if self.left == 0 {
            (self.left, self.due) = (self.at_once, now + self.every);
        }
        (Phase::A, false)
    }

    fn ended(&mut self, _sensor: u8, _at: Instant) {}

    fn sensors(&self) -> usize {
        3
    }

    fn set_enabled(&mut self, _sensor: u8, _enabled: bool) {}

    fn set_paused(&mut self, _paused: bool) {}

    fn is_enabled(&self, sensor: u8) -> bool {
        sensor < 3
    }

    fn restart(&mut self, _now: Instant) {}

    fn last_firing(&self, _sensor: u8, _periods_ago: u8) -> FiringContext {
        FiringContext::new(Phase::A)
    }

    fn limits(&self) -> PlanLimits<'_> {
        PlanLimits { longest_window: self.every, verified_for: None, audible: None }
    }

    fn min_refire(&self) -> Micros {
        self.every
    }

    fn horizon(&self) -> Micros {
        self.every
    }
}

// The check allows fewer steps at once than four a sensor plus eight to come to rest.
#[test]
fn check_limits_steps_at_once() {
    let steps = |at_once| check_plan(&mut Periods::new(at_once, Micros::from_millis(50)), START, 1, 0);
    assert_eq!(steps(4 * 3 + 7), Ok(()));
    assert_eq!(steps(4 * 3 + 8), Err(BrokenPromise::Endless));
}

// The check calls a sensor silent after more than four horizons, not at four.
#[test]
fn check_calls_silence_after_four_horizons() {
    let every = Micros::from_millis(50);
    // A run in which all polls are on time and nothing else happens: the sensors wait from the end of the first.
    let after = |polls, seed| {
        let mut periods = Periods::new(1, every);
        let result = check_plan(&mut periods, START, polls, seed);
        (periods.due.since(START).as_micros(), result)
    };
    let seed = (0..1000).find(|&seed| after(5, seed).0 == 6 * 50_000).unwrap();
    assert_eq!(after(5, seed).1, Ok(()));
    assert_eq!(after(6, seed).1, Err(BrokenPromise::Silent { sensor: 0 }));
}

// A deadline as far ahead as the horizon does not count as a jump of the clock.
#[test]
fn deadline_at_the_horizon_is_no_jump() {
    let every = Micros::from_millis(50);
    let mut metronome = Metronome::new(every, every);
    assert!(metronome.poll(START).is_some());
    let calls = metronome.calls;
    assert_eq!((metronome.poll(START), metronome.calls), (None, calls), "nothing is due");
    let sooner = Instant::from_micros(START.as_micros() - 1);
    assert_eq!((metronome.poll(sooner), metronome.calls != calls), (None, true), "it is restarted");
}
