//! A survey as text. Sensors are printed from 1.

use std::fmt::Write as _;

use eeruf_logs::FoundPath;

use super::{SurveyReport, compare};
use crate::report::table::markdown;

/// Writes the whole result.
pub(crate) fn describe(found: &SurveyReport<'_>) -> String {
    let surveyed = found.surveyed;
    let mut text = format!(
        "{}: {} sensors, {} slots; clock: {}{}\n",
        found.file.display(),
        surveyed.sensors,
        found.slots(),
        found.log.clock,
        found.truth.map_or(String::new(), |(_, physics)| format!("; physics: {physics}")),
    );
    let expected: f64 = surveyed.paths.iter().map(|path| path.accidents).sum();
    let (edges, strays) = surveyed.edges;
    // Writing to a string does not fail.
    _ = writeln!(
        text,
        "{} paths, {:.4} of them expected to be accidents; of {edges} edges {strays} fit none.\n",
        surveyed.paths.len(),
        // Not -0.0, which a sum of none is.
        expected + 0.0,
    );
    own(found, &mut text);
    foreign(found, &mut text);
    silent(found, &mut text);
    let conflicts = surveyed.conflicts(found.until_us);
    let pairs = surveyed.sensors * surveyed.sensors.saturating_sub(1) / 2;
    _ = writeln!(
        text,
        "\n{} of {pairs} pairs hear each other within {:.1} ms, in one direction or both.",
        conflicts.len(),
        1e-3 * f64::from(found.until_us)
    );
    if let Some((truth, _)) = found.truth {
        let compared = compare(found, truth);
        _ = writeln!(
            text,
            "Simulated: {} of {} ordered pairs that hear each other so were found, {} of the {} that do by 6 dB or \
             more; {} that never do were.\nOf {} paths between different sensors no sound takes {}.",
            compared.pairs_found,
            compared.pairs,
            compared.loud_pairs_found,
            compared.loud_pairs,
            compared.pairs_wrong,
            compared.paths,
            compared.paths_wrong,
        );
    }
    text
}

fn own(found: &SurveyReport<'_>, text: &mut String) {
    let mut without = Vec::new();
    for sensor in 0..found.surveyed.sensors as u8 {
        if found.surveyed.between(sensor, sensor).next().is_none() {
            without.push((sensor + 1).to_string());
        }
    }
    if !without.is_empty() && found.log.listened.is_empty() {
        let plural = if without.len() == 1 { "Sensor" } else { "Sensors" };
        _ = writeln!(text, "{plural} {} without an own echo: deaf, or nothing is in range.\n", without.join(", "));
    }
}

fn foreign(found: &SurveyReport<'_>, text: &mut String) {
    let header = ["hears", "sound of", "length m", "travel ms", "scatter us", "heard", "offsets", "accidents"];
    let row = |path: &FoundPath| {
        vec![
            (path.receiver + 1).to_string(),
            if path.sender == path.receiver { "itself".to_owned() } else { (path.sender + 1).to_string() },
            format!("{:.2}", found.length_m(path)),
            format!("{:.2}", 1e-3 * path.travel_us),
            format!("{:.0}", path.scatter_us),
            format!("{:.0} %", 100.0 * path.heard),
            format!("{} of {}", path.offsets.0, path.offsets.1),
            format!("{:.0e}", path.accidents),
        ]
    };
    _ = writeln!(text, "{}", markdown(&header, found.surveyed.paths.iter().map(row)));
}

/// Lists pairs without a path, and the weight of that evidence.
fn silent(found: &SurveyReport<'_>, text: &mut String) {
    let near = |x, y| found.surveyed.between(x, y).any(|path| path.travel_us <= f64::from(found.until_us));
    let silent: Vec<_> = found.pairs().filter(|&(x, y)| !near(x, y)).collect();
    if silent.is_empty() {
        return;
    }
    let visible = |&(x, y): &(u8, u8)| found.surveyed.visible(x, y, found.until_us);
    let least = silent.iter().map(visible).fold(1.0, f64::min);
    _ = writeln!(
        text,
        "\nNo path within {:.1} ms in {} of {} ordered pairs. Of the travel times up to there {:.0} % or more would \
         have been seen, had a sound taken them; at the others the receiver is deaf or its own echo comes first.",
        1e-3 * f64::from(found.until_us),
        silent.len(),
        found.pairs().count(),
        100.0 * least,
    );
}
