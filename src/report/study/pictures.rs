//! The pictures of a study, and the choice of methods, sensor and stretch of time that show most.

use std::collections::BTreeMap;
use std::path::Path;

use eeruf_sim::{Cause, HeardPath, Method, Point, Readings, SensorId, Summary, World};

use super::found::{Study, TOLERANCE_US, of_robot};
use crate::files::error::InputError;
use crate::report::draw::{self, DrawnPath, Panel};

/// The largest number of paths drawn for one method.
const MOST_PATHS: usize = 24;
/// Number of readings of one sensor that are drawn.
const SHOWN_READINGS: usize = 70;

/// Draws `scene`, `timing`, `readings`, `methods` and `blind` with this extension; returns their number.
pub(crate) fn pictures(folder: &Path, ending: &str, world: &World, study: &Study) -> Result<usize, InputError> {
    let file = |name: &str| folder.join(name).with_extension(ending);
    comparison(study, &file("methods"))?;
    // A method without a filter and one of ours, if both were simulated; or else the first and the last.
    let before = study.of(Method::Conventional).or_else(|| study.runs.first());
    let known = [Method::Flow, Method::Eeruf, Method::EerufBest];
    let after = known.into_iter().find_map(|method| study.of(method)).or_else(|| study.runs.last());
    let (Some(before), Some(after)) = (before, after) else { return Ok(1) };
    let shown: Vec<&Readings> = if before.method == after.method { vec![after] } else { vec![before, after] };
    let panels: Vec<Panel> = shown.iter().map(|readings| panel(world, readings)).collect();
    draw::scene_with_paths(world, &panels).save(&file("scene"))?;

    let (robot, sensor) = most_helped(before, after);
    let Some(body) = world.robots().get(robot) else { return Ok(2) };
    let alone: Vec<Readings> = shown.iter().map(|readings| of_robot(readings, robot, body.sensors.len())).collect();
    let after = &alone[alone.len() - 1];
    let window_s = 1e-6 * f64::from(body.window.as_micros());
    draw::two_periods(after, robot as u16, body.sensors.len(), window_s).save(&file("timing"))?;
    let stretch = richest_stretch(&alone[0], after, sensor);
    let metres_per_us = 0.5e-6 * world.scene().air().speed_of_sound();
    let alone: Vec<&Readings> = alone.iter().collect();
    draw::readings_over_time(&alone, sensor, stretch, metres_per_us, TOLERANCE_US).save(&file("readings"))?;
    let lane = |run: &Readings| (run.method, right_shares(&of_robot(run, robot, body.sensors.len())));
    draw::blind_sensors(&study.runs.iter().map(lane).collect::<Vec<_>>()).save(&file("blind"))?;
    Ok(5)
}

/// Draws what each method reads into this file.
pub(crate) fn comparison(study: &Study, file: &Path) -> Result<(), InputError> {
    let summaries: Vec<Summary> = study.runs.iter().map(Readings::summary).collect();
    draw::methods_chart(&summaries).save(file)
}

/// Returns the share of each sensor's firings that were right and believed.
fn right_shares(readings: &Readings) -> Vec<f64> {
    let mut counts = vec![(0_u32, 0_u32); readings.sensors];
    for reading in 0..readings.len() {
        let (right, fired) = &mut counts[usize::from(readings.sensor[reading])];
        *right += u32::from(readings.is_accepted(reading) && !readings.is_wrong(reading, TOLERANCE_US));
        *fired += 1;
    }
    counts.into_iter().map(|(right, fired)| f64::from(right) / f64::from(fired.max(1))).collect()
}

/// Returns wrong readings that a method believed, by path.
fn panel(world: &World, readings: &Readings) -> Panel {
    let entries = readings.attribution(TOLERANCE_US);
    let foreign = |cause| matches!(cause, Cause::Crosstalk | Cause::Stale);
    let fooled = entries.iter().filter(|entry| entry.accepted > 0 && foreign(entry.cause));
    let paths: Vec<DrawnPath> = fooled
        .clone()
        .take(MOST_PATHS)
        .filter_map(|entry| {
            let path = readings.paths.get(entry.path as usize)?;
            Some(DrawnPath {
                emitter: usize::from(path.emitter.sensor),
                corners: corners(world, readings, entry.path, path)?,
                times: entry.accepted,
            })
        })
        .collect();
    let times: usize = fooled.map(|entry| entry.accepted).sum();
    let accepted = (0..readings.len()).filter(|&reading| readings.is_accepted(reading)).count();
    let share = 100.0 * times as f64 / accepted.max(1) as f64;
    Panel {
        title: format!("{}: who fools whom", readings.method),
        caption: format!("crosstalk in {share:.1} % of what it believes ({times} of {accepted})"),
        paths,
    }
}

/// Returns the corners of a path when it first fooled its receiver.
fn corners(world: &World, readings: &Readings, index: u32, path: &HeardPath) -> Option<Vec<Point>> {
    let first = (0..readings.len()).find(|&reading| readings.path[reading] == index)?;
    let position = |id: SensorId, time_s: f64| {
        let sensor = world.sensors(usize::from(id.robot), time_s).nth(usize::from(id.sensor))?;
        Some(Point::from(sensor.translation.vector))
    };
    let sent_s = readings.emitted_s[first];
    let heard_s = sent_s + path.length_m / world.scene().air().speed_of_sound();
    world.scene().bounce_points(position(path.emitter, sent_s)?, position(path.receiver, heard_s)?, &path.bounces)
}

/// The robot and the sensor that were fooled most and farthest under one method; the other method must have accepted
/// some of that sensor's readings, or there is little to see.
fn most_helped(before: &Readings, after: &Readings) -> (usize, u8) {
    let mut scores = BTreeMap::<SensorId, [f64; 2]>::new();
    for reading in (0..before.len()).filter(|&reading| is_fooled(before, reading)) {
        let off_us = (before.t_echo_us[reading] - before.reference_us[reading]).abs();
        // If the sensor would read nothing alone, the whole range is wrong.
        scores.entry(before.id(reading)).or_default()[0] += if off_us.is_nan() { 2e4 } else { off_us };
    }
    for reading in (0..after.len()).filter(|&reading| after.is_accepted(reading)) {
        scores.entry(after.id(reading)).or_default()[1] += 1.0;
    }
    let score = |&(_, [off, believed]): &(SensorId, [f64; 2])| off * believed;
    let most = scores.into_iter().max_by(|a, b| score(a).total_cmp(&score(b)));
    most.map_or((0, 0), |(id, _)| (usize::from(id.robot), id.sensor))
}

/// Returns true if the reading is foreign sound that was accepted and is wrong.
fn is_fooled(of: &Readings, reading: usize) -> bool {
    let is_foreign = matches!(of.cause[reading], Cause::Crosstalk | Cause::Stale | Cause::External);
    of.is_accepted(reading) && is_foreign && of.is_wrong(reading, TOLERANCE_US)
}

/// Returns the stretch of a sensor's readings that shows most: one method is fooled, and the other accepts and rejects
/// about equally many readings.
fn richest_stretch(before: &Readings, after: &Readings, sensor: u8) -> (f64, f64) {
    let own: Vec<usize> = (0..after.len()).filter(|&reading| after.sensor[reading] == sensor).collect();
    let fooled = (0..before.len()).filter(|&reading| before.sensor[reading] == sensor && is_fooled(before, reading));
    let times: Vec<f64> = fooled.map(|reading| before.fired_s[reading]).collect();
    let end = |reading: Option<&usize>| reading.map_or(0.0, |&reading| after.fired_s[reading]);
    let shows = |stretch: &[usize]| {
        let span = end(stretch.first())..end(stretch.last());
        let accepted = stretch.iter().filter(|&&reading| after.is_accepted(reading)).count();
        let wrong = times.iter().filter(|time| span.contains(time)).count();
        (wrong.min(SHOWN_READINGS / 4), accepted.min(stretch.len() - accepted))
    };
    let stretches = own.chunks(SHOWN_READINGS).filter(|stretch| stretch.len() == SHOWN_READINGS);
    // The first of equals.
    let best = stretches.rev().max_by_key(|stretch| shows(stretch)).unwrap_or(&own);
    (end(best.first()) - 0.05, end(best.last()) + 0.05)
}
