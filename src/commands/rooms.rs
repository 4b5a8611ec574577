//! The ways of firing a ring, judged in rooms: the first part of `eeruf design`'s answer.

use std::ops::Range;
use std::path::{Path, PathBuf};

use eeruf_design::{CHOICE, RingDesign, RingSpec, RoomsAnswer, RoomsAsked, UnderCondition};
use eeruf_files::{FileError, Kind};
use eeruf_sim::experiments::measure::{
    Condition, Family, MeasureAsked, MeasuredWay, Moving, Speeds, measure, measured_ways,
};
use eeruf_sim::experiments::rooms::{RoomGroup, RoomWay};

use super::{Answer, show};
use crate::console::tell;
use crate::files::error::InputError;
use crate::files::map::read_map;
use crate::files::ring::read_ring;
use crate::files::toml::read_world;
use crate::report::rooms::{RoomsOrNot, describe, describe_all};
use crate::report::three::Three;
use crate::report::watch::Watch;

/// Options for judging ways of firing in rooms.
#[derive(clap::Args)]
pub(crate) struct RoomArgs {
    /// Judge ways of firing in these scenes and maps instead of the usual rooms: files, or folders of them. The
    /// ring takes the place of a scene's first robot, or stands at free --places of a map
    #[arg(long, value_name = "SCENE.toml|MAP.yaml|DIR")]
    rooms: Vec<PathBuf>,
    /// Number of rooms of each kind, and of places in each map; 6 by default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000))]
    places: Option<u64>,
    /// Number of the first room of each kind, or place in each map; 0 by default. Ways are chosen on numbers below
    /// 2000; report those from 20000 on
    #[arg(long, hide_short_help = true, value_name = "N")]
    #[arg(value_parser = clap::value_parser!(u64).range(..=1_000_000_000))]
    first: Option<u64>,
    /// The largest share of foreign sound among the accepted readings of a recommended way, in per cent; 3 by
    /// default
    #[arg(long, hide_short_help = true, value_name = "PERCENT", value_parser = percent)]
    wrong: Option<f64>,
    /// Let the robot drive through the rooms at the ring's speed_m_s, or 0.3 m/s
    #[arg(long, hide_short_help = true)]
    driving: bool,
}

fn percent(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=100.0).contains(number));
    number.ok_or_else(|| "expected a number from 0 to 100".to_owned())
}

impl RoomArgs {
    /// Returns the first of these options that was given, to refuse it for a file that is not a ring.
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
}

/// Measures a ring file's ways of firing, without its period: `eeruf study RING.toml`. With `all`, or in the user's own
/// rooms, it prints every way in every kind of room; with `cost`, it prints the cost of each kind of way.
pub(crate) fn study(args: &RoomArgs, file: &Path, as_json: bool, all: bool, cost: bool) -> Result<Answer, InputError> {
    let spec = read_ring(file)?;
    let watch = Watch::new();
    let design = spec.shortest_to_study().map_err(|error| InputError::new(file, error))?;
    let name = file.display().to_string();
    if as_json || all || cost || !args.rooms.is_empty() {
        let mut judged = judged(args, &spec, design.as_ref(), &watch)?;
        // In rooms of the user's own nothing appears.
        if let Some(answer) = judged.as_mut().ok().filter(|_| cost && args.rooms.is_empty()) {
            answer.by_cost =
                spec.cost_in_rooms(design.as_ref(), &asked(args, &spec)?, &|done| goes_on(&watch, done)).ok();
        }
        drop(watch);
        show(as_json, || RoomsOrNot::of(&judged), || describe(&name, &judged) + &describe_all(&judged))?;
        return Ok(if judged.is_ok() { Answer::Yes } else { Answer::No });
    }
    match three_ways(args, &spec, design.as_ref(), &watch)? {
        Ok(text) => tell(format!("{name}: {text}")).map(|()| Answer::Yes),
        Err(why) => tell(format!("{name}: not judged in rooms: {why}.\n")).map(|()| Answer::No),
    }
    .map_err(InputError::from)
}

/// Compares the recommended way with firing one by one in rooms; or gives the reason why there is none.
fn three_ways(
    args: &RoomArgs,
    spec: &RingSpec,
    design: Option<&RingDesign>,
    watch: &Watch,
) -> Result<Result<String, String>, InputError> {
    let asked = asked(args, spec)?;
    let found = spec.recommended_in_rooms(design, &asked, &|share| goes_on(watch, share));
    let robot = design.map_or(spec, |design| &design.spec).room_robot();
    let (best, robot) = match found.and_then(|best| Ok((best, robot?.robot))) {
        Ok((Some(best), robot)) => (best, robot),
        Ok((None, _)) => return Ok(Err("no way of firing is possible for this ring".to_owned())),
        Err(why) => return Ok(Err(why)),
    };
    let ways = measured_ways(&robot, design.map(|design| &design.schedule));
    let of_best = ways.iter().find(|way| way.way.name == best.name).map_or(Family::OneByOne, |way| way.family);
    let other = if of_best == Family::OneByOne { Family::Flow } else { of_best };
    let name = if of_best == Family::OneByOne { "flow" } else { best.name };
    let is_shown = |way: &MeasuredWay| way.family == Family::OneByOne || way.way.name == name;
    let ways: Vec<_> = ways.into_iter().filter(is_shown).map(|way| (way, None)).collect();
    let moving = if asked.driving { Moving::Driving } else { Moving::Standing };
    let speeds = Speeds { speed_m_s: spec.room_speed_m_s(), turn_rad_s: 0.0 };
    let measured = |first: u64| {
        let conditions = vec![Condition { moving, others: false }];
        let asked = MeasureAsked { conditions, first, places: asked.places, speeds };
        measure(&ways, &asked, &|share| goes_on(watch, share)).map_err(|error| error.to_string())
    };
    let both = measured(CHOICE).and_then(|chosen| Ok((chosen, measured(asked.first)?)));
    Ok(both.map(|(chosen, measured)| {
        let rooms = measured.under.first().map_or(0, |under| under.places.len());
        let moves = if asked.driving { "driving" } else { "standing" };
        let title = format!("{} sensors; in {rooms} rooms, {moves}, a thing appears.\n\n", spec.sensors);
        let is_recommended = Some(of_best != Family::OneByOne);
        let three = Three { chosen: &chosen, measured: &measured, other, is_recommended };
        title + &three.describe() + "`eeruf design` says how to get it, `--all` every way in every room.\n"
    }))
}

/// Judges the ways of firing a ring, with the schedule of two phases found for it; or gives the reason why it cannot.
pub(crate) fn judged(
    args: &RoomArgs,
    spec: &RingSpec,
    design: Option<&RingDesign>,
    watch: &Watch,
) -> Result<Result<RoomsAnswer, String>, InputError> {
    Ok(spec.judge_in_rooms(design, &asked(args, spec)?, &|share| goes_on(watch, share)))
}

/// The figures of the recommended way where the ring is used; none in the user's own rooms, where nothing appears.
pub(crate) fn conditions(
    args: &RoomArgs,
    spec: &RingSpec,
    judged: Option<&Result<RoomsAnswer, String>>,
    watch: &Watch,
) -> Result<Vec<UnderCondition>, InputError> {
    let best = judged.and_then(|judged| judged.as_ref().ok()?.judgement.best());
    let Some(best) = best.filter(|_| args.rooms.is_empty()) else { return Ok(vec![]) };
    Ok(spec.way_in_rooms(&best.way, &asked(args, spec)?, &|share| goes_on(watch, share)).unwrap_or_default())
}

/// The recommended way of firing a ring, by [`judged`]; or the reason why there is none.
pub(crate) fn recommended(
    args: &RoomArgs,
    spec: &RingSpec,
    design: &RingDesign,
    watch: &Watch,
) -> Result<Result<Option<RoomWay>, String>, InputError> {
    Ok(spec.recommended_in_rooms(Some(design), &asked(args, spec)?, &|share| goes_on(watch, share)))
}

fn asked(args: &RoomArgs, spec: &RingSpec) -> Result<RoomsAsked, InputError> {
    let default = RoomsAsked::default();
    let (places, first) = (args.places.unwrap_or(default.places), args.first.unwrap_or(default.first));
    // A ring without places is refused later, when it is judged.
    let radius_m = spec.room_robot().map_or(0.0, |robot| robot.robot.radius_m());
    Ok(RoomsAsked {
        own: own_rooms(&args.rooms, first..first.saturating_add(places), radius_m)?,
        places,
        first,
        driving: args.driving,
        wrong: args.wrong.map_or(default.wrong, |percent| percent / 100.0),
    })
}

fn goes_on(watch: &Watch, share: f64) -> bool {
    watch.go_on(|| format!("rooms: {:.0} % done", 100.0 * share))
}

/// Reads the named scenes and maps as rooms for a robot of this radius.
fn own_rooms(paths: &[PathBuf], numbers: Range<u64>, radius_m: f64) -> Result<Vec<RoomGroup>, InputError> {
    let mut files = vec![];
    for path in paths {
        if path.is_dir() {
            let bad = |error: std::io::Error| FileError::reading(path, &error);
            let entries = std::fs::read_dir(path).map_err(bad)?;
            let mut inside: Vec<_> =
                entries.map(|entry| entry.map(|entry| entry.path())).collect::<Result<_, _>>().map_err(bad)?;
            inside.retain(|file| file.extension().is_some_and(|ending| ending == "toml") || is_map(file));
            inside.sort();
            if inside.is_empty() {
                return Err(InputError::new(path, "no file that ends in .toml, and no map; expected scenes or maps"));
            }
            files.extend(inside);
        } else {
            files.push(path.clone());
        }
    }
    let room = |(file, number): (&PathBuf, u64)| {
        if !is_map(file) {
            let room = RoomGroup::of_world(name_of(file), number, &read_world(file)?);
            return room.ok_or_else(|| InputError::new(file, "no robot; expected one, for the ring's place"));
        }
        let grid = read_map(file)?;
        let group = RoomGroup::of_map(name_of(file), &grid, numbers.clone(), radius_m);
        group.map_err(|error| InputError::new(file, error))
    };
    files.iter().zip(0..).map(room).collect()
}

fn is_map(file: &Path) -> bool {
    Kind::of_file(file) == Some(Kind::Map)
}

/// Returns a file's name in tables.
fn name_of(file: &Path) -> String {
    file.file_stem().map_or_else(|| file.display().to_string(), |stem| stem.to_string_lossy().into_owned())
}
