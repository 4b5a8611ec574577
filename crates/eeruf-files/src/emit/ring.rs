//! A ring of modules as source text: its modules as comments, its schedule, and the settings of its driver.

use std::fmt::Write as _;

use eeruf_core::{Micros, Requirements, Schedule};
use eeruf_modules::{Module, PulseTimes};

use super::{Emit as _, Flow};

/// Language of a ring's source text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A schedule file.
    Toml,
    /// A constant that is checked when the firmware is compiled.
    Rust,
    /// A C99 header, alone or for `c/eeruf.h`.
    C,
    /// A file of an Arduino sketch: the constant `RING`.
    Arduino,
}

impl Form {
    /// Writes a line as a comment.
    pub fn comment(self, line: &str) -> String {
        match self {
            Self::Toml => format!("# {line}\n"),
            Self::Rust => format!("// {line}\n"),
            Self::C | Self::Arduino => format!("/* {line} */\n"),
        }
    }

    /// Comments that name the modules of a ring and their times.
    pub fn modules(self, modules: &[Module]) -> String {
        let alike = modules.chunk_by(|one, next| one == next);
        let firsts = alike.clone().scan(0, |next, group| Some(core::mem::replace(next, *next + group.len())));
        let lines = alike.zip(firsts).map(|(group, first)| {
            let Module { name, trigger_us, rest_us, interface, no_echo, .. } = group[0];
            let held = match no_echo.hold_us() {
                0 => String::new(),
                us => format!(", held {us} us without an echo"),
            };
            let (last, interface) = (first + group.len() - 1, interface.name());
            let times = format!("trigger {trigger_us} us, rest {rest_us} us{held}");
            self.comment(&format!("Sensors {first} to {last}: {name}, {interface}, {times}"))
        });
        lines.collect()
    }

    /// Writes a schedule between the comments on its modules and the settings of its driver.
    pub fn table<const K: usize>(self, schedule: &Schedule<K>, needs: &Requirements<'_>, modules: &[Module]) -> String {
        let mut text = self.modules(modules);
        text += &match self {
            Self::Toml => schedule.to_toml(),
            Self::Rust => schedule.to_rust(needs),
            Self::C => schedule.to_c(needs),
            Self::Arduino => schedule.to_arduino(needs, "RING"),
        };
        let deaf_us = modules.iter().map(|module| module.blanking_us).min().unwrap_or(0);
        // Writing to a string does not fail.
        _ = match self {
            Self::Rust if !modules.is_empty() => writeln!(
                text,
                "\n// For `Ring::new(&RING, CONFIG, now)`: modules are deaf after firing.\npub const CONFIG: \
                 eeruf_core::RingConfig = eeruf_core::RingConfig::new().with_blanking(Micros::new({deaf_us}));"
            ),
            Self::C if !modules.is_empty() => writeln!(
                text,
                "\n/* For an EerufConfig: modules are deaf after firing. */\n#define EERUF_RING_CONFIG \
                 {{EERUF_VERSION, 2, 0, 0, {deaf_us}, 0, 0}}"
            ),
            // The Arduino library reads pulses; it does not hear the time just after firing anyway.
            _ => Ok(()),
        };
        text + &self.settings(modules, schedule.min_refire())
    }

    /// Writes the setup of a flow ring between the comments on its modules and the driver's settings; nothing in TOML.
    pub fn flow<const K: usize>(self, flow: &Flow<'_, K>, modules: &[Module]) -> String {
        let source = match self {
            Self::Toml => String::new(),
            Self::Rust => flow.to_rust(),
            Self::C => flow.to_c(),
            Self::Arduino => flow.to_arduino("RING"),
        };
        self.modules(modules) + &source + &self.settings(modules, flow.turns.rest.max(flow.window))
    }

    /// Writes the settings of a driver in C, if all modules are alike and answer by a pulse. A ring file may let
    /// modules be triggered sooner than their data sheet says. A driver takes one kind of module; if the kinds differ,
    /// a comment in Rust or C lists the sensors that differ from sensor 0.
    fn settings(self, modules: &[Module], min_refire: Micros) -> String {
        let Some(module) = modules.first() else { return String::new() };
        let others = (0..).zip(modules).filter(|&(_, other)| other != module);
        let others: Vec<_> = others.map(|(sensor, _): (usize, _)| sensor.to_string()).collect();
        if !others.is_empty() && self != Self::Toml {
            let others = others.join(", ");
            let line = format!("No settings of one driver: sensors {others} are of another kind than sensor 0.");
            return format!("\n{}", self.comment(&line));
        }
        let name = match self {
            Self::C => "EERUF_MODULES",
            Self::Arduino => "RING_MODULES",
            Self::Toml | Self::Rust => return String::new(),
        };
        let Some(times) = module.pulse_times() else { return String::new() };
        let PulseTimes { deaf_us, shortest_us, latest_rise_us, longest_us, longest_hold_us } = times;
        let (rest_us, trigger_us) = (module.rest_us.min(min_refire.as_micros()), module.trigger_us);
        let edges = format!("{deaf_us}, {shortest_us}, {latest_rise_us}");
        let times = format!("{edges}, {longest_us}, {longest_hold_us}, {rest_us}, 3, {trigger_us}");
        format!("\n/* Of these modules, for an EerufHcSr04Settings. */\n#define {name} {{EERUF_VERSION, {times}}}\n")
    }
}
