//! A ring as source text: Rust that is checked when it is compiled, a C header, a tab of an Arduino sketch, a TOML
//! file.

mod c;
mod flow;
mod ring;

use std::fmt;

use eeruf_core::{Criterion, Layout, Micros, Phase, Requirements, Schedule, Uneven};

use c::{ArduinoTab, CHeader, CLimits, EERUF_VERSION, Plain};
pub use flow::Flow;
pub use ring::Form;

use crate::ScheduleFile;

/// A schedule that can be written as source text.
pub trait Emit {
    /// Returns a `const RING` in Rust, with `requirements` for the compiler to check (see `eeruf_core::schedule!`).
    fn to_rust(&self, requirements: &Requirements<'_>) -> String;

    /// Returns a C99 header that includes only `<stdint.h>`, with the firing times and their requirements. If `eeruf.h`
    /// is included first, it also defines the constant `eeruf_schedule` for `eeruf_ring_init`.
    fn to_c(&self, requirements: &Requirements<'_>) -> String;

    /// Returns a file of an Arduino sketch for the library in `c/arduino`, with the schedule as a constant `name`.
    fn to_arduino(&self, requirements: &Requirements<'_>, name: &str) -> String;

    /// Returns a schedule file, as the program reads it: lags and waits, or firing times if all lags are zero.
    fn to_toml(&self) -> String;
}

impl<const K: usize> Emit for Schedule<K> {
    fn to_rust(&self, requirements: &Requirements<'_>) -> String {
        RustSource { schedule: self, requirements }.to_string()
    }

    fn to_c(&self, requirements: &Requirements<'_>) -> String {
        CHeader { schedule: self, requirements }.to_string()
    }

    fn to_arduino(&self, requirements: &Requirements<'_>, name: &str) -> String {
        ArduinoTab { schedule: self, requirements, name }.to_string()
    }

    fn to_toml(&self) -> String {
        let ScheduleFile { period_us, t_lag_us, t_wait_a_us, t_wait_b_us, t_fire_a_us, t_fire_b_us } = self.into();
        let mut text = format!("period_us = {}\n", Grouped(Micros::new(period_us)));
        for (key, times) in [
            ("t_lag_us", t_lag_us),
            ("t_wait_a_us", t_wait_a_us),
            ("t_wait_b_us", t_wait_b_us),
            ("t_fire_a_us", t_fire_a_us),
            ("t_fire_b_us", t_fire_b_us),
        ] {
            if let Some(times) = times {
                text += &format!("{key} = [{}]\n", Numbers(|| times.iter().copied().map(Micros::new)));
            }
        }
        text
    }
}

fn fire_times<const K: usize>(schedule: &Schedule<K>, phase: Phase) -> impl Iterator<Item = Micros> {
    (0..schedule.sensors()).filter_map(move |x| schedule.t_fire(phase, x))
}

fn has_lags<const K: usize>(schedule: &Schedule<K>) -> bool {
    schedule.t_lag().iter().any(|&lag| lag != Micros::ZERO)
}

/// A schedule in Rust: see [`Emit::to_rust`].
struct RustSource<'r, const K: usize> {
    schedule: &'r Schedule<K>,
    requirements: &'r Requirements<'r>,
}

impl<const K: usize> fmt::Display for RustSource<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { schedule, requirements } = self;
        let uneven = &requirements.uneven;
        let (each, uneven_too) = if uneven.is_some() { ("EachSensor, ", "Uneven, ") } else { ("", "") };
        let criterion = if requirements.criterion == Criterion::Exact { "" } else { "Criterion, " };
        write!(f, "use eeruf_core::{{{criterion}{each}Layout, Micros, Requirements, ")?;
        writeln!(f, "{uneven_too}VerifiedSchedule, schedule}};\n")?;
        writeln!(f, "// {}; {}.", Summary(schedule), Promise(requirements))?;
        let sensors = schedule.sensors();
        match uneven {
            None => writeln!(f, "pub const RING: VerifiedSchedule<{sensors}> = schedule! {{")?,
            Some(_) => {
                writeln!(f, "pub const RING: VerifiedSchedule<{sensors}, 2, EachSensor<{sensors}>> = schedule! {{")?;
            }
        }
        writeln!(f, "    period_us: {},", Grouped(schedule.period()))?;
        if has_lags(schedule) && uneven.is_none() {
            writeln!(f, "    t_lag_us: [{}],", Numbers(|| schedule.t_lag().iter().copied()))?;
            writeln!(f, "    t_wait_a_us: [{}],", Numbers(|| schedule.t_wait(Phase::A).iter().copied()))?;
            writeln!(f, "    t_wait_b_us: [{}],", Numbers(|| schedule.t_wait(Phase::B).iter().copied()))?;
        } else {
            writeln!(f, "    t_fire_a_us: [{}],", Numbers(|| fire_times(schedule, Phase::A)))?;
            writeln!(f, "    t_fire_b_us: [{}],", Numbers(|| fire_times(schedule, Phase::B)))?;
        }
        writeln!(f, "{}}};", Meets(requirements))
    }
}

/// Requirements as Rust source: the last field of the `schedule!` macro.
struct Meets<'r>(&'r Requirements<'r>);

impl fmt::Display for Meets<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let &Requirements { t_delta, criterion, min_interval, layout, window, blanking, audible, .. } = self.0;
        let Requirements { stale_echo, uneven, .. } = self.0;
        writeln!(f, "    {}: Requirements {{", if uneven.is_some() { "each_meets" } else { "meets" })?;
        match criterion {
            Criterion::Exact => {}
            Criterion::Paper => writeln!(f, "        criterion: Criterion::Paper,")?,
            Criterion::Margin(margin) => {
                writeln!(f, "        criterion: Criterion::Margin(Micros::new({})),", Grouped(margin))?;
            }
        }
        writeln!(f, "        min_interval: Micros::new({}),", Grouped(min_interval))?;
        writeln!(f, "        layout: {},", RustLayout(layout))?;
        writeln!(f, "        window: Micros::new({}),", Grouped(window))?;
        if blanking != Micros::ZERO {
            writeln!(f, "        blanking: Micros::new({}),", Grouped(blanking))?;
        }
        if let Some(audible) = audible {
            writeln!(f, "        audible: Some(Micros::new({})),", Grouped(audible))?;
        }
        writeln!(f, "        stale_echo: {stale_echo},")?;
        if let Some(uneven) = uneven {
            write!(f, "{}", UnevenSource(uneven))?;
        }
        writeln!(f, "        ..Requirements::new(Micros::new({}))", Grouped(t_delta))?;
        writeln!(f, "    }},")
    }
}

/// A layout as an expression in Rust.
struct RustLayout<'r>(Layout<'r>);

impl fmt::Display for RustLayout<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Layout::Line(n) => write!(f, "Layout::Line({n})"),
            Layout::Ring(n) => write!(f, "Layout::Ring({n})"),
            Layout::Blocks(n) => write!(f, "Layout::Blocks({n})"),
            Layout::Graph(rows) => {
                write!(f, "Layout::Graph(&[")?;
                // Sensors beyond the last row have no neighbours of their own.
                let used = rows.iter().rposition(|&row| row != 0).map_or(0, |last| last + 1);
                for (place, row) in rows.iter().take(used).enumerate() {
                    write!(f, "{}{row:#x}", if place == 0 { "" } else { ", " })?;
                }
                write!(f, "])")
            }
        }
    }
}

/// "12 sensors, `T_p` = 65 ms".
struct Summary<'s, const K: usize>(&'s Schedule<K>);

impl<const K: usize> fmt::Display for Summary<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} sensors, T_p = {}", self.0.sensors(), self.0.period())
    }
}

/// Requirements that the schedule was designed for.
struct Promise<'r>(&'r Requirements<'r>);

impl fmt::Display for Promise<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Requirements { t_delta, min_interval, layout, window, uneven, .. } = *self.0;
        if uneven.is_some() {
            return write!(f, "{layout} at least {min_interval} apart, and what each sensor and pair needs");
        }
        write!(f, "t_delta = {t_delta}, {layout} at least {min_interval} apart, listening for {window}")
    }
}

/// Differences between the sensors, as the field of the requirements.
struct UnevenSource<'u>(&'u Uneven<'u>);

impl fmt::Display for UnevenSource<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Uneven { t_delta, window, refire, intervals, shared_lines, together } = *self.0;
        writeln!(f, "        uneven: Some(Uneven {{")?;
        for (name, each) in [("t_delta", t_delta), ("window", window), ("refire", refire)] {
            list(f, name, each, |to, time| write!(to, "Micros::new({})", Grouped(*time)))?;
        }
        list(f, "intervals", intervals, |to, (x, y, interval)| {
            write!(to, "({x}, {y}, Micros::new({}))", Grouped(*interval))
        })?;
        for (name, sets) in [("shared_lines", shared_lines), ("together", together)] {
            list(f, name, sets, |to, set| write!(to, "{set:#b}"))?;
        }
        writeln!(f, "        }}),")
    }
}

/// Writes a field that is a list as rustfmt does: on one line of up to 120 columns, or one line for each item.
fn list<T>(
    f: &mut fmt::Formatter<'_>,
    name: &str,
    items: &[T],
    show: impl Fn(&mut dyn fmt::Write, &T) -> fmt::Result,
) -> fmt::Result {
    let mut columns = Columns("            : &[],".len() + name.len());
    for (at, item) in items.iter().enumerate() {
        columns.0 += if at == 0 { 0 } else { 2 };
        show(&mut columns, item)?;
    }
    write!(f, "            {name}: &[")?;
    if columns.0 <= 120 {
        for (at, item) in items.iter().enumerate() {
            f.write_str(if at == 0 { "" } else { ", " })?;
            show(f, item)?;
        }
        return writeln!(f, "],");
    }
    writeln!(f)?;
    for item in items {
        f.write_str("                ")?;
        show(f, item)?;
        writeln!(f, ",")?;
    }
    writeln!(f, "            ],")
}

/// Counts the columns of the text written to it.
struct Columns(usize);

impl fmt::Write for Columns {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 += text.len();
        Ok(())
    }
}

/// Numbers in microseconds, separated by commas.
struct Numbers<F>(F);

impl<F: Fn() -> I, I: Iterator<Item = Micros>> fmt::Display for Numbers<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, time) in (self.0)().enumerate() {
            write!(f, "{}{}", if place == 0 { "" } else { ", " }, Grouped(time))?;
        }
        Ok(())
    }
}

/// Microseconds with underscores between groups of three digits: `65_000`.
struct Grouped(Micros);

impl fmt::Display for Grouped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let us = self.0.as_micros();
        match (us / 1_000_000_000, us / 1_000_000 % 1000, us / 1000 % 1000, us % 1000) {
            (0, 0, 0, ones) => write!(f, "{ones}"),
            (0, 0, thousands, ones) => write!(f, "{thousands}_{ones:03}"),
            (0, millions, thousands, ones) => write!(f, "{millions}_{thousands:03}_{ones:03}"),
            (billions, millions, thousands, ones) => write!(f, "{billions}_{millions:03}_{thousands:03}_{ones:03}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eeruf_core::tables::{TABLE_I_C, TABLE_I_D};

    const REQUIREMENTS: Requirements<'static> =
        Requirements { min_interval: Micros::from_millis(15), ..Requirements::new(Micros::new(999)) };

    // A table of waits is written as lags and waits, a table of firing times as firing times.
    #[test]
    fn table_is_written_as_it_was_made_waits_or_firing_times() {
        assert_eq!(
            TABLE_I_D.to_toml(),
            "period_us = 100_000\n\
             t_lag_us = [0, 25_000, 50_000, 75_000, 0, 25_000, 50_000, 75_000, 0, 25_000, 50_000, 75_000]\n\
             t_wait_a_us = [24_000, 24_000, 24_000, 24_000, 24_000, 24_000, 24_000, 24_000, 24_000, 24_000, 24_000, \
             24_000]\n\
             t_wait_b_us = [18_000, 12_000, 6_000, 0, 20_000, 14_000, 8_000, 2_000, 22_000, 16_000, 10_000, 4_000]\n"
        );
        let text = TABLE_I_C.to_toml();
        assert!(text.contains("t_fire_b_us = [0, 27_000, 54_000,") && !text.contains("t_lag_us"), "{text}");
    }

    #[test]
    fn the_sources_say_what_the_schedule_was_designed_for() {
        let rust = TABLE_I_D.to_rust(&REQUIREMENTS);
        let promise = "12 sensors, T_p = 100 ms";
        assert!(
            rust.contains(promise) && rust.contains("pub const RING: VerifiedSchedule<12> = schedule! {"),
            "{rust}"
        );
        assert!(rust.contains("t_delta = 999 us, 4 adjacent sensors of a line at least 15 ms apart"), "{rust}");
        let c = TABLE_I_D.to_c(&REQUIREMENTS);
        assert!(c.contains(promise) && c.contains("#define EERUF_SENSORS 12\n"), "{c}");
        assert!(c.contains("{24000u, 49000u") && c.contains("{18000u, 37000u"), "{c}");
    }

    // An uneven schedule is written with all requirements that it was designed for.
    #[test]
    fn uneven_schedule_is_written_with_all_needs() {
        let ms = |ms: [u32; 2]| ms.map(Micros::from_millis);
        let schedule = Schedule::from_firing(Micros::from_millis(60), [ms([0, 20]), ms([0, 23])]).unwrap();
        let uneven = Uneven {
            t_delta: &[Micros::new(999), Micros::new(1_400)],
            window: &ms([50, 12]),
            refire: &[],
            intervals: &[(0, 1, Micros::new(15_000))],
            shared_lines: &[],
            together: &[],
        };
        let requirements = Requirements { uneven: Some(uneven), ..Requirements::new(Micros::new(999)) };
        let rust = schedule.to_rust(&requirements);
        for line in [
            "use eeruf_core::{EachSensor, Layout, Micros, Requirements, Uneven, VerifiedSchedule, schedule};",
            "pub const RING: VerifiedSchedule<2, 2, EachSensor<2>> = schedule! {",
            "            window: &[Micros::new(50_000), Micros::new(12_000)],",
            "            intervals: &[(0, 1, Micros::new(15_000))],",
        ] {
            assert!(rust.lines().any(|found| found == line), "{line}\n{rust}");
        }
        let c = schedule.to_c(&requirements);
        assert!(c.contains("#define EERUF_T_DELTA_US 999u\n#define EERUF_WINDOW_US 12000u\n"), "{c}");
        assert!(c.contains("static const uint32_t eeruf_window_us[EERUF_SENSORS] = {50000u, 12000u};\n"), "{c}");
    }

    #[test]
    fn a_list_stays_on_its_line_up_to_120_columns() {
        let (mut on_one, mut on_many) = (0, 0);
        for count in 1..=64 {
            for last in [1, 2, 4, 8, 16] {
                let mut items = vec![1; count];
                items[count - 1] = last;
                let uneven = Uneven { together: &items, ..Uneven::NONE };
                let text = UnevenSource(&uneven).to_string();
                let each: Vec<_> = items.iter().map(|set| format!("{set:#b}")).collect();
                let line = format!("            together: &[{}],", each.join(", "));
                assert_eq!(text.lines().any(|found| found == line), line.len() <= 120, "{text}");
                let alone = text.lines().filter(|found| found.starts_with("                0b")).count();
                assert_eq!(alone, if line.len() <= 120 { 0 } else { count }, "{text}");
                on_one += u32::from(line.len() == 120);
                on_many += u32::from(line.len() == 121);
            }
        }
        assert!(on_one > 0 && on_many > 0, "both sides of the limit are tried");
    }

    #[test]
    fn numbers_are_grouped_by_thousands() {
        for (us, text) in [(0, "0"), (999, "999"), (1000, "1_000"), (65_005, "65_005"), (1_000_070, "1_000_070")] {
            assert_eq!(Grouped(Micros::new(us)).to_string(), text);
        }
        assert_eq!(Grouped(Micros::MAX).to_string(), "4_294_967_295");
    }
}
