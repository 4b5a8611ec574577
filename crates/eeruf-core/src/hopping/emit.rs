//! A hopping schedule as source text: Rust that is checked when it is compiled, a C header, a TOML file.

use core::fmt;

use super::schedule::HoppingSchedule;
use crate::emit::{Grouped, Numbers, RustLayout};
use crate::phases::{PhaseCriterion, PhaseRequirements};
use crate::time::Micros;

impl<const K: usize> HoppingSchedule<K> {
    /// A `const RING: HoppingSchedule` in Rust, with the `requirements` for the compiler to check (see
    /// [`hopping_schedule!`](crate::hopping_schedule!)).
    pub const fn to_rust<'r>(&'r self, requirements: &'r PhaseRequirements<'r>) -> HoppingRust<'r, K> {
        HoppingRust { schedule: self, requirements }
    }

    /// A C99 header that includes nothing but `<stdint.h>`, with the firing times of each phase.
    pub const fn to_c<'r>(&'r self, requirements: &'r PhaseRequirements<'r>) -> HoppingHeader<'r, K> {
        HoppingHeader { schedule: self, requirements }
    }

    /// A schedule file, as the program reads it: the code and the lags.
    pub const fn to_toml(&self) -> HoppingToml<'_, K> {
        HoppingToml { schedule: self }
    }

    fn lags(&self) -> impl Iterator<Item = Micros> {
        (0..self.code().sensors()).filter_map(|sensor| self.t_lag(sensor))
    }
}

/// A hopping schedule in Rust: see [`HoppingSchedule::to_rust`].
#[derive(Clone, Copy, Debug)]
pub struct HoppingRust<'r, const K: usize> {
    schedule: &'r HoppingSchedule<K>,
    requirements: &'r PhaseRequirements<'r>,
}

impl<const K: usize> fmt::Display for HoppingRust<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { schedule, requirements } = self;
        let PhaseRequirements { t_delta, criterion, audible, min_interval, layout, stale_echo } = requirements;
        let code = schedule.code();
        write!(f, "use eeruf_core::{{Audible, HoppingSchedule, Layout, Micros, PhaseCriterion, PhaseRequirements, ")?;
        writeln!(f, "hopping_schedule}};\n")?;
        writeln!(f, "// {},", Summary(schedule))?;
        writeln!(f, "// {}.", Promise(requirements))?;
        writeln!(
            f,
            "#[allow(long_running_const_eval, reason = \"all pairs of neighbours are checked in all phases\")]"
        )?;
        writeln!(f, "pub const RING: HoppingSchedule<{}> = hopping_schedule! {{", code.sensors())?;
        writeln!(f, "    period_us: {},", Grouped(schedule.period()))?;
        writeln!(f, "    step_us: {},", Grouped(code.step()))?;
        writeln!(f, "    phases: {},", code.phases())?;
        writeln!(f, "    first_multiplier: {},", code.first_multiplier())?;
        writeln!(f, "    t_lag_us: [{}],", Numbers(|| schedule.lags()))?;
        writeln!(f, "    meets: PhaseRequirements {{")?;
        writeln!(f, "        t_delta: Micros::new({}),", Grouped(*t_delta))?;
        match criterion {
            PhaseCriterion::Exact => writeln!(f, "        criterion: PhaseCriterion::Exact,")?,
            PhaseCriterion::Margin(margin) => {
                writeln!(f, "        criterion: PhaseCriterion::Margin(Micros::new({})),", Grouped(*margin))?;
            }
        }
        writeln!(f, "        audible: Audible {{")?;
        writeln!(f, "            window: Micros::new({}),", Grouped(audible.window))?;
        writeln!(f, "            blanking: Micros::new({}),", Grouped(audible.blanking))?;
        writeln!(f, "            reach: Micros::new({}),", Grouped(audible.reach))?;
        writeln!(f, "        }},")?;
        writeln!(f, "        min_interval: Micros::new({}),", Grouped(*min_interval))?;
        writeln!(f, "        layout: {},", RustLayout(*layout))?;
        writeln!(f, "        stale_echo: {stale_echo},")?;
        writeln!(f, "    }},\n}};")
    }
}

/// A hopping schedule as a C header: see [`HoppingSchedule::to_c`].
#[derive(Clone, Copy, Debug)]
pub struct HoppingHeader<'r, const K: usize> {
    schedule: &'r HoppingSchedule<K>,
    requirements: &'r PhaseRequirements<'r>,
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
        writeln!(f, "#define EERUF_T_DELTA_US {}u", requirements.t_delta.as_micros())?;
        writeln!(f, "#define EERUF_WINDOW_US {}u\n", requirements.audible.window.as_micros())?;
        writeln!(f, "static const uint32_t eeruf_t_fire_us[EERUF_PHASES][EERUF_SENSORS] = {{")?;
        for phase in 0..code.phases() {
            write!(f, "    {{")?;
            for (sensor, time) in (0..code.sensors()).filter_map(|sensor| schedule.t_fire(phase, sensor)).enumerate() {
                write!(f, "{}{}u", if sensor == 0 { "" } else { ", " }, time.as_micros())?;
            }
            writeln!(f, "}}, /* phase {phase} */")?;
        }
        writeln!(f, "}};\n\n#endif")
    }
}

/// A hopping schedule as a TOML file: see [`HoppingSchedule::to_toml`].
#[derive(Clone, Copy, Debug)]
pub struct HoppingToml<'s, const K: usize> {
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
        writeln!(f, "t_lag_us = [{}]", Numbers(|| self.schedule.lags()))
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

/// What a schedule was designed for.
struct Promise<'s>(&'s PhaseRequirements<'s>);

impl fmt::Display for Promise<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let PhaseRequirements { t_delta, audible, min_interval, layout, .. } = self.0;
        write!(f, "t_delta = {t_delta}, {layout} at least {min_interval} apart, listening for {}", audible.window)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::{HoppingCode, Layout};
    use std::string::ToString;

    #[test]
    fn the_sources_say_the_code_and_what_it_was_designed_for() {
        let code = HoppingCode::shortest(3, 2, Micros::new(301)).unwrap();
        let lags = [0, 9_000, 18_000, 0].map(Micros::new);
        let schedule = HoppingSchedule::<4>::new(code, Micros::from_millis(40), lags).unwrap();
        let requirements = PhaseRequirements {
            min_interval: Micros::from_millis(8),
            layout: Layout::Ring(2),
            ..PhaseRequirements::new(Micros::new(150), Micros::from_millis(36))
        };
        assert_eq!(
            schedule.to_toml().to_string(),
            "period_us = 40_000\nstep_us = 301\nphases = 3\nt_lag_us = [0, 9_000, 18_000]\n"
        );
        let rust = schedule.to_rust(&requirements).to_string();
        assert!(rust.contains("const RING: HoppingSchedule<3> = hopping_schedule! {"), "{rust}");
        assert!(rust.contains("layout: Layout::Ring(2),") && rust.contains("window: Micros::new(36_000)"), "{rust}");
        assert!(
            rust.contains("// 3 sensors, 3 phases, T_p = 40 ms,\n// t_delta = 150 us, 2 adjacent sensors of a ring"),
            "{rust}"
        );
        let c = schedule.to_c(&requirements).to_string();
        assert!(c.contains("{301u, 9602u, 18000u}, /* phase 1 */"), "{c}");
        assert!(c.contains("#define EERUF_PHASES 3\n") && c.contains("#define EERUF_T_DELTA_US 150u\n"), "{c}");
        let five = HoppingCode::shortest(4, 5, Micros::new(301)).unwrap();
        let five = HoppingSchedule::<4>::new(five, Micros::from_millis(40), [Micros::ZERO; 4]).unwrap();
        assert!(five.to_toml().to_string().contains("phases = 5\nfirst_multiplier = 2\n"));
    }
}
