//! The outcome of one firing: [`ReadingKind`]; and [`Tally`], which counts the kinds.

use core::fmt;

use crate::time::Micros;

/// The outcome of one firing of one sensor. Each firing yields exactly one kind; only [`ReadingKind::Late`] with
/// an echo time may follow it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[repr(u8)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ReadingKind {
    /// An echo with nothing to compare it with: at the start, or after a firing without echo.
    First,
    /// Near-identical to the previous reading (Eq. 11), the required number of times in a row.
    Accepted,
    /// Not near-identical to the previous reading: crosstalk, noise, or an object that moved too fast.
    Rejected,
    /// Near-identical to the previous reading, but not yet often enough; only if more than two readings are compared.
    Repeated,
    /// No echo within the window, once; or repeatedly, if nothing shows that the sensor listened
    /// ([`Silence::NeverFree`](crate::Silence)).
    NoEcho,
    /// No echo for the required number of firings in a row: nothing is in range.
    Clear,
    /// Only an edge within the blanking time: ringing of the transducer, or an object too close to measure.
    TooEarly,
    /// An edge after the window has ended; it is not compared. Without an echo time, the edge is uncertain by more than
    /// 0.6 ms.
    Late,
    /// The driver reported that the echo line was stuck when the sensor was to fire.
    Stuck,
    /// An echo nearer than the confirmed one, with little support so far but no contradiction: slow down for it. Only a
    /// judge of your own returns it.
    Tentative,
    /// Near-identical to the previous reading, but sound of another firing explains both: [`Explanation`] names that
    /// firing. Only a [`Ring`](crate::Ring) returns it.
    Ambiguous,
    /// No evidence at all: neither an echo nor a witness that the sensor listened
    /// ([`Silence::NeedsAnswer`](crate::Silence)). Never free space.
    Unanswered,
}

impl ReadingKind {
    /// Every kind, in the order of the enumeration.
    pub const ALL: [Self; 12] = [
        Self::First,
        Self::Accepted,
        Self::Rejected,
        Self::Repeated,
        Self::NoEcho,
        Self::Clear,
        Self::TooEarly,
        Self::Late,
        Self::Stuck,
        Self::Tentative,
        Self::Ambiguous,
        Self::Unanswered,
    ];

    /// A short name, as `--json` and Python spell it.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Accepted => "accepted",
            Self::Rejected => "rejected",
            Self::Repeated => "repeated",
            Self::NoEcho => "no_echo",
            Self::Clear => "clear",
            Self::TooEarly => "too_early",
            Self::Late => "late",
            Self::Stuck => "stuck",
            Self::Tentative => "tentative",
            Self::Ambiguous => "ambiguous",
            Self::Unanswered => "unanswered",
        }
    }

    /// Returns true if an echo was compared and is not believed: rejected, or ambiguous.
    pub const fn is_rejected(self) -> bool {
        matches!(self, Self::Rejected | Self::Ambiguous)
    }
}

impl fmt::Display for ReadingKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

/// The reason why a reading is [`Ambiguous`](ReadingKind::Ambiguous).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Explanation {
    /// Two firings of this sensor, from 0, lie as far apart as the sounds of the two readings.
    Sensor(u8),
    /// A firing that is no longer remembered could have been heard.
    History,
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sensor(sensor) => write!(f, "sensor {}", u16::from(*sensor) + 1),
            Self::History => f.write_str("history"),
        }
    }
}

/// A judge's answer to one firing of one sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Verdict {
    /// The outcome of the firing.
    pub kind: ReadingKind,
    /// The echo time: the accepted one, or else the earliest; `None` without echo.
    #[doc(alias = "T_echo")]
    pub t_echo: Option<Micros>,
    /// The echo time of the previous firing that this one was compared with, if any.
    pub previous: Option<Micros>,
    /// Number of firings of this sensor since the last accepted reading: 0 for an accepted one, `None` if none ever
    /// was. Stops at 65,534.
    pub age: Option<u16>,
    /// The explanation of an [`Ambiguous`](ReadingKind::Ambiguous) reading; `None` for all other kinds.
    pub explained_by: Option<Explanation>,
}

/// Counts of readings by kind; `N` is `u8` for one period of a ring, `u32` for long runs. Counts saturate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tally<N = u32> {
    counts: [N; ReadingKind::ALL.len()],
}

impl Tally<u8> {
    /// An empty tally.
    pub(crate) const NONE: Self = Self { counts: [0; ReadingKind::ALL.len()] };
}

impl<N: Copy + Into<u32> + TryFrom<u32>> Tally<N> {
    /// Counts one more reading of this kind.
    pub fn count(&mut self, kind: ReadingKind) {
        // `ReadingKind` is numbered in the order of `ALL`, so the index is in range.
        if let Some(count) = self.counts.get_mut(kind as usize) {
            let more: u32 = (*count).into().saturating_add(1);
            if let Ok(more) = N::try_from(more) {
                *count = more;
            }
        }
    }

    /// The number of readings of one kind.
    pub fn of(&self, kind: ReadingKind) -> u32 {
        self.counts.get(kind as usize).map_or(0, |&count| count.into())
    }

    /// The rejection rate (end of Sec. 3.1): the share of rejected and ambiguous readings among all that were compared,
    /// in thousandths; `None` if none was compared.
    pub fn rejection_permille(&self) -> Option<u16> {
        let rejected = u64::from(self.of(ReadingKind::Rejected)) + u64::from(self.of(ReadingKind::Ambiguous));
        let compared = rejected + u64::from(self.of(ReadingKind::Accepted)) + u64::from(self.of(ReadingKind::Repeated));
        // At most 1000.
        (1000 * rejected).checked_div(compared).map(|permille| permille as u16)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn a_tally_counts_each_kind_apart_and_saturates() {
        let mut tally = Tally::<u8>::default();
        for _ in 0..300 {
            tally.count(ReadingKind::Clear);
        }
        for kind in ReadingKind::ALL {
            tally.count(kind);
        }
        assert_eq!(tally.of(ReadingKind::Clear), 255);
        assert_eq!(tally.of(ReadingKind::Stuck), 1);
        assert_eq!(tally.rejection_permille(), Some(500));
        assert_eq!(Tally::<u32>::default().rejection_permille(), None);
    }

    #[test]
    fn explaining_sensors_are_displayed_from_one() {
        assert_eq!(Explanation::Sensor(255).to_string(), "sensor 256");
        assert_eq!(Explanation::History.to_string(), "history");
    }
}
