//! Symptoms of a single sensor, judged by itself.

use super::series::{Series, Steady};
use crate::symptom::Symptom;

/// Number of readings below which nothing is concluded.
const FEWEST: usize = 30;

/// Returns the evidence that the echoes never change by more than the scatter of sound in still air, if so.
fn never_changes(echoes: &[f64]) -> Option<String> {
    const MANY: usize = 15;
    const STILL_US: f64 = 3.0;
    let of = |pick: fn(f64, f64) -> f64| echoes.iter().copied().reduce(pick).unwrap_or(0.0);
    let [least, most] = [of(f64::min), of(f64::max)];
    (echoes.len() >= MANY && most - least < STILL_US).then(|| {
        format!(
            "never changes: {} readings of {:.0} us: a wall that stands, in coarse steps, or a number that nothing \
             measures",
            echoes.len(),
            0.5 * (least + most)
        )
    })
}

impl Series {
    /// Sorts the readings by time.
    pub(crate) fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.at_us.len()).collect();
        order.sort_by(|&a, &b| self.at_us[a].total_cmp(&self.at_us[b]));
        self.at_us = order.iter().map(|&k| self.at_us[k]).collect();
        self.echo_us = order.iter().map(|&k| self.echo_us[k]).collect();
    }

    /// The most striking symptom of the sensor's readings, if there is one.
    pub(crate) fn symptom(&self) -> Option<(Symptom, String)> {
        let count = self.echo_us.len();
        let echoes: Vec<f64> = self.echoes().collect();
        let of = |symptom: Symptom| move |said: String| (symptom, said);
        if let Some(said) = never_changes(&echoes) {
            return Some((Symptom::Constant, said));
        }
        if count >= FEWEST && echoes.is_empty() {
            let said = "no echo at all: nothing in range, or a sensor that is deaf or not connected";
            return Some((Symptom::Silent, said.to_owned()));
        }
        if echoes.len() < FEWEST {
            return None;
        }
        let coarse = |step: f64| {
            format!("values in steps of {step:.0} us: smaller changes, and who agrees with whom, do not show")
        };
        (self.step_us().map(coarse).map(of(Symptom::Coarse)))
            .or_else(|| self.scattered(&echoes).map(of(Symptom::Scatters)))
            .or_else(|| self.stale().map(of(Symptom::Stale)))
            .or_else(|| self.faded().map(of(Symptom::Jumps)))
    }

    /// Returns the evidence that nearly all readings are far from the previous one and from every recurring value.
    fn scattered(&self, echoes: &[f64]) -> Option<String> {
        let near = echoes.windows(2).filter(|two| (two[1] - two[0]).abs() < 500.0).count();
        let steady = self.steady().into_iter().filter(Steady::is_still);
        let lasting: usize = steady.map(|value| value.count).sum();
        (near * 4 < echoes.len() && lasting * 4 < echoes.len()).then(|| {
            let percent = 100.0 * near as f64 / (echoes.len() - 1) as f64;
            format!("scatters: {percent:.0} % of the readings are within 500 us of the one before")
        })
    }

    /// Returns the evidence for two steady values that differ by the sensor's own period: the second is the echo of
    /// the previous firing.
    fn stale(&self) -> Option<String> {
        let mut periods: Vec<f64> = self.at_us.windows(2).map(|two| two[1] - two[0]).filter(|us| *us > 0.0).collect();
        periods.sort_by(f64::total_cmp);
        let period = periods.get(periods.len() / 2).copied()?;
        let spread = periods[periods.len() * 9 / 10] - periods[periods.len() / 10];
        if spread < 200.0 {
            return None;
        }
        // A reading that fits the previous firing moves against the time between the two.
        let (mut fits, mut stays, mut number) = (0, 0, 0);
        for k in 2..self.echo_us.len() {
            let change = self.echo_us[k] - self.echo_us[k - 1];
            let moved = (self.at_us[k] - self.at_us[k - 1]) - (self.at_us[k - 1] - self.at_us[k - 2]);
            if change.is_nan() || moved.abs() < 200.0 {
                continue;
            }
            number += 1;
            fits += usize::from((change + moved).abs() < 60.0);
            stays += usize::from(change.abs() < 60.0);
        }
        (number >= FEWEST && fits * 2 > number && fits > stays).then(|| {
            format!(
                "stale echo: {fits} of {number} readings move against the time since the sensor's own firing before, \
                 {:.1} ms earlier",
                period * 1e-3
            )
        })
    }

    /// Returns the evidence for two steady values, each with at least a tenth of the readings.
    fn faded(&self) -> Option<String> {
        if self.moves() {
            return None;
        }
        let count = self.echoes().count();
        let mut values = self.steady();
        values.retain(|value| value.count * 10 >= count);
        let [near, far] = values[..] else { return None };
        let jumps = self.echo_us.windows(2).filter(|two| (two[1] - two[0]).abs() > 0.5 * (far.from_us - near.to_us));
        Some(format!(
            "jumps {} times between {:.1} and {:.1} ms: a near echo that fades, or another's sound",
            jumps.count(),
            0.5e-3 * (near.from_us + near.to_us),
            0.5e-3 * (far.from_us + far.to_us)
        ))
    }
}
