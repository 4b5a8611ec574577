//! `eeruf replay --hopping`: what the tracker makes of a hopping ring's own log of firings.

use std::path::Path;

use eeruf_core::judge::TrackerSettings;
use eeruf_logs::{Counted, replay, write_replayed};

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
            let at_ns = firing.at_ns();
            let (from, to) = counted.between_ns.unwrap_or((at_ns, at_ns));
            counted.between_ns = Some((from.min(at_ns), to.max(at_ns)));
        }
        if let Some(kind) = firing.weighed.as_ref().and_then(|weighed| weighed.kind) {
            known += 1;
            same += u64::from(kind == verdict.kind);
        }
    }
    if let Some(out) = out {
        write_replayed(out, file, &log, &verdicts, speed_of_sound)?;
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
