//! The ways of firing a ring, judged in rooms: the first part of `eeruf design`'s answer.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use eeruf_design::{RingDesign, RingSpec, RoomsAnswer, RoomsAsked};
use eeruf_files::{FileError, Kind};
use eeruf_sim::experiments::rooms::{RoomGroup, RoomWay};

use super::{Answer, show};
use crate::files::error::InputError;
use crate::files::map::read_map;
use crate::files::ring::read_ring;
use crate::files::toml::read_world;
use crate::report::rooms::{RoomsOrNot, describe};
use crate::report::watch::Watch;

/// Options for judging ways of firing in rooms.
#[derive(clap::Args)]
pub(crate) struct RoomArgs {
    /// Judge ways of firing in these scenes and maps instead of the rooms of the set: files, or folders of them. The
    /// ring stands where the scene's first robot does, and at --places of a map that are free
    #[arg(long, value_name = "SCENE.toml|MAP.yaml|DIR")]
    rooms: Vec<PathBuf>,
    /// Number of rooms of each kind, and of places in each map; 6 by default
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000))]
    places: Option<u64>,
    /// Number of the first room of each kind, or place in each map; 0 by default. Ways are chosen on numbers below
    /// 2000; report those from 20000 on
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
}

/// Judges a ring file without a word of its period: `eeruf study RING.toml`.
pub(crate) fn study(args: &RoomArgs, file: &Path, as_json: bool) -> Result<Answer, InputError> {
    let spec = read_ring(file)?;
    let mut watch = Watch::new();
    let design = spec.shortest_to_study().map_err(|error| InputError::new(file, error))?;
    let judged = judged(args, &spec, design.as_ref(), &mut watch)?;
    drop(watch);
    show(as_json, || RoomsOrNot::of(&judged), || describe(&file.display().to_string(), &judged))?;
    Ok(if judged.is_ok() { Answer::Yes } else { Answer::No })
}

/// Judges the ways of firing a ring, with the schedule of two phases that was found for it; or says why that cannot be
/// done.
pub(crate) fn judged(
    args: &RoomArgs,
    spec: &RingSpec,
    design: Option<&RingDesign>,
    watch: &mut Watch,
) -> Result<Result<RoomsAnswer, String>, InputError> {
    let asked = asked(args, spec)?;
    let watch = Mutex::new(watch);
    Ok(spec.judge_in_rooms(design, &asked, &|share| goes_on(&watch, share)))
}

/// The way of firing a ring to recommend, as [`judged`] finds it; or why that cannot be said.
pub(crate) fn recommended(
    args: &RoomArgs,
    spec: &RingSpec,
    design: &RingDesign,
    watch: &mut Watch,
) -> Result<Result<Option<RoomWay>, String>, InputError> {
    let asked = asked(args, spec)?;
    let watch = Mutex::new(watch);
    Ok(spec.recommended_in_rooms(Some(design), &asked, &|share| goes_on(&watch, share)))
}

fn asked(args: &RoomArgs, spec: &RingSpec) -> Result<RoomsAsked, InputError> {
    let default = RoomsAsked::default();
    let (places, first) = (args.places.unwrap_or(default.places), args.first.unwrap_or(default.first));
    // A ring without places is refused where it is judged.
    let radius_m = spec.room_robot().map_or(0.0, |robot| robot.robot.radius_m());
    Ok(RoomsAsked {
        own: own_rooms(&args.rooms, first..first.saturating_add(places), radius_m)?,
        places,
        first,
        driving: args.driving,
        wrong: args.wrong.map_or(default.wrong, |percent| percent / 100.0),
    })
}

fn goes_on(watch: &Mutex<&mut Watch>, share: f64) -> bool {
    let mut watch = watch.lock().unwrap_or_else(PoisonError::into_inner);
    watch.go_on(|| format!("rooms: {:.0} % done", 100.0 * share))
}

/// The scenes and maps that were named, as rooms for a robot of this radius.
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

/// A file's name in tables.
fn name_of(file: &Path) -> String {
    file.file_stem().map_or_else(|| file.display().to_string(), |stem| stem.to_string_lossy().into_owned())
}
