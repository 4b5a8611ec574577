//! Every plan works with every judge, including a custom one.

use eeruf_core::{
    EchoFilter, Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent,
    flow::{Belief, BeliefSettings, InTurn, TurnSettings},
    judge::{Agreement, Heard, Judge, MOfN, MedianFilter, Sounds, Verdict},
    plan::{ImmediateRefiring, Plan, ScheduledFiring},
    tables::TABLE_I_D,
};

const SENSORS: usize = 8;
const BEGIN: Instant = Instant::from_micros(0);
const CONFIG: RingConfig = RingConfig::new().with_window(Micros::from_millis(30));

/// A judge that accepts every third echo of a sensor and reports clear otherwise.
#[derive(Default)]
struct EveryThird {
    readings: [u8; SENSORS],
    restarts: u32,
}

impl Judge for EveryThird {
    fn t_delta(&self) -> Micros {
        Micros::new(200)
    }

    fn judge(&mut self, heard: &Heard<'_>, _: &impl Sounds) -> Verdict {
        let readings = &mut self.readings[usize::from(heard.sensor)];
        *readings += 1;
        let t_echo = heard.echoes.first().copied();
        let kind = if *readings % 3 == 0 { ReadingKind::Accepted } else { ReadingKind::Repeated };
        Verdict { kind, t_echo, previous: None, age: None, explained_by: None }
    }

    fn skip(&mut self, heard: &Heard<'_>, kind: ReadingKind) -> Verdict {
        Verdict { kind, t_echo: heard.echoes.first().copied(), previous: None, age: None, explained_by: None }
    }

    fn age(&self, _sensor: u8) -> Option<u16> {
        None
    }

    fn is_clear(&self, _sensor: u8) -> bool {
        true
    }

    fn forget(&mut self, sensor: u8) {
        self.readings[usize::from(sensor)] = 0;
    }

    fn restart(&mut self) {
        self.restarts += 1;
        self.readings = [0; SENSORS];
    }
}

fn in_turn() -> InTurn<SENSORS> {
    InTurn::new(SENSORS, TurnSettings::new(1), Micros::from_millis(30), BEGIN).unwrap()
}

/// The share of readings accepted in two seconds, with a wall for each sensor.
fn accepted<P: Plan, J: Judge>(plan: P, judge: J) -> f64 {
    let mut ring = Ring::<P, J, 12>::judged_by(plan, judge, CONFIG, BEGIN).unwrap();
    let (mut readings, mut accepted) = (0, 0);
    loop {
        let now = ring.next_deadline();
        if now.since(BEGIN) > Micros::from_millis(2000) {
            return f64::from(accepted) / f64::from(readings);
        }
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    ring.echo(sensor, now + Micros::new(5_000 + 1_000 * u32::from(sensor))).unwrap();
                }
                RingEvent::Reading(reading) => {
                    readings += 1;
                    accepted += u32::from(reading.kind == ReadingKind::Accepted);
                }
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
}

#[test]
fn own_walls_are_accepted_by_any_plan_with_any_judge() {
    let filter = || EchoFilter::<12>::new(Micros::new(200), 2).unwrap();
    let votes = || Agreement(MOfN::<12, 3>::new(2, 3, Micros::new(200)).unwrap());
    let median = || MedianFilter::<12>::new(3, Micros::new(200)).unwrap();
    let belief = || Belief::<12>::new(BeliefSettings::DEFAULT).unwrap();
    let scheduled = || ScheduledFiring::new(&TABLE_I_D, BEGIN);
    let immediate = || ImmediateRefiring::new(&TABLE_I_D, Micros::from_millis(40), BEGIN);
    let shares = [
        ("scheduled, filter", accepted(scheduled(), filter())),
        ("scheduled, belief", accepted(scheduled(), belief())),
        ("scheduled, agreement", accepted(scheduled(), Agreement(filter()))),
        ("immediate, agreement", accepted(immediate(), Agreement(filter()))),
        ("in turn, belief", accepted(in_turn(), belief())),
        ("in turn, agreement", accepted(in_turn(), Agreement(filter()))),
        ("scheduled, votes", accepted(scheduled(), votes())),
        ("immediate, votes", accepted(immediate(), votes())),
        ("in turn, votes", accepted(in_turn(), votes())),
        ("scheduled, median", accepted(scheduled(), median())),
        ("in turn, median", accepted(in_turn(), median())),
    ];
    for (name, share) in shares {
        assert!(share > 0.85, "{name}: {share}");
    }
}

#[test]
fn a_judge_of_ones_own_decides() {
    let share = accepted(in_turn(), EveryThird::default());
    assert!((0.2..0.34).contains(&share), "{share}");
}

#[test]
fn a_judge_is_asked_to_restart_with_the_ring() {
    let mut ring = Ring::<_, _, 12>::judged_by(in_turn(), EveryThird::default(), CONFIG, BEGIN).unwrap();
    ring.restart(BEGIN + Micros::from_millis(200));
    assert_eq!(ring.judge().restarts, 1);
}

// A judge whose `t_delta` is no shorter than the window is refused.
#[test]
fn judge_with_t_delta_of_a_window_is_refused() {
    let coarse = EchoFilter::<12>::new(Micros::from_millis(30), 2).unwrap();
    let ring = Ring::<_, _, 12>::judged_by(ScheduledFiring::new(&TABLE_I_D, BEGIN), coarse, CONFIG, BEGIN);
    assert!(ring.is_err());
}
