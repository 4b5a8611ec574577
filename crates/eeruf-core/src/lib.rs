//! *Error Eliminating Rapid Ultrasonic Firing* (EERUF) for rings of ultrasonic range sensors, without an allocator.
//!
//! Sensors that fire at the same time hear each other: *crosstalk*. Firing one by one avoids it and is slow. EERUF
//! fires every sensor once per period `T_p` at `T_fire = T_lag + T_wait`, where `T_wait` alternates between two values
//! that differ from sensor to sensor, and accepts a reading only if it is near-identical to the one before. A true echo
//! does not depend on the waits; crosstalk shifts with them and is rejected. What is proven, and why: [`theory`].
//!
//! - [`Schedule`]: when each sensor fires. [`Requirements`] and [`Schedule::verify`]: Eqs. (13a), (13b), the smallest
//!   interval between neighbours, and the listening window.
//! - [`VerifiedSchedule`]: a schedule that meets them. [`schedule!`] makes one while the firmware is compiled.
//! - [`Ring`]: what firmware runs. It combines a [`Plan`] ([`ScheduledFiring`] or [`ImmediateRefiring`]) with the
//!   filter; [`EchoFilter`] is the filter alone.
//! - [`EchoTracker`]: believes an echo that readings from several phases support, for schedules of many phases.
//! - [`EdgeQueue`]: from the interrupt of an echo line to the main loop.
//! - [`SensorWatch`]: what is known of the space before each sensor now ([`SensorState`]), and which sensors are blind.
//! - [`Adaptation`]: moves along a ladder of schedules as the rejection rate asks for.
//! - [`Survey`]: a measuring run, after which it is known which sensors hear each other.
//! - [`SpeedOfSound`]: distances from echo times.
//!
//! The crate is `no_std` and uses no allocator, no floats and no clock: the caller passes `now` in and sleeps until the
//! deadline it gets back, so the same code runs in an interrupt, in a simulator and in a test. Sensors are counted from
//! 0 in code and printed from 1, as in the paper.
//!
//! Features: `search`, on by default, is the search for schedules, which firmware with a table can leave out (for an
//! AVR it must). The others are off by default, for crates that firmware already uses: `defmt` (formats), `serde`
//! (schedules, readings and times), `fugit` and `embassy-time` (conversions of times).
//!
//! Equations and sections are those of J. Borenstein and Y. Koren, *Error Eliminating Rapid Ultrasonic Firing for
//! Mobile Robot Obstacle Avoidance*, IEEE Transactions on Robotics and Automation 11(1), February 1995, pp. 132-138.
#![no_std]

mod adaptation;
mod checked;
mod conditions;
mod edges;
pub mod emit;
mod filter;
mod hopping;
mod interop;
mod judge;
mod layout;
mod needs;
mod own_limits;
mod phases;
mod plan;
mod reading;
mod ring;
mod schedule;
#[cfg(feature = "search")]
pub mod search;
mod sensor_error;
mod sensor_set;
mod sound;
mod survey;
pub mod tables;
mod time;
mod tracker;
mod uneven;
mod verified;
mod verify;
mod watch;

pub use adaptation::{Adaptation, Advice, Ladder, LadderError};
#[doc(hidden)]
pub use checked::{__checked, __checked_each, __checked_hopping, __micros};
pub use conditions::{Criterion, Interval, Requirements, Separation};
pub use edges::{Edge, EdgeQueue};
pub use filter::{EchoFilter, FilterError, RateFilter};
pub use hopping::{
    HoppingCode, HoppingError, HoppingHeader, HoppingListening, HoppingPlan, HoppingRing, HoppingRust, HoppingSchedule,
    HoppingSettings, HoppingTab, HoppingToml, Weighed,
};
pub use interop::DurationError;
pub use judge::{Agreement, Firing, Heard, Judge, Sounds};
pub use layout::{Layout, LayoutError, neighbour_rows};
pub use own_limits::{Alike, EachInUse, EachSensor, LimitsInUse, OwnLimits, SensorLimits};
pub use phases::{
    Audible, PhaseCriterion, PhaseInterval, PhaseRequirements, PhaseSeparation, PhaseTable, PhaseVerification,
    PhaseViolation, PhaseViolations,
};
pub use plan::{BrokenPromise, ImmediateRefiring, Limits, Plan, PlanStep, ScheduledFiring, check_plan};
pub use reading::{Explanation, ReadingKind, Tally, Verdict};
pub use ring::{AgreementRing, PeriodStats, Reading, Ring, RingConfig, RingError, RingEvent, ScheduledRing};
pub use schedule::{MAX_PERIOD, MAX_PHASES, MAX_SENSORS, Phase, Schedule, ScheduleError, VerifiedFor};
pub use sensor_error::SensorError;
pub use sound::SpeedOfSound;
pub use survey::{Survey, SurveyEvent, SurveyPlan, SurveyRow, SurveySlot};
pub use time::{Instant, Micros};
pub use tracker::{EchoTracker, TrackerError, TrackerSettings};
pub use uneven::{Uneven, UnevenError};
pub use verified::VerifiedSchedule;
pub use verify::{Verification, Violation, ViolationKind, Violations};
pub use watch::{Blind, Doubt, SensorState, SensorWatch};

/// What is proven, and why: `docs/theory.md`, for reading here.
///
/// The file in this crate is a link to it, so that a packed crate holds the text too.
#[cfg(doc)]
#[doc = include_str!("../theory.md")]
pub mod theory {}

/// The listing of the crate's README compiles and holds.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
