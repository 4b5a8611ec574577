//! [`InTurn`]: the plan of rings that fire in turn.

use super::settings::{LONGEST_REST, TurnSettings};
use crate::judging::{FiringContext, Heard, Judge, Pace, Quiet};
use crate::own_limits::{OwnLimits, SensorLimits};
use crate::plan::{Plan, PlanLimits};
use crate::reading::Verdict;
use crate::ring_error::{PLAUSIBLE, RingError, within};
use crate::schedule::{MAX_SENSORS, Phase};
use crate::time::{Instant, Micros, longer, shorter};

/// Unit in which quiet is stored, so that two bytes hold it.
const UNIT: u32 = 4;
const NOBODY: u8 = u8::MAX;
/// Age at which firings are forgotten, long before differences of instants wrap.
const OLD: Micros = Micros::new(1 << 29);

/// A sensor of the plan.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Slot {
    /// Time of the last firing, if any.
    fired: Instant,
    /// Quiet that the sensor needs before and after its firing, in units.
    doubt: u16,
    /// The next sensor in the order, or [`NOBODY`].
    then: u8,
    flags: u8,
}

/// The sensor has fired, and not too long ago.
const FIRED: u8 = 1;
/// The sensor awaits its edge.
const LISTENS: u8 = 2;
const DISABLED: u8 = 4;
/// The sensor fires together with one that has a turn.
const FOLLOWS: u8 = 8;
/// The sensor has not fired yet, but its group's leader has.
const PENDING: u8 = 16;

impl Slot {
    const fn is(&self, flag: u8) -> bool {
        self.flags & flag != 0
    }

    fn set(&mut self, flag: u8, on: bool) {
        self.flags = if on { self.flags | flag } else { self.flags & !flag };
    }
}

/// A plan that fires one sensor after the other, alternating between distant ones.
///
/// A sensor fires a random time after three conditions hold: its own quiet has passed since the last firing, the quiet
/// of all sensors that still await their edge has passed, and it has rested. Sensors that fire together share a turn,
/// with the greatest need of the group; those that share an echo line wait for each other's windows. A period is a
/// round: it ends when the order begins again.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InTurn<const K: usize, U = ()> {
    /// The sensor that fires next, or [`NOBODY`] if the round ends.
    next: u8,
    /// The first sensor, in the order, whose turn is still to come; [`NOBODY`] if the round ends.
    from: u8,
    /// The sensor with the turn, or [`NOBODY`].
    turn: u8,
    /// The sensor that has fired in this round before its turn, or [`NOBODY`].
    ahead: u8,
    sensors: u8,
    /// Upper bound of the number of sensors that listen.
    listening: u8,
    /// The robot's motion: while it moves, random gaps are twice as long, and if every echo is reported, so is the
    /// least quiet.
    pace: Pace,
    paused: bool,
    /// Time when the next sensor is due, or the round ends.
    due: Instant,
    /// Time when a sensor last fired, or the plan began.
    last: Instant,
    /// The random time of the next gap.
    thrown: Micros,
    random: u32,
    window: Micros,
    /// Least quiet, doubled while every echo is reported; and greatest quiet.
    least: Micros,
    most: Micros,
    rest: Micros,
    dice: Micros,
    /// Initial doubt, in units.
    first: u16,
    slots: [Slot; K],
    own_limits: U,
}

impl<const K: usize> InTurn<K> {
    /// A plan of `sensors` sensors that listen for `window` and begin at `now`.
    ///
    /// # Errors
    /// [`RingError::Setting`] for a setting out of its range; [`RingError::Sensors`] for none, or more than there is
    /// room for.
    pub fn new(sensors: usize, settings: TurnSettings, window: Micros, now: Instant) -> Result<Self, RingError> {
        Self::with_limits(sensors, (), settings, window, now)
    }
}

impl<const K: usize, U: OwnLimits> InTurn<K, U> {
    /// Makes a plan like [`new`](InTurn::new), for sensors that have limits of their own; `window` is the longest of
    /// all.
    ///
    /// # Errors
    /// See [`new`](InTurn::new).
    pub fn with_limits(
        sensors: usize,
        own_limits: U,
        settings: TurnSettings,
        window: Micros,
        now: Instant,
    ) -> Result<Self, RingError> {
        Ok(Self::begin(sensors, own_limits, settings, Pace::STANDING, window, now)?.grouped())
    }

    /// Sets the groups of sensors that fire together.
    pub(super) fn grouped(mut self) -> Self {
        self.group();
        self.decide();
        self
    }

    /// Changes the seed of the random gaps.
    pub(super) fn set_seed(&mut self, seed: u32) -> Result<(), RingError> {
        TurnSettings::check_seed(seed)?;
        self.random = seed;
        self.throw();
        self.decide_no_sooner();
        Ok(())
    }

    /// A plan without groups of sensors that fire together.
    pub(super) const fn begin(
        sensors: usize,
        own_limits: U,
        settings: TurnSettings,
        pace: Pace,
        window: Micros,
        now: Instant,
    ) -> Result<Self, RingError> {
        if let Err(error) = settings.check() {
            return Err(error);
        }
        if sensors == 0 || sensors > K || sensors > MAX_SENSORS {
            return Err(RingError::Sensors { sensors, capacity: K });
        }
        if let Err(error) = within("window", window, PLAUSIBLE, LONGEST_REST) {
            return Err(error);
        }
        let sensors = sensors as u8;
        // At most 250 ms.
        let first = (settings.first().as_micros() / UNIT) as u16;
        let mut plan = Self {
            next: 0,
            from: 0,
            turn: 0,
            ahead: NOBODY,
            sensors,
            listening: 0,
            pace,
            paused: false,
            due: now,
            last: now,
            thrown: Micros::ZERO,
            random: settings.seed,
            window,
            least: settings.least,
            most: settings.most,
            rest: settings.rest,
            dice: settings.dice,
            first,
            slots: [Slot { fired: now, doubt: first, then: NOBODY, flags: 0 }; K],
            own_limits,
        };
        let mut place = 1;
        while place < sensors {
            plan.slots[in_order(place - 1, sensors) as usize].then = in_order(place, sensors);
            place += 1;
        }
        plan.throw();
        // As `decide` does: sensor 0 is the first in the order.
        let after = longer(Micros::new(first as u32 * UNIT), plan.least()).as_micros() + plan.thrown.as_micros();
        plan.due = Instant::from_micros(now.as_micros().wrapping_add(after));
        Ok(plan)
    }

    /// Quiet that a sensor needs before and after its firing.
    pub fn doubt_of(&self, sensor: u8) -> Option<Micros> {
        self.slot(sensor).map(|slot| self.quiet(slot))
    }

    fn quiet(&self, slot: &Slot) -> Micros {
        longer(Micros::new(u32::from(slot.doubt) * UNIT), self.least())
    }

    const fn least(&self) -> Micros {
        shorter(Micros::new(self.least.as_micros() << self.pace.every_echo as u32), self.most)
    }

    fn slot(&self, sensor: u8) -> Option<&Slot> {
        self.slots.get(usize::from(sensor)).filter(|_| sensor < self.sensors)
    }

    fn slot_mut(&mut self, sensor: u8) -> Option<&mut Slot> {
        self.slots.get_mut(usize::from(sensor)).filter(|_| sensor < self.sensors)
    }

    const fn throw(&mut self) {
        // Xorshift by 13, 17 and 5 (Marsaglia, 2003).
        self.random ^= self.random << 13;
        self.random ^= self.random >> 17;
        self.random ^= self.random << 5;
        let most = (self.dice.as_micros() << self.pace.moves as u32) + 1;
        // The high word of their product, which is no call of 64 bits on a Cortex-M0: `most` is below 2^20.
        let (high, low, most_high, most_low) = (self.random >> 16, self.random & 0xFFFF, most >> 16, most & 0xFFFF);
        let middle = high * most_low + ((low * most_low) >> 16);
        let carried = (low * most_high + (middle & 0xFFFF)) >> 16;
        self.thrown = Micros::new(high * most_high + (middle >> 16) + carried);
    }

    fn each(&self) -> impl Iterator<Item = (u8, &Slot)> {
        (0..self.sensors).zip(&self.slots)
    }

    /// Returns true if a sensor is enabled and belongs to the group.
    fn is_with(&self, other: u8, group: u8) -> bool {
        group > 0 && self.own_limits.group_of(other) == group && self.is_enabled(other)
    }

    /// Gives the turn of each group to its first sensor.
    fn group(&mut self) {
        for sensor in 0..self.sensors {
            let group = self.own_limits.group_of(sensor);
            let follows = (0..sensor).any(|other| self.is_with(other, group));
            if let Some(slot) = self.slot_mut(sensor) {
                slot.set(FOLLOWS, follows);
                slot.set(PENDING, false);
            }
        }
    }

    /// The quiet that listening sensors still need.
    fn listeners(&self) -> Listeners {
        let mut all = Listeners { most: Micros::ZERO, whose: NOBODY, others: Micros::ZERO };
        if self.listening == 0 {
            return all;
        }
        for (sensor, slot) in self.each() {
            if slot.is(LISTENS) {
                // Sound after the window does not matter, however late it is reported.
                let quiet = self.since_last(slot.fired, shorter(self.quiet(slot), self.window_of(sensor)));
                if quiet > all.most {
                    all = Listeners { most: quiet, whose: sensor, others: all.most };
                } else {
                    all.others = longer(all.others, quiet);
                }
            }
        }
        all
    }

    /// Two times from the last firing, without the random part: until all is quiet for a sensor and those that fire
    /// with it, and until they have rested and their lines are free.
    fn waits(&self, sensor: u8, own: &Slot, listeners: &Listeners) -> (Micros, Micros) {
        let mut all = self.waits_alone(sensor, own, listeners);
        let group = self.own_limits.group_of(sensor);
        for (other, slot) in self.each().filter(|&(other, _)| self.is_with(other, group)) {
            let one = self.waits_alone(other, slot, listeners);
            all = (longer(all.0, one.0), longer(all.1, one.1));
        }
        all
    }

    fn waits_alone(&self, sensor: u8, own: &Slot, listeners: &Listeners) -> (Micros, Micros) {
        let others = if listeners.whose == sensor { listeners.others } else { listeners.most };
        let mut rested = Micros::ZERO;
        if own.is(FIRED) {
            rested = self.since_last(own.fired, self.rest);
            if own.is(LISTENS) {
                rested = longer(rested, self.since_last(own.fired, self.window_of(sensor)));
            }
        }
        let line = self.own_limits.line_of(sensor);
        if line > 0 {
            for (other, slot) in self.each() {
                if other != sensor && slot.is(FIRED) && self.own_limits.line_of(other) == line {
                    rested = longer(rested, self.since_last(slot.fired, self.window_of(other)));
                }
            }
        }
        (longer(self.quiet(own), others), rested)
    }

    fn window_of(&self, sensor: u8) -> Micros {
        self.own_limits.limits_of(sensor).map_or(self.window, |own| shorter(own.window, self.window))
    }

    /// Corrects the instant of a sensor's last firing.
    fn correct(&mut self, sensor: u8, at: Instant) {
        let Some(slot) = self.slot_mut(sensor) else { return };
        let was = core::mem::replace(&mut slot.fired, at);
        if self.last == was || at.has_reached(self.last) {
            self.last = at;
        }
        self.decide_no_sooner();
    }

    /// The time from the plan's last firing until `after` has passed since this firing; zero if it already has.
    fn since_last(&self, fired: Instant, after: Micros) -> Micros {
        let until = fired + after;
        if self.last.has_reached(until) { Micros::ZERO } else { until.since(self.last) }
    }

    /// Decides like [`decide`](Self::decide) after a call that has no `now`: nothing becomes due sooner than before,
    /// since that instant might be long past.
    #[inline(never)]
    fn decide_no_sooner(&mut self) {
        let due = self.due;
        self.decide();
        self.due_from(due);
    }

    /// Decides which sensor fires next, and when.
    #[inline(never)]
    fn decide(&mut self) {
        let listeners = self.listeners();
        self.decide_among(&listeners);
    }

    fn decide_among(&mut self, listeners: &Listeners) {
        if self.own_limits.most().is_some() {
            let pending = self.each().find(|(_, slot)| slot.is(PENDING)).map(|(sensor, _)| sensor);
            if let Some(sensor) = pending {
                (self.next, self.due) = (sensor, self.last);
                return;
            }
        }
        let mut sensor = if self.paused { NOBODY } else { self.from };
        (self.turn, self.next) = (NOBODY, NOBODY);
        while let Some(slot) = self.slots.get(usize::from(sensor)) {
            let then = slot.then;
            if sensor != self.ahead && !slot.is(DISABLED | FOLLOWS) {
                let (quiet, rested) = self.waits(sensor, slot, listeners);
                if self.turn == NOBODY || rested <= quiet {
                    (self.next, self.due) = (sensor, self.last + longer(quiet, rested) + self.thrown);
                }
                if self.turn == NOBODY {
                    self.turn = sensor;
                }
                // No sensor is passed over twice: only one may fire ahead in a round.
                if rested <= quiet || self.ahead != NOBODY {
                    return;
                }
            }
            sensor = then;
        }
        if self.turn == NOBODY {
            // The round ends at once or, if no sensor can fire, after the rest time.
            let nobody = self.paused || !self.each().any(|(_, slot)| !slot.is(DISABLED));
            self.due = self.last + if nobody { self.rest } else { Micros::ZERO };
        }
    }
}

/// Quiet that the listening sensors need, from the last firing on.
struct Listeners {
    /// Longest quiet that a listening sensor needs.
    most: Micros,
    whose: u8,
    /// Longest quiet that any other listening sensor needs.
    others: Micros,
}

/// The sensor at a place of the order, which alternates between distant sensors: neighbours never follow each other if
/// the number of sensors allows it.
const fn in_order(place: u8, sensors: u8) -> u8 {
    const SIX: [u8; 6] = [0, 2, 4, 1, 5, 3];
    match sensors {
        0..=4 => place,
        6 => SIX[(place % 6) as usize],
        _ => {
            let mut stride = 3;
            while !shares_no_factor(stride, sensors) || stride == sensors - 1 {
                stride += 1;
            }
            (place as u16 * stride as u16 % sensors as u16) as u8
        }
    }
}

const fn shares_no_factor(mut one: u8, mut other: u8) -> bool {
    while other != 0 {
        (one, other) = (other, one % other);
    }
    one == 1
}

impl<const K: usize, U: OwnLimits> Plan for InTurn<K, U> {
    #[inline]
    fn deadline(&self) -> Instant {
        self.due
    }

    #[inline]
    fn next_firing(&self) -> Option<(u8, Phase)> {
        (self.next != NOBODY).then_some((self.next, Phase::A))
    }

    fn fire(&mut self, now: Instant) {
        let sensor = self.next;
        let Some(slot) = self.slots.get_mut(usize::from(sensor)) else { return };
        slot.fired = now;
        self.listening = self.listening.saturating_add(1);
        slot.set(FIRED | LISTENS, true);
        let pending = self.own_limits.most().is_some() && slot.is(PENDING);
        if pending {
            slot.set(PENDING, false);
        } else {
            if sensor == self.turn {
                self.from = slot.then;
            } else {
                self.ahead = sensor;
            }
            let group = self.own_limits.group_of(sensor);
            if group > 0 {
                for other in (0..self.sensors).filter(|&other| other != sensor) {
                    let with = self.is_with(other, group);
                    if let Some(slot) = self.slot_mut(other).filter(|_| with) {
                        slot.set(PENDING, true);
                    }
                }
            }
            self.throw();
        }
        self.last = now;
        let mut listeners = Listeners { most: Micros::ZERO, whose: sensor, others: Micros::ZERO };
        if pending {
            listeners = self.listeners();
        } else if let Some(slot) = self.slot(sensor) {
            // It was not due before the others had the quiet that they need.
            listeners.most = shorter(self.quiet(slot), self.window_of(sensor));
        }
        self.decide_among(&listeners);
    }

    fn postpone(&mut self, sensor: u8, by: Micros) {
        if let Some(fired) = self.slot(sensor).map(|slot| slot.fired) {
            self.correct(sensor, fired + by);
        }
    }

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        for slot in &mut self.slots {
            if slot.is(FIRED) && now.since(slot.fired) > OLD {
                slot.set(FIRED | LISTENS, false);
            }
        }
        // The one that fired ahead has had its turn.
        (self.from, self.ahead) = (0, NOBODY);
        if self.next == NOBODY && now.since(self.last) >= self.rest {
            // No sensor fires, but rounds go on.
            self.last = now;
        }
        self.decide_no_sooner();
        (Phase::A, false)
    }

    fn judged(&mut self, heard: &Heard<'_>, _: &Verdict, judge: &impl Judge) {
        self.pace = judge.pace();
        // At most 250 ms. In 16 bits a Cortex-M0 divides by a constant without a call.
        let more = (self.most.saturating_sub(self.least).as_micros() / UNIT) as u16;
        let (down, up) = (u32::from(more / 10), u32::from(more / 4));
        let (least, most) = (self.least().as_micros() / UNIT, self.most.as_micros() / UNIT);
        if let Some(slot) = self.slot_mut(heard.sensor) {
            let now = u32::from(slot.doubt);
            let then = match judge.quiet() {
                Quiet::Less => now.saturating_sub(down).max(least),
                Quiet::Same => now,
                Quiet::More => (now + up).min(most),
            };
            // At most 250 ms.
            slot.doubt = then as u16;
        }
    }

    fn fired(&mut self, sensor: u8, at: Instant) {
        // If it was later and still listens, it is postponed too.
        if self.slot(sensor).is_some_and(|slot| !slot.is(LISTENS) || slot.fired.has_reached(at)) {
            self.correct(sensor, at);
        }
    }

    fn ended(&mut self, sensor: u8, _at: Instant) {
        if let Some(slot) = self.slots.get_mut(usize::from(sensor)) {
            self.listening = self.listening.saturating_sub(slot.is(LISTENS).into());
            slot.set(LISTENS, false);
            self.decide();
        }
    }

    fn due_from(&mut self, soonest: Instant) {
        if soonest.has_reached(self.due) {
            self.due = soonest;
        }
    }

    fn forget(&mut self, sensor: u8) {
        let first = self.first;
        if let Some(slot) = self.slot_mut(sensor) {
            slot.doubt = first;
            self.decide_no_sooner();
        }
    }

    fn sensors(&self) -> usize {
        self.sensors.into()
    }

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        let first = self.first;
        if let Some(slot) = self.slot_mut(sensor) {
            if enabled && slot.is(DISABLED) {
                slot.doubt = first;
            }
            slot.set(DISABLED, !enabled);
            self.group();
            self.decide_no_sooner();
        }
    }

    fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
        self.group();
        self.decide_no_sooner();
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        self.slot(sensor).is_some_and(|slot| !slot.is(DISABLED))
    }

    fn restart(&mut self, now: Instant) {
        let first = self.first;
        for slot in &mut self.slots {
            // After a jump of the clock, it is unknown when they fired.
            let rests = slot.is(FIRED) && now.has_reached(slot.fired) && now.since(slot.fired) <= self.rest;
            slot.set(FIRED, rests);
            slot.set(LISTENS | PENDING, false);
            slot.doubt = first;
        }
        self.listening = 0;
        // Sound from before dies away.
        (self.from, self.ahead, self.last) = (0, NOBODY, now + self.most);
        self.decide();
    }

    fn set_pace(&mut self, pace: Pace) {
        self.pace = pace;
        self.decide();
    }

    fn last_firing(&self, _sensor: u8, _periods_ago: u8) -> FiringContext {
        FiringContext::new(Phase::A)
    }

    fn limits(&self) -> PlanLimits<'_> {
        PlanLimits { longest_window: self.min_refire(), verified_for: None, audible: Some(self.most) }
    }

    fn hears(&self, receiver: u8, emitter: u8) -> bool {
        self.own_limits.hears(receiver, emitter)
    }

    #[inline]
    fn limits_of(&self, sensor: u8) -> Option<SensorLimits> {
        self.own_limits.limits_of(sensor)
    }

    fn min_refire(&self) -> Micros {
        longer(self.rest, self.window)
    }

    fn horizon(&self) -> Micros {
        // A round of the longest gaps, in which each has its turn: at most 64 times 750 ms, and the rest.
        let gap = self.most.as_micros() + 2 * self.dice.as_micros();
        let round = (u32::from(self.sensors) + 1) * gap;
        Micros::new(round + longer(self.rest, self.window).as_micros())
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::own_limits::EachSensor;
    use crate::plan::check_plan;
    use std::vec::Vec;

    #[test]
    fn neighbours_never_fire_one_after_the_other() {
        let orders: [(u8, &[u8]); 4] =
            [(3, &[0, 1, 2]), (5, &[0, 3, 1, 4, 2]), (6, &[0, 2, 4, 1, 5, 3]), (8, &[0, 3, 6, 1, 4, 7, 2, 5])];
        for (sensors, expected) in orders {
            assert_eq!((0..sensors).map(|place| in_order(place, sensors)).collect::<Vec<_>>(), expected);
        }
        for sensors in 5..=MAX_SENSORS as u8 {
            let order: Vec<_> = (0..sensors).map(|place| in_order(place, sensors)).collect();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..sensors).collect::<Vec<_>>());
            let pairs = order.iter().zip(order.iter().cycle().skip(1));
            let apart = |(one, other): (&u8, &u8)| one.abs_diff(*other).min(sensors - one.abs_diff(*other));
            // With six sensors the order wraps around from one to its neighbour.
            assert!(pairs.filter(|pair| apart(*pair) < 2).count() <= usize::from(sensors == 6), "{order:?}");
        }
    }

    #[test]
    fn plan_keeps_its_contract_whatever_is_done_to_it() {
        for sensors in [1, 2, 3, 6, 8, 12, 16] {
            for (least, rest) in [(6, 60), (33, 60), (6, 200)] {
                let mut settings = TurnSettings::new(1 + sensors as u32);
                (settings.least, settings.rest) = (Micros::from_millis(least), Micros::from_millis(rest));
                let now = Instant::from_micros(u32::MAX - 7_000_000);
                let mut plan = InTurn::<16>::new(sensors, settings, Micros::from_millis(30), now).unwrap();
                check_plan(&mut plan, now, 20_000, 1).unwrap_or_else(|broken| std::panic!("{sensors}: {broken}"));
            }
        }
        let windows = [20, 30, 30, 12, 30, 25].map(Micros::from_millis);
        let own = windows.map(|window| SensorLimits { t_delta: Micros::MAX, window });
        let cases: [(&[u64], &[u64]); 3] = [(&[0b11], &[]), (&[0b1010, 0b10_0101], &[0b11]), (&[], &[0b11_1111])];
        for (groups, lines) in cases {
            let limits = EachSensor::for_flow(own, groups).with_shared_lines(lines);
            let now = Instant::from_micros(u32::MAX - 7_000_000);
            let mut plan =
                InTurn::<6, _>::with_limits(6, limits, TurnSettings::new(1), Micros::from_millis(30), now).unwrap();
            check_plan(&mut plan, now, 20_000, 5).unwrap_or_else(|broken| std::panic!("{groups:?}: {broken}"));
        }
    }

    #[test]
    fn settings_out_of_range_are_refused_by_name() {
        let of = |change: fn(&mut TurnSettings)| {
            let mut settings = TurnSettings::new(1);
            change(&mut settings);
            InTurn::<8>::new(8, settings, Micros::from_millis(30), Instant::default()).map(drop)
        };
        assert_eq!(of(|_| ()), Ok(()));
        let named = |name, value, least, most| Err(RingError::Setting { name, value, least, most });
        assert_eq!(of(|settings| settings.seed = 0), named("seed", 0, 1, u32::MAX));
        assert_eq!(of(|settings| settings.least = Micros::new(40_000)), named("least", 40_000, 100, 33_500));
        assert_eq!(of(|settings| settings.most = Micros::new(33)), named("most", 33, 1_000, 250_000));
        assert_eq!(of(|settings| settings.rest = Micros::ZERO), named("rest", 0, 1_000, 4_000_000));
    }
}
