//! `eeruf replay --hopping`: what the tracker makes of a hopping ring's own log of firings.

use std::path::Path;

use eeruf_core::{
    ReadingKind,
    judge::{TrackerSettings, Verdict},
};
use eeruf_logs::{Counted, Firing, FiringLog, McapWriter, Reading, replay};

use super::Answer;
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::files::implausible::read_firings;
use crate::report::json::to_json;
use crate::report::replay::{Counts, Replay, hopping_table};

pub(crate) fn replay_hopping(
    file: &Path,
    settings: TrackerSettings,
    speed_of_sound: f64,
    out: Option<&Path>,
    json: bool,
) -> Result<Answer, InputError> {
    let log = read_firings(file)?;
    let verdicts = replay(&log, settings).map_err(|error| InputError::new(file, error))?;
    let mut counted: Vec<Counted> = (0..log.sensors()).map(|_| Counted::default()).collect();
    let (mut known, mut same) = (0, 0);
    for (firing, verdict) in log.firings.iter().zip(&verdicts) {
        let counted = &mut counted[usize::from(firing.sensor)];
        counted.tally.count(verdict.kind);
        if !log.lacks_instants {
            let at_ns = at_ns(firing);
            let (from, to) = counted.between_ns.unwrap_or((at_ns, at_ns));
            counted.between_ns = Some((from.min(at_ns), to.max(at_ns)));
        }
        if let Some(kind) = firing.weighed.as_ref().and_then(|weighed| weighed.kind) {
            known += 1;
            same += u64::from(kind == verdict.kind);
        }
    }
    if let Some(out) = out {
        write(out, file, &log, &verdicts, speed_of_sound)?;
    }
    let counts: Vec<_> = (1..).zip(&counted).map(|(number, of)| Counts::of_hopping(&format!("{number}"), of)).collect();
    let total = counts.iter().fold(Counts::default(), Counts::plus);
    if json {
        let (damage, as_logged) = (log.damage.iter().cloned().collect(), (known > 0).then_some(same));
        print_line(to_json(&Replay { total, sensors: counts, as_logged, damage, ..Replay::default() }))?;
    } else {
        let table = hopping_table(file, settings.t_delta.as_micros(), &counts, &total, (known, same));
        tell(format!("{table}\n"))?;
    }
    match log.damage {
        None => Ok(Answer::Yes),
        Some(damage) => Err(InputError::new(file, damage)),
    }
}

/// A stamp of zero would mean that there is none.
fn at_ns(firing: &Firing) -> u64 {
    1000 * firing.fired_us.max(0).cast_unsigned().max(1)
}

/// The log's ranges; beside each topic what is accepted, and of that what is confirmed.
fn write(
    out: &Path,
    file: &Path,
    log: &FiringLog,
    verdicts: &[Verdict],
    speed_of_sound: f64,
) -> Result<(), InputError> {
    if log.lacks_instants {
        return Err(InputError::new(file, "no column `fired_us`; --out needs to know when sensors fired"));
    }
    let mut out = McapWriter::create(out)?;
    let metres = |us: u32| 0.5e-6 * f64::from(us) * speed_of_sound;
    let longest = log.firings.iter().filter_map(|firing| firing.t_echo_us).max().map_or(0.0, metres);
    for (firing, verdict) in log.firings.iter().zip(verdicts) {
        let frame = format!("sonar_{}", firing.sensor + 1);
        let topic = format!("/{frame}");
        let reading = Reading {
            sensor: firing.sensor.into(),
            at_ns: Some(at_ns(firing)),
            radiation: 0,
            field_of_view_rad: 0.26,
            min_range_m: 0.0,
            max_range_m: longest,
            range_m: firing.t_echo_us.map_or(f64::INFINITY, metres),
            variance: Some(0.0),
        };
        out.range(&topic, &frame, &reading)?;
        let range_m = match verdict.kind {
            ReadingKind::Accepted | ReadingKind::Tentative => reading.range_m,
            ReadingKind::Clear => f64::INFINITY,
            ReadingKind::TooEarly => f64::NEG_INFINITY,
            _ => continue,
        };
        let believed = Reading { range_m, ..reading };
        out.range(&format!("{topic}/accepted"), &frame, &believed)?;
        if verdict.kind != ReadingKind::Tentative {
            out.range(&format!("{topic}/confirmed"), &frame, &believed)?;
        }
    }
    Ok(out.finish()?)
}
