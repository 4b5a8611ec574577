//! A pasted log: the answer of `eeruf logs`, and its ranges for a picture.

use std::io::Read as _;
use std::path::Path;

use eeruf_logs::{Doctor, Echo, Options, read_text};
use serde::Serialize;

/// Largest number of points of a sensor in the picture; more are thinned out.
const MOST_POINTS: usize = 2000;

#[derive(Serialize)]
pub(crate) struct Pasted {
    verdict: &'static str,
    /// The answer, in lines as the program prints them.
    answer: String,
    form: String,
    sensors: Vec<Sensor>,
    /// Guesses, each with the program's option that overrides it.
    guesses: Vec<String>,
    damage: Vec<String>,
    /// True if points have a time in seconds; otherwise their first coordinate is the number of the reading.
    is_timed: bool,
}

#[derive(Serialize, Default)]
struct Sensor {
    name: String,
    /// True if the sensor reads another's sound, or may.
    is_concerned: bool,
    readings: usize,
    /// Points in seconds and metres.
    points: Vec<(f64, f64)>,
}

pub(crate) fn paste(text: &str) -> Result<Pasted, String> {
    let options = Options::default();
    let mut doctor = Doctor::new(options.speed_of_sound);
    let (mut sensors, mut first_ns): (Vec<Sensor>, _) = (vec![], None);
    let mut is_timed = true;
    // A paste may end in the middle of a line, which is not damage.
    let whole = text.rsplit_once('\n').filter(|(_, rest)| !rest.is_empty()).map_or(text, |(whole, _)| whole);
    let input = whole.as_bytes().chain(&b"\n"[..]);
    let report = read_text(input, Path::new("the paste"), &options, |report, reading| {
        doctor.push(reading);
        sensors.resize_with(report.sensors.len(), Sensor::default);
        let own = &mut sensors[reading.sensor];
        let at_s = reading.at_ns.map(|ns| (ns as f64 - *first_ns.get_or_insert(ns as f64)) * 1e-9);
        is_timed &= at_s.is_some();
        if let Echo::At(range_m) = reading.echo() {
            own.points.push((at_s.unwrap_or(own.readings as f64), range_m));
        }
        own.readings += 1;
    })
    .map_err(|error| error.to_string())?;
    if report.sensors.is_empty() {
        let found: Vec<_> = report.skipped.iter().map(|of| format!("{}: {}", of.topic, of.why)).collect();
        return Err(format!("No ranges are found in it. {}", found.join("; ")));
    }
    let names = report.names();
    let found = doctor.examine(&report.firing, &names);
    for (index, (sensor, name)) in sensors.iter_mut().zip(names.clone()).enumerate() {
        sensor.name = name;
        sensor.is_concerned = found.fooled.contains(&index) || found.suspects.iter().any(|of| of.sensor == index);
        let every = sensor.points.len().div_ceil(MOST_POINTS).max(1);
        sensor.points = sensor.points.iter().copied().step_by(every).collect();
    }
    let guess = |of: &eeruf_logs::Guess| format!("{}: {} ({})", of.what, of.value, of.option);
    Ok(Pasted {
        verdict: found.verdict.as_str(),
        answer: found.answer(&report.firing, &names),
        form: report.form.clone(),
        guesses: report.guesses.iter().map(guess).collect(),
        damage: report.damage.iter().map(ToString::to_string).collect(),
        sensors,
        is_timed,
    })
}
