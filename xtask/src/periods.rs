//! `cargo xtask periods`: the columns that the example `shortest_periods` prints, as the table of
//! docs/log/search.md.

use std::process::Command;

use crate::steps::{Trouble, output};

/// One row for each ring, one column for each window: period in ms, and in brackets nodes and milliseconds.
pub(crate) fn table(arguments: &[String]) -> Result<String, Trouble> {
    // Not in release: the tests have built it, and its timings are not compared.
    let example = ["run", "--quiet", "--locked", "--package", "eeruf-core"];
    let mut cargo = Command::new("cargo");
    cargo.args(example).args(["--example", "shortest_periods", "--"]).args(arguments);
    let columns = output(&mut cargo).ok_or_else(|| Trouble::Failed("the example shortest_periods fails".to_owned()))?;
    Ok(pivoted(&columns))
}

fn pivoted(columns: &str) -> String {
    let (mut windows, mut rows): (Vec<&str>, Vec<(String, Vec<String>)>) = Default::default();
    for line in columns.lines().skip(1).filter(|line| !line.starts_with('#')) {
        let [layout, sensors, window, period, _, nodes, ms, ..] = line.split(' ').collect::<Vec<_>>()[..] else {
            continue;
        };
        let ring = format!("{layout} {sensors}");
        if rows.last().is_none_or(|(last, _)| *last != ring) {
            rows.push((ring, Vec::new()));
        }
        if !windows.contains(&window) {
            windows.push(window);
        }
        let ms = ms.parse().unwrap_or(0.0_f64);
        if let Some((_, cells)) = rows.last_mut() {
            cells.push(format!("{period} ({} / {ms:.1})", with_commas(nodes)));
        }
    }
    let header: Vec<_> = windows.iter().map(|window| format!("{window} ms")).collect();
    let mut text = format!("| ring | {} |\n|---|{}\n", header.join(" | "), "---|".repeat(windows.len()));
    for (ring, cells) in rows {
        text += &format!("| {ring} | {} |\n", cells.join(" | "));
    }
    text
}

/// 41355 as 41,355.
fn with_commas(digits: &str) -> String {
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_one_ring_become_one_row() {
        let columns = "layout sensors window period bound nodes milliseconds reason\n\
                       ring 24 15 70 70 41355 484.61 why\nring 24 30 76 76 171 2.04 why\n# median 1 ms\n";
        let table = "| ring | 15 ms | 30 ms |\n|---|---|---|\n| ring 24 | 70 (41,355 / 484.6) | 76 (171 / 2.0) |\n";
        assert_eq!(pivoted(columns), table);
    }
}
