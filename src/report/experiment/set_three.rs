//! The table of Set III.

use std::fmt::Write as _;

use eeruf_sim::experiments::Spread;
use eeruf_sim::experiments::set_three::{Arrangement, Brief, Figures, Group, PERIOD, SetThree, Site};

use crate::report::percent::{fine_percent, mean_95, median};
use crate::report::table::{Column, by_name, markdown, or_dash};

/// The largest number of methods in one table.
const WIDEST: usize = 8;

const ACCEPTED: [Column<Figures>; 7] = [
    ("others, % of accepted", |of| with_interval(of.others_of_accepted)),
    ("90 %", |of| or_dash(of.others_of_accepted, |spread| fine_percent(spread.p90))),
    ("worst sensor", |of| with_interval(of.others_at_worst)),
    ("foreign, % of accepted", |of| with_interval(of.foreign_of_accepted)),
    ("good lost %", |of| with_interval(of.good_lost)),
    ("right echoes/s", |of| mean_95(of.right_echoes_per_s, 1.0, 1)),
    ("blind", |of| mean_95(of.blind, 1.0, 2)),
];

const BELIEF: [Column<Figures>; 5] = [
    ("right", |of| with_interval(of.belief_right)),
    ("unknown", |of| with_interval(of.unknown)),
    ("phantom", |of| with_interval(of.phantom)),
    ("too far", |of| with_interval(of.too_far)),
    ("faint", |of| with_interval(of.faint)),
];

pub(crate) fn describe(found: &SetThree) -> String {
    let mut text = format!(
        "Set III: {} placings from {} on of two to six robots, {} periods of {} each, physics: {}{};\n\
         medians with 95 % intervals. Others: another robot's sound, and the same at the sensor that accepts most of\n\
         it; foreign: the robot's own other sensors and earlier firings too. Belief: what was last believed, \
         no longer\n\
         than 0.6 s ago. Echoes and blind sensors are those of one robot with twelve (means).\n\n",
        found.seeds, found.first, found.periods, PERIOD, found.physics, found.conditions,
    );
    _ = writeln!(text, "{}", by_name(&[("method", str::to_owned)], &ACCEPTED, &found.methods));
    _ = writeln!(text, "\n{}", by_name(&[("% of the time", str::to_owned)], &BELIEF, &found.methods));
    // Many methods are split over several tables of about the same width.
    let methods = found.methods.len().max(1);
    let columns = methods.div_ceil(methods.div_ceil(WIDEST));
    for (at, part) in found.methods.chunks(columns).enumerate() {
        let mut header = vec!["others, % of accepted / belief right %", "placings"];
        header.extend(part.iter().map(|(way, _)| way.as_str()));
        let rows = found.groups.iter().map(|of| group(of, of.methods.iter().skip(at * columns).take(columns)));
        _ = writeln!(text, "\n{}", markdown(&header, rows));
    }
    text
}

fn with_interval(spread: Option<Spread>) -> String {
    or_dash(spread, |Spread { median, median_95: [low, high], .. }| {
        format!("{} ({}-{})", fine_percent(median), fine_percent(low), fine_percent(high))
    })
}

fn group<'g>(group: &'g Group, methods: impl Iterator<Item = &'g (String, Brief)>) -> Vec<String> {
    let place = group.place.map(|place| match place {
        Site::Corridor => "corridor, ",
        Site::Hall => "hall, ",
    });
    let arrangement = group.arrangement.map(|arrangement| match arrangement {
        Arrangement::Standing => "standing",
        Arrangement::Meeting => "meeting",
        Arrangement::Following => "following",
    });
    let robots = group.robots.map(|robots| format!("{robots} robots"));
    let name = [place.map(str::to_owned), arrangement.map(str::to_owned), robots];
    let mut row = vec![name.into_iter().flatten().collect::<String>(), group.placings.to_string()];
    row.extend(methods.map(|(_, brief)| briefly(brief)));
    row
}

fn briefly(brief: &Brief) -> String {
    let percent =
        |spread: Option<Spread>| median(spread.map(|spread| Spread { median: 100.0 * spread.median, ..spread }), 1);
    format!("{} / {}", percent(brief.others_of_accepted), percent(brief.belief_right))
}
