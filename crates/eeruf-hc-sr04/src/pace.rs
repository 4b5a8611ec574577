//! [`Pace`]: whether a loop polls often enough.

use eeruf_core::judge::Judge;
use eeruf_core::plan::Plan;
use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingEvent};

/// Watches whether a loop polls a ring often enough.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Sensors with a punctual reading since `since`, and sensors with two in a row; bit x for sensor x.
    heard: u64,
    twice: u64,
    since: Instant,
    max_late: Micros,
}

impl Pace {
    /// Starts watching at `now`.
    pub const fn new(now: Instant) -> Self {
        Self { heard: 0, twice: 0, since: now, max_late: Micros::ZERO }
    }

    /// Records an event that a poll of the ring returned.
    pub fn observe(&mut self, event: &RingEvent) {
        match event {
            RingEvent::Reading(reading) => {
                let bit = 1_u64.checked_shl(reading.sensor.into()).unwrap_or(0);
                let heard = self.heard & bit;
                self.heard &= !bit;
                // A late reading without an echo time leaves the next one nothing to compare with.
                if reading.kind != ReadingKind::Late || reading.t_echo.is_some() {
                    self.twice |= heard;
                    self.heard |= bit;
                }
            }
            RingEvent::PeriodEnded(stats) => self.max_late = self.max_late.max(stats.max_late),
            RingEvent::Fire { .. } => {}
        }
    }

    /// Returns true, at most once a second or once in 0.1 s per sensor if that is longer, if the loop was too slow
    /// since: a sensor had no two punctual readings in a row, or a table's firings were more than a millisecond late,
    /// which makes readings ambiguous.
    pub fn too_slow<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize>(
        &mut self,
        ring: &Ring<P, J, K, E, H>,
        now: Instant,
    ) -> bool {
        // Twice in two seconds, whatever the loop does in between; one by one two rounds of many sensors take longer.
        if now.since(self.since) < Micros::from_millis(950).max(Micros::from_millis(100 * ring.sensors() as u32)) {
            return false;
        }
        let Self { twice, max_late, .. } = core::mem::replace(self, Self::new(now));
        let misses = (0..ring.sensors() as u8)
            .any(|x| ring.is_enabled(x) && twice.checked_shr(x.into()).is_none_or(|bits| bits & 1 == 0));
        // If a plan knows only one firing ahead, late polls cost only time; a paused plan knows none.
        let is_late = max_late > Micros::from_millis(1) && ring.upcoming().nth(1).is_some();
        (misses || is_late) && ring.upcoming().next().is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eeruf_core::RingConfig;
    use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};

    // Sensors that fire one by one, polled so often for five seconds.
    fn is_slow<const K: usize>(every: Micros, pauses: bool) -> bool {
        let mut now = Instant::from_micros(u32::MAX - 500_000);
        let window = RingConfig::new().with_window(Micros::from_millis(37));
        let turns = TurnSettings::new(1).one_by_one();
        let mut ring = FlowRing::<K>::flow(K, turns, BeliefSettings::DEFAULT, window, now).unwrap();
        if pauses {
            ring.pause();
        }
        let (mut pace, mut is_slow) = (Pace::new(now), false);
        for _ in 0..5_000_000 / every.as_micros() {
            now += every;
            while let Some(event) = ring.poll(now) {
                pace.observe(&event);
            }
            is_slow |= pace.too_slow(&ring, now);
        }
        is_slow
    }

    #[test]
    fn loop_is_too_slow_where_a_sensor_has_no_two_readings() {
        let [often, seldom] = [1, 200].map(Micros::from_millis);
        let four = [is_slow::<4>(often, false), is_slow::<4>(seldom, false), is_slow::<4>(seldom, true)];
        assert_eq!(four, [false, true, false]);
        assert_eq!([is_slow::<24>(often, false), is_slow::<24>(seldom, false)], [false, true]);
    }
}
