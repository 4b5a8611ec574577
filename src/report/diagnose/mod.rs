//! Report of a ring's log: as text, as JSON, as a picture.

mod json;
mod picture;
mod text;

use std::path::Path;

use eeruf_core::ReadingKind;
use eeruf_logs::{Diagnosis, FiringLog, FoundPath, Timing};

pub(crate) use json::json;
pub(crate) use picture::who_fools_whom;
pub(crate) use text::describe;

/// A log and its diagnosis.
pub(crate) struct DiagnosisReport<'a> {
    pub(crate) file: &'a Path,
    pub(crate) log: &'a FiringLog,
    pub(crate) diagnosis: &'a Diagnosis,
    /// Largest difference between readings of one path.
    pub(crate) tolerance_us: u32,
    pub(crate) timing: Option<Timing>,
    pub(crate) speed_of_sound: f64,
}

impl DiagnosisReport<'_> {
    fn length_m(&self, path: &FoundPath) -> f64 {
        1e-6 * path.travel_us * self.speed_of_sound
    }

    fn phases(&self) -> usize {
        let mut phases: Vec<_> = self.log.firings.iter().map(|firing| firing.phase).collect();
        phases.sort_unstable();
        phases.dedup();
        phases.len()
    }

    fn periods(&self) -> u32 {
        let periods = || self.log.firings.iter().map(|firing| firing.period);
        periods().max().unwrap_or(0) - periods().min().unwrap_or(0) + 1
    }

    /// Returns the number of rejected readings, if the log marks them, and how many are surely another sensor's sound.
    fn rejected(&self) -> Option<(usize, usize)> {
        let firings = || self.log.firings.iter().zip(&self.diagnosis.named);
        firings().any(|(firing, _)| firing.reading.is_some()).then(|| {
            let rejected = || firings().filter(|(firing, _)| firing.reading.is_some_and(ReadingKind::is_rejected));
            let named = rejected().filter(|(firing, named)| named.is_some_and(|named| named.sender != firing.sensor));
            (rejected().count(), named.count())
        })
    }

    /// Sensors that are blind in at least half of the phases.
    fn mostly_blind(&self) -> Vec<u8> {
        let phases = self.phases();
        let blind = self.diagnosis.hearing.iter().filter(|of| 2 * of.blind_phases.len() >= phases.max(1));
        blind.map(|of| of.sensor).collect()
    }

    /// Advice, with one change on each line.
    fn advice(&self) -> Vec<String> {
        let deaf = self.diagnosis.faults.iter();
        let mut advice: Vec<_> =
            deaf.map(|of| format!("look at the echo line of sensor {}: its sound goes out", of.sensor + 1)).collect();
        for sensor in self.diagnosis.silent() {
            advice.push(format!("hold a board before sensor {} and record again: it may be deaf", sensor + 1));
        }
        if self.diagnosis.moved {
            advice.push("record a minute of a robot that stands".to_owned());
        }
        if self.phases() <= 2 && !self.diagnosis.firings_move() {
            advice.push(
                "record a log of a ring whose waits are drawn at random, as method dither draws them: two phases do \
                 not say whose sound a reading is"
                    .to_owned(),
            );
        } else if !self.mostly_blind().is_empty() {
            advice.push("fire by flow, or use sensors that report several echoes".to_owned());
        }
        let window_us = self.log.firings.iter().filter_map(|firing| firing.t_echo_us).max().unwrap_or(0);
        let period_us = self.period_us();
        let old = self.diagnosis.paths.iter().filter(|path| path.travel_us > period_us);
        if let Some(longest) = old.max_by(|a, b| a.travel_us.total_cmp(&b.travel_us)) {
            advice.push(format!(
                "a longer period: sound is heard for {:.1} ms, the period is {:.1} ms and windows are {:.1} ms",
                1e-3 * longest.travel_us,
                1e-3 * period_us,
                1e-3 * f64::from(window_us)
            ));
        }
        advice
    }

    /// The median time from a sensor's firing to its next, in microseconds.
    fn period_us(&self) -> f64 {
        let mut last = vec![None; 256];
        let mut between: Vec<_> = self
            .log
            .firings
            .iter()
            .filter_map(|firing| {
                let before = last[usize::from(firing.sensor)].replace(firing.fired_us);
                before.map(|before: i64| firing.fired_us - before)
            })
            .collect();
        between.sort_unstable();
        between.get(between.len() / 2).map_or(f64::INFINITY, |&us| us as f64)
    }
}
