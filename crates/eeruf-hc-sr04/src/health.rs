//! [`Health`]: the health of a sensor, judged by its line or its answers.

use core::fmt;

/// The health of a sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Health {
    /// The line answers, or the sensor has not been triggered often enough to know.
    #[default]
    Well,
    /// No answer to triggers: no sensor there, a cut wire, or no interrupts at all.
    Missing,
    /// The line was high when the sensor was to be triggered.
    StuckHigh,
    /// Several pulses or answers followed one trigger, or an invalid one.
    Chatters,
    /// An edge or a part of an answer was lost: the line fell without having risen, or rose and was low again without
    /// having fallen.
    LosesEdges,
    /// A pin, the bus or the serial line reported an error.
    PinError,
}

impl fmt::Display for Health {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Well => "well",
            Self::Missing => "missing",
            Self::StuckHigh => "stuck high",
            Self::Chatters => "chatters",
            Self::LosesEdges => "loses edges",
            Self::PinError => "pin error",
        })
    }
}
