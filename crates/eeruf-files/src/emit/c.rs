//! A schedule for C: a header with firing times for any program, and the constant that `eeruf.h` takes.

use std::fmt;

use eeruf_core::conditions::VerifiedFor;
use eeruf_core::{EachSensor, Layout, Micros, Phase, Requirements, Schedule, SensorLimits, VerifiedSchedule};

use super::{Promise, Summary};

/// `EERUF_VERSION` of the `eeruf.h` that tables are written for.
pub(super) const EERUF_VERSION: u16 = 5;

/// A schedule as a C header: see [`Emit::to_c`](super::Emit::to_c).
pub(super) struct CHeader<'r, const K: usize> {
    pub(super) schedule: &'r Schedule<K>,
    pub(super) requirements: &'r Requirements<'r>,
}

/// Reads one requirement of one sensor.
type OfSensor<'r> = fn(&Requirements<'r>, usize) -> Micros;

impl<'r, const K: usize> fmt::Display for CHeader<'r, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { schedule, requirements } = *self;
        writeln!(f, "/* {};\n   {}.", Summary(schedule), Promise(requirements))?;
        writeln!(f, "   Times are microseconds from the start of each period; phases a and b alternate. */")?;
        writeln!(f, "#ifndef EERUF_SCHEDULE_H\n#define EERUF_SCHEDULE_H\n\n#include <stdint.h>\n")?;
        writeln!(f, "#define EERUF_SENSORS {}", schedule.sensors())?;
        writeln!(f, "#define EERUF_PERIOD_US {}u", schedule.period().as_micros())?;
        let each = |of: OfSensor<'r>| (0..schedule.sensors()).map(move |x| of(requirements, x).as_micros());
        let uneven = requirements.uneven.is_some();
        if uneven {
            writeln!(f, "/* The smallest of all sensors, with which all may run; each one's own follow. */")?;
        }
        writeln!(f, "#define EERUF_T_DELTA_US {}u", each(Requirements::t_delta_of).min().unwrap_or_default())?;
        writeln!(f, "#define EERUF_WINDOW_US {}u\n", each(Requirements::window_of).min().unwrap_or_default())?;
        let own: [(&str, OfSensor<'r>); 2] =
            [("t_delta", Requirements::t_delta_of), ("window", Requirements::window_of)];
        for (name, of) in own.into_iter().filter(|_| uneven) {
            let times = Plain(|| each(of).map(|time| (time, "u")));
            writeln!(f, "static const uint32_t eeruf_{name}_us[EERUF_SENSORS] = {{{times}}};")?;
        }
        writeln!(f, "static const uint32_t eeruf_t_fire_us[2][EERUF_SENSORS] = {{")?;
        for phase in [Phase::A, Phase::B] {
            let times = || (0..schedule.sensors()).filter_map(move |x| schedule.t_fire(phase, x));
            writeln!(f, "    {{{}}}, /* phase {phase} */", Plain(|| times().map(|time| (time.as_micros(), "u"))))?;
        }
        writeln!(f, "}};\n\n#ifdef EERUF_H /* with eeruf.h before this file: the schedule for eeruf_ring_init */")?;
        write!(f, "{}", Constant { schedule, requirements, name: "eeruf_schedule" })?;
        writeln!(f, "#endif\n\n#endif")
    }
}

/// A schedule as a file of an Arduino sketch: see [`Emit::to_arduino`](super::Emit::to_arduino).
pub(super) struct ArduinoTab<'r, const K: usize> {
    pub(super) schedule: &'r Schedule<K>,
    pub(super) requirements: &'r Requirements<'r>,
    pub(super) name: &'r str,
}

impl<const K: usize> fmt::Display for ArduinoTab<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { schedule, requirements, name } = *self;
        writeln!(f, "// {};\n// {}.", Summary(schedule), Promise(requirements))?;
        writeln!(f, "#pragma once\n#include <EerufArduino.h>\n")?;
        write!(f, "{}", Constant { schedule, requirements, name })
    }
}

/// The constant of type `EerufSchedule`, and the arrays it points to. It names the requirements if the schedule meets
/// them; otherwise it is marked unverified.
struct Constant<'r, const K: usize> {
    schedule: &'r Schedule<K>,
    requirements: &'r Requirements<'r>,
    name: &'r str,
}

impl<const K: usize> fmt::Display for Constant<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { schedule, requirements, name } = *self;
        let sensors = schedule.sensors();
        writeln!(f, "static const uint8_t {name}_order[] EERUF_FLASH = {{")?;
        for phase in [Phase::A, Phase::B] {
            let order = schedule.firing_order(phase);
            writeln!(f, "    {}, /* phase {phase} */", Plain(|| order.iter().map(|&sensor| (sensor.into(), ""))))?;
        }
        writeln!(f, "}};\nstatic const uint32_t {name}_gap_us[] EERUF_FLASH = {{")?;
        for Phase(phase) in [Phase::A, Phase::B] {
            let order = schedule.firing_order(Phase(phase));
            let times = || order.iter().filter_map(move |&x| schedule.t_fire(Phase(phase), x.into()));
            let ends = || times().chain([schedule.period()]);
            let begins = || [Micros::ZERO].into_iter().chain(times());
            let gaps = || ends().zip(begins()).map(|(end, begin)| (end.abs_diff(begin).as_micros(), "u"));
            writeln!(f, "    {},", Plain(gaps))?;
        }
        let verified = schedule.verified_each(requirements).ok();
        let each = verified.as_ref().map(VerifiedSchedule::own_limits).filter(|_| requirements.uneven.is_some());
        let most = each.and_then(|each| each.most().copied());
        let alike = || verified.map(|verified| verified.verified_for());
        let verified_for = most.or_else(alike);
        let of = |time: fn(VerifiedFor) -> Micros| verified_for.map_or(Micros::ZERO, time);
        let (layout, neighbours) = match requirements.layout {
            // Individual pairs may have other intervals.
            _ if requirements.uneven.is_some() => ("OTHER", 0),
            Layout::Line(n) => ("LINE", n),
            Layout::Ring(n) => ("RING", n),
            Layout::Blocks(n) => ("BLOCKS", n),
            Layout::Graph(_) => ("OTHER", 0),
        };
        let stale_echo = u8::from(requirements.stale_echo);
        let designed = [of(|it| it.t_delta), of(|it| it.min_interval), of(|it| it.window), of(|it| it.separation)];
        let times = [schedule.period(), schedule.min_refire()].into_iter().chain(designed);
        if let Some(each) = each {
            writeln!(f, "}};")?;
            write!(f, "{}", CLimits { name, sensors, limits: each })?;
            writeln!(f, "static const EerufSchedule {name} EERUF_FLASH = {{")?;
        } else {
            writeln!(f, "}};\nstatic const EerufSchedule {name} EERUF_FLASH = {{")?;
        }
        writeln!(f, "    {EERUF_VERSION}, {sensors}, 2, {name}_order, {name}_gap_us,")?;
        writeln!(f, "    {},", Plain(|| times.clone().map(|time| (time.as_micros(), "u"))))?;
        match verified_for.and_then(|it| it.path_change) {
            Some(path_change) => write!(f, "    {}u,", path_change.as_micros())?,
            None => f.write_str("    EERUF_AS_T_DELTA,")?,
        }
        writeln!(f, " {}u,", of(|it| it.audible).as_micros())?;
        let verified = u8::from(verified.is_some());
        write!(f, "    {verified}, EERUF_LAYOUT_{layout}, {neighbours}, {stale_echo}, ")?;
        match each {
            Some(_) => writeln!(f, "{name}_limits,\n}};"),
            None => writeln!(f, "0,\n}};"),
        }
    }
}

/// The limits of each sensor as a constant.
pub(super) struct CLimits<'r, const K: usize> {
    pub(super) name: &'r str,
    pub(super) sensors: usize,
    pub(super) limits: &'r EachSensor<K>,
}

impl<const K: usize> fmt::Display for CLimits<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, sensors, limits } = *self;
        writeln!(f, "static const EerufLimits {name}_limits[] EERUF_FLASH = {{")?;
        for (x, group) in (0..sensors as u8).zip(limits.groups()) {
            let Some(SensorLimits { t_delta, window }) = limits.of(x) else { continue };
            writeln!(f, "    {{{}u, {}u, {group}}},", window.as_micros(), t_delta.as_micros())?;
        }
        writeln!(f, "}};")
    }
}

/// Comma-separated numbers, each with a suffix.
pub(super) struct Plain<F>(pub(super) F);

impl<F: Fn() -> I, I: Iterator<Item = (u32, &'static str)>> fmt::Display for Plain<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, (number, suffix)) in (self.0)().enumerate() {
            write!(f, "{}{number}{suffix}", if place == 0 { "" } else { ", " })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emit::Emit;
    use eeruf_core::tables::TABLE_I_D;

    const REQUIREMENTS: Requirements<'static> =
        Requirements { min_interval: Micros::from_millis(15), ..Requirements::new(Micros::new(999)) };

    // The constant states what it was verified for, or that it is unverified.
    #[test]
    fn constant_says_what_it_was_verified_for() {
        let tab = TABLE_I_D.to_arduino(&REQUIREMENTS, "PAPER");
        assert!(tab.contains("EerufSchedule PAPER EERUF_FLASH = {\n    5, 12, 2, PAPER_order, PAPER_gap_us,"), "{tab}");
        assert!(
            tab.contains(
                "100000u, 76000u, 999u, 15000u, 76000u, 2000u,\n    EERUF_AS_T_DELTA, 100000u,\n    \
                 1, EERUF_LAYOUT_LINE, 4, 0, 0,"
            ),
            "{tab}"
        );
        let more = Requirements { t_delta: Micros::new(1000), ..REQUIREMENTS };
        let tab = TABLE_I_D.to_arduino(&more, "PAPER");
        assert!(
            tab.contains(
                "100000u, 76000u, 0u, 0u, 0u, 0u,\n    EERUF_AS_T_DELTA, 0u,\n    0, EERUF_LAYOUT_LINE, 4, 0, 0,"
            ),
            "{tab}"
        );
    }
}
