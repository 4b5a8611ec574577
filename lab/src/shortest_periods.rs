//! The table of shortest periods with their cost, for 8 to 24 sensors in a line and in a ring unless asked otherwise.
//!
//! ```text
//! cargo lab shortest-periods [TICKS_PER_MS [SEPARATION_MS [SENSORS,.. [NEIGHBOURS [LAYOUT,.. [BUDGET
//!     [WINDOW_MS,..]]]]]]]
//! cargo lab periods
//! ```
//!
//! The first command prints columns, which `benches/peers/cpsat.py` reads; the second the table of docs/log/search.md.

use std::time::Instant;

use eeruf_core::Layout;
use eeruf_period::engine::Problem;
use eeruf_period::engine::shortest::{Shortest, shortest};

/// Windows of the table, in milliseconds.
const WINDOWS_MS: &str = "15,30,45,60";

/// A ring of the table.
struct Ring {
    layout: String,
    sensors: usize,
    window_ms: u32,
}

fn list<T: std::str::FromStr>(text: &str) -> Vec<T> {
    text.split(',').filter_map(|item| item.parse().ok()).collect()
}

/// Searches every requested ring, and passes on the result and its milliseconds.
fn search(arguments: &[String], mut found: impl FnMut(Ring, Shortest, f64)) -> crate::Answer {
    let argument = |i: usize, default: &'static str| arguments.get(i).map_or(default, String::as_str);
    let (ticks, separation_ms): (u32, u32) = (argument(0, "1").parse()?, argument(1, "2").parse()?);
    let (neighbours, budget): (u8, u64) = (argument(3, "4").parse()?, argument(5, "100000000").parse()?);
    for layout in list::<String>(argument(4, "line,ring")) {
        for sensors in list::<usize>(argument(2, "8,12,16,24")) {
            let rows = match layout.as_str() {
                "ring" => Layout::Ring(neighbours),
                "blocks" => Layout::Blocks(neighbours),
                _ => Layout::Line(neighbours),
            }
            .rows(sensors);
            for window_ms in list::<u32>(argument(6, WINDOWS_MS)) {
                let (gap, window) = (15 * ticks, window_ms * ticks);
                let problem = Problem::alike(&rows[..sensors], separation_ms * ticks, gap, window);
                let begin = Instant::now();
                let shortest = shortest(&problem, budget, &mut |_| true).ok_or("the grid is too fine")?;
                let ms = begin.elapsed().as_secs_f64() * 1e3;
                found(Ring { layout: layout.clone(), sensors, window_ms }, shortest, ms);
            }
        }
    }
    Ok(())
}

/// Prints the columns, one line for each ring.
pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    println!("layout sensors window period bound nodes milliseconds");
    let (mut times, begin) = (Vec::new(), Instant::now());
    search(arguments, |Ring { layout, sensors, window_ms }, found, ms| {
        times.push(ms);
        let Shortest { period, bound, nodes, .. } = found;
        println!("{layout} {sensors} {window_ms} {period} {bound} {nodes} {ms:.2}");
    })?;
    times.sort_by(f64::total_cmp);
    let (median, longest) = (times[times.len() / 2], times[times.len() - 1]);
    println!("# median {median:.2} ms, longest {longest:.2} ms, all {:.3} s", begin.elapsed().as_secs_f64());
    Ok(())
}

/// Prints the table: a row for each ring, a column for each window; period in ms, and in brackets nodes and
/// milliseconds.
pub(crate) fn table() -> crate::Answer {
    let windows: Vec<_> = list::<u32>(WINDOWS_MS).iter().map(|window_ms| format!("{window_ms} ms")).collect();
    print!("| ring | {} |\n|---|{}", windows.join(" | "), "---|".repeat(windows.len()));
    let mut last = String::new();
    search(&[], |Ring { layout, sensors, .. }, found, ms| {
        let ring = format!("{layout} {sensors}");
        if ring != last {
            print!("\n| {ring} |");
            last = ring;
        }
        print!(" {} ({} / {ms:.1}) |", found.period, with_commas(found.nodes));
    })?;
    println!();
    Ok(())
}

/// Formats 41355 as 41,355.
fn with_commas(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}
