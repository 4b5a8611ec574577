//! Ambiguous readings of a ring: after a restart, all that earlier sound could explain; at any time, none without an
//! explanation.

use eeruf_core::tables::{PAPER_12, TABLE_I_D};
use eeruf_core::{
    Instant, Micros, Reading, ReadingKind, Ring, RingConfig, RingEvent, ScheduledRing,
    judge::{AgreementRing, Explanation},
    plan::ScheduledFiring,
};

const WINDOW: Micros = Micros::from_millis(40);

/// A ring of twelve sensors, each of which sees a wall after 9 ms.
struct Run<'s> {
    ring: ScheduledRing<'s, 12>,
    now: Instant,
    /// The firings of the current period with their instants.
    fired: Vec<(u8, Instant)>,
}

impl<'s> Run<'s> {
    fn new(ring: ScheduledRing<'s, 12>) -> Self {
        Self { ring, now: Instant::from_micros(0), fired: vec![] }
    }

    /// Polls this much after the next event is due, and returns the event.
    fn step(&mut self, late: u32) -> RingEvent {
        self.now = self.ring.next_deadline() + Micros::new(late);
        let event = self.ring.poll(self.now).expect("an event at the deadline");
        match event {
            RingEvent::Fire { sensor, .. } => {
                self.ring.echo(sensor, self.now + Micros::from_millis(9)).unwrap();
                self.fired.push((sensor, self.now));
            }
            RingEvent::PeriodEnded(_) => self.fired.clear(),
            RingEvent::Reading(_) => {}
        }
        event
    }

    /// The readings until `count` periods have ended.
    fn periods(&mut self, count: u32) -> Vec<Reading> {
        let (mut ended, mut read) = (0, vec![]);
        while ended < count {
            match self.step(0) {
                RingEvent::Reading(reading) => read.push(reading),
                RingEvent::PeriodEnded(_) => ended += 1,
                RingEvent::Fire { .. } => {}
            }
        }
        read
    }

    /// Runs until `count` sensors have fired in this period.
    fn firings(&mut self, count: usize) {
        while self.fired.len() < count {
            self.step(0);
        }
    }
}

fn config() -> RingConfig {
    RingConfig::new().with_window(WINDOW)
}

fn paper() -> Run<'static> {
    Run::new(Ring::new(&PAPER_12, config(), Instant::from_micros(0)).unwrap())
}

/// The readings of each sensor, in order.
fn by_sensor(read: &[Reading]) -> [Vec<Reading>; 12] {
    std::array::from_fn(|x| read.iter().filter(|reading| usize::from(reading.sensor) == x).copied().collect())
}

#[test]
fn restart_leaves_readings_ambiguous_while_sound_is_audible() {
    let mut run = paper();
    run.ring.set_audible(Micros::from_millis(180)).unwrap();
    run.periods(5);
    // Two sensors listen.
    run.firings(2);
    run.ring.restart(run.now);
    let mut ambiguous = 0;
    for own in by_sensor(&run.periods(6)) {
        assert_eq!(own[0].kind, ReadingKind::First, "{own:?}");
        // Its first reading may hold sound from 180 ms before it, and so from before the restart.
        if own[1].kind != ReadingKind::Accepted {
            let history = (ReadingKind::Ambiguous, Some(Explanation::History));
            assert_eq!((own[1].kind, own[1].explained_by), history, "{own:?}");
            ambiguous += 1;
        }
        assert!(own[4..].iter().all(|reading| reading.kind == ReadingKind::Accepted), "{own:?}");
    }
    assert!(ambiguous > 2, "{ambiguous}");
}

#[test]
fn a_restart_drops_the_firings_under_way() {
    let mut run = paper();
    run.periods(4);
    // Phase a begins with the same sensor after a restart.
    run.firings(1);
    run.ring.restart(run.now);
    let mut fired = vec![];
    while fired.len() < 12 {
        match run.step(0) {
            RingEvent::Fire { sensor, .. } => fired.push(sensor),
            RingEvent::Reading(reading) => assert!(fired.contains(&reading.sensor), "{reading:?} after {fired:?}"),
            RingEvent::PeriodEnded(stats) => panic!("{stats:?}"),
        }
    }
}

#[test]
fn a_change_to_the_same_schedule_costs_nothing() {
    let mut run = paper();
    run.periods(5);
    run.ring.change_schedule(&PAPER_12).unwrap();
    let read = run.periods(8);
    assert!(read.iter().all(|reading| reading.kind == ReadingKind::Accepted), "{read:?}");
}

#[test]
fn a_resumed_ring_compares_nothing_from_before() {
    let mut run = paper();
    run.periods(4);
    run.firings(3);
    run.ring.pause();
    run.ring.resume();
    for own in by_sensor(&run.periods(8)) {
        let compared = own.iter().filter(|reading| reading.previous.is_some()).count();
        assert!(compared >= own.len() - 1 && own.last().unwrap().kind == ReadingKind::Accepted, "{own:?}");
    }
}

// A firing corrected by the timer costs nothing without crosstalk.
#[test]
fn corrected_firing_costs_nothing_without_crosstalk() {
    for change in [-300_i32, 40] {
        let mut run = paper();
        run.periods(5);
        let mut read = vec![];
        while read.len() < 60 {
            run.now = run.ring.next_deadline();
            match run.ring.poll(run.now).expect("an event at the deadline") {
                RingEvent::Fire { sensor, .. } => {
                    let at = Instant::from_micros(run.now.as_micros().wrapping_add_signed(change));
                    run.ring.fired(sensor, at).unwrap();
                    run.ring.echo(sensor, at + Micros::from_millis(9)).unwrap();
                }
                RingEvent::Reading(reading) => read.push(reading),
                RingEvent::PeriodEnded(_) => {}
            }
        }
        for reading in &read[16..] {
            assert_eq!((reading.kind, reading.t_echo), (ReadingKind::Accepted, Some(Micros::from_millis(9))));
        }
    }
}

#[test]
fn agreement_alone_accepts_what_constant_waits_repeat() {
    // All fire at constant lags: every foreign sound repeats, and so does the wall's.
    let lags = std::array::from_fn(|x| Micros::from_millis(4 * x as u32));
    let constant = eeruf_core::Schedule::<12>::from_firing(Micros::from_millis(60), [lags, lags]).unwrap();
    let config = config().with_t_delta(Micros::new(500));
    let begin = Instant::from_micros(0);
    let plan = ScheduledFiring::new(&constant, begin);
    let mut alone: AgreementRing<_, 12> = AgreementRing::agreement_alone(plan, config, begin).unwrap();
    let mut asked = Ring::unverified(&constant, config, begin).unwrap();
    let mut kinds = [vec![], vec![]];
    while kinds[1].len() < 100 {
        let now = alone.next_deadline();
        let both = [alone.poll(now), asked.poll(now)];
        if let Some(RingEvent::Fire { sensor, .. }) = both[0] {
            alone.echo(sensor, now + Micros::from_millis(9)).unwrap();
            asked.echo(sensor, now + Micros::from_millis(9)).unwrap();
        }
        for (kinds, event) in kinds.iter_mut().zip(both) {
            if let Some(RingEvent::Reading(reading)) = event {
                kinds.push(reading.kind);
            }
        }
    }
    let of = |kinds: &[ReadingKind], kind| kinds.iter().filter(|&&of| of == kind).count();
    assert_eq!((of(&kinds[0], ReadingKind::Accepted), of(&kinds[0], ReadingKind::First)), (88, 12));
    assert_eq!((of(&kinds[1], ReadingKind::Ambiguous), of(&kinds[1], ReadingKind::First)), (88, 12));
}

#[test]
fn a_ring_is_on_time_until_lateness_exceeds_what_is_to_spare() {
    // Table I-d separates by 2 ms: 2 t_delta + 1 us for 999 us, which leaves 1 us, and 1,399 us for 300 us.
    for (t_delta, late, on_time) in [(999, 0, true), (999, 1, false), (300, 349, true), (300, 350, false)] {
        let config = config().with_t_delta(Micros::new(t_delta));
        let mut run = Run::new(Ring::new(&PAPER_12, config, Instant::from_micros(0)).unwrap());
        run.periods(4);
        run.firings(1);
        assert!(matches!(run.step(late), RingEvent::Fire { .. } | RingEvent::Reading(_)));
        while run.fired.len() < 2 {
            run.step(late);
        }
        assert_eq!(run.ring.is_on_time(), on_time, "{t_delta} us, {late} us late");
        run.periods(7);
        assert!(run.ring.is_on_time());
    }
}

#[test]
fn an_unverified_ring_is_never_on_time_and_accepts_all_the_same() {
    let config = config().with_t_delta(Micros::new(999));
    let mut run = Run::new(Ring::unverified(&TABLE_I_D, config, Instant::from_micros(0)).unwrap());
    let read = run.periods(12);
    assert!(!run.ring.is_on_time());
    let accepted = read.iter().filter(|reading| reading.kind == ReadingKind::Accepted).count();
    assert!(accepted >= read.len() - 12, "{accepted} of {}", read.len());
}
