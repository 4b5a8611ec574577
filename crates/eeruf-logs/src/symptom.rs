//! Symptoms of one sensor, with the words for `eeruf logs`, for a ring's own log, and for Python.

/// Symptoms of one sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Symptom {
    /// The sensor has no echo: nothing is in its range, or it is deaf.
    Silent,
    /// The sensor has no echo though others hear its sound along paths on which it should hear theirs.
    Deaf,
    /// The value never changes.
    Constant,
    /// The values come in coarse steps.
    Coarse,
    /// The readings are scattered over all values.
    Scatters,
    /// The sensor reads the echo of its own previous firing.
    Stale,
    /// The sensor jumps between two values.
    Jumps,
}

impl Symptom {
    /// The name, as `--json` and Python give it.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Silent => "silent",
            Self::Deaf => "deaf",
            Self::Constant => "constant",
            Self::Coarse => "coarse",
            Self::Scatters => "scatters",
            Self::Stale => "stale echo",
            Self::Jumps => "jumps",
        }
    }
}

/// A symptom of one sensor, with its evidence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The sensor, from 0.
    pub sensor: usize,
    /// The symptom.
    pub symptom: Symptom,
    /// The evidence for the symptom, with figures.
    pub said: String,
}
