//! The published state of the space in front of each sensor.

use eeruf_core::{Micros, ReadingKind, watch::SensorState};

use crate::range::{Distance, Scale};

/// State of the space in front of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum View {
    /// The sensor works, and sees this.
    Sees(Distance),
    /// The sensor does not answer, its line is broken, or it no longer fires: the space in front of it is not free.
    Unanswered,
    /// Nothing is confirmed: not yet, or readings are rejected or ambiguous.
    Unknown,
}

impl View {
    /// The view of a sensor in this state, and its age.
    pub(crate) fn of(state: SensorState, scale: &Scale) -> (Self, Micros) {
        let seen = |kind, t_echo| scale.distance(kind, t_echo).map_or(Self::Unknown, Self::Sees);
        match state {
            SensorState::Obstacle { t_echo, age } => (seen(ReadingKind::Accepted, Some(t_echo)), age),
            SensorState::Clear { age } => (seen(ReadingKind::Clear, None), age),
            SensorState::TooClose { age } => (seen(ReadingKind::TooEarly, None), age),
            SensorState::Unanswered { since } => (Self::Unanswered, since),
            SensorState::Unknown { since, .. } => (Self::Unknown, since),
            _ => (Self::Unknown, Micros::ZERO),
        }
    }
}
