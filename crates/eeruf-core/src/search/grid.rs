//! Conversion between microseconds, in which a ring is described, and the ticks of a grid, in which it is searched.

use super::error::SearchError;
use crate::time::Micros;

/// A grid of ticks, each at least a microsecond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Grid {
    tick_us: u32,
}

impl Grid {
    pub(super) fn new(tick: Micros) -> Result<Self, SearchError> {
        if tick == Micros::ZERO { Err(SearchError::NoTick) } else { Ok(Self { tick_us: tick.as_micros() }) }
    }

    /// The least number of ticks that is at least `time`.
    pub(super) fn at_least(self, time: Micros) -> u32 {
        time.as_micros().div_ceil(self.tick_us)
    }

    /// The greatest number of ticks that is at most `time`.
    pub(super) fn at_most(self, time: Micros) -> u32 {
        time.as_micros() / self.tick_us
    }

    /// Number of ticks of a time that must lie on the grid.
    pub(super) fn exactly(self, what: &'static str, time: Micros) -> Result<u32, SearchError> {
        if time.as_micros() % self.tick_us == 0 {
            Ok(time.as_micros() / self.tick_us)
        } else {
            Err(SearchError::OffGrid { what, time, tick: Micros::new(self.tick_us) })
        }
    }

    /// The separation in ticks that `t_delta` needs: `2 t_delta + 1 us` or more.
    pub(super) fn separation(self, t_delta: Micros) -> u32 {
        self.at_least(t_delta.saturating_add(t_delta).saturating_add(Micros::new(1)))
    }

    /// The largest `t_delta` that a separation in ticks allows; `None` for no separation at all.
    pub(super) fn t_delta(self, separation: u32) -> Option<Micros> {
        self.time(separation).checked_sub(Micros::new(1)).map(|twice| Micros::new(twice.as_micros() / 2))
    }

    /// A number of ticks as a time; saturates at [`Micros::MAX`].
    pub(super) fn time(self, ticks: u32) -> Micros {
        Micros::new(ticks.saturating_mul(self.tick_us))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_separation_of_two_milliseconds_is_what_999_us_need() {
        for (tick, t_delta, ticks) in [(1000, 999, 2), (1000, 1000, 3), (1000, 499, 1), (100, 999, 20), (1, 999, 1999)]
        {
            let grid = Grid::new(Micros::new(tick)).unwrap();
            assert_eq!(grid.separation(Micros::new(t_delta)), ticks);
            assert!(grid.t_delta(ticks) >= Some(Micros::new(t_delta)));
            assert!(grid.t_delta(ticks - 1) < Some(Micros::new(t_delta)));
        }
        assert_eq!(Grid::new(Micros::ZERO), Err(SearchError::NoTick));
    }
}
