use eeruf_core::{Instant, Micros, Reading, ReadingKind, judge::Explanation};

/// One firing of one sensor, and its outcome.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FiringMessage {
    /// The sensor, from 0.
    pub sensor: u8,
    /// The phase of the firing, from 0.
    pub phase: u8,
    /// The outcome: accepted, or the reason why not.
    pub kind: ReadingKind,
    /// Time of the firing, by the board's clock, which wraps after 2^32 us.
    pub fired: Instant,
    /// The period of the firing, from 0.
    pub period: u32,
    /// The raw time from firing to the first echo; `None` without echo.
    pub t_echo: Option<Micros>,
    /// Delay of the firing after it was due; 65,535 us stands for this or more.
    pub late: Micros,
    /// Time from the firing until the frame was made.
    pub age: Micros,
    /// The reason why the reading is ambiguous; `None` for every other kind.
    pub explained_by: Option<Explanation>,
}

impl FiringMessage {
    /// Makes the message of a reading whose sensor fired at the instant `fired`, with a delay of `late`, for a frame
    /// made at `now`.
    pub fn of(reading: &Reading, fired: Instant, late: Micros, now: Instant) -> Self {
        let Reading { sensor, phase, kind, period, t_echo, explained_by, .. } = *reading;
        let age = now.since(fired);
        Self { sensor, phase: phase.0, kind, fired, period, t_echo, late, age, explained_by }
    }
}
