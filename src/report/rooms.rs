//! Ways of firing judged in rooms, as text and as JSON.

use std::fmt::Write as _;

use eeruf_design::{RoomsAnswer, RoomsJson};
use eeruf_sim::experiments::rooms::{Condition, JudgedWay, Judgement, RoomFigures, VERSION};
use serde::Serialize;

use super::table::{markdown, or_dash};

/// The recommended way, or the reason why there is none.
pub(crate) fn describe(name: &str, judged: &Result<RoomsAnswer, String>) -> String {
    match judged {
        Ok(answer) => Described { answer, judgement: &answer.judgement }.verdict(name),
        Err(why) => format!("{name}: not judged in rooms: {why}.\n"),
    }
}

/// Every way in every kind of room, and under other conditions.
pub(crate) fn describe_all(judged: &Result<RoomsAnswer, String>) -> String {
    let text = |answer| Described { answer, judgement: &answer.judgement }.text();
    judged.as_ref().map_or_else(|_| String::new(), text)
}

/// Lists the conditions under which another way is recommended.
pub(crate) fn describe_elsewhere(judged: &Result<RoomsAnswer, String>) -> String {
    let text = |answer| Described { answer, judgement: &answer.judgement }.depends_on(false);
    judged.as_ref().map_or_else(|_| String::new(), text)
}

struct Described<'a> {
    answer: &'a RoomsAnswer,
    judgement: &'a Judgement,
}

/// The ways that need no library of ours.
const PLAIN: [&str; 6] =
    ["sequential", "sequential_votes", "sequential_median", "simultaneous", "far_groups", "arrays"];

impl Described<'_> {
    fn text(&self) -> String {
        let RoomsAnswer { groups, assumed, speed_m_s, .. } = self.answer;
        let judgement = self.judgement;
        let mut text = "\n".to_owned();
        let rooms = groups.iter().map(|(_, rooms)| rooms).sum::<usize>();
        let moves = if *speed_m_s > 0.0 { format!("driving at {speed_m_s} m/s") } else { "standing".into() };
        _ = writeln!(text, "In {rooms} rooms (version {VERSION}); {moves}, {}.", condition(Condition::ALL[0]));
        for assumed in assumed {
            _ = writeln!(text, "Assumed: {assumed}.");
        }
        let Some(base) = judgement.ways.first() else { return text };
        let header = ["way", "right %", "phantom %", "echoes/s", "times", "foreign %", "blind", "limits"];
        let row = |way: &JudgedWay| self.row(way, base);
        _ = writeln!(text, "\n{}", markdown(&header, judgement.ways.iter().map(row)));
        text.push_str(
            "right: share of time in which the last believed reading, at most 0.6 s old, is right within 0.5 ms \
             (8.6 cm); phantom: in which it is foreign sound. echoes/s: accepted and right, all sensors together; \
             times: the same as a multiple of one by one's. foreign, blind: share of foreign sound in what was \
             believed, and sensors that are right under 5 % of the time, in the median room of the worst kind. limits: \
             the first kind of room in which foreign sound exceeds its limit, or own wrong echoes those of one by one \
             by a point, or a sensor is blind that one by one is not.\n",
        );
        for way in &judgement.ways {
            if let Err(why) = &way.rooms {
                _ = writeln!(text, "{}: not possible: {why}.", way.way.name);
            }
        }
        let mut header = vec!["right %"];
        header.extend(groups.iter().map(|(name, _)| name.as_str()));
        let able = judgement.ways.iter().filter_map(|way| Some((way, way.rooms.as_ref().ok()?)));
        let rows = able.map(|(way, rooms)| {
            let shares = rooms.iter().map(|figures| format!("{:.1}", 100.0 * figures.belief.right));
            core::iter::once(way.way.name.to_owned()).chain(shares).collect()
        });
        _ = writeln!(text, "\n{}\n", markdown(&header, rows));
        text.push_str(&self.depends_on(true));
        text.push_str(&self.answer.by_cost.as_ref().map_or(String::new(), super::cost::describe));
        text
    }

    /// Writes the answer in one sentence.
    fn verdict(&self, name: &str) -> String {
        let judgement = self.judgement;
        let (Some(way), Some(base)) = (judgement.best(), judgement.ways.first()) else {
            return format!("{name}: no way of firing was possible for this ring.\n");
        };
        let right = |way: &JudgedWay| 100.0 * way.belief_right().unwrap_or(0.0);
        let echoes = |way: &JudgedWay| {
            let rooms = way.rooms.as_ref().map_or(&[][..], Vec::as_slice);
            rooms.iter().map(|figures| figures.right_echoes_per_s).sum::<f64>() / rooms.len().max(1) as f64
        };
        let title = if way.way.name == way.way.title() { String::new() } else { format!(" ({})", way.way.title()) };
        let mut text = format!("{name}: recommended: {}{title}, right {:.1} % of the time", way.way.name, right(way));
        _ = writeln!(text, ", {:.0} right echoes a second.", echoes(way));
        if way != base {
            _ = writeln!(text, "One by one: {:.1} % and {:.0}.", right(base), echoes(base));
            if let Some((times, [low, high])) = way.echoes_against(base).zip(way.times_95) {
                let name = way.way.name;
                _ = writeln!(
                    text,
                    "By kinds of rooms, {name} has {times:.2} times its right echoes ({low:.2} to {high:.2})."
                );
            }
        }
        if PLAIN.contains(&way.way.name) {
            text.push_str("You do not need eeruf here: no other way is right for a point more of the time.\n");
            let fast = judgement.ways.iter().filter(|way| way.fails_in(base, self.answer.wrong).is_none());
            let most = fast.filter_map(|way| Some((way, way.echoes_against(judgement.best()?)?)));
            let most = most.reduce(|one, next| if next.1 > one.1 { next } else { one });
            if let Some((other, times)) = most.filter(|(_, times)| *times > 1.5) {
                _ = writeln!(
                    text,
                    "For fresher readings: {} has {times:.1} times its right echoes, and is right {:.1} % of the time.",
                    other.way.name,
                    right(other)
                );
            }
        }
        if !judgement.keeps {
            let wrong = 100.0 * self.answer.wrong;
            _ = writeln!(
                text,
                "No way keeps foreign sound at {wrong} % of what is believed, and each sensor seeing, in every kind of \
                 room; this one is right most."
            );
        }
        if let Some(worst) = way.rooms.iter().flatten().map(|figures| figures.belief_right_worst).reduce(f64::min) {
            _ = writeln!(text, "In the worst room it is right {:.0} % of the time.", 100.0 * worst);
        }
        let [least, most] = way.blind_90;
        if most > 0.0 {
            let to = if least < most { format!("{least} to {most}") } else { most.to_string() };
            let sensors = way.way.robot.sensors.len();
            _ = writeln!(text, "In 9 of 10 rooms {to} of its {sensors} sensors are blind.");
        } else {
            text.push_str("In 9 of 10 rooms none of its sensors is blind.\n");
        }
        text
    }

    fn row(&self, way: &JudgedWay, base: &JudgedWay) -> Vec<String> {
        let mut row = vec![way.way.name.to_owned()];
        let Ok(rooms) = &way.rooms else {
            row.extend(core::iter::repeat_n("-".to_owned(), 7));
            return row;
        };
        let mean = |of: fn(&RoomFigures) -> f64| rooms.iter().map(of).sum::<f64>() / rooms.len() as f64;
        let most = |of: fn(&RoomFigures) -> f64| rooms.iter().map(of).fold(0.0, f64::max);
        let kept = match way.fails_in(base, self.answer.wrong).and_then(|index| self.answer.groups.get(index)) {
            Some((room, _)) => format!("not in {room}"),
            None => "kept".to_owned(),
        };
        row.extend([
            format!("{:.1}", 100.0 * mean(|figures| figures.belief.right)),
            format!("{:.2}", 100.0 * mean(|figures| figures.belief.phantom)),
            format!("{:.1}", mean(|figures| figures.right_echoes_per_s)),
            or_dash(way.echoes_against(base), |times| format!("{times:.2}")),
            format!("{:.1}", 100.0 * most(|figures| figures.foreign_of_believed)),
            format!("{}", most(|figures| figures.blind)),
            kept,
        ]);
        row
    }

    /// Lists recommendations under other conditions; without `all` only those that differ.
    fn depends_on(&self, all: bool) -> String {
        let here = self.judgement;
        let mut text = String::new();
        let chosen = here.best().map_or("", |way| way.way.name);
        let (mut differs, mut judged) = (false, false);
        for (other, judgement) in &self.answer.elsewhere {
            let Some(best) = judgement.best() else { continue };
            differs |= best.way.name != chosen;
            judged = true;
            if best.way.name == chosen && !all {
                continue;
            }
            let right = |way: &JudgedWay| format!("{:.1} %", 100.0 * way.belief_right().unwrap_or(0.0));
            let ours = judgement.ways.iter().find(|way| way.way.name == chosen).map(right);
            let kept = if judgement.keeps { "" } else { "; none keeps to the shares asked for" };
            _ = match best.way.name == chosen {
                true => writeln!(text, "- {}: {chosen} too, {}{kept}.", condition(*other), right(best)),
                false => writeln!(
                    text,
                    "- {}: {}, {}; {chosen} {}{kept}.",
                    condition(*other),
                    best.way.name,
                    right(best),
                    ours.unwrap_or_default()
                ),
            };
        }
        if !judged {
            return "Other gain and height: not judged, as the time was over.\n".to_owned();
        }
        let alone = here.without(
            |index| self.answer.groups.get(index).is_some_and(|(name, _)| name == "meeting"),
            self.answer.wrong,
        );
        if let Some(best) = alone.as_ref().and_then(Judgement::best).filter(|best| all || best.way.name != chosen) {
            differs |= best.way.name != chosen;
            let right = 100.0 * best.belief_right().unwrap_or(0.0);
            let too = if best.way.name == chosen { " too" } else { "" };
            _ = writeln!(text, "- no other robot of the same make near: {}{too}, {right:.1} %.", best.way.name);
        }
        let title = match differs {
            true => "The answer depends on conditions; elsewhere the recommended way is:",
            false if !all => "The answer is the same with another gain, no floor and ceiling, and no other robot.",
            false => "The answer is the same under other conditions:",
        };
        format!("{title}\n{text}")
    }
}

/// Ways of firing in the JSON of `eeruf design`, or the reason why none was judged.
#[derive(Serialize)]
#[serde(untagged)]
pub(crate) enum RoomsOrNot<'a> {
    Judged(RoomsJson<'a>),
    Not { not_judged: &'a str },
}

impl<'a> RoomsOrNot<'a> {
    pub(crate) fn of(judged: &'a Result<RoomsAnswer, String>) -> Self {
        match judged {
            Ok(answer) => Self::Judged(answer.json()),
            Err(why) => Self::Not { not_judged: why },
        }
    }
}

/// Returns the words for a condition.
fn condition(condition: Condition) -> &'static str {
    match (condition.other_gain, condition.flat) {
        (false, false) => "the modules' own gain, between floor and ceiling",
        (true, false) => "the other gain (steps for constant, constant for rising), between floor and ceiling",
        (false, true) => "the modules' own gain, without floor and ceiling",
        (true, true) => "the other gain, without floor and ceiling",
    }
}
