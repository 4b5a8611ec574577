//! Needs of one sensor or one pair according to [`Requirements`], for rings with and without [`Uneven`](crate::Uneven)
//! sensors.

use crate::requirements::Requirements;
use crate::time::{Micros, longer, shorter};
use crate::uneven::Uneven;

impl Requirements<'_> {
    /// `T_delta` of a sensor.
    pub const fn t_delta_of(&self, sensor: usize) -> Micros {
        match self.uneven {
            Some(uneven) if sensor < uneven.t_delta.len() => uneven.t_delta[sensor],
            _ => self.t_delta,
        }
    }

    /// `T_wind` of a sensor.
    pub const fn window_of(&self, sensor: usize) -> Micros {
        match self.uneven {
            Some(uneven) if sensor < uneven.window.len() => uneven.window[sensor],
            _ => self.window,
        }
    }

    /// Least time between two triggers of a sensor; its window if no refire time is given.
    pub const fn refire_of(&self, sensor: usize) -> Micros {
        match self.uneven {
            Some(uneven) if sensor < uneven.refire.len() => uneven.refire[sensor],
            _ => Micros::ZERO,
        }
    }

    /// The separation that two sensors need, from the larger of their `t_delta`; pass a sensor twice for its stale
    /// echoes. `None` for two that fire together.
    pub const fn separation_of(&self, x: usize, y: usize) -> Option<Micros> {
        if x != y && self.fire_together(x, y) {
            return None;
        }
        let (one, other) = (self.t_delta_of(x), self.t_delta_of(y));
        Some(self.criterion.separation(longer(one, other)))
    }

    /// The least time between the firings of two sensors, in a ring of this size; `None` if they need none.
    pub const fn interval_of(&self, sensors: usize, x: usize, y: usize) -> Option<Micros> {
        if let Some(uneven) = self.uneven {
            let mut at = 0;
            while at < uneven.intervals.len() {
                let (p, q, interval) = uneven.intervals[at];
                let (p, q) = (p as usize, q as usize);
                if p == x && q == y || p == y && q == x {
                    return if interval.as_micros() == 0 { None } else { Some(interval) };
                }
                at += 1;
            }
        }
        if self.layout.neighbours(sensors, x, y) { Some(self.min_interval) } else { None }
    }

    /// Returns true if two sensors share an echo line.
    pub const fn share_a_line(&self, x: usize, y: usize) -> bool {
        match self.uneven {
            Some(uneven) => x != y && Uneven::in_one(uneven.shared_lines, x, y),
            None => false,
        }
    }

    /// Sets of sensors that must fire at the same instants.
    pub(crate) const fn together(&self) -> &[u64] {
        match &self.uneven {
            Some(uneven) => uneven.together,
            None => &[],
        }
    }

    /// Returns true if two sensors must fire at the same instants.
    pub const fn fire_together(&self, x: usize, y: usize) -> bool {
        match self.uneven {
            Some(uneven) => x != y && Uneven::in_one(uneven.together, x, y),
            None => false,
        }
    }

    /// Time after a firing of `x` in which sensor `y` must not fire, in a ring of this size: the interval of the two,
    /// or the window of `x` where that is longer and they share an echo line.
    pub const fn gap_after(&self, sensors: usize, x: usize, y: usize) -> Micros {
        let interval = match self.interval_of(sensors, x, y) {
            Some(interval) => interval,
            None => Micros::ZERO,
        };
        let window = self.window_of(x);
        if self.share_a_line(x, y) && window.as_micros() > interval.as_micros() { window } else { interval }
    }

    /// The smallest `t_delta`, the longest time between firings that any sensor or pair keeps, and the smallest window,
    /// in a ring of this size.
    pub(crate) const fn strictest(&self, sensors: usize) -> (Micros, Micros, Micros) {
        let (mut t_delta, mut gap, mut window) = (Micros::MAX, self.min_interval, Micros::MAX);
        let mut x = 0;
        while x < sensors {
            t_delta = shorter(t_delta, self.t_delta_of(x));
            gap = longer(gap, longer(self.window_of(x), self.refire_of(x)));
            // A window of zero sets no limit.
            if self.window_of(x).as_micros() > 0 {
                window = shorter(window, self.window_of(x));
            }
            let mut y = 0;
            while y < sensors {
                gap = longer(gap, self.gap_after(sensors, x, y));
                y += 1;
            }
            x += 1;
        }
        (t_delta, gap, if window.as_micros() == u32::MAX { Micros::ZERO } else { window })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::Layout;

    const fn ms(ms: u32) -> Micros {
        Micros::from_millis(ms)
    }

    // After a firing, the other sensor waits for the interval, or for the window if both share a line.
    #[test]
    fn gap_after_firing_is_interval_or_shared_window() {
        let windows = [ms(12), ms(40), ms(40)];
        let uneven = Uneven { window: &windows, shared_lines: &[0b011], intervals: &[(0, 1, ms(20))], ..Uneven::NONE };
        let requirements = Requirements {
            min_interval: ms(15),
            layout: Layout::Line(2),
            uneven: Some(uneven),
            ..Requirements::new(Micros::new(999))
        };
        // The window of the first counts where it is longer; sensors 2 and 3 share no line, 1 and 3 are not neighbours.
        for (x, y, gap) in [(0, 1, 20), (1, 0, 40), (1, 2, 15), (2, 1, 15), (0, 2, 0), (2, 0, 0)] {
            assert_eq!(requirements.gap_after(3, x, y), ms(gap), "{x} {y}");
        }
        // No window or time to refire is as long as that of the shared line.
        assert_eq!(requirements.strictest(3), (Micros::new(999), ms(40), ms(12)));
    }

    #[test]
    fn the_strictest_gap_may_be_that_of_one_pair_or_of_one_sensor() {
        let of = |uneven| Requirements { uneven: Some(uneven), ..Requirements::new(Micros::new(99)) }.strictest(3);
        let pair = Uneven { intervals: &[(1, 2, ms(30))], ..Uneven::NONE };
        assert_eq!(of(pair).1, ms(30));
        let (t_delta, refire) = ([99, 50, 70].map(Micros::new), [ms(9), ms(33), ms(1)]);
        assert_eq!(of(Uneven { t_delta: &t_delta, refire: &refire, ..pair }), (Micros::new(50), ms(33), Micros::ZERO));
    }
}
