//! Ways of firing judged in rooms, as text and as JSON.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use eeruf_design::{JudgedWay, KindCost, RoomsAnswer};
use eeruf_sim::experiments::measure::{Cell, Estimate, Family};
use eeruf_sim::experiments::rooms::VERSION;
use serde::Serialize;

use super::table::{markdown, or_dash};
use super::three::{stops, t95};

/// Describes the recommended way, with a row for each kind and the conditions that change it; or why there is none.
pub(crate) fn describe(name: &str, judged: &Result<RoomsAnswer, String>) -> String {
    match judged {
        Ok(answer) => verdict(name, answer) + &kinds(answer) + &depends_on(answer),
        Err(why) => format!("{name}: not judged in rooms: {why}.\n"),
    }
}

/// Every way under each condition.
pub(crate) fn describe_all(judged: &Result<RoomsAnswer, String>) -> String {
    judged.as_ref().map_or_else(|_| String::new(), every_way)
}

/// Writes the sentence that answers.
fn verdict(name: &str, answer: &RoomsAnswer) -> String {
    let Some(best) = &answer.best else {
        return format!("{name}: no way of firing is possible for this ring.\n");
    };
    let kind = answer.kinds.iter().find(|kind| kind.kind == best.family.to_string());
    let title = kind.and_then(|kind| kind.best.iter().find(|way| way.way == best.name));
    let title = title.map_or_else(|| best.family.to_string(), |way| way.title.clone());
    let draw = answer.draw.as_ref().map_or(String::new(), |other| format!("; a draw with {other}"));
    let mut text = format!("{name}: recommended: {title}{draw}.\n");
    if !answer.keeps {
        text.push_str("No way keeps to one false stop a minute under each condition; this one has the fewest.\n");
    } else if best.family == Family::OneByOne {
        text.push_str("You do not need eeruf here: no other way sees what appears significantly sooner.\n");
    }
    text
}

/// Writes the table of the best one by one and of the kinds that can be recommended, and its columns in words.
fn kinds(answer: &RoomsAnswer) -> String {
    let RoomsAnswer { kinds, baseline, speed_m_s, turn_deg_s, rooms, .. } = answer;
    let among = |best: &&JudgedWay, others: bool| best.condition.ends_with("_others") == others;
    let row = |kind: &str, cost: Option<&Estimate>, best: &[JudgedWay], others: bool| -> Option<Vec<String>> {
        let best: Vec<_> = best.iter().filter(|best| among(best, others)).collect();
        let mean = |of: fn(&Cell) -> Estimate| {
            best.iter().map(|best| of(&best.figures).value).sum::<f64>() / best.len() as f64
        };
        let label = if others { "(near others)" } else { kind };
        let cost = cost.filter(|_| !others);
        let mut row = vec![label.to_owned(), or_dash(cost, |cost| format!("{:.2}", cost.value))];
        row.extend(best.iter().map(|best| format!("{:.0}, {}", best.figures.mean_ms.value, t95(&best.figures))));
        row.push(format!("{:.1}", mean(|cell| cell.false_stops_per_min)));
        row.push(format!("{:.1}", mean(|cell| cell.blind)));
        (!best.is_empty()).then_some(row)
    };
    let header = ["way", "cost", "standing", "driving", "turning", "stops", "blind"];
    let both = |kind: &str, cost: Option<&Estimate>, best: &[JudgedWay]| {
        [row(kind, cost, best, false), row(kind, cost, best, true)]
    };
    let of_kind = |KindCost { kind, cost, best, .. }: &KindCost| both(kind, cost.as_ref(), best);
    let candidates = kinds.iter().filter(|kind| kind.is_candidate);
    let rows = both("baseline", None, baseline).into_iter().chain(candidates.flat_map(of_kind)).flatten();
    let title = |way: &JudgedWay| way.title.clone() + if way.has_program { "" } else { ", without quiet" };
    let titles = Vec::from_iter(BTreeSet::from_iter(baseline.iter().map(title)));
    format!(
        "\n{}\nms until what appears is seen: mean, t95 (95 of 100); {rooms} rooms each.\n\
         cost: mean relative to the baseline's ({}).\n\
         {speed_m_s} m/s, {turn_deg_s} degrees/s. stops: false, a minute. blind: right in under 5 %.\n",
        markdown(&header, rows),
        titles.join("; ")
    )
}

/// The conditions, each by itself, under which another kind is recommended.
fn depends_on(answer: &RoomsAnswer) -> String {
    let ours = answer.best.as_ref().map(|best| best.family.to_string());
    let differs = answer.elsewhere.iter().filter(|(_, kind)| *kind != ours);
    let words = |(condition, kind): &(String, Option<String>)| {
        let condition = condition.replace("_others", " beside another robot");
        format!("{condition}: {}", kind.as_deref().unwrap_or("none"))
    };
    let differs: Vec<_> = differs.map(words).collect();
    match differs.is_empty() {
        true => String::new(),
        false => format!("Where only one condition counts: {}.\n", differs.join("; ")),
    }
}

fn every_way(answer: &RoomsAnswer) -> String {
    let mut text = format!("\nRooms of version {VERSION}; each way with the votes that serve it best.\n");
    for assumed in &answer.assumed {
        _ = writeln!(text, "Assumed: {assumed}.");
    }
    let estimate = |Estimate { value, interval_95: [low, high] }: &Estimate, scale: f64, digits: usize| {
        let number = |value: &f64| format!("{:.digits$}", scale * value);
        format!("{} ({}..{})", number(value), number(low), number(high))
    };
    let header =
        ["condition", "way", "mean ms", "t95 ms", "never %", "stops/min", "foreign %", "right %", "right/s", "blind"];
    let row = |way: &JudgedWay| {
        let Cell { t95_ms, mean_ms, never, foreign, right, right_echoes_per_s, blind, .. } = &way.figures;
        let keeps = if way.keeps { "" } else { "!" };
        vec![
            way.condition.to_owned(),
            way.title.clone(),
            estimate(mean_ms, 1.0, 0),
            estimate(t95_ms, 1.0, 0),
            format!("{:.1}", 100.0 * never),
            stops(&way.figures) + keeps,
            estimate(foreign, 100.0, 2),
            estimate(right, 100.0, 1),
            format!("{:.1}", right_echoes_per_s.value),
            format!("{:.1}", blind.value),
        ]
    };
    _ = writeln!(text, "\n{}", markdown(&header, answer.ways.iter().map(row)));
    text.push_str(
        "mean: time until a thing is seen, a second at most. t95: by then 95 of 100 are seen; never: not within 5 s. \
         stops/min: false stops, ! for more than one where votes were chosen. foreign: share of time in which foreign \
         sound is believed and wrong. right: share of time with an echo in which the belief is right. right/s: right \
         echoes a second. blind: sensors that are right in under 5 % of firings. In brackets 95 % intervals over \
         rooms.\n",
    );
    let mut header = vec!["right %", "way"];
    header.extend(answer.ways.first().iter().flat_map(|way| &way.rooms).map(|(name, _)| name.as_str()));
    let of_first = answer.ways.iter().filter(|way| way.rooms.len() + 2 == header.len());
    let rows = of_first.map(|way| {
        let shares = way.rooms.iter().map(|(_, right)| or_dash(*right, |right| format!("{:.1}", 100.0 * right)));
        [way.condition.to_owned(), way.title.clone()].into_iter().chain(shares).collect()
    });
    _ = writeln!(text, "\n{}", markdown(&header, rows));
    text
}

/// Ways of firing in the JSON of `eeruf design`, or the reason why none was judged.
#[derive(Serialize)]
#[serde(untagged)]
pub(crate) enum RoomsOrNot<'a> {
    Judged(&'a RoomsAnswer),
    Not { not_judged: &'a str },
}

impl<'a> RoomsOrNot<'a> {
    pub(crate) fn of(judged: &'a Result<RoomsAnswer, String>) -> Self {
        match judged {
            Ok(answer) => Self::Judged(answer),
            Err(why) => Self::Not { not_judged: why },
        }
    }
}
