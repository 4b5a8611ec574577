//! The words for a module's figures, the same in ring files, scenes and Python.

use core::fmt;

use crate::module::{Beam, Gain, Interface, Module, NoEcho};

/// A figure of a module, under its name in files.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// The name.
    pub name: &'static str,
    kind: Kind,
}

/// The type of a figure.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// A number in the file's unit, stored in units of 1 / `scale`, at most `most`.
    Number { scale: f64, most: f64, get: fn(&Module) -> u32, set: fn(&mut Module, u32) },
    /// A word from a list.
    Word { names: &'static [&'static str], get: fn(&Module) -> &'static str, set: fn(&mut Module, &str) -> bool },
}

/// A value of a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<'a> {
    /// A number, in the unit that ends the key's name.
    Number(f64),
    /// A word.
    Word(&'a str),
}

impl fmt::Display for Value<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Word(word) => word.fmt(f),
        }
    }
}

/// Reason why the description of a module is invalid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ModuleError<'a> {
    /// No figure has this name.
    Key(&'a str),
    /// No preset has this name.
    Name(&'a str),
    /// A value is out of range for its figure, or an unknown word.
    Value {
        /// The figure.
        key: &'static str,
        /// The value.
        value: Value<'a>,
    },
    /// The module listens no longer than it is deaf.
    Deaf {
        /// The blanking in us.
        blanking_us: u32,
        /// Echo time of a wall at the farthest range, in us.
        range_us: u32,
    },
}

/// Writes words separated by commas.
fn list<'a>(f: &mut fmt::Formatter<'_>, words: impl Iterator<Item = &'a str>) -> fmt::Result {
    for (index, word) in words.enumerate() {
        write!(f, "{}{word}", if index == 0 { "" } else { ", " })?;
    }
    Ok(())
}

impl fmt::Display for ModuleError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(key) => {
                write!(f, "module: no figure `{key}`; expected like, ")?;
                list(f, KEYS.iter().map(|key| key.name))
            }
            Self::Name(name) => {
                write!(f, "module: no preset \"{name}\"")?;
                if let Some(why) = crate::aliases::why_not(name) {
                    write!(f, ", which {why}")?;
                }
                f.write_str("; expected ")?;
                list(f, crate::names())
            }
            Self::Value { key, value } => {
                write!(f, "module: {key} = {value}; expected ")?;
                match KEYS.iter().find(|known| known.name == *key).map(|key| key.kind) {
                    Some(Kind::Number { most, .. }) => write!(f, "a number from 0 to {most}"),
                    Some(Kind::Word { names, .. }) => list(f, names.iter().copied()),
                    None => Ok(()),
                }
            }
            Self::Deaf { blanking_us, range_us } => write!(
                f,
                "module: blanking_us = {blanking_us}; expected less than {range_us}, when the echo from sees_to_m is \
                 back"
            ),
        }
    }
}

impl core::error::Error for ModuleError<'_> {}

/// Describes a figure that is a number.
macro_rules! number {
    ($name:literal, $scale:literal, $most:literal, $field:ident) => {
        Key {
            name: $name,
            kind: Kind::Number {
                scale: $scale,
                most: $most,
                get: |module| module.$field,
                set: |module, value| module.$field = value,
            },
        }
    };
}

/// Describes a figure that is a word.
macro_rules! word {
    ($name:literal, $field:ident: $kind:ident, $names:expr) => {
        Key {
            name: $name,
            kind: Kind::Word {
                names: &$names,
                get: |module| module.$field.name(),
                set: |module, word| {
                    let found = $kind::NAMES.into_iter().find(|(name, _)| *name == word);
                    found.map(|(_, value)| module.$field = value).is_some()
                },
            },
        }
    };
}

/// The figures of a module, in the order in which tables list them.
pub const KEYS: [Key; 15] = [
    number!("sees_to_m", 1e3, 100.0, sees_to_mm),
    number!("hears_to_m", 1e3, 100.0, hears_to_mm),
    number!("blanking_us", 1.0, 1e6, blanking_us),
    number!("frequency_hz", 1.0, 1e6, frequency_hz),
    number!("bandwidth_hz", 1.0, 1e6, bandwidth_hz),
    number!("burst_cycles", 1.0, 1e3, burst_cycles),
    word!(
        "gain",
        gain: Gain,
        ["constant", "square_root", "linear", "stepped", "polaroid_6500"]
    ),
    number!("radius_mm", 1e3, 100.0, radius_um),
    word!("beam", beam: Beam, ["cut_at_90", "continuous"]),
    Key {
        name: "no_echo",
        kind: Kind::Word {
            names: &NoEcho::NAMES,
            get: |module| module.no_echo.name(),
            set: |module, word| {
                let us = module.no_echo.hold_us();
                module.no_echo = match word {
                    "holds" => NoEcho::Holds { us },
                    "silent" => NoEcho::Silent,
                    "reports" => NoEcho::Reports,
                    _ => return false,
                };
                true
            },
        },
    },
    Key {
        name: "hold_us",
        kind: Kind::Number {
            scale: 1.0,
            most: 1e7,
            get: |module| module.no_echo.hold_us(),
            set: |module, us| {
                if us > 0 {
                    module.no_echo = NoEcho::Holds { us };
                }
            },
        },
    },
    number!("rest_us", 1.0, 1e7, rest_us),
    number!("trigger_us", 1.0, 1e6, trigger_us),
    word!(
        "interface",
        interface: Interface,
        ["edge", "one_pin", "pulse_width", "uart", "i2c", "analog"]
    ),
    number!("report_us", 1.0, 1e7, report_us),
];

impl Key {
    /// Returns true if the figure's values are whole numbers: microseconds, hertz, cycles.
    pub fn is_whole(&self) -> bool {
        matches!(self.kind, Kind::Number { scale, .. } if scale == 1.0)
    }

    /// Returns the value of this figure.
    pub fn of(&self, module: &Module) -> Value<'static> {
        match self.kind {
            Kind::Number { scale, get, .. } => Value::Number(f64::from(get(module)) / scale),
            Kind::Word { get, .. } => Value::Word(get(module)),
        }
    }
}

impl Module {
    /// Sets a figure by its name in files.
    ///
    /// # Errors
    /// An unknown name, or a value that the figure cannot have.
    pub fn set<'a>(&mut self, key: &'a str, value: Value<'a>) -> Result<(), ModuleError<'a>> {
        let known = KEYS.iter().find(|known| known.name == key).ok_or(ModuleError::Key(key))?;
        let wrong = ModuleError::Value { key: known.name, value };
        match (known.kind, value) {
            (Kind::Number { scale, most, set, .. }, Value::Number(number)) if (0.0..=most).contains(&number) => {
                // Rounded; at most 10^7.
                set(self, (number * scale + 0.5) as u32);
                Ok(())
            }
            (Kind::Word { set, .. }, Value::Word(word)) if set(self, word) => Ok(()),
            _ => Err(wrong),
        }
    }

    /// Checks the figures against each other, once all are set.
    ///
    /// # Errors
    /// Zero range, frequency, burst or size, or a module that is deaf for as long as it listens.
    pub fn check(&self) -> Result<(), ModuleError<'static>> {
        for key in ["sees_to_m", "frequency_hz", "bandwidth_hz", "burst_cycles", "radius_mm"] {
            let value = KEYS.iter().find(|known| known.name == key).map(|known| known.of(self));
            if let Some(value) = value.filter(|value| *value == Value::Number(0.0)) {
                return Err(ModuleError::Value { key, value });
            }
        }
        let range_us = self.range_us();
        if self.blanking_us >= range_us {
            return Err(ModuleError::Deaf { blanking_us: self.blanking_us, range_us });
        }
        Ok(())
    }

    /// Returns the farthest range in metres.
    pub const fn sees_to_m(&self) -> f64 {
        self.sees_to_mm as f64 / 1e3
    }

    /// Returns the echo time of a wall at the module's farthest range, in air of 20 degrees, in us.
    ///
    /// ```
    /// assert_eq!(eeruf_modules::HC_SR04.range_us(), 23_311);
    /// ```
    pub const fn range_us(&self) -> u32 {
        // 343.2 m/s; at most 100 m.
        (self.sees_to_mm as u64 * 20_000).div_ceil(3_432) as u32
    }
}
