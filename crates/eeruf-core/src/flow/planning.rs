//! The gaps of the next cycle of a flow ring.

use super::plan::{FlowPlan, NOBODY};
use super::settings::{Pace, in_units};
use super::slot::{FIRED, QUIET_US, Slot};
use crate::hopping::CATCHES_UP;
use crate::plan::Plan;
use crate::time::{Instant, Micros};

impl<const K: usize> FlowPlan<K> {
    /// Decides on the cycle that has begun. `fired` says when a sensor that has fired last did.
    pub(super) fn plan(&mut self, fired: impl Fn(u8) -> Instant) {
        let most = self.longest_cycle();
        self.fastest = 0;
        self.put_in_order();
        self.give_gaps(most);
        self.place_firings(fired);
        self.obey_pause();
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

    /// Lists the sensors that fire.
    fn put_in_order(&mut self) {
        if self.in_order != NOBODY {
            self.planned = self.in_order;
            return;
        }
        self.planned = 0;
        let mut sensor = 0;
        for _ in 0..self.code.sensors() {
            if self.is_enabled(sensor) {
                if let Some(slot) = self.slots.get_mut(usize::from(self.planned)) {
                    slot.order = sensor;
                    self.planned += 1;
                }
            }
            sensor = self.sensor_after(sensor);
        }
        self.in_order = self.planned;
    }

    /// Gives each firing the gap to the next that the sensors on both sides need, within `most` units in all.
    fn give_gaps(&mut self, most: u32) {
        let last = self.planned.saturating_sub(1);
        let (mut sum, mut previous) = (0, last);
        let mut after = self.sensor_at(last).map_or(0, |slot| slot.after);
        for place in 0..self.planned {
            let Some(&Slot { before, after: own_after, .. }) = self.sensor_at(place) else { continue };
            let gap = self.gap_for(after.max(before));
            self.set_gap(previous, gap);
            sum += u32::from(gap);
            (previous, after) = (place, own_after);
        }
        if sum > most {
            self.share_out(most);
        }
    }

    /// Gives all the least gap, and what is left to whoever has been unserved for longest.
    fn share_out(&mut self, most: u32) {
        let least = self.pace.least_gap;
        for place in 0..self.planned {
            self.set_gap(place, least);
            let unserved = self.sensor_at(place).map_or(0, |slot| slot.unserved);
            // Of those that are unserved for as long, the first in order. There are at most 64.
            self.sort_in(place, u16::from(unserved) << 8 | u16::from(u8::MAX - place));
        }
        let mut left = most.saturating_sub(u32::from(least) * u32::from(self.planned));
        for rank in 0..self.planned {
            if left == 0 {
                return;
            }
            let key = self.slots.get(usize::from(rank)).map_or(0, |slot| slot.at);
            let place = u8::MAX - (key & 0xff) as u8;
            let Some(&Slot { before, after, .. }) = self.sensor_at(place) else { continue };
            let previous = if place == 0 { self.planned - 1 } else { place - 1 };
            left = self.raise_gap(previous, before, left);
            left = self.raise_gap(place, after, left);
        }
    }

    /// Sorts a key in among the first `count`, the largest first. They are kept where firing times are, which are
    /// decided next.
    fn sort_in(&mut self, count: u8, key: u16) {
        let mut key = key;
        for slot in self.slots.iter_mut().take(usize::from(count)) {
            if slot.at < key {
                core::mem::swap(&mut slot.at, &mut key);
            }
        }
        if let Some(slot) = self.slots.get_mut(usize::from(count)) {
            slot.at = key;
        }
    }

    /// Raises a gap to what this quiet needs, by at most `left` units; returns what is left of them.
    fn raise_gap(&mut self, place: u8, quiet: u8, left: u32) -> u32 {
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
    fn place_firings(&mut self, fired: impl Fn(u8) -> Instant) {
        // Gaps of a byte for at most 64 sensors, and a window.
        let (mut at, unit) = (0_u16, self.unit());
        // No sensor has to wait for longer after the cycle's start.
        let most = self.rest.saturating_add(CATCHES_UP).as_micros();
        for place in 0..self.planned {
            let sensor = self.order(place);
            if u32::from(at) * unit < most {
                let rests = self.rests_for(sensor, fired(sensor));
                let waits = self.slots.get(usize::from(sensor)).map_or(0, |slot| u32::from(slot.place));
                let offset = u32::from(at) * unit + waits * self.code.step().as_micros();
                let short = rests.as_micros().saturating_sub(offset);
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
    fn rests_for(&self, sensor: u8, fired: Instant) -> Micros {
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
