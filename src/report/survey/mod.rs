//! Result of a survey: as text, as JSON, as a ring file, as a picture.

mod compared;
mod picture;
mod ring;
mod text;

use std::path::Path;

use eeruf_logs::{FiringLog, FoundPath, Surveyed};
use serde::Serialize;

use crate::files::survey::TruePath;
pub(crate) use compared::Scenes;
use compared::{Compared, compare};
pub(crate) use picture::who_hears_whom;
pub(crate) use ring::{FROM, RingTerms, ring_file};
pub(crate) use text::describe;

/// A survey's log and its result.
pub(crate) struct SurveyReport<'a> {
    pub(crate) file: &'a Path,
    pub(crate) log: &'a FiringLog,
    pub(crate) surveyed: &'a Surveyed,
    /// Sensors that hear each other within this time are neighbours.
    pub(crate) until_us: u32,
    pub(crate) speed_of_sound: f64,
    /// The true paths of a simulated survey, and the name of the physics.
    pub(crate) truth: Option<(&'a [TruePath], &'a str)>,
}

impl SurveyReport<'_> {
    fn length_m(&self, path: &FoundPath) -> f64 {
        1e-6 * path.travel_us * self.speed_of_sound
    }

    /// All ordered pairs, by sender.
    fn pairs(&self) -> impl Iterator<Item = (u8, u8)> + use<> {
        let sensors = self.surveyed.sensors as u8;
        (0..sensors).flat_map(move |x| (0..sensors).filter(move |&y| y != x).map(move |y| (x, y)))
    }

    fn slots(&self) -> usize {
        let mut slots: Vec<_> = self.log.firings.iter().map(|firing| firing.period).collect();
        slots.sort_unstable();
        slots.dedup();
        slots.len()
    }
}

/// Output of `--json`; sensors from 0.
#[derive(Serialize)]
pub(crate) struct Json {
    sensors: usize,
    clock: String,
    slots: usize,
    paths: Vec<PathJson>,
    /// `[x, y, us]`: pairs that hear each other within `until_us`, and the longest travel time within it.
    conflicts: Vec<(u8, u8, f64)>,
    until_us: u32,
    edges: u32,
    unexplained: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    physics: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    truth: Option<Compared>,
}

#[derive(Serialize)]
struct PathJson {
    sender: u8,
    receiver: u8,
    travel_us: f64,
    travel_error_us: f64,
    length_m: f64,
    scatter_us: f64,
    /// Number of offsets at which the path was heard, and of all.
    offsets: (u32, u32),
    readings: u32,
    heard: f64,
    /// Expected number of accidental paths with as much support.
    accidents: f64,
}

pub(crate) fn json(found: &SurveyReport<'_>) -> Json {
    let path = |path: &FoundPath| PathJson {
        sender: path.sender,
        receiver: path.receiver,
        travel_us: path.travel_us,
        travel_error_us: path.travel_error_us,
        length_m: found.length_m(path),
        scatter_us: path.scatter_us,
        offsets: path.offsets,
        readings: path.readings,
        heard: path.heard,
        accidents: path.accidents,
    };
    Json {
        sensors: found.surveyed.sensors,
        clock: found.log.clock.clone(),
        slots: found.slots(),
        paths: found.surveyed.paths.iter().map(path).collect(),
        conflicts: found.surveyed.conflicts(found.until_us),
        until_us: found.until_us,
        edges: found.surveyed.edges.0,
        unexplained: found.surveyed.edges.1,
        physics: found.truth.map(|(_, physics)| physics.to_owned()),
        truth: found.truth.map(|(truth, _)| compare(found, truth)),
    }
}
