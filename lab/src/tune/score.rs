//! Rounds of a search, and the score of a pilot in one.

/// Numbers of pilots and of courses that each drives, alone, behind a second robot and ahead of one. Courses of a round
/// come after those of the round before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Round {
    pub(crate) pilots: usize,
    pub(crate) courses: u64,
}

/// Budget of each method: 48 pilots, and 2,880 courses driven.
pub(crate) const ROUNDS: [Round; 3] =
    [Round { pilots: 48, courses: 8 }, Round { pilots: 12, courses: 24 }, Round { pilots: 4, courses: 72 }];

/// Score of a pilot on a round's courses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Score {
    /// Number of courses that the pilot finished alone, with a second robot behind, and with one ahead.
    pub(crate) finished: [u32; 3],
    /// Time of driving on finished courses, in seconds.
    pub(crate) time_s: f64,
}

impl Score {
    /// Computes the score: a finished course counts 1, and four more seconds on it cost a fortieth of that. All three
    /// places count alike, as each has as many courses.
    pub(crate) fn value(&self) -> f64 {
        f64::from(self.finished.iter().sum::<u32>()) - self.time_s / 160.0
    }
}
