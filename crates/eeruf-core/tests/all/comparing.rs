//! Which readings of a ring are compared with the one before: not those that a restart, a change or lateness of unknown
//! size lies between, and all others.

use eeruf_core::tables::{PAPER_12, TABLE_I_D};
use eeruf_core::{Instant, Micros, Reading, ReadingKind, Requirements, Ring, RingConfig, RingEvent, ScheduledRing};

const WINDOW: Micros = Micros::from_millis(40);

/// A ring of twelve, and a wall that each of them sees after 9 ms.
struct Run<'s> {
    ring: ScheduledRing<'s, 12>,
    now: Instant,
    /// The firings of the present period, and when they were.
    fired: Vec<(u8, Instant)>,
}

impl<'s> Run<'s> {
    fn new(ring: ScheduledRing<'s, 12>) -> Self {
        Self { ring, now: Instant::from_micros(0), fired: vec![] }
    }

    /// The next event, polled for so much later than it is due.
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

    /// What is read until so many periods have ended.
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

    /// Goes on until so many sensors have fired in this period.
    fn firings(&mut self, count: usize) {
        while self.fired.len() < count {
            self.step(0);
        }
    }

    /// Says that the firing before the last one came so much later; its sensor still listens.
    fn say_too_late(&mut self, later: u32) {
        let (sensor, when) = self.fired[self.fired.len() - 2];
        self.ring.fired(sensor, when + Micros::new(later)).unwrap();
    }
}

fn paper() -> Run<'static> {
    Run::new(Ring::new(&PAPER_12, RingConfig::new().with_window(WINDOW), Instant::from_micros(0)).unwrap())
}

/// The readings of each sensor, in order.
fn by_sensor(read: &[Reading]) -> [Vec<Reading>; 12] {
    std::array::from_fn(|x| read.iter().filter(|reading| usize::from(reading.sensor) == x).copied().collect())
}

#[test]
fn the_first_two_readings_after_a_restart_are_compared_with_nothing_and_the_fourth_is_compared() {
    let mut run = paper();
    run.periods(5);
    // Two sensors listen.
    run.firings(2);
    run.ring.restart(run.now);
    for own in by_sensor(&run.periods(6)) {
        // The second might hold the same crosstalk as the first, whose sound was sent before the restart.
        assert_eq!((own[0].previous, own[1].previous), (None, None), "{own:?}");
        assert!(own[3..].iter().all(|reading| reading.kind == ReadingKind::Accepted), "{own:?}");
    }
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
fn readings_before_and_after_a_change_of_schedule_are_not_compared() {
    let mut run = paper();
    run.periods(5);
    run.ring.change_schedule(&PAPER_12).unwrap();
    run.periods(1);
    let begun = run.ring.clone().poll(run.now);
    assert_eq!(begun, None, "the first period after the change has begun");
    for own in by_sensor(&run.periods(6)) {
        assert_eq!((own[0].previous, own[1].previous), (None, None), "{own:?}");
        assert!(own[4..].iter().all(|reading| reading.kind == ReadingKind::Accepted), "{own:?}");
    }
}

#[test]
fn after_a_firing_that_was_said_too_late_nothing_is_compared_until_two_periods_have_ended() {
    let mut run = paper();
    run.periods(5);
    // Something is late, and so each firing is looked at.
    run.firings(4);
    let (sensor, when) = run.fired[3];
    run.ring.fired(sensor, when + Micros::new(50)).unwrap();
    run.firings(6);
    run.say_too_late(100);
    for reading in run.periods(8) {
        match reading.period {
            // The reading that follows on those of the two periods is not compared with them either.
            5..=7 => assert_eq!(reading.previous, None, "{reading:?}"),
            8 => {}
            _ => assert_eq!(reading.kind, ReadingKind::Accepted, "{reading:?}"),
        }
    }
}

#[test]
fn a_ring_that_was_late_long_ago_does_what_one_does_that_never_was() {
    let kinds = [0, 100].map(|late| {
        let mut run = paper();
        run.periods(2);
        run.step(late);
        run.periods(6);
        run.firings(6);
        run.say_too_late(300);
        run.periods(5).into_iter().map(|reading| (reading.sensor, reading.kind)).collect::<Vec<_>>()
    });
    assert_eq!(kinds[0], kinds[1]);
}

#[test]
fn without_a_verified_separation_a_shift_of_t_delta_is_compared_and_one_of_a_microsecond_more_is_not() {
    let config = RingConfig::new().with_t_delta(Micros::new(500)).with_window(WINDOW);
    let compared = [500, 501].map(|late| {
        let mut run = Run::new(Ring::unverified(&TABLE_I_D, config, Instant::from_micros(0)).unwrap());
        run.periods(4);
        run.firings(4);
        // The next step is that of the fifth firing.
        assert!(matches!(run.step(late), RingEvent::Fire { .. }));
        run.periods(6).iter().all(|reading| reading.previous.is_some())
    });
    assert_eq!(compared, [true, false]);
}

#[test]
fn only_a_larger_t_delta_than_before_costs_a_comparison() {
    let mut run = paper();
    let asked = run.ring.t_delta();
    for (t_delta, compares) in [(asked, true), (Micros::new(500), true), (Micros::new(500), true), (asked, false)] {
        run.periods(4);
        run.ring.set_t_delta(t_delta).unwrap();
        let compared = run.periods(3).iter().all(|reading| reading.previous.is_some());
        assert_eq!(compared, compares, "{t_delta}");
    }
}

#[test]
fn a_ring_has_the_patience_that_it_is_asked_for() {
    let config = RingConfig::new().with_consecutive(3).with_patience(7);
    assert_eq!((config.consecutive, config.patience), (3, 7));
    let verified = TABLE_I_D.verify(&Requirements::new(Micros::new(999))).verified().unwrap();
    let ring = |patience| {
        let config = RingConfig::new().with_window(WINDOW).with_patience(patience);
        Ring::new(&verified, config, Instant::from_micros(0)).map(|_ring: ScheduledRing<'_, 12>| ())
    };
    assert!(ring(15).is_ok() && ring(16).is_err());
}
