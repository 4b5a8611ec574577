//! A doctor for any log of ranges: is there crosstalk in it, and between which sensors?

mod mirror;
mod notes;
mod series;
mod statistics;

use crate::pattern::{FiringPattern, Pattern};
use crate::reading::{Echo, Reading};

use mirror::mirrored;
use series::Series;
use statistics::Dependence;

/// Readings that are kept.
const MOST_READINGS: usize = 1 << 18;
/// Fewer readings of a sensor tell nothing.
const FEWEST: u32 = 30;
/// Readings depend on the lag if chance explains it in 3 of 100,000 sensors.
const DEVIATIONS: f64 = 4.0;
/// And if this share of the readings does.
const LEAST_SHARE: f64 = 0.05;

/// The verdict of a log on crosstalk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Verdict {
    /// Sensors read each other's sound.
    Crosstalk,
    /// The log would show it, and does not.
    NoneSeen,
    /// The log would not show it.
    #[default]
    CannotTell,
}

impl Verdict {
    /// The name, as `eeruf logs --json` prints it.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Crosstalk => "crosstalk",
            Self::NoneSeen => "none seen",
            Self::CannotTell => "cannot tell",
        }
    }
}

/// The findings of the doctor in a log.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Examination {
    /// The verdict.
    pub verdict: Verdict,
    /// The sensors that read foreign sound, from 0, in order.
    pub fooled: Vec<usize>,
    /// Pairs of sensors that read each other's sound.
    pub pairs: Vec<(usize, usize)>,
    /// The reasons, one sentence each.
    pub reasons: Vec<String>,
    /// Advice on what to record, if the log cannot tell.
    pub record: Option<String>,
    /// Remarks on single sensors, one sentence each.
    pub notes: Vec<String>,
}

/// Collects the readings of a log.
///
/// ```
/// use eeruf_logs::{Doctor, Options, Verdict, read_stream};
/// // Two sensors in turn, each 40 ms after the other.
/// let rows = (0..200).map(|n| format!("{},{},{}\n", 40 * n, n % 2, 1.0 + 0.001 * f64::from(n % 3)));
/// let text = format!("ms,sensor,m\n{}", rows.collect::<String>());
/// let (options, mut doctor) = (Options::default(), Doctor::new(343.2));
/// let report = read_stream(text.as_bytes(), "log".as_ref(), &options, |_, reading| doctor.push(reading))?;
/// let found = doctor.examine(&report.firing, &report.names());
/// assert_eq!(found.verdict, Verdict::NoneSeen, "{:?}", found.reasons);
/// # Ok::<(), eeruf_files::FileError>(())
/// ```
pub struct Doctor {
    speed_of_sound: f64,
    first_ns: Option<u64>,
    sensors: Vec<Series>,
    kept: usize,
    left_out: usize,
}

impl Doctor {
    /// Begins with no readings; the speed of sound in m/s turns ranges into echo times.
    pub fn new(speed_of_sound: f64) -> Self {
        Self { speed_of_sound, first_ns: None, sensors: vec![], kept: 0, left_out: 0 }
    }

    /// Takes a reading. The first 262,144 are kept.
    pub fn push(&mut self, reading: &Reading) {
        if self.kept == MOST_READINGS {
            self.left_out += 1;
            return;
        }
        self.kept += 1;
        if self.sensors.len() <= reading.sensor {
            self.sensors.resize_with(reading.sensor + 1, Series::default);
        }
        let at_us = reading.at_ns.map_or(f64::NAN, |at| {
            let first = *self.first_ns.get_or_insert(at);
            (i128::from(at) - i128::from(first)) as f64 * 1e-3
        });
        let echo_us = match reading.echo() {
            Echo::At(range_m) => 2e6 * range_m / self.speed_of_sound,
            _ => f64::NAN,
        };
        let series = &mut self.sensors[reading.sensor];
        series.at_us.push(at_us);
        series.echo_us.push(echo_us);
    }

    /// Examines what was collected; `names` are those of the sensors.
    pub fn examine(mut self, firing: &FiringPattern, names: &[String]) -> Examination {
        for series in &mut self.sensors {
            series.sort();
        }
        let name = |sensor: usize| names.get(sensor).map_or("?", String::as_str);
        let mut found = match firing.pattern {
            Pattern::Alternating => self.alternating(&name),
            Pattern::ConstantLags => self.constant(firing, &name),
            Pattern::AtOnce => Examination {
                reasons: vec![
                    "the sensors fire at the same instant: sound from one to another repeats as exactly as the own \
                     echo, and a wall before two sensors gives both the same echo without any crosstalk"
                        .to_owned(),
                ],
                record: Some(CHANGE.to_owned()),
                ..Examination::default()
            },
            Pattern::InTurn => self.in_turn(firing, &name),
            Pattern::Several | Pattern::Flow => Examination {
                reasons: vec![
                    "lags move between many values, which takes the log of the firings to examine".to_owned(),
                ],
                record: Some(
                    "firings with sensor, fired_us, period, phase and t_echo_us; `eeruf diagnose` names who \
                              fools whom"
                        .to_owned(),
                ),
                ..Examination::default()
            },
            Pattern::Unknown => Examination {
                reasons: vec![format!("the log does not say when each sensor fired: {}", firing.why)],
                record: Some(
                    "5 minutes with the time of firing of each reading, to the millisecond or better".to_owned(),
                ),
                ..Examination::default()
            },
        };
        let others = self.sensors.iter().enumerate().filter(|(sensor, _)| !found.fooled.contains(sensor));
        let notes = others.filter_map(|(sensor, own)| Some(format!("{}: {}", name(sensor), own.note()?)));
        found.notes = notes.collect();
        if self.left_out > 0 {
            found.notes.push(format!("the first {MOST_READINGS} readings were examined, {} not", self.left_out));
        }
        found
    }

    /// Readings of two phases: an own echo is the same in both.
    fn alternating<'n>(&self, name: &impl Fn(usize) -> &'n str) -> Examination {
        let mut found = Examination::default();
        let (mut few, mut unclear) = (0, 0);
        for (sensor, own) in self.sensors.iter().enumerate() {
            if own.echoes().count() == 0 {
                continue;
            }
            let others = self.sensors.iter().enumerate().filter(|&(other, _)| other != sensor);
            let classes = others.filter_map(|(_, other)| own.two_classes(other));
            let Some((classes, _)) = classes.max_by(|a, b| a.1.total_cmp(&b.1)) else {
                few += 1;
                continue;
            };
            let Dependence { share, deviations, count } = own.changes(&classes).dependence();
            if count < FEWEST {
                few += 1;
            } else if deviations >= DEVIATIONS && share >= LEAST_SHARE {
                found.fooled.push(sensor);
                found.reasons.push(format!(
                    "{}: {:.0} % of the readings depend on which of two lags others fire with; an own echo does not",
                    name(sensor),
                    100.0 * share
                ));
            } else if share >= LEAST_SHARE + 1.0 / f64::from(count).sqrt() {
                unclear += 1;
            }
        }
        if !found.fooled.is_empty() {
            found.verdict = Verdict::Crosstalk;
        } else if few + unclear == 0 && self.sensors.len() > 1 {
            found.verdict = Verdict::NoneSeen;
            found.reasons.push(
                "lags alternate, and the readings of no sensor depend on them: less than about one in ten is another's \
                 sound"
                    .to_owned(),
            );
        } else {
            found.reasons.push(format!(
                "{} sensors have fewer than {FEWEST} readings that can be compared at two lags",
                few + unclear
            ));
            found.record = Some("5 minutes of the same".to_owned());
        }
        found
    }

    /// Lags that stay: crosstalk repeats, and shows only where two sensors read each other's sound while they move.
    fn constant<'n>(&self, firing: &FiringPattern, name: &impl Fn(usize) -> &'n str) -> Examination {
        let mut found = Examination::default();
        let period_us = firing.period_us.unwrap_or(0) as f64;
        let moving = self.sensors.iter().filter(|own| own.moves()).count();
        for x in 0..self.sensors.len() {
            for y in x + 1..self.sensors.len() {
                let seen = mirrored(&self.sensors[x], &self.sensors[y], period_us);
                if seen.is_mutual() {
                    found.pairs.push((x, y));
                    found.fooled.extend([x, y]);
                    found.reasons.push(format!(
                        "{} and {}: {} of {} readings differ by twice the lag between their firings while they change \
                         by {:.1} ms, as sound on one path in both directions does, and {} nearly do",
                        name(x),
                        name(y),
                        seen.agree,
                        seen.both,
                        seen.spread_us * 1e-3,
                        seen.nearly
                    ));
                }
            }
        }
        found.fooled.sort_unstable();
        found.fooled.dedup();
        if found.pairs.is_empty() {
            found.reasons.push(if moving == 0 {
                "the sensors fire with lags that stay the same, and nothing moves: another's sound repeats as exactly \
                 as the own echo"
                    .to_owned()
            } else {
                "the sensors fire with lags that stay the same, and no two of them read the same sound; what one \
                 reads of another alone does not show"
                    .to_owned()
            });
            found.record = Some(CHANGE.to_owned());
        } else {
            found.verdict = Verdict::Crosstalk;
        }
        found
    }

    /// No sound of another sensor is left when a sensor listens.
    fn in_turn<'n>(&self, firing: &FiringPattern, name: &impl Fn(usize) -> &'n str) -> Examination {
        /// More readings that nothing explains refute that the times are those of firings.
        const STRAYS: f64 = 0.02;
        let gap_us = firing.gap_us.unwrap_or(0);
        let gap_ms = gap_us as f64 * 1e-3;
        if gap_us < QUIET_US {
            return Examination {
                reasons: vec![format!(
                    "the sensors fire {gap_ms:.1} ms apart, and sound in a room lasts up to {} ms",
                    QUIET_US / 1000
                )],
                record: Some(format!("1 minute with {} ms from one sensor to the next", QUIET_US / 1000)),
                ..Examination::default()
            };
        }
        let strays = self.sensors.iter().enumerate().map(|(sensor, own)| (sensor, own.strays()));
        if let Some((sensor, share)) = strays.filter(|of| of.1 > STRAYS).max_by(|a, b| a.1.total_cmp(&b.1)) {
            return Examination {
                reasons: vec![format!(
                    "{}: {:.0} % of the readings come from nothing that stands or moves, as others' sound does; if \
                     the times are those of reading the modules and not of firing, each fires by itself",
                    name(sensor),
                    100.0 * share
                )],
                record: Some(CHANGE.to_owned()),
                ..Examination::default()
            };
        }
        Examination {
            verdict: Verdict::NoneSeen,
            reasons: vec![format!(
                "each sensor fires {gap_ms:.1} ms or more after the one before, when its sound has died away; sound \
                 that lasts longer would not show"
            )],
            ..Examination::default()
        }
    }
}

/// A log that tells.
const CHANGE: &str =
    "1 minute in the same place with lags that change, as `eeruf design` plans them, or one sensor at a time";
/// Sound in a room has died away after this time.
const QUIET_US: u64 = 30_000;

#[cfg(test)]
mod tests;
