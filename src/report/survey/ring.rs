//! A survey as a ring file for `design`.

use std::fmt::Write as _;

use super::SurveyReport;

/// Needs of a ring file other than the pairs that hear each other.
pub(crate) struct RingTerms {
    pub(crate) t_delta_us: u32,
    pub(crate) window_us: u32,
    /// Time added to travel times.
    pub(crate) tolerance_us: u32,
}

/// First words of the ring files that a survey writes.
pub(crate) const FROM: &str = "# From the survey ";

/// Writes the pairs that hear each other as neighbours, each with the time after which the other's sound has passed.
pub(crate) fn ring_file(found: &SurveyReport<'_>, terms: &RingTerms) -> String {
    let conflicts = found.surveyed.conflicts(found.until_us);
    let round = |travel_us: f64| (travel_us.ceil() as u32).saturating_add(terms.tolerance_us).next_multiple_of(100);
    let intervals: Vec<_> = conflicts.iter().map(|&(x, y, travel_us)| (x, y, round(travel_us))).collect();
    let longest = intervals.iter().map(|interval| interval.2).max().unwrap_or(0);
    let mut text = format!(
        "{FROM}{}: sensors (from 0) that hear each other within {} us are neighbours, each pair with the\n\
         # time after which the other's sound has passed. It holds where it was measured: survey where echoes are \
         many.\n\
         sensors = {}\nt_delta_us = {}\nwindow_us = {}\nmin_interval_us = {longest}\n",
        found.file.display(),
        found.until_us,
        found.surveyed.sensors,
        terms.t_delta_us,
        terms.window_us,
    );
    let list = |text: &mut String, name: &str, entries: &mut dyn Iterator<Item = String>| {
        let entries: Vec<_> = entries.collect();
        // Writing to a string does not fail.
        if entries.is_empty() {
            _ = writeln!(text, "{name} = []");
            return;
        }
        _ = writeln!(text, "{name} = [");
        for row in entries.chunks(8) {
            _ = writeln!(text, "    {},", row.join(", "));
        }
        *text += "]\n";
    };
    list(&mut text, "layout", &mut intervals.iter().map(|(x, y, _)| format!("[{x}, {y}]")));
    list(&mut text, "intervals_us", &mut intervals.iter().map(|(x, y, us)| format!("[{x}, {y}, {us}]")));
    text
}
