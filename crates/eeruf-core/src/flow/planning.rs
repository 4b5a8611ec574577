//! The gaps of the next cycle of a flow ring.

use super::plan::{FlowPlan, NOBODY};
use super::settings::{Pace, in_units};
use super::slot::{FIRED, QUIET_US, Slot};
use crate::hopping::CATCHES_UP;
use crate::own_limits::OwnLimits;
use crate::plan::Plan;
use crate::time::{Instant, Micros};

impl<const K: usize, U: OwnLimits> FlowPlan<K, U> {
    /// Decides on the cycle that has begun. `rests` says for how long after its start a sensor must not fire yet.
    #[inline(always)]
    pub(super) fn plan(&mut self, rests: impl Fn(&Self, u8) -> Micros) {
        self.decide_gaps();
        self.place_firings(rests);
        self.obey_pause();
    }

    #[inline(never)]
    fn decide_gaps(&mut self) {
        let most = self.longest_cycle();
        self.fastest = 0;
        self.put_in_order();
        self.give_gaps(most);
    }

    /// The longest that this cycle may take, in units: the shorter the faster the robot moved in the last.
    fn longest_cycle(&self) -> u32 {
        let pace = &self.pace;
        let most = match self.fastest {
            0 => pace.longest,
            fastest => {
                // Below 2^32.
                let share = self.length.min(u32::from(u16::MAX)) * u32::from(pace.travel_us) / u32::from(fastest);
                share.min(pace.longest)
            }
        };
        most.max(pace.shortest - u32::from(pace.rounded_up))
    }

    /// The gap in units that leaves this quiet, and at least the least.
    fn gap_for(&self, quiet: u8) -> u8 {
        let Pace { per_quiet, least_gap, .. } = self.pace;
        let quiet = u32::from(quiet);
        let gap = if per_quiet == 0 {
            in_units(quiet * QUIET_US, self.unit()).min(255)
        } else {
            // As dividing, which takes small processors a hundred instructions, does: the product is short by less than
            // a unit's share of 65,280 us, the longest quiet.
            (quiet * per_quiet + 0x00ff_ffff) >> 24
        };
        (gap as u8).max(least_gap)
    }

    /// The sensor after one in the order of firing, if all do: as far from it as the ring allows, since neighbours hear
    /// each other loudest.
    pub(super) fn sensor_after(&self, sensor: u8) -> u8 {
        let sensors = self.code.sensors() as u8;
        let next = sensor + self.pace.stride;
        if next >= sensors { next - sensors } else { next }
    }

    /// The sensor before one in that order.
    pub(super) fn sensor_before(&self, sensor: u8) -> u8 {
        let stride = self.pace.stride;
        if sensor >= stride { sensor - stride } else { sensor + self.code.sensors() as u8 - stride }
    }

    /// Returns true if the firing in this place of the order and the next are of sensors that fire together: the gap
    /// between them is none.
    #[inline(always)]
    fn is_with_next(&self, place: u8) -> bool {
        self.own_limits.most().is_some() && self.slots.get(usize::from(place)).is_some_and(|slot| slot.gap == 0)
    }

    /// The first place of those that fire together with this one.
    #[inline(always)]
    fn first_with(&self, place: u8) -> u8 {
        let mut first = place;
        while first > 0 && self.is_with_next(first - 1) {
            first -= 1;
        }
        first
    }

    /// The last place of those that fire together with this one.
    #[inline(always)]
    pub(super) fn last_with(&self, place: u8) -> u8 {
        let mut last = place;
        while self.is_with_next(last) {
            last += 1;
        }
        last
    }

    /// The most quiet before and after that any sensor needs of those that fire in these places.
    #[inline(always)]
    fn needs(&self, first: u8, last: u8) -> (u8, u8) {
        let of = |place| self.sensor_at(place).map_or((0, 0), |slot| (slot.before, slot.after));
        let ((mut before, mut after), mut place) = (of(first), first);
        // No range: the compiler does not see that it is empty where no sensors fire together.
        while place < last {
            place += 1;
            let other = of(place);
            (before, after) = (before.max(other.0), after.max(other.1));
        }
        (before, after)
    }

    /// Lists the sensors that fire: those that fire together in the place of the first of them.
    fn put_in_order(&mut self) {
        if self.in_order != NOBODY {
            self.planned = self.in_order;
            return;
        }
        self.planned = 0;
        let mut sensor = 0;
        for _ in 0..self.code.sensors() {
            if self.own_limits.leader_of(sensor) == sensor {
                self.list(sensor);
                if self.own_limits.most().is_some() {
                    for other in sensor + 1..self.code.sensors() as u8 {
                        if self.own_limits.leader_of(other) == sensor {
                            self.list(other);
                        }
                    }
                    // Any but 0, which is the gap to the next of those that fire together.
                    self.set_gap(self.planned.wrapping_sub(1), 1);
                }
            }
            sensor = self.sensor_after(sensor);
        }
        self.in_order = self.planned;
    }

    /// Lists a sensor next, if it fires.
    #[inline(always)]
    fn list(&mut self, sensor: u8) {
        if self.is_enabled(sensor) {
            if let Some(slot) = self.slots.get_mut(usize::from(self.planned)) {
                (slot.order, slot.gap) = (sensor, 0);
                self.planned += 1;
            }
        }
    }

    /// Gives each firing the gap to the next that the sensors on both sides need, within `most` units in all.
    fn give_gaps(&mut self, most: u32) {
        let last = self.planned.saturating_sub(1);
        let (mut sum, mut previous) = (0, last);
        let (_, mut after) = self.needs(self.first_with(last), last);
        let mut place = 0;
        while place < self.planned {
            let end = self.last_with(place);
            let (before, own_after) = self.needs(place, end);
            let gap = self.gap_for(after.max(before));
            self.set_gap(previous, gap);
            sum += u32::from(gap);
            (previous, place, after) = (end, end + 1, own_after);
        }
        if sum > most {
            self.share_out(most);
        }
    }

    /// Gives all the least gap, and what is left to whoever has been unserved for longest.
    fn share_out(&mut self, most: u32) {
        let Pace { least, least_gap, .. } = self.pace;
        let mut left = most;
        for slot in self.slots.iter_mut().take(self.planned.into()) {
            // Between sensors that fire together there is none.
            if slot.gap > 0 {
                slot.gap = least_gap;
                left = left.saturating_sub(least_gap.into());
            }
        }
        if left == 0 {
            return;
        }
        let mut in_need = 0;
        for place in 0..self.planned {
            let Some(&Slot { before, after, unserved, .. }) = self.sensor_at(place) else { continue };
            if before > least || after > least {
                // Of those that are unserved for as long, the first in order. There are at most 64.
                self.sort_in(in_need, u16::from(unserved) << 8 | u16::from(u8::MAX - place));
                in_need += 1;
            }
        }
        let mut rank = 0;
        while left > 0 && rank < in_need {
            let key = self.slots.get(rank).map_or(0, |slot| slot.at);
            let place = u8::MAX - (key & 0xff) as u8;
            let Some(&Slot { before, after, .. }) = self.sensor_at(place) else { return };
            let first = self.first_with(place);
            let previous = if first == 0 { self.planned - 1 } else { first - 1 };
            left = self.raise_gap(previous, before, left);
            left = self.raise_gap(self.last_with(place), after, left);
            rank += 1;
        }
    }

    /// Sorts a key in among the first `count`, the largest first. They are kept where firing times are, which are
    /// decided next.
    #[inline(always)]
    fn sort_in(&mut self, count: usize, key: u16) {
        let mut rank = count;
        // From the end, where most stay: of those that are unserved for as long the first in order come first.
        while let Some([before, slot]) = rank.checked_sub(1).and_then(|first| self.slots.get_mut(first..=rank)) {
            if before.at >= key {
                break;
            }
            slot.at = before.at;
            rank -= 1;
        }
        if let Some(slot) = self.slots.get_mut(rank) {
            slot.at = key;
        }
    }

    /// Raises a gap to what this quiet needs, by at most `left` units; returns what is left of them.
    fn raise_gap(&mut self, place: u8, quiet: u8, left: u32) -> u32 {
        if quiet <= self.pace.least {
            return left;
        }
        let gap = self.gap_for(quiet);
        match self.slots.get_mut(usize::from(place)) {
            Some(slot) if slot.gap < gap => {
                // Below 256.
                let more = u32::from(gap - slot.gap).min(left);
                slot.gap += more as u8;
                left - more
            }
            _ => left,
        }
    }

    /// State of the sensor that fires in a place.
    #[inline(always)]
    fn sensor_at(&self, place: u8) -> Option<&Slot> {
        self.slots.get(usize::from(self.order(place)))
    }

    fn gap(&self, place: u8) -> u8 {
        self.slots.get(usize::from(place)).map_or(0, |slot| slot.gap)
    }

    fn set_gap(&mut self, place: u8, gap: u8) {
        if let Some(slot) = self.slots.get_mut(usize::from(place)) {
            slot.gap = gap;
        }
    }

    /// Adds the gaps up to firing times.
    #[inline(always)]
    fn place_firings(&mut self, rests: impl Fn(&Self, u8) -> Micros) {
        // Gaps of a byte for at most 64 sensors, and a window.
        let (mut at, unit) = (0_u16, self.unit());
        // No sensor has to wait for longer after the cycle's start.
        let most = self.rest.saturating_add(CATCHES_UP).as_micros();
        for place in 0..self.planned {
            let sensor = self.order(place);
            // Sensors that fire together wait for each other.
            let is_first = place == 0 || !self.is_with_next(place - 1);
            if is_first && u32::from(at) * unit < most {
                let (mut rest, mut other) = (rests(self, sensor), place);
                while self.is_with_next(other) {
                    other += 1;
                    rest = rest.max(rests(self, self.order(other)));
                }
                let short = rest.saturating_sub(self.offset_at(sensor, at)).as_micros();
                if short > 0 {
                    at = at.saturating_add(u16::try_from(in_units(short, unit)).unwrap_or(u16::MAX));
                }
            }
            if let Some(slot) = self.slots.get_mut(usize::from(sensor)) {
                slot.at = at;
            }
            at = at.saturating_add(u16::from(self.gap(place)));
        }
        self.length = u32::from(at).max(self.pace.shortest);
    }

    /// Time after the cycle's start for which a sensor that has last `fired` then must not fire yet.
    pub(super) fn rests_for(&self, sensor: u8, fired: Instant) -> Micros {
        let rested = fired + self.rest;
        let rests = if self.start.has_reached(rested) { Micros::ZERO } else { rested.since(self.start) };
        let has_fired = self.slots.get(usize::from(sensor)).is_some_and(|slot| slot.is(FIRED));
        // A clock that has jumped says nothing about when that was.
        if has_fired && rests <= self.rest.saturating_add(CATCHES_UP) { rests } else { Micros::ZERO }
    }

    /// Takes a sensor out of those that are still to fire.
    pub(super) fn leave_out(&mut self, sensor: u8) {
        let Some(at) = (self.place..self.planned).find(|&at| self.order(at) == sensor) else { return };
        self.planned -= 1;
        for at in at..self.planned {
            let next = self.order(at + 1);
            if let Some(slot) = self.slots.get_mut(usize::from(at)) {
                slot.order = next;
            }
        }
    }
}
