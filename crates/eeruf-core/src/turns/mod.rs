//! Firing in turn: one sensor after the other, with as much quiet around each firing as its readings have needed, and a
//! throw of dice in every gap; readings are believed if they fit what is believed, or if two agree and nothing foreign
//! explains both.
//!
//! The plan [`InTurn`] and the judge [`Belief`] work by what was fired: a late poll costs time, never a promise. What
//! is proven of `twice` is in `docs/explanation/theory.md`; what is left to chance is measured.

mod belief;
mod motion;
mod plan;
mod settings;

use crate::plan::Plan as _;
use crate::ring::{Ring, RingConfig};
use crate::ring_error::RingError;
use crate::time::Instant;

pub use belief::Belief;
pub use plan::InTurn;
pub use settings::{BeliefSettings, TurnSettings};

/// A ring of up to `K` sensors that fires in turn, and remembers the last three firings of each: fewer explain nothing,
/// more add nothing.
pub type TurnRing<const K: usize> = Ring<InTurn<K>, Belief<K>, K, 1, 3>;

impl<const K: usize> TurnRing<K> {
    /// A ring of `sensors` sensors that begins at `now`. Of `config` only how the ring listens counts: the window, and
    /// the blanking time. How long sound is audible is the longest quiet of `turns`, and P is that of `belief`.
    ///
    /// # Errors
    /// [`RingError::Setting`] for a setting out of its range, and as for [`Ring::judged_by`].
    pub fn in_turn(
        sensors: usize,
        turns: TurnSettings,
        belief: BeliefSettings,
        config: RingConfig,
        now: Instant,
    ) -> Result<Self, RingError> {
        let window = config.window.ok_or(RingError::Unverified)?;
        let mut plan = InTurn::new(sensors, turns, window, now)?;
        plan.set_moving(belief.top_speed_mm_s > 0);
        let judge = Belief::new(belief)?;
        let config = config.with_audible(turns.most).with_path_change(belief.path_change);
        Self::judged_by(plan, judge, config, now)
    }
}
