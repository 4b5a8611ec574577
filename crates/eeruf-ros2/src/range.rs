//! Conversion of echo times to the values of a `sensor_msgs/Range`, by REP 117.

use eeruf_core::{Micros, ReadingKind, SpeedOfSound};

use crate::parameters::Parameters;

/// The distance that a reading means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Distance {
    /// Something is there, in metres.
    At(f32),
    /// Nothing is in range.
    Clear,
    /// Something is too close to measure.
    TooClose,
}

/// Limits and speed of sound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    sound_m_s: f64,
    pub(crate) min_m: f32,
    pub(crate) max_m: f32,
}

impl Scale {
    pub(crate) fn new(parameters: &Parameters) -> Self {
        // Within -60 to 80 degrees.
        let sound = SpeedOfSound::at_celsius_tenths((10.0 * parameters.temperature_c).round() as i16);
        Self {
            sound_m_s: f64::from(sound.mm_per_s()) / 1000.0,
            min_m: parameters.min_range_m,
            max_m: parameters.max_range_m,
        }
    }

    /// Returns the distance for an echo time, in metres.
    pub(crate) fn metres(&self, t_echo: Micros) -> f64 {
        f64::from(t_echo.as_micros()) * 1e-6 * self.sound_m_s / 2.0
    }

    /// Returns the meaning of a reading; `None` if it has none: rejected, ambiguous, unanswered, or not yet confirmed.
    pub(crate) fn distance(&self, kind: ReadingKind, t_echo: Option<Micros>) -> Option<Distance> {
        match (kind, t_echo) {
            (ReadingKind::Accepted, Some(t_echo)) => {
                let metres = self.metres(t_echo) as f32;
                Some(if metres > self.max_m {
                    Distance::Clear
                } else if metres < self.min_m {
                    Distance::TooClose
                } else {
                    Distance::At(metres)
                })
            }
            (ReadingKind::Clear, _) => Some(Distance::Clear),
            (ReadingKind::TooEarly, _) => Some(Distance::TooClose),
            _ => None,
        }
    }
}

impl Distance {
    /// Returns the number for this distance in a `Range`.
    pub(crate) fn number(self) -> f32 {
        match self {
            Self::At(metres) => metres,
            Self::Clear => f32::INFINITY,
            Self::TooClose => f32::NEG_INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_as_rep_117_wants_them() {
        let us = |us| Some(Micros::new(us));
        let scale = Scale::new(&Parameters::default());
        for (kind, t_echo, expected) in [
            (ReadingKind::Accepted, us(10_000), Some(1.716)),
            // 4.12 m, and 1.7 cm.
            (ReadingKind::Accepted, us(24_000), Some(f32::INFINITY)),
            (ReadingKind::Accepted, us(100), Some(f32::NEG_INFINITY)),
            (ReadingKind::Clear, None, Some(f32::INFINITY)),
            (ReadingKind::TooEarly, us(90), Some(f32::NEG_INFINITY)),
            (ReadingKind::Rejected, us(10_000), None),
            (ReadingKind::First, us(10_000), None),
            (ReadingKind::Late, us(41_000), None),
            (ReadingKind::NoEcho, None, None),
            (ReadingKind::Stuck, None, None),
            (ReadingKind::Ambiguous, us(10_000), None),
            (ReadingKind::Unanswered, None, None),
        ] {
            assert_eq!(scale.distance(kind, t_echo).map(Distance::number), expected, "{kind}");
        }
    }
}
