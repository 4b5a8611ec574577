//! Ways of firing judged in rooms, as text and as JSON.

use std::fmt::Write as _;

use eeruf_sim::experiments::rooms::{Condition, JudgedWay, Judgement, RoomFigures, VERSION};
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::table::markdown;

/// The answer under other conditions.
pub(crate) struct Elsewhere {
    pub(crate) condition: Condition,
    pub(crate) judgement: Judgement,
}

/// Ways of firing judged in rooms.
pub(crate) struct RoomsReport {
    /// The judgement, or why there is none.
    pub(crate) judgement: Result<Judgement, String>,
    /// Assumptions where the ring file is silent.
    pub(crate) assumed: Vec<String>,
    /// The names of groups of rooms, and how many rooms each has.
    pub(crate) groups: Vec<(String, usize)>,
    /// True if they are the caller's.
    pub(crate) own_rooms: bool,
    /// The robot's speed in m/s.
    pub(crate) speed_m_s: f64,
    /// The largest share of foreign sound, in per cent.
    pub(crate) wrong: f64,
    /// The number of the first room.
    pub(crate) first: u64,
    /// What it hangs on.
    pub(crate) elsewhere: Vec<Elsewhere>,
}

/// The ways that need nothing of ours.
const PLAIN: [&str; 5] = ["sequential", "sequential_votes", "simultaneous", "far_groups", "arrays"];

impl RoomsReport {
    pub(crate) fn not_judged(why: String) -> Self {
        Self {
            judgement: Err(why),
            assumed: vec![],
            groups: vec![],
            own_rooms: false,
            speed_m_s: 0.0,
            wrong: 0.0,
            first: 0,
            elsewhere: vec![],
        }
    }

    /// The recommended way and its table.
    pub(crate) fn text(&self, name: &str) -> String {
        let judgement = match &self.judgement {
            Ok(judgement) => judgement,
            Err(why) => return format!("{name}: not judged in rooms: {why}.\n\n"),
        };
        let mut text = self.verdict(name, judgement);
        text.push('\n');
        let rooms = match self.own_rooms {
            true => "the rooms named".to_owned(),
            false => {
                let each = self.groups.first().map_or(0, |group| group.1);
                format!("rooms of version {VERSION}, {each} of each kind from number {} on", self.first)
            }
        };
        let moves = if self.speed_m_s > 0.0 { format!("driving at {} m/s", self.speed_m_s) } else { "standing".into() };
        _ = writeln!(text, "In {rooms}; {moves}, {}.", condition(Condition::ALL[0]));
        for assumed in &self.assumed {
            _ = writeln!(text, "Assumed: {assumed}.");
        }
        let Some(base) = judgement.ways.first() else { return text };
        let header = ["way", "right %", "phantom %", "right echoes/s", "x one by one", "foreign %", "blind", "limits"];
        let row = |way: &JudgedWay| self.row(way, base);
        _ = writeln!(text, "\n{}", markdown(&header, judgement.ways.iter().map(row)));
        text.push_str(
            "right: share of time in which the last believed reading, at most 0.6 s old, is right within 0.5 ms (8.6 \
             cm); phantom: in which it is foreign sound. foreign, blind: share of foreign sound in what was believed, and \
             sensors that are right under 5 % of the time, in the median room of the worst kind. limits: the first kind \
             of room in which foreign sound exceeds its limit, or own wrong echoes those of one by one by a point, or \
             a sensor is blind that one by one is not.\n",
        );
        for way in &judgement.ways {
            if let Err(why) = &way.rooms {
                _ = writeln!(text, "{}: not possible: {why}.", way.way.name);
            }
        }
        let mut header = vec!["right %"];
        header.extend(self.groups.iter().map(|(name, _)| name.as_str()));
        let able = judgement.ways.iter().filter_map(|way| Some((way, way.rooms.as_ref().ok()?)));
        let rows = able.map(|(way, rooms)| {
            let shares = rooms.iter().map(|figures| format!("{:.1}", 100.0 * figures.belief.right));
            core::iter::once(way.way.name.to_owned()).chain(shares).collect()
        });
        _ = writeln!(text, "\n{}\n", markdown(&header, rows));
        text.push_str(&self.hangs_on(judgement));
        text
    }

    /// The sentence that answers.
    fn verdict(&self, name: &str, judgement: &Judgement) -> String {
        let (Some(way), Some(base)) = (way_of(judgement), judgement.ways.first()) else {
            return format!("{name}: no way of firing was possible for this ring.\n");
        };
        let right = |way: &JudgedWay| 100.0 * way.belief_right().unwrap_or(0.0);
        let title = if way.way.name == way.way.title() { String::new() } else { format!(" ({})", way.way.title()) };
        let mut text = format!("{name}: recommended: {}{title}, right {:.1} % of the time", way.way.name, right(way));
        match way.echoes_against(base).filter(|_| way != base) {
            Some(times) => {
                _ = writeln!(text, "; one by one {:.1} %, with 1/{times:.1} of its right echoes.", right(base));
            }
            None => text.push_str(".\n"),
        }
        if PLAIN.contains(&way.way.name) {
            text.push_str("You do not need eeruf here: no other way is right for a point more of the time.\n");
            let fast = judgement.ways.iter().filter(|way| way.fails_in(base, self.wrong / 100.0).is_none());
            let most = fast.filter_map(|way| Some((way, way.echoes_against(way_of(judgement)?)?)));
            if let Some((other, times)) = most.reduce(|one, next| if next.1 > one.1 { next } else { one }) {
                if times > 1.5 {
                    _ = writeln!(
                        text,
                        "For fresher readings: {} has {times:.1} times its right echoes and is right {:.1} % of the time.",
                        other.way.name,
                        right(other)
                    );
                }
            }
        }
        if !judgement.keeps {
            let wrong = self.wrong;
            _ = writeln!(
                text,
                "No way keeps foreign sound at {wrong} % of what is believed, and each sensor seeing, in every kind of \
                 room; this one is right most."
            );
        }
        if let Some(worst) = way.rooms.iter().flatten().map(|figures| figures.belief_right_worst).reduce(f64::min) {
            _ = writeln!(text, "In the worst room it is right {:.0} % of the time.", 100.0 * worst);
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
        let kept = match way.fails_in(base, self.wrong / 100.0).and_then(|index| self.groups.get(index)) {
            Some((room, _)) => format!("not in {room}"),
            None => "kept".to_owned(),
        };
        row.extend([
            format!("{:.1}", 100.0 * mean(|figures| figures.belief.right)),
            format!("{:.2}", 100.0 * mean(|figures| figures.belief.phantom)),
            format!("{:.1}", mean(|figures| figures.right_echoes_per_s)),
            way.echoes_against(base).map_or_else(|| "-".to_owned(), |times| format!("{times:.2}")),
            format!("{:.1}", 100.0 * most(|figures| figures.foreign_of_believed)),
            format!("{}", most(|figures| figures.blind)),
            kept,
        ]);
        row
    }

    /// What the answer hangs on.
    fn hangs_on(&self, here: &Judgement) -> String {
        let mut text = String::new();
        let chosen = way_of(here).map_or("", |way| way.way.name);
        let mut differs = false;
        for Elsewhere { condition: other, judgement } in &self.elsewhere {
            let Some(best) = way_of(judgement) else { continue };
            differs |= best.way.name != chosen;
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
        if text.is_empty() {
            return "Other gain and height: not judged, as the time was over.\n\n".to_owned();
        }
        let alone =
            here.without(|index| self.groups.get(index).is_some_and(|(name, _)| name == "meeting"), self.wrong / 100.0);
        if let Some(best) = alone.as_ref().and_then(way_of) {
            differs |= best.way.name != chosen;
            let right = 100.0 * best.belief_right().unwrap_or(0.0);
            let too = if best.way.name == chosen { " too" } else { "" };
            _ = writeln!(text, "- no other robot of the same make near: {}{too}, {right:.1} %.", best.way.name);
        }
        let title = match differs {
            true => "The answer depends on conditions; elsewhere the recommended way is:",
            false => "The answer is the same under other conditions:",
        };
        format!("{title}\n{text}\n")
    }

    /// `recommended` and `ways` of `--json`.
    pub(crate) fn json(&self) -> RoomsJson {
        let Ok(judgement) = &self.judgement else {
            return RoomsJson { not_judged: self.judgement.as_ref().err().cloned(), ..RoomsJson::default() };
        };
        let best = |judgement: &Judgement| way_of(judgement).map(|way| way.way.name.to_owned());
        let rooms_of = |way: &JudgedWay| {
            let named = self.groups.iter().zip(way.rooms.iter().flatten());
            named.map(|((name, _), figures)| (name.clone(), room_json(figures))).collect::<Map<_, _>>()
        };
        let way_json = |way: &JudgedWay| {
            let mut entry = json!({"way": way.way.name, "title": way.way.title(), "rooms": rooms_of(way)});
            if let (Some(entry), Err(why)) = (entry.as_object_mut(), &way.rooms) {
                entry.insert("not_possible".to_owned(), json!(why));
            }
            entry
        };
        let elsewhere = self.elsewhere.iter().map(|Elsewhere { condition, judgement }| {
            json!({"condition": condition, "recommended": best(judgement), "keeps": judgement.keeps,
                   "ways": judgement.ways.iter().map(way_json).collect::<Vec<_>>()})
        });
        RoomsJson {
            recommended: best(judgement),
            keeps: Some(judgement.keeps),
            assumed: self.assumed.clone(),
            ways: judgement.ways.iter().map(way_json).collect(),
            elsewhere: elsewhere.collect(),
            not_judged: None,
        }
    }
}

/// The recommended way.
fn way_of(judgement: &Judgement) -> Option<&JudgedWay> {
    judgement.recommended.and_then(|index| judgement.ways.get(index))
}

/// A room's figures, with the belief's shares by the names that they have in other tables.
fn room_json(figures: &RoomFigures) -> Value {
    serde_json::to_value(figures).unwrap_or(Value::Null)
}

/// Ways of firing, in the JSON of `eeruf design`.
#[derive(Default, Serialize)]
pub(crate) struct RoomsJson {
    /// The way to recommend.
    #[serde(skip_serializing_if = "Option::is_none")]
    recommended: Option<String>,
    /// True if it keeps to the shares asked for in each kind of room.
    #[serde(skip_serializing_if = "Option::is_none")]
    keeps: Option<bool>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    assumed: Vec<String>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    ways: Vec<Value>,
    /// Recommendations under other gain and height.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    elsewhere: Vec<Value>,
    /// Why nothing was judged.
    #[serde(skip_serializing_if = "Option::is_none")]
    not_judged: Option<String>,
}

/// A condition in words.
fn condition(condition: Condition) -> &'static str {
    match (condition.other_gain, condition.flat) {
        (false, false) => "the modules' own gain, between floor and ceiling",
        (true, false) => "the other gain (steps for constant, constant for rising), between floor and ceiling",
        (false, true) => "the modules' own gain, without floor and ceiling",
        (true, true) => "the other gain, without floor and ceiling",
    }
}
