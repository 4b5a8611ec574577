//! The answer of `study` for a scene: a row each for firing as sketches do, for the best way of firing one by one, and
//! for flow; then a recommendation.

use std::fmt::Write as _;

use eeruf_sim::experiments::measure::{Cell, Family, Measured, ONE_A_MINUTE, Operating, Point, Setting};

use super::table::markdown;

/// Ways of firing, measured by the needs of a robot: `measured` is reported, with the votes chosen on `chosen`.
pub(crate) struct Three<'a> {
    pub(crate) chosen: &'a Measured,
    pub(crate) measured: &'a Measured,
}

/// A 95th percentile in words, for sentences and tables.
pub(super) fn t95(cell: &Cell) -> String {
    if cell.t95_ms.value.is_finite() { format!("{:.0}", cell.t95_ms.value) } else { "never".to_owned() }
}

pub(super) fn stops(cell: &Cell) -> String {
    match cell.false_stops {
        0 => format!("< {:.1}", 3.0 / cell.minutes),
        _ => format!("{:.1}", cell.false_stops_per_min.value),
    }
}

impl Three<'_> {
    /// Writes the table, the meaning of its columns, and the recommendation.
    pub(crate) fn describe(&self) -> String {
        let Self { chosen, measured } = *self;
        let (Some(under), Some(chooses)) = (measured.under.first(), chosen.under.first()) else {
            return String::new();
        };
        let groups = [Family::OneByOne, Family::Flow].map(|of| measured.points(|way| measured.ways[way].family == of));
        let costs = measured.costs(chosen, &groups[0], &groups);
        let is_other = costs.recommended.map(|index| index == 1);
        let blocking = measured.ways.iter().position(|way| way.name == "blocking");
        let blocking = blocking.map(|way| Point { way, setting: Setting::ALL[0] });
        let at = |group: &Vec<Point>| chooses.operating(chosen, group, ONE_A_MINUTE).map(Operating::point);
        let [one_by_one, other] = groups.each_ref().map(at);
        let name = |point: Point| measured.ways[point.way].in_words(point.setting);
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
