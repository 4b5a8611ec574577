//! What follows from the choices made so far.
//!
//! Four arguments, repeated until nothing is new: an order that has become impossible leaves the other one; ranked neighbours are D apart;
//! K values `|d|` must fit ([`packing`](super::packing)); and where the difference `d_y - d_x` is forced for several x, these x are D apart
//! among themselves, so y is that far behind the last of them.
//!
//! Indices: sensors are below `needs.sensors` and so below `MAX_SENSORS`; a chain holds each sensor at most once, a set at most the conflicting
//! ones.

use super::MAX_SENSORS;
use super::network::Contradiction;
use super::packing::Intervals;
use super::problem::Sensors;
use super::tree::Tree;

/// Rounds after each choice. Almost always a few are enough. In fine ticks conclusions can go round in circles and gain a tick each time:
/// then it is far cheaper to go on here than to let the search try value by value.
const ROUNDS: usize = 400;

impl Tree<'_, '_> {
    /// Draws conclusions from all choices so far.
    pub(super) fn propagate(&mut self) -> Result<(), Contradiction> {
        let mut packed = Intervals::NONE;
        // How many changes there were when each argument was last begun: without another since, it has nothing new to say.
        let mut begun = [u64::MAX; 4];
        for _ in 0..ROUNDS {
            let before = self.net.changes();
            for (argument, begun) in begun.iter_mut().enumerate() {
                let now = self.net.changes();
                // The two that cost more wait until the others have nothing new.
                if argument == 2 && now != before {
                    break;
                }
                if core::mem::replace(begun, now) == now {
                    continue;
                }
                match argument {
                    0 => self.force_orders()?,
                    1 => self.space_ranks()?,
                    2 => self.pack(&mut packed)?,
                    _ => self.set_precedence()?,
                }
            }
            if self.net.changes() == before {
                break;
            }
        }
        Ok(())
    }

    /// Where one order of two conflicting firings is impossible, demands the other.
    fn force_orders(&mut self) -> Result<(), Contradiction> {
        let interval = self.needs.interval;
        if interval == 0 {
            return Ok(());
        }
        loop {
            let before = self.net.changes();
            for x in 1..self.needs.sensors {
                for y in Sensors(self.needs.conflicts[x] & ((1 << x) - 1)) {
                    for phase in 0..2 {
                        let (u, v) = (self.node(x, phase), self.node(y, phase));
                        if self.net.at_most(u, v) < interval {
                            self.net.demand(u, v, -interval)?;
                        } else if self.net.at_most(v, u) < interval {
                            self.net.demand(v, u, -interval)?;
                        }
                    }
                }
            }
            if self.net.changes() == before {
                return Ok(());
            }
        }
    }

    /// Demands the separation between sensors whose order of `|d|` is known.
    fn space_ranks(&mut self) -> Result<(), Contradiction> {
        let mut chain = [0u8; MAX_SENSORS];
        let (lows, highs) = (self.ranks.lows().len(), self.ranks.highs().len());
        chain[..lows].copy_from_slice(self.ranks.lows());
        for (place, &x) in chain[lows..].iter_mut().zip(self.ranks.highs().iter().rev()) {
            *place = x;
        }
        let unranked = self.needs.all() & !self.ranks.ranked;
        for i in 1..lows + highs {
            if i != lows || unranked == 0 {
                self.behind(usize::from(chain[i - 1]), usize::from(chain[i]))?;
            }
        }
        for x in Sensors(unranked) {
            if lows > 0 {
                self.behind(usize::from(chain[lows - 1]), x)?;
            }
            if highs > 0 {
                self.behind(x, usize::from(chain[lows]))?;
            }
        }
        Ok(())
    }

    /// The nodes whose difference is `|d|` of sensor `x`, later first; `None` while the sign is open.
    fn signed(&self, x: usize) -> Option<(usize, usize)> {
        let (low, high) = self.span(x);
        let (a, b) = (self.node(x, 0), self.node(x, 1));
        if low >= 0 {
            Some((a, b))
        } else if high <= 0 {
            Some((b, a))
        } else {
            None
        }
    }

    /// Demands `|d_x| + D <= |d_y|`: of four times, each pair of differences bounds the other.
    fn behind(&mut self, x: usize, y: usize) -> Result<(), Contradiction> {
        let (Some((late_x, early_x)), Some((late_y, early_y))) = (self.signed(x), self.signed(y)) else {
            return Ok(());
        };
        let d = self.needs.separation;
        // (late_y - early_y) + (early_x - late_x) >= D
        self.net.demand(early_y, late_y, self.net.at_most(early_x, late_x) - d)?;
        self.net.demand(late_x, early_x, self.net.at_most(late_y, early_y) - d)?;
        // (late_y - late_x) + (early_x - early_y) >= D
        self.net.demand(late_x, late_y, self.net.at_most(early_x, early_y) - d)?;
        self.net.demand(early_y, early_x, self.net.at_most(late_y, late_x) - d)
    }

    /// Demands that `|d|` of sensor `x` is within `low..=high`, as far as the sign is known; for ranked sensors it is.
    pub(super) fn demand_size(&mut self, x: usize, low: i32, high: i32) -> Result<(), Contradiction> {
        if low > high {
            return Err(Contradiction);
        }
        let (a, b) = (self.node(x, 0), self.node(x, 1));
        self.net.demand(a, b, high)?;
        self.net.demand(b, a, high)?;
        let (least, most) = self.span(x);
        let ranked = self.ranks.ranked >> x & 1 == 1;
        let negative = self.ranks.negative >> x & 1 == 1;
        if (ranked && !negative) || -low < least {
            self.net.demand(b, a, -low)?;
        }
        if (ranked && negative) || low > most {
            self.net.demand(a, b, -low)?;
        }
        Ok(())
    }

    /// All `|d|` must fit with the separation between them; `packed` is what came out the last time.
    fn pack(&mut self, packed: &mut Intervals) -> Result<(), Contradiction> {
        let mut intervals = self.intervals();
        let k = self.needs.sensors;
        if intervals.low[..k] == packed.low[..k] && intervals.high[..k] == packed.high[..k] {
            return Ok(());
        }
        if (0..k).any(|x| intervals.low[x] > intervals.high[x]) {
            return Err(Contradiction);
        }
        intervals.round(k, self.needs.separation, self.needs.least, self.widest)?;
        intervals.pack(k, self.needs.separation)?;
        for x in 0..k {
            self.demand_size(x, intervals.low[x], intervals.high[x])?;
        }
        *packed = intervals;
        Ok(())
    }

    /// Sensors whose d lies a forced distance before or behind that of several others.
    fn set_precedence(&mut self) -> Result<(), Contradiction> {
        for y in 0..self.needs.sensors {
            self.behind_set(y, false)?;
            self.behind_set(y, true)?;
        }
        Ok(())
    }

    /// `d_y` against those conflicting x with forced `d_y - d_x > 0`; with `mirrored`, `d_x - d_y > 0`.
    fn behind_set(&mut self, y: usize, mirrored: bool) -> Result<(), Contradiction> {
        let separation = self.needs.separation;
        // (forced distance, low end of d_x), largest distance first.
        let mut set = [(0, 0); MAX_SENSORS];
        let mut count = 0;
        let (ya, yb) = (self.node(y, 0), self.node(y, 1));
        for x in Sensors(self.needs.conflicts[y]) {
            let (xa, xb) = (self.node(x, 0), self.node(x, 1));
            let (low, high) = self.span(x);
            let (forced, low) = if mirrored {
                (-(self.net.at_most(ya, xa) + self.net.at_most(xb, yb)), -high)
            } else {
                (-(self.net.at_most(xa, ya) + self.net.at_most(yb, xb)), low)
            };
            if forced > 0 {
                let forced = forced.max(separation);
                let mut at = count;
                while at > 0 && set[at - 1].0 < forced {
                    set[at] = set[at - 1];
                    at -= 1;
                }
                set[at] = (forced, low);
                count += 1;
            }
        }
        if count == 0 {
            return Ok(());
        }
        let mut least = i32::MIN;
        let mut lows = [0; MAX_SENSORS];
        for i in 0..count {
            let (forced, low) = set[i];
            let mut at = i;
            while at > 0 && lows[at - 1] > low {
                lows[at] = lows[at - 1];
                at -= 1;
            }
            lows[at] = low;
            // All d of the set, D apart: where the last one is at the earliest.
            let last = lows[1..=i].iter().fold(lows[0], |last, &low| low.max(last + separation));
            least = least.max(last + forced);
        }
        if mirrored { self.net.demand(ya, yb, -least) } else { self.net.demand(yb, ya, -least) }
    }
}
