//! The gaps of the next cycle of a flow ring.

use super::plan::FlowPlan;
use super::slot::{FIRED, GIVEN, QUIET_US};
use crate::hopping::CATCHES_UP;
use crate::plan::Plan;
use crate::time::{Instant, Micros};

impl<const K: usize> FlowPlan<K> {
    /// Decides on the cycle that has begun. `fired` says when a sensor that has fired last did.
    pub(super) fn plan(&mut self, fired: impl Fn(u8) -> Instant) {
        let most = self.longest_cycle();
        self.fastest = 0;
        self.put_in_order();
        self.give_gaps(self.units(most, false));
        self.place_firings(fired);
        self.obey_pause();
    }

    /// The longest that this cycle may take: the shorter the faster the robot moved in the last.
    fn longest_cycle(&self) -> Micros {
        let pace = &self.pace;
        let travel = u32::from(pace.travel_us);
        // Changes are at most 65,535 us where they count.
        let most = match self.fastest {
            0 => pace.longest_cycle,
            fastest if fastest <= travel && self.length >= pace.longest_cycle => pace.longest_cycle,
            fastest => {
                let length = u64::from(self.length.as_micros()) * u64::from(travel) / u64::from(fastest);
                Micros::new(u32::try_from(length).unwrap_or(u32::MAX)).min(pace.longest_cycle)
            }
        };
        most.max(pace.shortest_cycle)
    }

    /// A time in units of the grid.
    fn units(&self, time: Micros, up: bool) -> u32 {
        let unit = self.unit.as_micros().max(1);
        let time = time.as_micros().saturating_add(if up { unit - 1 } else { 0 });
        time / unit
    }

    fn quiet_units(&self, quiet: u8) -> u8 {
        self.units(Micros::new(u32::from(quiet) * QUIET_US), true).min(255) as u8
    }

    /// The sensor after one in the order of firing, if all do: as far from it as the ring allows, since neighbours hear
    /// each other loudest.
    pub(super) fn sensor_after(&self, sensor: u8) -> u8 {
        let sensors = self.code.sensors() as u8;
        let next = sensor + stride(sensors);
        if next >= sensors { next - sensors } else { next }
    }

    /// Lists the sensors that fire.
    fn put_in_order(&mut self) {
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
    }

    /// Gives each firing the gap to the next, within `most` units in all.
    fn give_gaps(&mut self, most: u32) {
        let least = self.quiet_units(self.pace.least).max(1);
        let mut sum = 0;
        for place in 0..self.planned {
            let gap = self.need(place).max(least);
            self.set_gap(place, gap);
            sum += u32::from(gap);
        }
        if sum > most {
            self.share_out(most, least);
        }
    }

    /// Gives all the least gap, and what is left to whoever has been unserved for longest.
    fn share_out(&mut self, most: u32, least: u8) {
        for place in 0..self.planned {
            self.set_gap(place, least);
            let sensor = self.order(place);
            if let Some(slot) = self.slots.get_mut(usize::from(sensor)) {
                slot.set(GIVEN, false);
            }
        }
        let mut left = most.saturating_sub(u32::from(least) * u32::from(self.planned));
        while left > 0 {
            let Some(place) = self.longest_unserved() else { break };
            let sensor = self.order(place);
            let Some(slot) = self.slots.get_mut(usize::from(sensor)) else { break };
            slot.set(GIVEN, true);
            let (before, after) = (slot.before, slot.after);
            let previous = if place == 0 { self.planned - 1 } else { place - 1 };
            for (place, quiet) in [(previous, before), (place, after)] {
                let (need, has) = (self.quiet_units(quiet), self.gap(place));
                // Below 256.
                let more = u32::from(need.saturating_sub(has)).min(left) as u8;
                self.set_gap(place, has + more);
                left -= u32::from(more);
            }
        }
    }

    /// The gap after this place that the sensors on both sides need.
    fn need(&self, place: u8) -> u8 {
        let next = if place + 1 < self.planned { place + 1 } else { 0 };
        let after = self.slots.get(usize::from(self.order(place))).map_or(0, |slot| slot.after);
        let before = self.slots.get(usize::from(self.order(next))).map_or(0, |slot| slot.before);
        self.quiet_units(after.max(before))
    }

    fn longest_unserved(&self) -> Option<u8> {
        let mut longest = None;
        for place in 0..self.planned {
            let Some(slot) = self.slots.get(usize::from(self.order(place))) else { continue };
            if !slot.is(GIVEN) && longest.is_none_or(|(most, _)| slot.unserved > most) {
                longest = Some((slot.unserved, place));
            }
        }
        longest.map(|(_, place)| place)
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
        // At most 64 gaps of a byte, and a window.
        let mut at = 0_u16;
        for place in 0..self.planned {
            let sensor = self.order(place);
            if let Some(slot) = self.slots.get_mut(usize::from(sensor)) {
                slot.at = at;
            }
            let rests = self.rests_for(sensor, fired(sensor));
            let short = rests.saturating_sub(self.offset(sensor));
            at = at.saturating_add(u16::try_from(self.units(short, true)).unwrap_or(u16::MAX));
            if let Some(slot) = self.slots.get_mut(usize::from(sensor)) {
                slot.at = at;
            }
            at = at.saturating_add(u16::from(self.gap(place)));
        }
        let units = u32::from(at).max(self.units(self.pace.shortest_cycle, true));
        self.length = Micros::new(units.saturating_mul(self.unit.as_micros()));
    }

    /// Time after the cycle's start for which a sensor that has last `fired` then still listens.
    fn rests_for(&self, sensor: u8, fired: Instant) -> Micros {
        let rested = fired + self.window;
        let rests = if self.start.has_reached(rested) { Micros::ZERO } else { rested.since(self.start) };
        let has_fired = self.slots.get(usize::from(sensor)).is_some_and(|slot| slot.is(FIRED));
        // A clock that has jumped says nothing about when that was.
        if has_fired && rests <= self.window.saturating_add(CATCHES_UP) { rests } else { Micros::ZERO }
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

/// The distance in the ring from one firing to the next: neighbours hear each other loudest.
const fn stride(sensors: u8) -> u8 {
    let mut stride = if sensors > 6 { sensors / 3 + 1 } else { 1 };
    while !coprime(stride, sensors) {
        stride += 1;
    }
    stride
}

const fn coprime(mut a: u8, mut b: u8) -> bool {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a <= 1
}
