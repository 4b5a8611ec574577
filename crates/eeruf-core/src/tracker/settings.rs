//! [`TrackerSettings`]: how much must agree before an echo is believed, in three named sets.

use crate::ring_error::RingError;
use crate::time::Micros;

/// While odometry moves, confirmed echoes are remembered for this many times as long.
const MOVING_MEMORY: u8 = 3;
/// At least this many phases must support an echo before it is reported as tentative while odometry moves, as any two
/// readings are then those of some wall, and where sensors report several echoes, of which two soon agree.
const SAFER_VOTES: u8 = 3;

/// Settings by which an [`EchoTracker`](super::EchoTracker) weighs readings. Begin with one of
/// [`BALANCED`](Self::BALANCED), [`QUICK`](Self::QUICK) and [`MAPS`](Self::MAPS).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct TrackerSettings {
    /// `T_delta`: a reading supports a track that it differs from by no more. 1 us to 65,535 us.
    pub t_delta: Micros,
    /// A reading this near a confirmed track is accepted, though only one within `t_delta` supports it: an echo moves
    /// a little as the robot does. At least `t_delta`, at most 65,535 us.
    pub near: Micros,
    /// A track is confirmed once this many votes support it: one for each phase, two for one in which the sensor fired
    /// alone. 2 to 15.
    pub votes: u8,
    /// A track's score stops here; each new phase adds to it, each contradiction takes from it. `votes` to 15.
    pub score_limit: u8,
    /// Score that a contradiction takes from a confirmed track. 1 to 15.
    pub contradiction: u8,
    /// Score that it takes if the sensor fired alone. 1 to 15.
    pub solo_contradiction: u8,
    /// Number of phases that must support an echo that was never contradicted before it is reported as tentative, or 0
    /// to report confirmed echoes alone. 0 or 2 to 15; at least three while odometry moves and of sensors that report
    /// several echoes, one if the sensor fired alone.
    pub tentative_votes: u8,
    /// Tolerance of their agreement. At most `t_delta`.
    pub tentative_within: Micros,
    /// A confirmed echo that is contradicted or masked is remembered for this many firings without support, and
    /// confirmed again by a single reading; three times as many while odometry moves, since echoes of a robot that
    /// turns come and go. 0: it is forgotten.
    pub memory: u8,
}

impl TrackerSettings {
    /// For most robots: what comes nearer is reported as tentative after some four periods.
    pub const BALANCED: Self = Self {
        t_delta: Micros::new(150),
        near: Micros::new(400),
        votes: 5,
        score_limit: 6,
        contradiction: 2,
        solo_contradiction: 6,
        tentative_votes: 2,
        tentative_within: Micros::new(60),
        memory: 0,
    };
    /// For robots that must stop early: four phases confirm, and tentative readings need not agree as closely.
    pub const QUICK: Self = Self { votes: 4, tentative_within: Micros::new(100), ..Self::BALANCED };
    /// For maps: confirmed echoes alone, and beliefs that last.
    pub const MAPS: Self = Self { tentative_votes: 0, score_limit: 7, contradiction: 1, ..Self::BALANCED };

    /// With this `t_delta`, 1 us to 65,535 us.
    #[must_use]
    pub const fn with_t_delta(self, t_delta: Micros) -> Self {
        Self { t_delta, ..self }
    }

    /// Accepting readings this near a confirmed track, `t_delta` to 65,535 us.
    #[must_use]
    pub const fn with_near(self, near: Micros) -> Self {
        Self { near, ..self }
    }

    /// Confirming after this many votes, 2 to 15.
    #[must_use]
    pub const fn with_votes(self, votes: u8) -> Self {
        Self { votes, ..self }
    }

    /// With scores of at most this, `votes` to 15.
    #[must_use]
    pub const fn with_score_limit(self, score_limit: u8) -> Self {
        Self { score_limit, ..self }
    }

    /// With contradictions that take so much, 1 to 15.
    #[must_use]
    pub const fn with_contradiction(self, contradiction: u8) -> Self {
        Self { contradiction, ..self }
    }

    /// With contradictions that take so much where the sensor fired alone, 1 to 15.
    #[must_use]
    pub const fn with_solo_contradiction(self, solo_contradiction: u8) -> Self {
        Self { solo_contradiction, ..self }
    }

    /// Reporting as tentative after this many phases, 2 to 15; 0: never.
    #[must_use]
    pub const fn with_tentative_votes(self, tentative_votes: u8) -> Self {
        Self { tentative_votes, ..self }
    }

    /// Reporting as tentative what agrees within this, at most `t_delta`.
    #[must_use]
    pub const fn with_tentative_within(self, tentative_within: Micros) -> Self {
        Self { tentative_within, ..self }
    }

    /// Remembering confirmed echoes for this many firings without support; 0: not at all.
    #[must_use]
    pub const fn with_memory(self, memory: u8) -> Self {
        Self { memory, ..self }
    }

    /// Checks each setting's range, as [`EchoTracker::new`](super::EchoTracker::new) does.
    ///
    /// # Errors
    /// [`RingError::Setting`] for the first that is not.
    pub const fn check(&self) -> Result<(), RingError> {
        let (t_delta, near) = (self.t_delta.as_micros(), self.near.as_micros());
        let within = self.tentative_within.as_micros();
        macro_rules! expect {
            ($name:literal, $value:expr, $least:expr, $most:expr) => {
                if $value < $least || $value > $most {
                    return Err(RingError::Setting { name: $name, value: $value, least: $least, most: $most });
                }
            };
        }
        const LONGEST: u32 = u16::MAX as u32;
        expect!("t_delta", t_delta, 1, LONGEST);
        expect!("near", near, t_delta, LONGEST);
        expect!("votes", self.votes as u32, 2, 15);
        expect!("score_limit", self.score_limit as u32, self.votes as u32, 15);
        expect!("contradiction", self.contradiction as u32, 1, 15);
        expect!("solo_contradiction", self.solo_contradiction as u32, 1, 15);
        if self.tentative_votes != 0 {
            expect!("tentative_votes", self.tentative_votes as u32, 2, 15);
        }
        if within > t_delta {
            return Err(RingError::Setting { name: "tentative_within", value: within, least: 0, most: t_delta });
        }
        Ok(())
    }
}

impl TrackerSettings {
    /// These settings of a robot that moves or stands.
    #[inline(always)]
    pub(super) const fn for_motion(self, moving: bool) -> Self {
        let memory = if moving { self.memory.saturating_mul(MOVING_MEMORY) } else { self.memory };
        Self { memory, ..self }
    }

    /// Number of phases that must support an echo before it is reported as tentative, where two might be chance.
    #[inline(always)]
    pub(super) fn tentative_votes_if(&self, any_two_may_agree: bool) -> u8 {
        self.tentative_votes.max(if any_two_may_agree { SAFER_VOTES } else { 0 })
    }

    /// Scores that a contradiction takes from a track that is not confirmed, and from one that is.
    #[inline(always)]
    pub(super) const fn contradictions(&self, solo: bool) -> (u8, u8) {
        if solo { (self.solo_contradiction, self.solo_contradiction) } else { (1, self.contradiction) }
    }
}

impl Default for TrackerSettings {
    fn default() -> Self {
        Self::BALANCED
    }
}
