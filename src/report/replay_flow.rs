//! The verdicts of a flow ring on a log of its firings, as a table, as JSON and as CSV.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use eeruf_core::ReadingKind;
use eeruf_files::FIRING_COLUMNS;
use eeruf_logs::{Firing, FiringLog, Replayed};
use serde::Serialize;

use super::table::markdown;

/// Output of `--json`.
#[derive(Serialize)]
pub(crate) struct FlowReplay {
    sensors: Vec<OfSensor>,
    /// Number of readings with a verdict in the log, and of those with the same verdict here.
    compared: usize,
    alike: usize,
    /// The first reading with a different verdict.
    #[serde(skip_serializing_if = "Option::is_none")]
    first_unlike: Option<Unlike>,
}

#[derive(Default, Serialize)]
struct OfSensor {
    readings: u32,
    kinds: BTreeMap<&'static str, u32>,
}

#[derive(Serialize)]
struct Unlike {
    sensor: u8,
    fired_us: i64,
    was: &'static str,
    now: &'static str,
}

impl FlowReplay {
    pub(crate) fn of(log: &FiringLog, replayed: &[Option<Replayed>]) -> Self {
        let mut of = Self { sensors: vec![], compared: 0, alike: 0, first_unlike: None };
        of.sensors.resize_with(log.sensors(), OfSensor::default);
        for (firing, again) in log.firings.iter().zip(replayed) {
            let Some(again) = again else { continue };
            let sensor = &mut of.sensors[usize::from(firing.sensor)];
            sensor.readings += 1;
            *sensor.kinds.entry(again.kind.as_str()).or_default() += 1;
            let Some(was) = firing.reading else { continue };
            of.compared += 1;
            of.alike += usize::from(was == again.kind);
            if was != again.kind && of.first_unlike.is_none() {
                let (was, now) = (was.as_str(), again.kind.as_str());
                of.first_unlike = Some(Unlike { sensor: firing.sensor, fired_us: firing.fired_us, was, now });
            }
        }
        of
    }

    pub(crate) fn table(&self, file: &Path) -> String {
        let is_there = |kind: &&'static str| self.sensors.iter().any(|of| of.kinds.contains_key(kind));
        let kinds: Vec<_> = ReadingKind::ALL.into_iter().map(ReadingKind::as_str).filter(is_there).collect();
        let header = ["sensor", "readings"].into_iter().chain(kinds.iter().copied()).collect::<Vec<_>>();
        let row = |(sensor, of): (usize, &OfSensor)| {
            let counts = kinds.iter().map(|kind| of.kinds.get(kind).copied().unwrap_or(0));
            let numbers = [(sensor + 1) as u32, of.readings].into_iter().chain(counts);
            numbers.map(|number| number.to_string()).collect()
        };
        let table = markdown(&header, self.sensors.iter().enumerate().map(row));
        let mut text = format!("{}: judged again by what was fired\n{table}\n", file.display());
        if self.compared > 0 {
            _ = write!(text, "{} of {} readings as the ring judged them", self.alike, self.compared);
            if let Some(Unlike { sensor, fired_us, was, now }) = &self.first_unlike {
                let sensor = sensor + 1;
                _ = write!(
                    text,
                    "; the first other one is of sensor {sensor}, fired at {fired_us} us: {was}, now {now}"
                );
            }
            text.push('\n');
        }
        text
    }
}

/// Returns the log with each reading's new verdict, and the echo believed from then on.
pub(crate) fn rows(log: &FiringLog, replayed: &[Option<Replayed>]) -> String {
    let mut text = format!("# clock: {}\n{FIRING_COLUMNS},believed_us\n", log.clock);
    for (firing, again) in log.firings.iter().zip(replayed) {
        let reading = Some(again.map_or(ReadingKind::Late, |again| again.kind));
        let believed = again.and_then(|again| again.believed).map(|us| us.as_micros().to_string());
        _ = writeln!(text, "{},{}", Firing { reading, ..firing.clone() }, believed.unwrap_or_default());
    }
    text
}
