//! Ultrasonic ranging modules: range, beam, echo line and rest between two triggers.
//!
//! One description serves ring files, scenes, drivers and the simulator: a [`Module`] of plain numbers. Ten are
//! [presets](PRESETS); docs/reference/modules.md names the document that gives each figure, or marks it as a choice.
//!
//! ```
//! use eeruf_modules::{HC_SR04, Interface, find};
//! assert_eq!(HC_SR04.rest_us, 60_000);
//! assert_eq!(find("ping").map(|module| module.interface), Some(Interface::OnePin));
//! // Derive your own module from a known one.
//! let mut mine = HC_SR04;
//! mine.set("sees_to_m", eeruf_modules::Value::Number(2.5))?;
//! assert_eq!(mine.sees_to_mm, 2_500);
//! # Ok::<(), eeruf_modules::ModuleError<'static>>(())
//! ```
#![no_std]

#[cfg(feature = "serde")]
extern crate alloc;

#[cfg(feature = "sound")]
mod air;
mod aliases;
#[cfg(feature = "serde")]
mod file;
#[cfg(feature = "sound")]
mod fresnel;
mod keys;
mod module;
#[cfg(feature = "sound")]
mod piston;
mod presets;

#[cfg(feature = "sound")]
pub use air::Air;
pub use aliases::like;
#[cfg(feature = "serde")]
pub use file::{ModuleFile, ModulesFile};
#[cfg(feature = "sound")]
pub use fresnel::fresnel;
pub use keys::{KEYS, Key, ModuleError, Value};
pub use module::{Beam, Gain, Interface, Module, NoEcho, PulseTimes};
#[cfg(feature = "sound")]
pub use piston::{Piston, wrap_angle};
pub use presets::{
    A02YYUW, HC_SR04, HC_SR04_CLONE, JSN_SR04T, MB1010, MB1242, PING, POLAROID_6500, PRESETS, SRF08, US_100, find,
    names,
};
