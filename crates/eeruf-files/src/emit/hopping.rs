//! A hopping schedule as source text: Rust that is checked when it is compiled, a C header, a TOML file.

use std::fmt;

use eeruf_core::conditions::VerifiedFor;
use eeruf_core::hopping::{HoppingCode, HoppingSchedule, HoppingSettings};
use eeruf_core::judge::TrackerSettings;
use eeruf_core::{Criterion, EachSensor, Layout, Micros, Requirements};

use super::{CLimits, EERUF_VERSION, Emit, Grouped, Meets, Numbers, OfSensor, Plain, Promise};

impl<const K: usize> Emit for HoppingSchedule<K> {
    fn to_rust(&self, requirements: &Requirements<'_>) -> String {
        HoppingRust { schedule: self, requirements }.to_string()
    }

    fn to_c(&self, requirements: &Requirements<'_>) -> String {
        HoppingHeader { schedule: self, requirements }.to_string()
    }

    fn to_arduino(&self, requirements: &Requirements<'_>, name: &str) -> String {
        HoppingTab { schedule: self, requirements, name }.to_string()
    }

    fn to_toml(&self) -> String {
        HoppingToml { schedule: self }.to_string()
    }
}

fn lags<const K: usize>(schedule: &HoppingSchedule<K>) -> impl Iterator<Item = Micros> {
    (0..schedule.code().sensors()).filter_map(|sensor| schedule.t_lag(sensor))
}

/// A hopping schedule in Rust: see [`Emit::to_rust`].
struct HoppingRust<'r, const K: usize> {
    schedule: &'r HoppingSchedule<K>,
    requirements: &'r Requirements<'r>,
}

impl<const K: usize> fmt::Display for HoppingRust<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { schedule, requirements } = self;
        let (code, uneven) = (schedule.code(), requirements.uneven.is_some());
        let (each, uneven_too) = if uneven { ("EachSensor, ", ", Uneven") } else { ("", "") };
        let criterion = if requirements.criterion == Criterion::Exact { "" } else { "Criterion, " };
        writeln!(f, "use eeruf_core::{{\n    {criterion}{each}Layout, Micros, Requirements{uneven_too},")?;
        writeln!(f, "    hopping::{{HoppingListening, HoppingSchedule, HoppingSettings}},\n    hopping_schedule,")?;
        writeln!(f, "    judge::TrackerSettings,\n}};\n")?;
        writeln!(f, "// {},", Summary(schedule))?;
        writeln!(f, "// {}.", Promise(requirements))?;
        writeln!(
            f,
            "#[allow(long_running_const_eval, reason = \"all pairs of neighbours are checked in all phases\")]"
        )?;
        let sensors = code.sensors();
        if uneven {
            write!(f, "pub const RING: (HoppingSchedule<{sensors}>, EachSensor<{sensors}>)")?;
        } else {
            write!(f, "pub const RING: HoppingSchedule<{sensors}>")?;
        }
        writeln!(f, " = hopping_schedule! {{")?;
        writeln!(f, "    period_us: {},", Grouped(schedule.period()))?;
        writeln!(f, "    step_us: {},", Grouped(code.step()))?;
        writeln!(f, "    phases: {},", code.phases())?;
        writeln!(f, "    first_multiplier: {},", code.first_multiplier())?;
        writeln!(f, "    t_lag_us: [{}],", Numbers(|| lags(schedule)))?;
        writeln!(f, "{}}};\n", Meets(requirements))?;
        let HoppingSettings { tracker, neighbours, .. } = settings(requirements);
        let call = if uneven { "with_limits" } else { "hopping" };
        writeln!(f, "// For `HoppingRing::{call}`; QUICK, DRIVING and MAPS are other sets of settings.")?;
        writeln!(f, "pub const SETTINGS: HoppingSettings = HoppingSettings::BALANCED")?;
        write!(f, "    .with_tracker(\n        TrackerSettings::BALANCED")?;
        let TrackerSettings { t_delta, near, tentative_within, .. } = tracker;
        for (name, time) in [("t_delta", t_delta), ("near", near), ("tentative_within", tentative_within)] {
            write!(f, "\n            .with_{name}(Micros::new({}))", Grouped(time))?;
        }
        writeln!(f, ",\n    )\n    .with_neighbours({neighbours});\n")?;
        let &Requirements { window, blanking, audible, .. } = *requirements;
        write!(f, "pub const LISTENING: HoppingListening = ")?;
        if blanking == Micros::ZERO && audible.is_none() {
            return writeln!(f, "HoppingListening::new(Micros::new({}));", Grouped(window));
        }
        writeln!(f, "HoppingListening::new(Micros::new({}))", Grouped(window))?;
        writeln!(f, "    .with_blanking(Micros::new({}))", Grouped(blanking))?;
        writeln!(f, "    .with_reach(Micros::new({}));", Grouped(audible.unwrap_or(window)))
    }
}

/// The balanced settings for such a ring.
fn settings(requirements: &Requirements<'_>) -> HoppingSettings {
    let (balanced, t_delta) = (TrackerSettings::BALANCED, requirements.t_delta);
    let tracker = balanced.with_t_delta(t_delta).with_near(balanced.near.max(t_delta));
    let tracker = tracker.with_tentative_within(balanced.tentative_within.min(t_delta));
    let neighbours = match requirements.layout {
        Layout::Line(n) | Layout::Ring(n) | Layout::Blocks(n) => n,
        Layout::Graph(_) => 0,
    };
    HoppingSettings::BALANCED.with_tracker(tracker).with_neighbours(neighbours)
}

/// A hopping schedule as a C header: see [`Emit::to_c`].
struct HoppingHeader<'r, const K: usize> {
    schedule: &'r HoppingSchedule<K>,
    requirements: &'r Requirements<'r>,
}

impl<const K: usize> fmt::Display for HoppingHeader<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { schedule, requirements } = self;
        let code = schedule.code();
        writeln!(f, "/* {},\n   {}.", Summary(schedule), Promise(requirements))?;
        writeln!(f, "   Times are microseconds from the start of each period; phases follow each other. */")?;
        writeln!(f, "#ifndef EERUF_SCHEDULE_H\n#define EERUF_SCHEDULE_H\n\n#include <stdint.h>\n")?;
        writeln!(f, "#define EERUF_SENSORS {}", code.sensors())?;
        writeln!(f, "#define EERUF_PHASES {}", code.phases())?;
        writeln!(f, "#define EERUF_PERIOD_US {}u", schedule.period().as_micros())?;
        if requirements.uneven.is_some() {
            writeln!(f, "/* The largest of all sensors; each one's own follow. */")?;
        }
        writeln!(f, "#define EERUF_T_DELTA_US {}u", requirements.t_delta.as_micros())?;
        writeln!(f, "#define EERUF_WINDOW_US {}u\n", requirements.window.as_micros())?;
        let own: [(&str, OfSensor<'_>); 2] =
            [("t_delta", Requirements::t_delta_of), ("window", Requirements::window_of)];
        for (name, of) in own.into_iter().filter(|_| requirements.uneven.is_some()) {
            let times = Plain(|| (0..code.sensors()).map(move |x| (of(requirements, x).as_micros(), "u")));
            writeln!(f, "static const uint32_t eeruf_{name}_us[EERUF_SENSORS] = {{{times}}};")?;
        }
        writeln!(f, "static const uint32_t eeruf_t_fire_us[EERUF_PHASES][EERUF_SENSORS] = {{")?;
        let cycle = schedule.table_together::<{ HoppingCode::MAX_PHASES as usize }>(
            requirements.uneven.map_or(&[], |uneven| uneven.together),
        );
        for (phase, times) in cycle.iter().take(code.phases().into()).enumerate() {
            let times = Plain(|| times.iter().take(code.sensors()).map(|time| (time.as_micros(), "u")));
            writeln!(f, "    {{{times}}}, /* phase {phase} */")?;
        }
        writeln!(f, "}};\n\n#ifdef EERUF_H /* with eeruf.h before this file: for eeruf_hopping_init */")?;
        write!(f, "{}", Constant { schedule, requirements, name: "eeruf_hopping_config" })?;
        writeln!(f, "#endif\n\n#endif")
    }
}

/// A hopping schedule as a file of an Arduino sketch: see [`Emit::to_arduino`].
struct HoppingTab<'r, const K: usize> {
    schedule: &'r HoppingSchedule<K>,
    requirements: &'r Requirements<'r>,
    name: &'r str,
}

impl<const K: usize> fmt::Display for HoppingTab<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { schedule, requirements, name } = self;
        writeln!(f, "// {},\n// {}.", Summary(schedule), Promise(requirements))?;
        writeln!(f, "#pragma once\n#include <EerufArduino.h>\n")?;
        write!(f, "{}", Constant { schedule, requirements, name })
    }
}

/// The constant of type `EerufHoppingConfig`, and the lags it points to.
struct Constant<'r, const K: usize> {
    schedule: &'r HoppingSchedule<K>,
    requirements: &'r Requirements<'r>,
    name: &'r str,
}

impl<const K: usize> fmt::Display for Constant<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { schedule, requirements, name } = self;
        let (code, all, window) = (schedule.code(), settings(requirements), requirements.window);
        let lags = Plain(|| lags(schedule).map(|lag| (lag.as_micros(), "u")));
        writeln!(f, "static const uint32_t {name}_lag_us[] = {{{lags}}};")?;
        let limits = schedule.limits(requirements).ok().filter(|_| requirements.uneven.is_some());
        if let Some(limits) = &limits {
            write!(f, "{}", OwnLimits { schedule, limits, name })?;
        }
        writeln!(
            f,
            "/* The settings of most robots; EERUF_HOPPING_QUICK, _DRIVING and _MAPS in eeruf.h have others. */"
        )?;
        writeln!(f, "static const EerufHoppingConfig {name} = {{")?;
        let (step, period) = (code.step().as_micros(), schedule.period().as_micros());
        writeln!(f, "    {EERUF_VERSION}, {}, {}, {step}u, {period}u, {name}_lag_us,", code.sensors(), code.phases())?;
        let reach = requirements.audible.unwrap_or(window);
        let times = [window, requirements.blanking, reach, all.shift_interval].map(Micros::as_micros);
        let [window, blanking, reach, shift_interval] = times;
        write!(f, "    {window}u, {blanking}u, {reach}u, {shift_interval}u,")?;
        let TrackerSettings { t_delta, near, tentative_within, votes, score_limit, .. } = all.tracker;
        let TrackerSettings { contradiction, solo_contradiction, tentative_votes, memory, .. } = all.tracker;
        let [t_delta, near, within] = [t_delta, near, tentative_within].map(Micros::as_micros);
        write!(f, " 1u,\n    {{{t_delta}, {near}, {within}, {votes}, {score_limit}, {contradiction}, ")?;
        writeln!(f, "{solo_contradiction}, {tentative_votes}, {memory}}},")?;
        let HoppingSettings { solo_rate, solo_after, solo_spacing, shift_after, shift_spacing, neighbours, .. } = all;
        write!(f, "    {solo_rate}, {solo_after}, {solo_spacing}, {shift_after}, {shift_spacing}, {neighbours}, ")?;
        write!(f, "{}, ", 1 + code.first_multiplier())?;
        if limits.is_some() { writeln!(f, "&{name}_own,\n}};") } else { writeln!(f, "0,\n}};") }
    }
}

/// The limits of each sensor, and what of a schedule goes with them.
struct OwnLimits<'r, const K: usize> {
    schedule: &'r HoppingSchedule<K>,
    limits: &'r EachSensor<K>,
    name: &'r str,
}

impl<const K: usize> fmt::Display for OwnLimits<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { schedule, limits, name } = self;
        let Some(most) = limits.most() else { return Ok(()) };
        let sensors = schedule.code().sensors();
        write!(f, "{}", CLimits { name, sensors, limits })?;
        let VerifiedFor { t_delta, min_interval, window, separation, audible, .. } = *most;
        let times = [schedule.period(), window, t_delta, min_interval, window, separation];
        writeln!(f, "static const EerufSchedule {name}_own EERUF_FLASH = {{")?;
        writeln!(f, "    {EERUF_VERSION}, {sensors}, 0, 0, 0,")?;
        writeln!(f, "    {},", Plain(|| times.into_iter().map(|time| (time.as_micros(), "u"))))?;
        writeln!(
            f,
            "    EERUF_AS_T_DELTA, {}u,\n    1, EERUF_LAYOUT_OTHER, 0, 0, {name}_limits,\n}};",
            audible.as_micros()
        )
    }
}

/// A hopping schedule as a TOML file: see [`Emit::to_toml`].
struct HoppingToml<'s, const K: usize> {
    schedule: &'s HoppingSchedule<K>,
}

impl<const K: usize> fmt::Display for HoppingToml<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let code = self.schedule.code();
        writeln!(f, "period_us = {}", Grouped(self.schedule.period()))?;
        writeln!(f, "step_us = {}", Grouped(code.step()))?;
        writeln!(f, "phases = {}", code.phases())?;
        if code.first_multiplier() != 1 {
            writeln!(f, "first_multiplier = {}", code.first_multiplier())?;
        }
        writeln!(f, "t_lag_us = [{}]", Numbers(|| lags(self.schedule)))
    }
}

/// "8 sensors, 11 phases, `T_p` = 60 ms".
struct Summary<'s, const K: usize>(&'s HoppingSchedule<K>);

impl<const K: usize> fmt::Display for Summary<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let code = self.0.code();
        write!(f, "{} sensors, {} phases, T_p = {}", code.sensors(), code.phases(), self.0.period())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sources_say_the_code_and_what_it_was_designed_for() {
        let code = HoppingCode::shortest(3, 2, Micros::new(301)).unwrap();
        let lags = [0, 9_000, 18_000, 0].map(Micros::new);
        let schedule = HoppingSchedule::<4>::new(code, Micros::from_millis(40), lags).unwrap();
        let requirements = Requirements {
            min_interval: Micros::from_millis(8),
            layout: Layout::Ring(2),
            window: Micros::from_millis(36),
            ..Requirements::new(Micros::new(150))
        };
        assert_eq!(
            schedule.to_toml(),
            "period_us = 40_000\nstep_us = 301\nphases = 3\nt_lag_us = [0, 9_000, 18_000]\n"
        );
        let rust = schedule.to_rust(&requirements);
        assert!(rust.contains("const RING: HoppingSchedule<3> = hopping_schedule! {"), "{rust}");
        assert!(rust.contains("layout: Layout::Ring(2),") && rust.contains("window: Micros::new(36_000)"), "{rust}");
        assert!(
            rust.contains("// 3 sensors, 3 phases, T_p = 40 ms,\n// t_delta = 150 us, 2 adjacent sensors of a ring"),
            "{rust}"
        );
        let c = schedule.to_c(&requirements);
        assert!(c.contains("{301u, 9602u, 18000u}, /* phase 1 */"), "{c}");
        assert!(c.contains("#define EERUF_PHASES 3\n") && c.contains("#define EERUF_T_DELTA_US 150u\n"), "{c}");
        assert!(
            c.contains("3, 3, 3, 301u, 40000u, eeruf_hopping_config_lag_us,\n    36000u, 0u, 36000u, 8000u, 1u,"),
            "{c}"
        );
        let tab = schedule.to_arduino(&requirements, "PORT");
        assert!(tab.contains("PORT_lag_us[] = {0u, 9000u, 18000u};"), "{tab}");
        assert!(tab.contains("{150, 400, 60, 5, 6, 2, 6, 2, 0},\n    84, 5, 3, 0, 8, 2, 2, 0,\n};"), "{tab}");
        // What may not be less than T_delta, or more, follows it.
        let wide = Requirements { t_delta: Micros::new(500), ..requirements };
        assert!(schedule.to_c(&wide).contains("{500, 500, 60,"));
        let narrow = Requirements { t_delta: Micros::new(40), ..requirements };
        assert!(schedule.to_rust(&narrow).contains(".with_tentative_within(Micros::new(40)),"));
        let mut deaf = requirements;
        deaf.blanking = Micros::new(900);
        let rust = schedule.to_rust(&deaf);
        assert!(
            rust.ends_with("    .with_blanking(Micros::new(900))\n    .with_reach(Micros::new(36_000));\n"),
            "{rust}"
        );
        // Sound that is heard for as long as the window, without blanking, is what listening is unless it is said.
        let rust = schedule.to_rust(&requirements);
        assert!(rust.ends_with("HoppingListening = HoppingListening::new(Micros::new(36_000));\n"), "{rust}");
        let mut far = requirements;
        far.audible = Some(Micros::from_millis(50));
        let rust = schedule.to_rust(&far);
        assert!(
            rust.ends_with("    .with_blanking(Micros::new(0))\n    .with_reach(Micros::new(50_000));\n"),
            "{rust}"
        );
        let five = HoppingCode::shortest(4, 5, Micros::new(301)).unwrap();
        let five = HoppingSchedule::<4>::new(five, Micros::from_millis(40), [Micros::ZERO; 4]).unwrap();
        assert!(five.to_toml().contains("phases = 5\nfirst_multiplier = 2\n"));
    }
}
