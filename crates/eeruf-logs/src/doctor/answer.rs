//! The answer to "is it crosstalk?" in words, in the order of a reader's needs: the answer, the sensors concerned, what
//! to do now, and the reasons.

use std::fmt::Write as _;

use super::{Examination, LogVerdict};
use crate::pattern::{FiringPattern, Pattern};

impl Examination {
    /// The answer in words, as `eeruf logs` prints it: the verdict, the sensors concerned, what to do, and why. `names`
    /// are the sensors' names.
    pub fn answer(&self, firing: &FiringPattern, names: &[String]) -> String {
        let found = self;
        let name = |sensor: &usize| names.get(*sensor).map_or("?", String::as_str);
        let list = |sensors: &[usize]| sensors.iter().map(name).collect::<Vec<_>>().join(", ");
        let mut suspects: Vec<usize> = found.suspects.iter().map(|of| of.sensor).collect();
        suspects.dedup();
        let (answer, whom) = match found.verdict {
            LogVerdict::Crosstalk => ("Crosstalk: sensors read each other's sound.", list(&found.fooled)),
            LogVerdict::NoneSeen => ("No crosstalk seen.", String::new()),
            LogVerdict::CannotTell if !suspects.is_empty() => {
                ("Perhaps crosstalk: a test of 20 seconds decides.", list(&suspects))
            }
            LogVerdict::CannotTell => ("This log cannot tell whether there is crosstalk.", String::new()),
        };
        let mut text = answer.to_owned();
        if !whom.is_empty() {
            _ = write!(text, "\nconcerns: {whom}");
            for (x, y) in &found.pairs {
                _ = write!(text, "; {} and {} read each other", name(x), name(y));
            }
        }
        let mut steps: Vec<String> = found.suspects.iter().map(|of| of.test.clone()).collect();
        if found.verdict == LogVerdict::Crosstalk && steps.is_empty() {
            let fooled = found.fooled.first().map_or("?", name);
            steps.push(format!("to be sure: fire none but {fooled} for 20 s; if its readings differ, it read others"));
        }
        let is_free = found.suspects.iter().any(|of| of.by.is_none());
        if found.verdict == LogVerdict::Crosstalk || !suspects.is_empty() {
            steps.push(sketch(firing.pattern, is_free, whom.split(", ").next().unwrap_or("?")));
            steps.push(
                "then `eeruf design RING.toml --emit arduino` for waits that reject it; `eeruf examples` has rings"
                    .to_owned(),
            );
        }
        let first = names.first().map_or("?", String::as_str);
        if found.verdict == LogVerdict::CannotTell && suspects.is_empty() && names.len() > 1 {
            steps.push(format!(
                "hold a cloth before {first} for 10 s, then before each other sensor: if the range of another changes, \
                 it reads that one"
            ));
        }
        if let Some(record) = found.record.as_ref().filter(|_| suspects.is_empty()) {
            steps.push(format!("record {record}, and run `eeruf logs` on it"));
        }
        steps.iter().enumerate().for_each(|(n, step)| _ = write!(text, "\ndo {}: {step}", n + 1));
        found.reasons.iter().for_each(|reason| _ = write!(text, "\nbecause {reason}"));
        found.notes.iter().for_each(|note| _ = write!(text, "\nnote {note}"));
        text
    }
}

/// The change to make in the sketch.
fn sketch(pattern: Pattern, is_free: bool, sensor: &str) -> String {
    match pattern {
        Pattern::InTurn | Pattern::Unknown if is_free => format!(
            "in the sketch: trigger the modules yourself, one after the other, `delay(30)` between two (or tie their \
             supply to one pin), so that {sensor} listens when the others are silent"
        ),
        Pattern::Alternating | Pattern::Several | Pattern::Flow => {
            "in the sketch: believe a range when two in a row agree, as the ring does".to_owned()
        }
        _ => format!(
            "in the sketch: before the trigger of {sensor}, `delay(round % 2 ? 2 : 0);`, and believe a range when two \
             in a row agree within 5 cm: another's sound moves by 34 cm from round to round"
        ),
    }
}
