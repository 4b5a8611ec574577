use eeruf_core::{Instant, Micros, ReadingKind, hopping::Weighed, judge::Explanation};

/// One firing of one sensor, and what came of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Firing {
    /// The sensor, from 0.
    pub sensor: u8,
    /// The phase it fired in, from 0.
    pub phase: u8,
    /// What came of it: accepted, or why not.
    pub kind: ReadingKind,
    /// When it fired, by the board's clock, which wraps after 2^32 us.
    pub fired: Instant,
    /// The period it fired in, from 0.
    pub period: u32,
    /// The raw time from firing to the first echo; `None` without echo.
    pub t_echo: Option<Micros>,
    /// By how much the firing came after it was due; at most 65,535 us, which stands for all more.
    pub late: Micros,
    /// How long after the firing the frame was made.
    pub age: Micros,
    /// The reason why the reading is ambiguous; `None` for every other kind.
    pub explained_by: Option<Explanation>,
    /// How the tracker of a hopping ring weighed the reading; `None` for other rings.
    pub weighed: Option<Weighed>,
}
