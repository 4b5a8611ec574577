//! [`Weighed`]: what the log of a hopping ring says of a reading.

/// The tracker's weighing of a reading in a hopping ring, beside its phase and echo time: what a log needs, so that an
/// [`EchoTracker`](crate::judge::EchoTracker) can do the same again.
/// [`HoppingPlan::weighed`](crate::hopping::HoppingPlan::weighed) gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Weighed {
    /// True if no other sensor's sound could be heard.
    pub solo: bool,
    /// True if firings were so punctual that crosstalk moved as the schedule says.
    pub steady: bool,
    /// Number of times that firing times had changed otherwise than by the phase, modulo 256: see
    /// [`HoppingPlan::changes`](crate::hopping::HoppingPlan::changes).
    pub changes: u8,
    /// Change of the reading since the sensor's firing before that odometry expected, in microseconds; 0 for a robot
    /// that stands.
    pub expected_change_us: i32,
}
