//! The set-up of a flow ring as source text: Rust, a C header, a file of an Arduino sketch.

use std::fmt;

use eeruf_core::flow::FlowSettings;
use eeruf_core::hopping::HoppingListening;
use eeruf_core::judge::TrackerSettings;
use eeruf_core::{EachSensor, Micros, SensorLimits};

use super::{CLimits, EERUF_VERSION, Grouped};

/// The set-up of a flow ring.
#[derive(Clone, Copy, Debug)]
pub struct Flow<'r, const K: usize> {
    /// Settings of the ring.
    pub settings: &'r FlowSettings,
    /// Number of sensors.
    pub sensors: usize,
    /// Settings by which the ring listens.
    pub listening: HoppingListening,
    /// Limits of each sensor; [`EachSensor::NONE`] if all are alike.
    pub limits: &'r EachSensor<K>,
}

impl<const K: usize> Flow<'_, K> {
    /// Rust: the constants `SENSORS`, `SETTINGS` and `LISTENING` for `FlowRing::flow`; where sensors have limits of
    /// their own also `LIMITS` for `FlowRing::with_limits`.
    pub fn to_rust(&self) -> String {
        FlowRust(self).to_string()
    }

    /// A C99 header with the constant `eeruf_flow_config` for `eeruf_flow_init`, to be included after `eeruf.h`.
    pub fn to_c(&self) -> String {
        FlowHeader(self).to_string()
    }

    /// A file of an Arduino sketch with the constant `name`, as in [`to_c`](Self::to_c).
    pub fn to_arduino(&self, name: &str) -> String {
        FlowTab { source: self, name }.to_string()
    }
}

/// Times of the settings by their names.
fn times(settings: &FlowSettings) -> [(&'static str, Micros); 10] {
    [
        ("step", settings.step),
        ("shortest_gap", settings.shortest_gap),
        ("masked_adds", settings.masked_adds),
        ("believed_takes", settings.believed_takes),
        ("unserved_adds", settings.unserved_adds),
        ("shortest_cycle", settings.shortest_cycle),
        ("rest", settings.rest),
        ("lead", settings.lead),
        ("longest_cycle", settings.longest_cycle),
        ("travel", settings.travel),
    ]
}

impl<const K: usize> fmt::Display for Flow<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { settings, sensors, listening, .. } = self;
        write!(f, "{sensors} sensors that fire by flow, in cycles of at least {},", settings.shortest_cycle)?;
        write!(f, " listening for {}", listening.window)
    }
}

/// In Rust: see [`Flow::to_rust`].
struct FlowRust<'r, const K: usize>(&'r Flow<'r, K>);

impl<const K: usize> fmt::Display for FlowRust<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Flow { settings, sensors, listening, limits } = self.0;
        let usual = FlowSettings::DEFAULT;
        let own = limits.most().is_some();
        let (names, call) = if own {
            ("EachSensor, Micros, SensorLimits", "4, 1, _>::with_limits(SENSORS, LIMITS, SETTINGS, LISTENING, now)")
        } else {
            ("Micros", "SENSORS>::flow(SENSORS, SETTINGS, LISTENING, now)")
        };
        writeln!(f, "use eeruf_core::{{{names}, flow::FlowSettings, hopping::HoppingListening}};\n")?;
        writeln!(f, "// {}.", self.0)?;
        writeln!(f, "// For `FlowRing::<{}{call}`.", if own { "SENSORS, " } else { "" })?;
        writeln!(f, "pub const SENSORS: usize = {sensors};\n")?;
        writeln!(f, "pub const SETTINGS: FlowSettings = {{\n    let mut settings = FlowSettings::DEFAULT;")?;
        for ((name, time), (_, usual)) in times(settings).into_iter().zip(times(&usual)) {
            if time != usual {
                writeln!(f, "    settings.{name} = Micros::new({});", Grouped(time))?;
            }
        }
        if settings.unserved_after != usual.unserved_after {
            writeln!(f, "    settings.unserved_after = {};", settings.unserved_after)?;
        }
        for ((name, number), (_, usual)) in numbers(&settings.tracker).into_iter().zip(numbers(&usual.tracker)) {
            match name.strip_suffix("_us") {
                _ if number == usual => {}
                Some(name) => writeln!(f, "    settings.tracker.{name} = Micros::new({number});")?,
                None => writeln!(f, "    settings.tracker.{name} = {number};")?,
            }
        }
        writeln!(f, "    settings\n}};\n")?;
        let [window, blanking, reach] = [listening.window, listening.blanking, listening.reach].map(Grouped);
        write!(f, "pub const LISTENING: HoppingListening =\n    HoppingListening::new(Micros::new({window}))")?;
        writeln!(f, ".with_blanking(Micros::new({blanking})).with_reach(Micros::new({reach}));")?;
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
        for group in 1..=last {
            let set = groups().filter(|&(_, &of)| of == group).fold(0_u64, |set, (x, _)| set | 1 << x);
            write!(f, "{}{set:#b}", if group == 1 { "" } else { ", " })?;
        }
        writeln!(f, "],\n);")
    }
}

/// The settings of a tracker in the order of C's `EerufTrackerSettings`, by their names.
fn numbers(tracker: &TrackerSettings) -> [(&'static str, u32); 9] {
    let TrackerSettings { t_delta, near, tentative_within, votes, score_limit, contradiction, .. } = *tracker;
    [
        ("t_delta_us", t_delta.as_micros()),
        ("near_us", near.as_micros()),
        ("tentative_within_us", tentative_within.as_micros()),
        ("votes", votes.into()),
        ("score_limit", score_limit.into()),
        ("contradiction", contradiction.into()),
        ("solo_contradiction", tracker.solo_contradiction.into()),
        ("tentative_votes", tracker.tentative_votes.into()),
        ("memory", tracker.memory.into()),
    ]
}

/// As a C header: see [`Flow::to_c`].
struct FlowHeader<'r, const K: usize>(&'r Flow<'r, K>);

impl<const K: usize> fmt::Display for FlowHeader<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Flow { sensors, listening, .. } = self.0;
        writeln!(f, "/* {}.\n   For eeruf_flow_init; include eeruf.h before it. */", self.0)?;
        writeln!(f, "#ifndef EERUF_SCHEDULE_H\n#define EERUF_SCHEDULE_H\n")?;
        writeln!(f, "#ifndef EERUF_H\n#error \"include eeruf.h before this file\"\n#endif\n")?;
        writeln!(f, "#define EERUF_SENSORS {sensors}")?;
        writeln!(f, "#define EERUF_WINDOW_US {}u\n", listening.window.as_micros())?;
        write!(f, "{}", Constant { source: self.0, name: "eeruf_flow_config" })?;
        writeln!(f, "\n#endif")
    }
}

/// As a file of an Arduino sketch: see [`Flow::to_arduino`].
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
        let Flow { settings, sensors, listening, limits } = self.source;
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
        let [step, times @ ..] = times(settings).map(|(_, time)| time.as_micros());
        writeln!(f, "static const EerufFlowConfig {name} = {{")?;
        write!(f, "    {EERUF_VERSION}, {sensors}, {}, {step}u,", settings.unserved_after)?;
        for time in [listening.window, listening.blanking, listening.reach] {
            write!(f, " {}u,", time.as_micros())?;
        }
        write!(f, "\n   ")?;
        for time in times {
            write!(f, " {time}u,")?;
        }
        write!(f, "\n    {{")?;
        for (place, (_, number)) in numbers(&settings.tracker).into_iter().enumerate() {
            write!(f, "{}{number}", if place == 0 { "" } else { ", " })?;
        }
        if own { writeln!(f, "}},\n    &{name}_own,\n}};") } else { writeln!(f, "}},\n    0,\n}};") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALIKE: EachSensor<1> = EachSensor::NONE;
    const LISTENING: HoppingListening = HoppingListening::new(Micros::new(37_000)).with_blanking(Micros::new(300));

    #[test]
    fn rust_sets_what_differs_from_the_default() {
        let mut settings = FlowSettings::DEFAULT;
        settings.rest = Micros::from_millis(60);
        settings.tracker = settings.tracker.with_t_delta(Micros::new(100)).with_memory(9);
        let text = Flow { settings: &settings, sensors: 8, listening: LISTENING, limits: &ALIKE }.to_rust();
        assert!(text.contains("pub const SENSORS: usize = 8;\n"), "{text}");
        let sets: Vec<_> = text.lines().filter(|line| line.starts_with("    settings.")).collect();
        let expected = [
            "    settings.rest = Micros::new(60_000);",
            "    settings.tracker.t_delta = Micros::new(100);",
            "    settings.tracker.memory = 9;",
        ];
        assert_eq!(sets, expected);
        let listening = "HoppingListening::new(Micros::new(37_000)).with_blanking(Micros::new(300))";
        assert!(text.ends_with(&format!("{listening}.with_reach(Micros::new(37_000));\n")), "{text}");
    }

    #[test]
    fn limits_of_each_sensor_are_written() {
        let of = |us, window| SensorLimits { t_delta: Micros::new(us), window: Micros::new(window) };
        let limits = EachSensor::for_flow([of(150, 37_000), of(90, 12_000), of(150, 37_000)], &[0b101]);
        let flow = Flow { settings: &FlowSettings::DEFAULT, sensors: 3, listening: LISTENING, limits: &limits };
        let text = flow.to_c();
        let own = "eeruf_flow_config_limits[] EERUF_FLASH = {\n    {37000u, 150u, 1},\n    {12000u, 90u, 0},\n";
        assert!(text.contains(own) && text.contains("    &eeruf_flow_config_own,\n};\n"), "{text}");
        let text = flow.to_rust();
        assert!(text.contains("        SensorLimits { t_delta: Micros::new(90), window: Micros::new(12_000) },\n"));
        assert!(text.ends_with("    ],\n    &[0b101],\n);\n"), "{text}");
    }

    #[test]
    fn c_has_all_settings_in_their_order() {
        let flow = Flow { settings: &FlowSettings::DEFAULT, sensors: 12, listening: LISTENING, limits: &ALIKE };
        let text = flow.to_c();
        assert!(text.contains("#define EERUF_SENSORS 12\n#define EERUF_WINDOW_US 37000u\n"), "{text}");
        let constant = "= {\n    3, 12, 3, 240u, 37000u, 300u, 37000u,\n    \
                        7500u, 4000u, 1500u, 6000u, 60000u, 0u, 0u, 400000u, 260u,\n    \
                        {150, 400, 60, 5, 6, 2, 6, 2, 5},\n    0,\n};\n";
        assert!(text.contains(&format!("EerufFlowConfig eeruf_flow_config {constant}")), "{text}");
        let text = flow.to_arduino("RING");
        assert!(text.ends_with(&format!("#include <EerufArduino.h>\n\nstatic const EerufFlowConfig RING {constant}")));
    }
}
