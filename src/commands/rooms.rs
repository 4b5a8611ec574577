//! The ways of firing a ring, judged in rooms: the first part of `eeruf design`'s answer.

use std::ops::Range;
use std::path::{Path, PathBuf};

use eeruf_design::{RingDesign, RingSpec, RoomsAnswer, RoomsAsked};
use eeruf_files::{FileError, Kind};
use eeruf_sim::experiments::rooms::RoomGroup;

use super::{Answer, show};
use crate::files::error::InputError;
use crate::files::implausible::warn;
use crate::files::map::read_map;
use crate::files::ring::read_ring;
use crate::files::toml::read_world;
use crate::report::rooms::{RoomsOrNot, describe, describe_all};
use crate::report::watch::Watch;

/// Options for judging ways of firing in rooms.
#[derive(clap::Args)]
pub(crate) struct RoomArgs {
    /// Judge in these scenes and maps, or folders of them, instead of the usual rooms: the ring takes the place of a
    /// scene's first robot, or stands at free --places of a map
    #[arg(long, value_name = "SCENE.toml|MAP.yaml|DIR")]
    rooms: Vec<PathBuf>,
    /// Number of rooms of each kind, and of places in each map; 6 by default
    #[arg(long, hide_short_help = true, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1000))]
    places: Option<u64>,
    /// Number of the first room of each kind, or place in each map; 0 by default. Ways are chosen on numbers below
    /// 2000; report those from 20000 on
    #[arg(long, hide_short_help = true, value_name = "N")]
    #[arg(value_parser = clap::value_parser!(u64).range(..=1_000_000_000))]
    first: Option<u64>,
    /// Without effect; none by default
    #[arg(long, hide = true, value_name = "PERCENT")]
    wrong: Option<String>,
    /// Without effect
    #[arg(long, hide = true)]
    driving: bool,
}

impl RoomArgs {
    /// Returns the first of these options that was given, to refuse it for a file that is not a ring.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let given = [
            ("--rooms", !self.rooms.is_empty()),
            ("--places", self.places.is_some()),
            ("--first", self.first.is_some()),
        ];
        given.into_iter().chain(self.without_effect()).find(|(_, given)| *given).map(|(name, _)| name)
    }

    fn without_effect(&self) -> [(&'static str, bool); 2] {
        [("--wrong", self.wrong.is_some()), ("--driving", self.driving)]
    }
}

/// Judges a ring file's ways of firing, without a word of its period: `eeruf study RING.toml`. With `all` or rooms of
/// the user's own it prints every way under each condition.
pub(crate) fn study(args: &RoomArgs, file: &Path, as_json: bool, all: bool) -> Result<Answer, InputError> {
    let spec = read_ring(file)?;
    let watch = Watch::new();
    let design = spec.shortest_to_study().map_err(|error| InputError::new(file, error))?;
    let all = all || !args.rooms.is_empty();
    let judged = judged(args, &spec, design.as_ref(), all, &watch)?;
    drop(watch);
    let name = file.display().to_string();
    let more = || match (&judged, all) {
        (Ok(_), false) => "`eeruf design` says how to get it, `--all` every way.\n".to_owned(),
        _ => describe_all(&judged),
    };
    show(as_json, || RoomsOrNot::of(&judged), || describe(&name, &judged) + &more())?;
    Ok(if judged.is_ok() { Answer::Yes } else { Answer::No })
}

/// Judges the ways of firing a ring, with the schedule of two phases that was found for it; or says why that cannot be
/// done.
pub(crate) fn judged(
    args: &RoomArgs,
    spec: &RingSpec,
    design: Option<&RingDesign>,
    all: bool,
    watch: &Watch,
) -> Result<Result<RoomsAnswer, String>, InputError> {
    for (name, _) in args.without_effect().into_iter().filter(|(_, given)| *given) {
        let used = "a ring is judged standing, driving and turning, as its file says it is used";
        warn(InputError::new(name, format!("no effect; {used}")))?;
    }
    let default = RoomsAsked::default();
    let (places, first) = (args.places.unwrap_or(default.places), args.first.unwrap_or(default.first));
    // A ring without places is refused later, when it is judged.
    let radius_m = spec.room_robot().map_or(0.0, |robot| robot.robot.radius_m());
    let own = own_rooms(&args.rooms, first..first.saturating_add(places), radius_m)?;
    Ok(spec.judge_in_rooms(design, &RoomsAsked { own, places, first, all }, &|share| goes_on(watch, share)))
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
