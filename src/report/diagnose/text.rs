//! A diagnosis as text. Sensors are printed from 1.

use std::fmt::Write as _;

use eeruf_logs::{FoundPath, Share};

use super::DiagnosisReport;
use crate::report::table::markdown;

/// The smallest difference of clock rates that is reported, in ppm.
const APART_PPM: f64 = 10.0;

/// Writes the whole diagnosis.
pub(crate) fn describe(found: &DiagnosisReport<'_>) -> String {
    let mut text = head(found);
    faults(found, &mut text);
    sensors(found, &mut text);
    paths(found, &mut text);
    let advice = found.advice();
    if !advice.is_empty() {
        text += "\nWhat to change:\n";
        advice.iter().for_each(|line| text += &format!("- {line}\n"));
    }
    text
}

fn head(found: &DiagnosisReport<'_>) -> String {
    let (log, diagnosis) = (found.log, found.diagnosis);
    let mut text = format!(
        "{}: {} firings of {} sensors in {} periods and {} phases; clock: {}\n",
        found.file.display(),
        log.firings.len(),
        diagnosis.hearing.len(),
        found.periods(),
        found.phases(),
        log.clock,
    );
    if let Some((rejected, named)) = found.rejected() {
        let share = Share { count: named as u32, of: rejected as u32 };
        // Writing to a string does not fail.
        _ = writeln!(
            text,
            "Of {rejected} rejected readings {named} are another sensor's sound, surely: {}.",
            percent(share)
        );
    }
    let most = diagnosis.most_offsets;
    if diagnosis.moved {
        text +=
            "No sender can be named, and nothing can be said of blind sensors: ranges change while the robot moves.\n";
    } else if diagnosis.paths.is_empty() {
        _ = writeln!(
            text,
            "No sender can be named, and nothing can be said of blind sensors. Two sensors' firings stand at {most} \
             offsets to each other at most; that a path is no accident takes about five (fewer than 0.01 accidental \
             paths are allowed in the whole log)."
        );
    } else {
        let expected: f64 = diagnosis.paths.iter().map(|path| path.accidents).sum();
        _ = writeln!(
            text,
            "{} paths found, {expected:.2} of them expected to be accidents. A sender is named where it is 99 % sure.",
            diagnosis.paths.len()
        );
    }
    // Beyond this, one step of the usual waits is within the tolerance.
    if found.tolerance_us > 120 {
        _ = writeln!(
            text,
            "Readings scatter, and what differs by less than {} us is taken for the same: lags that move in smaller \
             steps tell no sender.",
            2 * found.tolerance_us
        );
    }
    match found.timing {
        Some(timing) => {
            _ = writeln!(
                text,
                "Timing: drift {:+.2} +- {:.2} ppm (95 %), jitter {:.1} us rms, 1 % of firings over {:.0} us late.",
                timing.drift_ppm,
                1.96 * timing.drift_error_ppm,
                timing.jitter_us,
                timing.late_99_us
            );
            if timing.drift_ppm.abs() > 1.96 * timing.drift_error_ppm + APART_PPM {
                _ = writeln!(text, "The clocks of log and schedule are {:.1} ppm apart.", timing.drift_ppm.abs());
            }
        }
        None => {
            if let Some(scatter) = scatter_us(&diagnosis.paths) {
                _ = writeln!(text, "Readings along one path scatter by {scatter:.0} us rms (median of the paths).");
            }
        }
    }
    text
}

fn scatter_us(paths: &[FoundPath]) -> Option<f64> {
    let mut scatter: Vec<_> = paths.iter().map(|path| path.scatter_us).collect();
    scatter.sort_by(f64::total_cmp);
    scatter.get(scatter.len() / 2).copied()
}

/// Lists sensors that hear nothing, with the reason if the log shows it.
fn faults(found: &DiagnosisReport<'_>, text: &mut String) {
    for fault in &found.diagnosis.faults {
        _ = writeln!(text, "Sensor {} is {}: {}.", fault.sensor + 1, fault.symptom.as_str(), fault.said);
    }
    for sensor in found.diagnosis.silent() {
        _ = writeln!(
            text,
            "Sensor {} hears nothing: nothing is in its range, or it is deaf. This log cannot tell.",
            sensor + 1
        );
    }
}

fn sensors(found: &DiagnosisReport<'_>, text: &mut String) {
    if found.diagnosis.paths.is_empty() {
        let rows = found.diagnosis.hearing.iter().map(|of| vec![(of.sensor + 1).to_string(), percent(of.echoes)]);
        _ = writeln!(text, "\n{}", markdown(&["sensor", "echoes"], rows));
        return;
    }
    let header = ["sensor", "echoes", "its own", "others' sound", "cannot be named", "fits no path", "blind in phases"];
    let rows = found.diagnosis.hearing.iter().map(|of| {
        let phases = match &of.blind_phases[..] {
            [] if !of.has_own_path => "own echo not found".to_owned(),
            [] => "-".to_owned(),
            phases => {
                let most = phases.iter().map(|&(_, fired)| fired).min().unwrap_or(0);
                let list: Vec<_> = phases.iter().map(|(phase, _)| phase.to_string()).collect();
                // None of n means a share under 3 / n, with 95 % confidence.
                format!("{} (95 %: first in under {:.0} %)", list.join(" "), (300.0 / f64::from(most)).min(100.0))
            }
        };
        let name = (of.sensor + 1).to_string();
        vec![
            name,
            percent(of.echoes),
            percent(of.own),
            percent(of.foreign),
            percent(of.unnamed),
            percent(of.unexplained),
            phases,
        ]
    });
    _ = writeln!(text, "\n{}", markdown(&header, rows));
}

fn paths(found: &DiagnosisReport<'_>, text: &mut String) {
    let mut foreign: Vec<_> = found.diagnosis.paths.iter().filter(|path| path.sender != path.receiver).collect();
    if foreign.is_empty() {
        return;
    }
    foreign.sort_by_key(|path| std::cmp::Reverse(path.readings));
    let header = ["who is fooled", "by whom", "length m", "readings", "heard %", "periods", "offsets", "accidents"];
    let rows = foreign.iter().map(|path| {
        vec![
            (path.receiver + 1).to_string(),
            (path.sender + 1).to_string(),
            format!("{:.3} +- {:.3}", found.length_m(path), 1.96e-6 * path.travel_error_us * found.speed_of_sound),
            path.readings.to_string(),
            format!("{:.0}", 100.0 * path.heard),
            format!("{} to {}", path.periods.0, path.periods.1),
            format!("{} of {}", path.offsets.0, path.offsets.1),
            format!("{:.0e}", path.accidents),
        ]
    });
    _ = writeln!(text, "\n{}", markdown(&header, rows));
    *text += "Heard: of the readings in which nothing earlier hid it.\n\
              Offsets: at how many offsets between the two firings it was heard.\n\
              Accidents: how many paths with as much support are expected in the whole log by accident.\n";
}

/// Formats a share with its 95 % interval.
fn percent(share: Share) -> String {
    let (low, high) = share.interval_95();
    if share.of == 0 {
        return "-".to_owned();
    }
    format!("{:.1} % ({:.1}-{:.1})", 100.0 * share.value(), 100.0 * low, 100.0 * high)
}
