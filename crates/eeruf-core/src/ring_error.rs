//! [`RingError`]: reasons why a ring or a judge cannot be set up.

use core::fmt;

use crate::schedule::MAX_SENSORS;
use crate::sensor_error::SensorError;
use crate::time::Micros;

/// The longest `t_delta` and blanking time, which a ring stores in two bytes each.
pub(crate) const LONGEST: Micros = Micros::new(u16::MAX as u32);
/// The longest time for which sound can be declared audible, about a minute.
pub(crate) const MAX_AUDIBLE: Micros = Micros::new(1 << 26);

/// The shortest plausible window or audible time: a smaller number is probably in milliseconds.
pub(crate) const PLAUSIBLE: Micros = Micros::from_millis(1);

/// Refuses a setting that is not within its range.
pub(crate) const fn within(name: &'static str, value: Micros, least: Micros, most: Micros) -> Result<(), RingError> {
    let [value, least, most] = [value.as_micros(), least.as_micros(), most.as_micros()];
    if value < least || value > most {
        return Err(RingError::Setting { name, value, least, most });
    }
    Ok(())
}

/// A hint at the unit in which an out-of-range setting was probably given.
fn likely(name: &str, value: u32, least: u32, most: u32) -> &'static str {
    let fits = |value: Option<u32>| value.is_some_and(|value| (least..=most).contains(&value));
    match name {
        "seed" | "hold" => "",
        _ if value < least && fits(value.checked_mul(1000)) => match name {
            "top_speed_mm_s" => ", likely given in m/s",
            _ => ", likely given in milliseconds",
        },
        _ if value > most && fits(Some(value / 1000)) => ", likely given in nanoseconds",
        _ => "",
    }
}

/// Reason why a [`Ring`](crate::Ring), or a judge, cannot be set up as asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RingError {
    /// A sensor would fire again while it still listens.
    Window {
        /// The window asked for.
        window: Micros,
        /// The shortest time between two firings of one sensor.
        min_refire: Micros,
    },
    /// The schedule was verified for a shorter window.
    VerifiedWindow {
        /// The window asked for.
        window: Micros,
        /// The window that the schedule was verified for.
        verified: Micros,
    },
    /// The window ends before the blanking time, or the blanking time is longer than a ring can store.
    Blanking {
        /// The blanking time asked for.
        blanking: Micros,
        /// The window asked for.
        window: Micros,
    },
    /// The plan fires more sensors than the ring has.
    Sensors {
        /// Number of sensors that the plan fires.
        sensors: usize,
        /// Sensors of the ring.
        capacity: usize,
    },
    /// The ring has room for more sensors than a schedule may have.
    Room {
        /// The number of sensors for which there is room.
        capacity: usize,
    },
    /// The schedule was verified for a smaller `t_delta`.
    TDelta {
        /// The `t_delta` asked for.
        t_delta: Micros,
        /// The `t_delta` that the schedule was verified for.
        verified: Micros,
    },
    /// Any two readings within the window would be near-identical, or `t_delta` is longer than a ring can store.
    CoarseTDelta {
        /// The `t_delta` asked for.
        t_delta: Micros,
        /// The window asked for.
        window: Micros,
    },
    /// Sound would be audible for longer than a ring remembers firings.
    Audible {
        /// The time asked for.
        audible: Micros,
    },
    /// `path_change` above what a ring can store.
    PathChange {
        /// The change asked for.
        path_change: Micros,
    },
    /// The schedule was not verified, so it provides neither `t_delta` nor a window.
    Unverified,
    /// Too few or too many consecutive readings to compare.
    Consecutive {
        /// The number asked for.
        consecutive: u8,
    },
    /// The interval of an echo, in instants or echo times, ends before it begins.
    Interval {
        /// The beginning of the interval, in microseconds.
        earliest: u32,
        /// The end of the interval, in microseconds.
        latest: u32,
    },
    /// A sensor out of range.
    Sensor(SensorError),
    /// A setting, or a judge's argument, out of its range; times are in microseconds.
    Setting {
        /// The name of the argument, or of the field in [`RingConfig`](crate::RingConfig),
        /// [`TurnSettings`](crate::flow::TurnSettings) or [`BeliefSettings`](crate::flow::BeliefSettings).
        name: &'static str,
        /// The value given.
        value: u32,
        /// The least valid value.
        least: u32,
        /// The greatest valid value.
        most: u32,
    },
}

impl fmt::Display for RingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Window { window, min_refire } => write!(
                f,
                "a listening window of {window}; expected at most {min_refire}, after which a sensor of this schedule \
                 fires again (T_wind)"
            ),
            Self::VerifiedWindow { window, verified } => write!(
                f,
                "a listening window of {window}; expected at most {verified}, which the schedule was verified for"
            ),
            Self::Blanking { blanking, window } => {
                write!(
                    f,
                    "a blanking time of {blanking}; expected less than the window of {window}, and at most {LONGEST}"
                )
            }
            Self::Sensors { sensors, capacity } => {
                write!(f, "a plan of {sensors} sensors; expected at most the {capacity} of the ring")
            }
            Self::Room { capacity } => write!(f, "room for {capacity} sensors; expected at most {MAX_SENSORS}"),
            Self::TDelta { t_delta, verified } => {
                write!(f, "a t_delta of {t_delta}; expected at most {verified}, which the schedule was verified for")
            }
            Self::CoarseTDelta { t_delta, window } => {
                write!(f, "a t_delta of {t_delta}; expected less than the window of {window}, and at most {LONGEST}")
            }
            Self::Audible { audible } => {
                write!(f, "sound that is audible for {audible}; expected at most {MAX_AUDIBLE}")
            }
            Self::PathChange { path_change } => {
                write!(f, "a path that changes by {path_change}; expected at most 65534 us")
            }
            Self::Unverified => {
                f.write_str("a schedule that was not verified; expected both t_delta and window in the configuration")
            }
            Self::Consecutive { consecutive } => write!(f, "{consecutive} consecutive readings; expected 2 to 8"),
            Self::Interval { earliest, latest } => write!(
                f,
                "an echo between {earliest} and {latest} us; expected the latest after the earliest, likely swapped"
            ),
            Self::Sensor(error) => error.fmt(f),
            Self::Setting { name, value, least, most } => {
                let likely = likely(name, *value, *least, *most);
                write!(f, "{name} is {value}; expected {least} to {most}{likely}")
            }
        }
    }
}

impl core::error::Error for RingError {}

impl From<SensorError> for RingError {
    fn from(error: SensorError) -> Self {
        Self::Sensor(error)
    }
}
