//! The answer of `study`: a row each for firing like sketches, the best way one by one and the recommended way, and
//! what to do.

use std::fmt::Write as _;

use eeruf_sim::experiments::measure::{Cell, Family, Measured, ONE_A_MINUTE, Operating, Point, Setting};

use super::table::markdown;

/// Ways of firing, measured by the needs of a robot: `measured` is reported, with the votes chosen on `chosen`.
pub(crate) struct Three<'a> {
    pub(crate) chosen: &'a Measured,
    pub(crate) measured: &'a Measured,
    /// The family of the way compared with one by one.
    pub(crate) other: Family,
    /// True if the other way is recommended; `None` lets the measurement decide.
    pub(crate) is_recommended: Option<bool>,
}

/// Returns the words for a way of firing.
fn in_words(name: &str, setting: Setting) -> String {
    let way = match name {
        "blocking" if setting == Setting::ALL[0] => "blocking, as sketches fire",
        "blocking" => "one by one, in a loop",
        "in_turn" => "one by one, after an echo",
        "sequential" => "one by one, after the sound",
        "one_by_one_10ms" => "one by one, 10 ms apart",
        "one_by_one_20ms" => "one by one, 20 ms apart",
        "one_by_one_33ms" => "one by one, 33 ms apart",
        "far_groups" => "groups, far apart",
        "eeruf" => "two phases (EERUF)",
        _ => name,
    };
    match setting {
        Setting::Votes { m: 1, .. } => way.to_owned(),
        Setting::Votes { m, n } => format!("{way}, {m} of {n}"),
        Setting::Median => format!("{way}, median"),
    }
}

/// Formats a 95th percentile for sentences and tables.
fn t95(cell: &Cell) -> String {
    if cell.t95_ms.value.is_finite() { format!("{:.0}", cell.t95_ms.value) } else { "never".to_owned() }
}

fn stops(cell: &Cell) -> String {
    match cell.false_stops {
        0 => format!("< {:.1}", 3.0 / cell.minutes),
        _ => format!("{:.1}", cell.false_stops_per_min.value),
    }
}

impl Three<'_> {
    /// Writes the table, the meaning of its columns, and the recommendation.
    pub(crate) fn describe(&self) -> String {
        let Self { chosen, measured, other, is_recommended } = *self;
        let (Some(under), Some(chooses)) = (measured.under.first(), chosen.under.first()) else {
            return String::new();
        };
        let of = |family| chooses.operating(chosen, |way| measured.ways[way].family == family, ONE_A_MINUTE);
        let group = |family: Family| -> Vec<usize> {
            (0..measured.ways.len()).filter(|&way| measured.ways[way].family == family).collect()
        };
        let costs = measured.costs(chosen, &[group(Family::OneByOne), group(other)]);
        let is_other = is_recommended.or(costs.recommended.map(|index| index == 1));
        let blocking = measured.ways.iter().position(|way| way.way.name == "blocking");
        let blocking = blocking.map(|way| Point { way, setting: Setting::ALL[0] });
        let [one_by_one, other] = [Family::OneByOne, other].map(|family| of(family).map(Operating::point));
        let name = |point: Point| in_words(measured.ways[point.way].way.name, point.setting);
        let cell = |point: Point| under.cell(point, measured);
        let row = |point: Point| {
            let cell = cell(point);
            let (blind, right) = (format!("{:.1}", cell.blind.value), format!("{:.1}", cell.right_echoes_per_s.value));
            vec![name(point), t95(&cell), stops(&cell), blind, right]
        };
        let header = ["way of firing", "t95 ms", "false stops/min", "blind", "right/s"];
        let blocking = blocking.filter(|&blocking| one_by_one != Some(blocking));
        let rows = [blocking, one_by_one, other].into_iter().flatten().map(row);
        let mut text = format!("{}\n", markdown(&header, rows));
        text.push_str(
            "t95: by then 95 of 100 things are seen. false stop: foreign sound believed to be\n\
             nearest. blind: right in under 5 % of firings. right/s: right echoes a second.\n\n",
        );
        let (Some(one), Some(next)) = (one_by_one, other) else { return text };
        let (one_cell, next_cell) = (cell(one), cell(next));
        let figures = |cell: &Cell| format!("t95 {} ms, {} false stops a minute", t95(cell), stops(cell));
        let (one_figures, next_figures) = (figures(&one_cell), figures(&next_cell));
        let todo = match is_other {
            Some(true) => format!("Fire by {}: {next_figures};\none by one {one_figures}.", name(next)),
            Some(false) => {
                format!(
                    "One by one is enough ({}): {one_figures};\n{} {next_figures}: not surely better.",
                    name(one),
                    name(next)
                )
            }
            None => format!("No way keeps to one false stop a minute; {} has fewest here.", name(next)),
        };
        _ = writeln!(text, "{todo}");
        text
    }
}
