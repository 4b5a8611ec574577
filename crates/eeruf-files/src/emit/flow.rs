//! The set-up of a flow ring as source text: Rust, a C header, a file of an Arduino sketch.

use std::fmt;

use eeruf_core::flow::{BeliefSettings, TurnSettings, Votes};
use eeruf_core::{EachSensor, Micros, SensorLimits};

use super::{CLimits, EERUF_VERSION, Grouped, Plain};

/// The set-up of a flow ring.
#[derive(Clone, Copy, Debug)]
pub struct Flow<'r, const K: usize> {
    /// Firing settings. Their seed goes into the C and Arduino constants; a ring can be given another.
    pub turns: &'r TurnSettings,
    /// Settings by which the ring believes echoes.
    pub belief: &'r BeliefSettings,
    /// Number of sensors.
    pub sensors: usize,
    /// Listening time; the longest, if sensors have limits of their own.
    pub window: Micros,
    /// Time for which sensors are deaf after firing.
    pub blanking: Micros,
    /// Limits of each sensor; [`EachSensor::NONE`] if all are alike.
    pub limits: &'r EachSensor<K>,
    /// Sets of sensors that share an echo line, bit x for sensor x.
    pub shared_lines: &'r [u64],
}

impl<const K: usize> Flow<'_, K> {
    /// Returns Rust source for `FlowRing::flow`: the constants `SENSORS`, `BELIEF` and `CONFIG`, and the function
    /// `turns` of the robot's seed. `LIMITS` for `FlowRing::with_limits` is included if sensors have their own limits.
    pub fn to_rust(&self) -> String {
        FlowRust(self).to_string()
    }

    /// Returns a C99 header with the constant `eeruf_flow_config` for `eeruf_flow_init`; include it after `eeruf.h`.
    pub fn to_c(&self) -> String {
        FlowHeader(self).to_string()
    }

    /// Returns a file of an Arduino sketch with the constant `name`, as in [`to_c`](Self::to_c).
    pub fn to_arduino(&self, name: &str) -> String {
        FlowTab { source: self, name }.to_string()
    }

    /// Returns the number of each sensor's shared echo line, from 1; 0 for a line of its own.
    fn lines(&self) -> impl Iterator<Item = u32> + Clone {
        (0..self.sensors).map(|sensor| {
            let shares = |(_, set): &(u32, &u64)| *set >> sensor & 1 == 1;
            (1..).zip(self.shared_lines).find(shares).map_or(0, |(line, _)| line)
        })
    }
}

impl<const K: usize> fmt::Display for Flow<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { turns, sensors, window, .. } = self;
        write!(f, "{sensors} sensors that fire one after the other, with ")?;
        if turns.least < turns.most {
            write!(f, "{} to ", turns.least)?;
        }
        write!(f, "{} of quiet, listening for {window}", turns.most)
    }
}

/// Returns the sets of sensors in Rust syntax.
fn sets(f: &mut fmt::Formatter<'_>, sets: impl Iterator<Item = u64>) -> fmt::Result {
    for (place, set) in sets.enumerate() {
        write!(f, "{}{set:#b}", if place == 0 { "" } else { ", " })?;
    }
    Ok(())
}

/// Rust text: see [`Flow::to_rust`].
struct FlowRust<'r, const K: usize>(&'r Flow<'r, K>);

impl<const K: usize> fmt::Display for FlowRust<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Flow { turns, belief, sensors, window, blanking, limits, shared_lines } = self.0;
        let own = limits.most().is_some();
        let (names, parameters, call) = if own {
            ("EachSensor, Micros, RingConfig, SensorLimits", "SENSORS, 1, _", "with_limits(SENSORS, LIMITS, ")
        } else {
            ("Micros, RingConfig", "SENSORS", "flow(SENSORS, ")
        };
        writeln!(f, "use eeruf_core::flow::{{BeliefSettings, TurnSettings}};")?;
        writeln!(f, "use eeruf_core::{{{names}}};\n")?;
        writeln!(f, "// {}.", self.0)?;
        writeln!(f, "// For `FlowRing::<{parameters}>::{call}turns(seed), BELIEF, CONFIG, now)`.")?;
        writeln!(f, "pub const SENSORS: usize = {sensors};\n")?;
        writeln!(
            f,
            "/// When sensors fire. The seed is the chip's number or another that each robot has of its own, not 0."
        )?;
        writeln!(f, "pub const fn turns(seed: u32) -> TurnSettings {{")?;
        writeln!(f, "    let mut turns = TurnSettings::new(seed);")?;
        let times = [("least", turns.least), ("most", turns.most), ("rest", turns.rest), ("dice", turns.dice)];
        for (name, time) in times {
            writeln!(f, "    turns.{name} = Micros::new({});", Grouped(time))?;
        }
        writeln!(f, "    turns\n}}\n")?;
        writeln!(f, "pub const BELIEF: BeliefSettings = {{\n    let mut belief = BeliefSettings::DEFAULT;")?;
        for (name, time) in [("t_delta", belief.t_delta), ("near", belief.near), ("path_change", belief.path_change)] {
            writeln!(f, "    belief.{name} = Micros::new({});", Grouped(time))?;
        }
        writeln!(f, "    belief.top_speed_mm_s = {};", Grouped(Micros::new(belief.top_speed_mm_s.into())))?;
        if belief.votes != Votes::ByMotion {
            writeln!(f, "    belief.votes = eeruf_core::flow::Votes::{:?};", belief.votes)?;
        }
        writeln!(f, "    belief.alone = {};\n    belief\n}};\n", belief.alone)?;
        write!(f, "pub const CONFIG: RingConfig = RingConfig::new().with_window(Micros::new({}))", Grouped(*window))?;
        writeln!(f, ".with_blanking(Micros::new({}));", Grouped(*blanking))?;
        if !own {
            return Ok(());
        }
        writeln!(f, "\n#[rustfmt::skip]\npub const LIMITS: EachSensor<SENSORS> = EachSensor::for_flow(\n    [")?;
        for SensorLimits { t_delta, window } in (0..*sensors as u8).filter_map(|x| limits.of(x)) {
            let (t_delta, window) = (Grouped(t_delta), Grouped(window));
            writeln!(f, "        SensorLimits {{ t_delta: Micros::new({t_delta}), window: Micros::new({window}) }},")?;
        }
        write!(f, "    ],\n    &[")?;
        let groups = || limits.groups().iter().take(*sensors).enumerate();
        let last = groups().map(|(_, &group)| group).max().unwrap_or(0);
        let set_of = |group| groups().filter(move |&(_, &of)| of == group).fold(0_u64, |set, (x, _)| set | 1 << x);
        sets(f, (1..=last).map(set_of))?;
        if shared_lines.is_empty() {
            return writeln!(f, "],\n);");
        }
        write!(f, "],\n)\n.with_shared_lines(&[")?;
        sets(f, shared_lines.iter().copied())?;
        writeln!(f, "]);")
    }
}

/// C header: see [`Flow::to_c`].
struct FlowHeader<'r, const K: usize>(&'r Flow<'r, K>);

impl<const K: usize> fmt::Display for FlowHeader<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Flow { sensors, window, .. } = self.0;
        writeln!(f, "/* {}.\n   For eeruf_flow_init; include eeruf.h before it. */", self.0)?;
        writeln!(f, "#ifndef EERUF_SCHEDULE_H\n#define EERUF_SCHEDULE_H\n")?;
        writeln!(f, "#ifndef EERUF_H\n#error \"include eeruf.h before this file\"\n#endif\n")?;
        writeln!(f, "#define EERUF_SENSORS {sensors}")?;
        writeln!(f, "#define EERUF_WINDOW_US {}u\n", window.as_micros())?;
        write!(f, "{}", Constant { source: self.0, name: "eeruf_flow_config" })?;
        writeln!(f, "\n#endif")
    }
}

/// File of an Arduino sketch: see [`Flow::to_arduino`].
struct FlowTab<'r, const K: usize> {
    source: &'r Flow<'r, K>,
    name: &'r str,
}

impl<const K: usize> fmt::Display for FlowTab<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { source, name } = self;
        writeln!(f, "// {source}.\n#pragma once\n#include <EerufArduino.h>\n")?;
        write!(f, "{}", Constant { source, name })
    }
}

/// The constant of type `EerufFlowConfig`.
struct Constant<'r, const K: usize> {
    source: &'r Flow<'r, K>,
    name: &'r str,
}

impl<const K: usize> fmt::Display for Constant<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Flow { turns, belief, sensors, window, blanking, limits, shared_lines } = self.source;
        let name = self.name;
        let own = limits.most().is_some();
        if own {
            write!(f, "{}", CLimits { name, sensors: *sensors, limits })?;
            writeln!(f, "static const EerufSchedule {name}_own EERUF_FLASH = {{")?;
            writeln!(
                f,
                "    {EERUF_VERSION}, {sensors}, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, EERUF_LAYOUT_OTHER, 0, 0,"
            )?;
            writeln!(f, "    {name}_limits,\n}};")?;
        }
        if !shared_lines.is_empty() {
            let lines = Plain(|| self.source.lines().map(|line| (line, "")));
            writeln!(f, "static const uint8_t {name}_lines[] EERUF_FLASH = {{{lines}}};")?;
        }
        writeln!(f, "/* The seed is to be another one for each robot, as its chip's number: set it in a copy. */")?;
        writeln!(f, "static const EerufFlowConfig {name} = {{\n    {EERUF_VERSION}, {sensors},")?;
        let times = [*window, *blanking, turns.least, turns.most, turns.rest, turns.dice].map(Micros::as_micros);
        writeln!(f, "    {}, {}u,", Plain(|| times.into_iter().map(|us| (us, "u"))), turns.seed)?;
        let votes = match belief.votes {
            Votes::ByMotion => "BY_MOTION",
            Votes::EveryEcho => "EVERY_ECHO",
            Votes::TwoInARow => "TWO_IN_A_ROW",
        };
        let believed = [belief.t_delta, belief.near, belief.path_change].map(Micros::as_micros);
        let counts = [belief.memory.into(), belief.hold.into(), belief.top_speed_mm_s.into(), belief.alone.into()];
        let numbers = Plain(|| believed.into_iter().chain(counts).map(|number| (number, "")));
        writeln!(f, "    {numbers}, EERUF_VOTES_{votes},")?;
        if own {
            write!(f, "    &{name}_own, ")?;
        } else {
            write!(f, "    0, ")?;
        }
        if shared_lines.is_empty() { writeln!(f, "0,\n}};") } else { writeln!(f, "{name}_lines,\n}};") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALIKE: EachSensor<1> = EachSensor::NONE;
    const TURNS: TurnSettings = TurnSettings::new(1);
    const BELIEF: BeliefSettings = BeliefSettings::DEFAULT;

    fn flow<const K: usize>(sensors: usize, limits: &EachSensor<K>) -> Flow<'_, K> {
        let (window, blanking) = (Micros::new(37_000), Micros::new(300));
        Flow { turns: &TURNS, belief: &BELIEF, sensors, window, blanking, limits, shared_lines: &[] }
    }

    #[test]
    fn rust_has_the_settings_and_takes_the_seed() {
        let belief = BeliefSettings { top_speed_mm_s: 1_200, ..BELIEF };
        let text = Flow { belief: &belief, ..flow(8, &ALIKE) }.to_rust();
        for line in [
            "pub const SENSORS: usize = 8;",
            "pub const fn turns(seed: u32) -> TurnSettings {",
            "    turns.most = Micros::new(33_500);",
            "    belief.top_speed_mm_s = 1_200;",
            "pub const CONFIG: RingConfig = \
             RingConfig::new().with_window(Micros::new(37_000)).with_blanking(Micros::new(300));",
        ] {
            assert!(text.lines().any(|found| found == line), "{line}\n{text}");
        }
    }

    #[test]
    fn limits_of_each_sensor_and_shared_lines_are_written() {
        let of = |us, window| SensorLimits { t_delta: Micros::new(us), window: Micros::new(window) };
        let limits = EachSensor::for_flow([of(150, 37_000), of(90, 12_000), of(150, 37_000)], &[0b101]);
        let flow = Flow { shared_lines: &[0b110], ..flow(3, &limits) };
        let text = flow.to_c();
        let own = "eeruf_flow_config_limits[] EERUF_FLASH = {\n    {37000u, 150u, 1},\n    {12000u, 90u, 0},\n";
        assert!(text.contains(own), "{text}");
        assert!(text.contains("static const uint8_t eeruf_flow_config_lines[] EERUF_FLASH = {0, 1, 1};\n"), "{text}");
        assert!(text.contains("    &eeruf_flow_config_own, eeruf_flow_config_lines,\n};\n"), "{text}");
        let text = flow.to_rust();
        assert!(text.contains("        SensorLimits { t_delta: Micros::new(90), window: Micros::new(12_000) },\n"));
        assert!(text.ends_with("    ],\n    &[0b101],\n)\n.with_shared_lines(&[0b110]);\n"), "{text}");
    }

    #[test]
    fn c_has_all_settings_in_their_order() {
        let text = flow(12, &ALIKE).to_c();
        assert!(text.contains("#define EERUF_SENSORS 12\n#define EERUF_WINDOW_US 37000u\n"), "{text}");
        let constant = "= {\n    5, 12,\n    37000u, 300u, 6000u, 33500u, 60000u, 2000u, 1u,\n    \
                        80, 150, 150, 8, 4, 0, 0, EERUF_VOTES_BY_MOTION,\n    0, 0,\n};\n";
        assert!(text.contains(&format!("EerufFlowConfig eeruf_flow_config {constant}")), "{text}");
        let text = flow(12, &ALIKE).to_arduino("RING");
        assert!(text.ends_with(&format!("static const EerufFlowConfig RING {constant}")), "{text}");
    }
}
