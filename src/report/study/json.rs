//! A study as JSON.

use std::path::Path;

use eeruf_files::{AnySchedule, as_file};
use eeruf_sim::{Cause, Method, Readings, SensorId, Summary, World};
use serde::Serialize;

use super::found::{Study, TOLERANCE_US, of_robot};
use crate::report::bounces::wall_numbers;
use crate::report::json::in_order;

/// Output of `--json`. Shares are fractions of 1; robots, sensors and walls from 0.
#[derive(Serialize)]
pub(crate) struct StudyJson<'a> {
    scene: String,
    seed: u64,
    periods: u32,
    #[serde(serialize_with = "in_order")]
    methods: Vec<(Method, MethodJson)>,
    #[serde(serialize_with = "in_order")]
    left_out: Vec<(Method, &'a str)>,
    #[serde(skip_serializing_if = "Option::is_none")]
    best: Option<BestJson>,
}

#[derive(Serialize)]
struct MethodJson {
    /// All robots together.
    #[serde(flatten)]
    summary: Summary,
    duration_s: f64,
    robots: Vec<Summary>,
    fooled: Vec<FooledJson>,
}

#[derive(Serialize)]
struct BestJson {
    #[serde(serialize_with = "as_file::serialize")]
    schedule: AnySchedule,
    proven: bool,
}

impl<'a> StudyJson<'a> {
    pub(crate) fn new(file: &Path, world: &World, study: &'a Study) -> Self {
        let methods = study.runs.iter().map(|readings| {
            let robots = world.robots().iter().enumerate();
            let entry = MethodJson {
                summary: readings.summary(),
                duration_s: readings.duration_s,
                robots: robots.map(|(k, robot)| of_robot(readings, k, robot.sensors.len()).summary()).collect(),
                fooled: fooled_by(readings, TOLERANCE_US),
            };
            (readings.method, entry)
        });
        Self {
            scene: file.display().to_string(),
            seed: study.seed,
            periods: study.periods,
            methods: methods.collect(),
            left_out: study.left_out.iter().map(|(method, why)| (*method, why.as_str())).collect(),
            best: study.best.as_ref().map(|best| BestJson { schedule: best.schedule, proven: best.proven() }),
        }
    }
}

/// One way in which readings were wrong under a method, for `--json`.
#[derive(Serialize)]
struct FooledJson {
    receiver: SensorId,
    emitter: Option<SensorId>,
    cause: Cause,
    order: Option<u32>,
    length_m: Option<f64>,
    walls: Vec<i64>,
    wrong: usize,
    accepted: usize,
}

/// Lists a method's wrong readings by receiver, sender and path, those believed most often first.
fn fooled_by(readings: &Readings, tolerance_us: f64) -> Vec<FooledJson> {
    let entries = readings.attribution(tolerance_us).into_iter().map(|entry| {
        let path = readings.paths.get(entry.path as usize);
        FooledJson {
            receiver: entry.receiver,
            emitter: entry.emitter,
            cause: entry.cause,
            order: entry.order,
            length_m: path.map(|path| path.length_m),
            walls: path.map_or_else(Vec::new, |path| wall_numbers(&path.bounces)),
            wrong: entry.wrong,
            accepted: entry.accepted,
        }
    });
    entries.collect()
}
