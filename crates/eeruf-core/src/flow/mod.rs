//! Firing in turn: one sensor after the other, with as much quiet around each firing as its readings require, and a
//! random time in every gap. Readings are accepted if they fit the belief, or if two agree and nothing foreign explains
//! both.
//!
//! While a robot moves alone, it reports every echo, with twice the least quiet: see [`Votes`]. The belief is still
//! updated and decides about quiet, but the promise about one path of sound covers only two agreeing readings in a row.
//!
//! The plan [`InTurn`] and the judge [`Belief`] work by actual firings: a late poll costs time but breaks no promise.
//! The proof for two that agree is in `docs/explanation/theory.md`; the remaining risks are measured.

mod belief;
pub(crate) mod m_of_n;
mod motion;
mod plan;
mod settings;

use crate::own_limits::OwnLimits;
use crate::ring::{Listening, Ring, RingConfig};
use crate::ring_error::RingError;
use crate::schedule::MAX_SENSORS;
use crate::time::Instant;

pub use belief::Belief;
pub use plan::InTurn;
pub use settings::{BeliefSettings, TurnSettings, Votes};

/// A ring of up to `K` sensors that fires in turn, with up to `E` echoes per firing. It remembers the last three
/// firings of each sensor: fewer are too few, more add nothing. `U` is [`EachSensor`](crate::EachSensor), or a
/// reference to one, if sensors have limits of their own.
pub type FlowRing<const K: usize, const E: usize = 1, U = ()> = Ring<InTurn<K, U>, Belief<K, E>, K, E, 3>;

impl<const K: usize, const E: usize> FlowRing<K, E> {
    /// A ring of `sensors` sensors that begins at `now`. Only the window and the blanking time of `config` are used. R
    /// is the longest quiet of `turns`, and P comes from `belief`.
    ///
    /// # Errors
    /// [`RingError::Setting`] for a setting out of its range, and as for [`Ring::judged_by`].
    #[inline(always)]
    pub const fn flow(
        sensors: usize,
        turns: TurnSettings,
        belief: BeliefSettings,
        config: RingConfig,
        now: Instant,
    ) -> Result<Self, RingError> {
        if K > MAX_SENSORS {
            return Err(RingError::Room { capacity: K });
        }
        let Some(window) = config.window else { return Err(RingError::Unverified) };
        let judge = match Belief::new(belief) {
            Ok(judge) => judge,
            Err(error) => return Err(error),
        };
        let plan = match InTurn::begin(sensors, (), turns, judge.pace_now(), window, now) {
            Ok(plan) => plan,
            Err(error) => return Err(error),
        };
        let listening = match Listening::of(belief.t_delta, window, window, config.blanking) {
            Ok(listening) => listening.with_sound(Some(belief.path_change), turns.most),
            Err(error) => Err(error),
        };
        match listening {
            Ok(listening) => Ok(Self::begin(plan, judge, listening, false, now)),
            Err(error) => Err(error),
        }
    }

    /// Changes the seed of the random gaps, for example to the chip's number in a ring that is a `const`.
    ///
    /// # Errors
    /// [`RingError::Setting`] for 0. The ring is then unchanged.
    pub fn set_seed(&mut self, seed: u32) -> Result<(), RingError> {
        self.change_plan(|plan| plan.set_seed(seed))
    }
}

impl<const K: usize, const E: usize, U: OwnLimits> FlowRing<K, E, U> {
    /// Makes a ring like [`flow`](FlowRing::flow), for sensors that have limits of their own. `config` and the
    /// `t_delta` of `belief` are the upper limits for all.
    ///
    /// # Errors
    /// See [`flow`](FlowRing::flow).
    #[inline(always)]
    pub fn with_limits(
        sensors: usize,
        own_limits: U,
        turns: TurnSettings,
        belief: BeliefSettings,
        config: RingConfig,
        now: Instant,
    ) -> Result<Self, RingError> {
        let window = config.window.ok_or(RingError::Unverified)?;
        let judge = Belief::new(belief)?;
        let plan = InTurn::begin(sensors, own_limits, turns, judge.pace_now(), window, now)?.grouped();
        let config = config.with_audible(turns.most).with_path_change(belief.path_change);
        Self::judged_by(plan, judge, config.with_echoes::<E>(), now)
    }
}
