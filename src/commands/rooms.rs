//! The ways of firing a ring, judged in rooms: the first part of `eeruf design`'s answer.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use eeruf_design::atlas::ATLAS;
use eeruf_design::{RingDesign, RingSpec, Search};
use eeruf_sim::experiments::ExperimentError;
use eeruf_sim::experiments::rooms::{
    Condition, DRIVING_S, RoomGroup, RoomKind, RoomPlan, RoomWay, RoomsOptions, judge,
};

use super::answer::Answer;
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::files::ring::read_ring;
use crate::files::toml::read_world;
use crate::report::json::to_json;
use crate::report::rooms::{Elsewhere, RoomsReport};
use crate::report::watch::Watch;

/// Options for judging ways of firing in rooms.
#[derive(clap::Args)]
pub(crate) struct RoomArgs {
    /// Judge ways of firing in these scenes instead of the rooms of the set: files, or folders of them. The ring stands
    /// where the scene's first robot does
    #[arg(long, value_name = "SCENE.toml|DIR")]
    rooms: Vec<PathBuf>,
    /// The number of rooms of each kind; 6 by default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000))]
    places: Option<u64>,
    /// The number of the first room of each kind; 0 by default. Ways are chosen on numbers below 2000; report from 20000
    /// on
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=1_000_000_000))]
    first: Option<u64>,
    /// The largest share of foreign sound in what is believed, in per cent, of a way that is recommended; 3 by
    /// default
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    wrong: Option<f64>,
    /// Let the robot drive through the rooms at the ring's speed_m_s, or 0.3 m/s
    #[arg(long)]
    driving: bool,
}

fn percent(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=100.0).contains(number));
    number.ok_or_else(|| "expected a number from 0 to 100".to_owned())
}

/// The speed of a robot whose ring file has none, in m/s: a choice.
const USUAL_SPEED_M_S: f64 = 0.3;
/// One room in so many is looked at under the other conditions.
const LESS_ELSEWHERE: usize = 3;

impl RoomArgs {
    /// Returns the first option that was given, for a file that is no ring.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let given = [
            ("--rooms", !self.rooms.is_empty()),
            ("--places", self.places.is_some()),
            ("--first", self.first.is_some()),
            ("--wrong", self.wrong.is_some()),
            ("--driving", self.driving),
        ];
        given.into_iter().find(|(_, given)| *given).map(|(name, _)| name)
    }

    fn first(&self) -> u64 {
        self.first.unwrap_or(0)
    }

    fn wrong_percent(&self) -> f64 {
        self.wrong.unwrap_or(3.0)
    }
}

/// Nodes for the schedule of two phases of `eeruf study RING.toml`.
const STUDY_BUDGET: u64 = 200_000;

/// Judges a ring file without a word of its period: `eeruf study RING.toml`.
pub(crate) fn study(args: &RoomArgs, file: &Path, as_json: bool) -> Result<Answer, InputError> {
    let spec = read_ring(file)?;
    let mut watch = Watch::new();
    let search = Search { budget: STUDY_BUDGET, what_if: false, atlas: ATLAS };
    let design = spec.shortest(&search, &mut ()).map_err(|error| InputError::new(file, None, error))?;
    let report = judged(args, &spec, design.as_ref().ok(), &mut watch)?;
    drop(watch);
    match as_json {
        true => print_line(to_json(&report.json()))?,
        false => tell(report.text(&file.display().to_string()))?,
    }
    Ok(if report.judgement.is_ok() { Answer::Yes } else { Answer::No })
}

/// Judges the ways of firing a ring, with the schedule of two phases that was found for it; or says why that cannot be
/// done.
pub(crate) fn judged(
    args: &RoomArgs,
    spec: &RingSpec,
    design: Option<&RingDesign>,
    watch: &mut Watch,
) -> Result<RoomsReport, InputError> {
    // With the T_delta that the schedule needs where the robot moves.
    let spec = design.map_or(spec, |design| &design.spec);
    let robot = match spec.room_robot() {
        Ok(robot) => robot,
        Err(why) => return Ok(RoomsReport::not_judged(why)),
    };
    let speed_m_s = spec.speed_mm_s.filter(|&mm| mm > 0).map_or(USUAL_SPEED_M_S, |mm| f64::from(mm) / 1e3);
    let asked = RoomsOptions {
        speed_m_s: if args.driving { speed_m_s } else { 0.0 },
        wrong: args.wrong_percent() / 100.0,
        ..RoomsOptions::default()
    };
    let groups = groups(args, robot.robot.radius_m())?;
    let ways = RoomWay::all(&robot.robot, design.map(|design| &design.schedule));
    let watch = Mutex::new(watch);
    let judge = |ways: &[RoomWay], groups: &[RoomGroup], asked: &RoomsOptions, of: &str| {
        judge(ways, groups, asked, &|share| {
            let mut watch = watch.lock().unwrap_or_else(PoisonError::into_inner);
            watch.go_on(|| format!("{of}: {:.0} % done", 100.0 * share))
        })
    };
    let judgement = match judge(&ways, &groups, &asked, "rooms") {
        Ok(judgement) => judgement,
        Err(ExperimentError::Stopped) => {
            return Ok(RoomsReport::not_judged("the time was over before the rooms were judged".to_owned()));
        }
        Err(error) => return Ok(RoomsReport::not_judged(error.to_string())),
    };
    let fewer: Vec<_> = groups
        .iter()
        .map(|group| RoomGroup {
            name: group.name.clone(),
            rooms: group.rooms.iter().step_by(LESS_ELSEWHERE).cloned().collect(),
        })
        .collect();
    let mut elsewhere = vec![];
    for condition in &Condition::ALL[1..] {
        let asked = RoomsOptions { condition: *condition, ..asked.clone() };
        match judge(&ways, &fewer, &asked, "other gain and height") {
            Ok(judgement) => elsewhere.push(Elsewhere { condition: *condition, judgement }),
            // What is left out, the report says.
            Err(_) => break,
        }
    }
    Ok(RoomsReport {
        judgement: Ok(judgement),
        assumed: robot.assumed,
        groups: groups.into_iter().map(|group| (group.name, group.rooms.len())).collect(),
        own_rooms: !args.rooms.is_empty(),
        speed_m_s: asked.speed_m_s,
        wrong: args.wrong_percent(),
        first: args.first(),
        elsewhere,
    })
}

/// The rooms of the set, or the scenes that were named.
fn groups(args: &RoomArgs, radius_m: f64) -> Result<Vec<RoomGroup>, InputError> {
    if args.rooms.is_empty() {
        let numbers = args.first()..args.first() + args.places.unwrap_or(6);
        return Ok(RoomKind::ALL.map(|kind| RoomGroup::of_kind(kind, numbers.clone(), radius_m)).into());
    }
    let mut files = vec![];
    for path in &args.rooms {
        if path.is_dir() {
            let bad = |error: std::io::Error| InputError::new(path, None, error);
            let entries = std::fs::read_dir(path).map_err(bad)?;
            let mut inside: Vec<_> =
                entries.map(|entry| entry.map(|entry| entry.path())).collect::<Result<_, _>>().map_err(bad)?;
            inside.retain(|file| file.extension().is_some_and(|ending| ending == "toml"));
            inside.sort();
            if inside.is_empty() {
                return Err(InputError::new(path, None, "no file that ends in .toml; expected scenes"));
            }
            files.extend(inside);
        } else {
            files.push(path.clone());
        }
    }
    files.iter().zip(0..).map(|(file, number)| scene(file, number)).collect()
}

/// A scene as a room.
fn scene(file: &Path, number: u64) -> Result<RoomGroup, InputError> {
    let world = read_world(file)?;
    let robot = world
        .robots()
        .first()
        .ok_or_else(|| InputError::new(file, None, "no robot; expected one, for the ring's place"))?;
    // As far as the scene's robot drives in that time.
    let way_m = robot.motion.at(&robot.pose, DRIVING_S).pose.translation.vector - robot.pose.translation.vector;
    let scene = world.scene();
    let plan = RoomPlan::own(number, scene.walls().to_vec(), scene.poles().to_vec(), robot.pose, way_m.norm());
    let name = file.file_stem().map_or_else(|| file.display().to_string(), |stem| stem.to_string_lossy().into_owned());
    Ok(RoomGroup { name, rooms: vec![plan] })
}
