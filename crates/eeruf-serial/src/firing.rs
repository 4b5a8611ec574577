use eeruf_core::{HoppingRing, Instant, Micros, ReadingKind};

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
    /// How the tracker of a hopping ring weighed the reading; `None` for other rings.
    pub weighed: Option<Weighed>,
}

/// How the tracker of a hopping ring weighed a reading, beside its phase and echo time: what `eeruf replay --hopping`
/// needs to do the same again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Weighed {
    /// Whether no other sensor's sound could be heard.
    pub solo: bool,
    /// Whether firings were so punctual that crosstalk moved as the schedule says.
    pub steady: bool,
    /// How often firing times had changed otherwise than by the phase, modulo 256: see [`HoppingRing::changes`].
    pub changes: u8,
    /// By how much the reading was expected to change since the sensor's firing before, in microseconds; 0 for a robot
    /// that stands.
    pub expected_change_us: i32,
}

impl Weighed {
    /// Of the reading of a sensor that the ring has just emitted; `None` for a sensor that is not there.
    pub fn of<const K: usize, const H: usize>(
        ring: &HoppingRing<K, H>,
        sensor: u8,
        expected_change_us: i32,
    ) -> Option<Self> {
        let firing = ring.weighed(sensor)?;
        Some(Self { solo: firing.solo, steady: firing.steady, changes: ring.changes(), expected_change_us })
    }
}
