//! Modules that measure by themselves: [`Measures`], and [`MeasuringRing`], a ring of them.
//!
//! Such a module times the echo with its own controller and reports a value: over I2C, a serial line, or by the width
//! of a pulse that the host's hardware captures. The ring starts each measurement when the plan says so, asks for the
//! result as soon as it may be ready, and passes it to [`Ring::measured`](eeruf_core::Ring::measured).
//!
//! | driver | module | interface |
//! |---|---|---|
//! | [`Srf08`] | Devantech SRF08 | I2C, `embedded-hal` |
//! | [`Us100`] | US-100 | serial line, `embedded-io` |
//! | [`Mb1010`] | `MaxBotix` MB1010 | pulse width, captured by the caller |
//!
//! Silence is not an answer: a reading is [`Clear`](eeruf_core::ReadingKind::Clear) only after the module itself
//! reported that nothing is in range, and [`Unanswered`](eeruf_core::ReadingKind::Unanswered) without a valid report.
//! Each driver discards what is left of an earlier measurement. It cannot recognise an answer that is a whole period
//! late if the current one is missing.

mod mb1010;
mod ring;
mod srf08;
mod us100;

use core::fmt;

use eeruf_core::Micros;

use crate::modules::Module;

pub use mb1010::Mb1010;
pub use ring::MeasuringRing;
pub use srf08::Srf08;
pub use us100::Us100;

/// A module that measures by itself: it is started, and asked for the result later.
///
/// Neither function may wait for the measurement; a [`MeasuringRing`] must start other modules meanwhile.
pub trait Measures {
    /// The module's figures, such as its time to report and its rest.
    fn module(&self) -> &Module;

    /// Starts a measurement, and discards any result of an earlier one. Returns the time after which to ask first.
    ///
    /// # Errors
    /// [`Fault`] if the module was not started.
    fn start(&mut self) -> Result<Micros, Fault>;

    /// Returns the result of the measurement that was started `since` ago. The ring calls this until there is a result
    /// or time runs out.
    ///
    /// # Errors
    /// [`Fault`] if there is no valid result. The ring asks again a little later.
    fn result(&mut self, since: Micros) -> Result<Measured, Fault>;

    /// Longest time from the start to the result, after which the module counts as unanswered: its figures plus an
    /// eighth for the error of its clock, an arbitrary choice.
    fn answers_within(&self) -> Micros {
        let module = self.module();
        let us = module.report_us.saturating_add(module.no_echo.hold_us());
        Micros::new(us.saturating_add(us / 8))
    }
}

impl<M: Measures + ?Sized> Measures for &mut M {
    fn module(&self) -> &Module {
        (**self).module()
    }

    fn start(&mut self) -> Result<Micros, Fault> {
        (**self).start()
    }

    fn result(&mut self, since: Micros) -> Result<Measured, Fault> {
        (**self).result(since)
    }

    fn answers_within(&self) -> Micros {
        (**self).answers_within()
    }
}

/// The state of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measured {
    /// The measurement is in progress. Ask again this long after its start.
    NotYet(Micros),
    /// An echo came back after this time.
    Echo(Micros),
    /// The module listened, and reports that nothing is in range.
    Nothing,
}

/// The reason why there is no result. No fault says anything about the space in front of the module.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Silence: no byte, no pulse, or an address that is not acknowledged.
    NoAnswer,
    /// The bus, the line or the pin reports an error.
    Bus,
    /// A part of the answer is missing.
    Truncated,
    /// The answer cannot belong to this measurement: an impossible value, several values, or an earlier one.
    Invalid,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::NoAnswer => "no answer",
            Self::Bus => "bus error",
            Self::Truncated => "truncated answer",
            Self::Invalid => "invalid answer",
        })
    }
}

impl core::error::Error for Fault {}
