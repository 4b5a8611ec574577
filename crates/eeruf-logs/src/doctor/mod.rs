//! A doctor for logs of ranges that finds crosstalk and the sensors concerned.

mod answer;
mod loops;
mod mirror;
mod notes;
mod series;
mod statistics;

use crate::pattern::{FiringPattern, Pattern};
use crate::reading::{Echo, LogReading};

use loops::looped;
use mirror::mirrored;
use series::{Scatter, Series};

use crate::symptom::Finding;
use statistics::{FEWEST, LEAST_SHARE};

/// Largest number of readings that are kept.
const MOST_READINGS: usize = 1 << 18;
/// Number of sensors above which a log is not of a ring.
const MOST_SENSORS: usize = 64;

/// The verdict of a log on crosstalk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LogVerdict {
    /// Sensors read each other's sound.
    Crosstalk,
    /// No crosstalk is seen, and the log would show it.
    NoneSeen,
    /// The log would not show crosstalk.
    #[default]
    CannotTell,
}

impl LogVerdict {
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
    pub verdict: LogVerdict,
    /// The sensors that read foreign sound, from 0, in order.
    pub fooled: Vec<usize>,
    /// Pairs of sensors that read each other's sound.
    pub pairs: Vec<(usize, usize)>,
    /// The reasons, one sentence each.
    pub reasons: Vec<String>,
    /// Advice on what to record, if the log cannot tell.
    pub record: Option<String>,
    /// Sensors that may read foreign sound, each with the test that decides.
    pub suspects: Vec<Suspect>,
    /// Symptoms of single sensors.
    pub findings: Vec<Finding>,
    /// Remarks, one sentence each: the findings, and what was not examined.
    pub notes: Vec<String>,
}

impl Examination {
    fn cannot_tell(reason: impl Into<String>, record: impl Into<String>) -> Self {
        Self { reasons: vec![reason.into()], record: Some(record.into()), ..Self::default() }
    }
}

/// A suspicion that a log alone does not decide.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Suspect {
    /// The sensor that may be fooled, from 0.
    pub sensor: usize,
    /// The sensor whose sound this one may read, if known.
    pub by: Option<usize>,
    /// The evidence for the suspicion.
    pub reason: String,
    /// The test that decides the suspicion.
    pub test: String,
}

/// Collects the readings of a log.
///
/// ```
/// use eeruf_logs::{Doctor, Options, LogVerdict, read_stream};
/// // Two sensors in turn, each 40 ms after the other.
/// let rows = (0..200).map(|n| format!("{},{},{}\n", 40 * n, n % 2, 1.0 + 0.001 * f64::from(n % 3)));
/// let text = format!("ms,sensor,m\n{}", rows.collect::<String>());
/// let (options, mut doctor) = (Options::default(), Doctor::new(343.2));
/// let report = read_stream(text.as_bytes(), "log".as_ref(), &options, |_, reading| doctor.push(reading))?;
/// let found = doctor.examine(&report.firing, &report.names());
/// assert_eq!(found.verdict, LogVerdict::NoneSeen, "{:?}", found.reasons);
/// # Ok::<(), eeruf_files::FileError>(())
/// ```
#[derive(Default)]
pub struct Doctor {
    speed_of_sound: f64,
    first_ns: Option<u64>,
    sensors: Vec<Series>,
    /// Each reading's sensor and echo time, in the order of the log.
    rows: Vec<(usize, f64)>,
    /// The time of each reading, in microseconds.
    row_at_us: Vec<f64>,
    left_out: usize,
    names: Vec<String>,
    /// The scatter of each sensor's readings.
    scatter: Vec<Scatter>,
}

impl Doctor {
    /// A doctor without readings; the speed of sound in m/s converts ranges to echo times.
    pub fn new(speed_of_sound: f64) -> Self {
        Self { speed_of_sound, ..Self::default() }
    }

    /// Adds a reading. The first 262,144 are kept.
    pub fn push(&mut self, reading: &LogReading) {
        if self.rows.len() == MOST_READINGS {
            self.left_out += 1;
            return;
        }
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
        self.rows.push((reading.sensor, echo_us));
        self.row_at_us.push(at_us);
        let series = &mut self.sensors[reading.sensor];
        series.at_us.push(at_us);
        series.echo_us.push(echo_us);
    }

    /// Examines the readings; `names` are the sensors' names.
    pub fn examine(mut self, firing: &FiringPattern, names: &[String]) -> Examination {
        self.sensors.iter_mut().for_each(Series::sort);
        self.scatter = self.sensors.iter().map(Series::scatter).collect();
        self.names = names.to_vec();
        let mut found = match firing.pattern {
            Pattern::Alternating => self.alternating(),
            Pattern::ConstantLags => self.constant(firing),
            Pattern::InTurn => self.in_turn(firing),
            Pattern::AtOnce => Examination::cannot_tell(
                "the sensors fire at the same instant: sound from one to another repeats as exactly as the own echo, \
                 and a wall before two sensors gives both the same echo without any crosstalk",
                CHANGE,
            ),
            Pattern::Several | Pattern::Flow => Examination::cannot_tell(
                "lags move between many values, which takes the log of the firings to examine",
                "firings with sensor, fired_us, period, phase and t_echo_us; `eeruf diagnose` names who fools whom",
            ),
            Pattern::Unknown => Examination::cannot_tell(
                format!("the log does not say when each sensor fired: {}", firing.why),
                "5 minutes with the time of firing of each reading, to the millisecond or better",
            ),
        };
        let cleared = self.silent_rounds(&mut found);
        self.senders(&mut found);
        found.fooled.sort_unstable();
        found.fooled.dedup();
        self.suspects(&cleared, &mut found);
        if found.verdict == LogVerdict::NoneSeen
            && let Some(suspect) = found.suspects.first()
        {
            found.verdict = LogVerdict::CannotTell;
            found.reasons = vec![format!(
                "{}; if the times are those of reading the modules and not of firing, each fires by itself",
                suspect.reason
            )];
        }
        for of in &found.suspects {
            if !found.reasons.iter().any(|reason| reason.contains(&of.reason)) {
                found.reasons.push(of.reason.clone());
            }
        }
        for (sensor, own) in self.sensors.iter().enumerate().filter(|(sensor, _)| !found.fooled.contains(sensor)) {
            if let Some((symptom, said)) = own.symptom() {
                found.notes.push(format!("{}: {said}", self.name(sensor)));
                found.findings.push(Finding { sensor, symptom, said });
            }
        }
        if self.left_out > 0 {
            found.notes.push(format!("the first {MOST_READINGS} readings were examined, {} not", self.left_out));
        }
        found
    }

    fn name(&self, sensor: usize) -> &str {
        self.names.get(sensor).map_or("?", String::as_str)
    }

    /// Uses rounds in which another sensor did not fire as a pause test, and returns the sensors that pass it with all
    /// others.
    fn silent_rounds(&self, found: &mut Examination) -> Vec<bool> {
        /// Number of comparisons in which a share of `LEAST_SHARE` would show.
        const MANY: u32 = 400;
        let sensors = self.sensors.len();
        if sensors > MOST_SENSORS {
            return vec![];
        }
        // By receiver and other sensor: did the other fire with it, or without fail since the receiver's last reading?
        let mut fired = vec![vec![]; sensors * sensors];
        let mut since = vec![false; sensors * sensors];
        let mut begin = 0;
        for group in self.row_at_us.chunk_by(|one, other| one == other) {
            let group = &self.rows[begin..begin + group.len()];
            begin += group.len();
            let is_in = |sensor: usize| group.iter().any(|row| row.0 == sensor);
            for &(receiver, _) in group {
                for other in 0..sensors {
                    let pair = receiver * sensors + other;
                    fired[pair].push(Some(std::mem::take(&mut since[pair]) || (other != receiver && is_in(other))));
                    since[other * sensors + receiver] |= !is_in(other);
                }
            }
        }
        let mut cleared = vec![sensors > 1; sensors];
        for receiver in 0..sensors {
            for other in (0..sensors).filter(|&other| other != receiver) {
                let classes = &fired[receiver * sensors + other];
                let with = classes.iter().filter(|&&fired| fired == Some(true)).count();
                // Two sensors that only change places in the round fire equally often.
                let is_seldomer = self.sensors[other].at_us.len() * 50 <= classes.len() * 49;
                if with * 50 < classes.len() || with * 50 > classes.len() * 49 || !is_seldomer {
                    cleared[receiver] = false;
                    continue;
                }
                let seen = self.sensors[receiver].changes(classes, self.scatter[receiver]).dependence();
                let is_fooled = seen.is_foreign();
                cleared[receiver] &= seen.count >= MANY && !is_fooled;
                if is_fooled {
                    found.verdict = LogVerdict::Crosstalk;
                    found.fooled.push(receiver);
                    found.suspects.push(Suspect {
                        sensor: receiver,
                        by: Some(other),
                        reason: format!(
                            "{}: {:.0} % of the readings are others in rounds in which {} did not fire",
                            self.name(receiver),
                            100.0 * seen.share,
                            self.name(other)
                        ),
                        test: pause(self.name(receiver), self.name(other)),
                    });
                }
            }
        }
        cleared
    }

    /// Finds readings that move against the lag to another sensor by as much, as only its sound does.
    fn senders(&self, found: &mut Examination) {
        /// Significance limit in standard deviations, for twice as many comparisons as there are pairs of sensors.
        const DEVIATIONS: f64 = 5.0;
        // The least: lags that change at random scatter a fooled sensor's readings.
        let same_us = self.scatter.iter().map(|of| of.same_us(*of)).fold(f64::INFINITY, f64::min);
        for (receiver, own) in self.sensors.iter().enumerate().take_while(|_| self.sensors.len() <= MOST_SENSORS) {
            let others = self.sensors.iter().enumerate().filter(|&(other, _)| other != receiver);
            let follows = others.map(|(other, of)| (other, own.follows(of, same_us)));
            let seen: Vec<_> = follows.filter(|(_, seen)| seen.is_foreign() && seen.deviations >= DEVIATIONS).collect();
            let most = seen.iter().map(|(_, seen)| seen.share).fold(0.0, f64::max);
            // Those that fire in step with the sender look like it.
            let alike: Vec<usize> =
                seen.iter().filter(|(_, of)| of.share > 0.9 * most).map(|&(other, _)| other).collect();
            let Some(&by) = alike.first() else { continue };
            let senders = alike.iter().map(|&other| self.name(other)).collect::<Vec<_>>().join(" or ");
            // Drop the reasons that the sender's pattern has answered.
            let is_known = found.verdict == LogVerdict::Crosstalk;
            found.reasons.retain(|_| is_known);
            found.verdict = LogVerdict::Crosstalk;
            found.fooled.push(receiver);
            found.suspects.retain(|of| of.sensor != receiver || of.by == Some(by));
            found.suspects.push(Suspect {
                sensor: receiver,
                by: Some(by),
                reason: format!(
                    "{}: {:.0} % of the readings move by as much as the lag to {senders}, and against it: the sound of \
                     {senders}; an own echo does not",
                    self.name(receiver),
                    100.0 * most
                ),
                test: pause(self.name(receiver), self.name(by)),
            });
        }
    }

    /// Finds readings explained by a loop or by others' sound but not by objects at rest or in motion.
    fn suspects(&self, cleared: &[bool], found: &mut Examination) {
        /// Share of unexplained readings for a suspect: isolated ones, jumps, and those off a steady value while the
        /// robot stands.
        const ISOLATED: f64 = 0.02;
        const JUMPS: f64 = 0.02;
        const STANDS: f64 = 0.5;
        let loops = if self.has_rounds() { looped(&self.rows, &self.scatter) } else { vec![] };
        for of in loops {
            let (own, other) = (self.name(of.receiver), self.name(of.sender));
            let what = if of.is_difference { "difference" } else { "sum" };
            found.suspects.push(Suspect {
                sensor: of.receiver,
                by: Some(of.sender),
                reason: format!(
                    "{own} and {other}: their {what} stays in {:.0} % of {} rounds while each changes by {:.1} ms, as \
                     where a loop waits for one echo and then fires the other",
                    100.0 * of.share,
                    of.rounds,
                    of.spread_us * 1e-3
                ),
                test: pause(own, other),
            });
        }
        let odd: Vec<_> = self.sensors.iter().map(Series::odd).collect();
        let stands = odd.iter().any(|of| of.stands >= STANDS);
        for (sensor, of) in odd.iter().enumerate().filter(|(_, of)| of.echoes >= FEWEST as usize) {
            let is_loose = stands && of.loose > ISOLATED && of.jumps >= (3.0 / of.echoes as f64).max(0.003);
            let is_known = found.fooled.contains(&sensor) || found.suspects.iter().any(|of| of.sensor == sensor);
            if is_known || !(of.isolated > ISOLATED || of.jumps > JUMPS || is_loose) {
                continue;
            }
            let share = 100.0 * if is_loose { of.loose } else { of.isolated.max(of.jumps) };
            let own = self.name(sensor);
            if cleared.get(sensor) == Some(&true) {
                found.reasons.push(format!(
                    "{own}: {share:.0} % of the readings come from nothing that stands or moves, and no fewer in \
                     rounds in which the others did not fire: noise of its own"
                ));
                continue;
            }
            found.suspects.push(Suspect {
                sensor,
                by: None,
                reason: format!(
                    "{own}: {share:.0} % of the readings come from nothing that stands or moves, as others' sound does \
                     and a bad contact"
                ),
                test: format!(
                    "fire none but {own} for 20 s: if it calms down, it reads others; if not, look at its wires and \
                     its supply"
                ),
            });
        }
    }

    /// Returns true if the sensors have about equally many readings, as in the rounds of a loop.
    fn has_rounds(&self) -> bool {
        let counts = || self.sensors.iter().map(|own| own.echo_us.len());
        counts().max().unwrap_or(0) <= counts().min().unwrap_or(0) + counts().max().unwrap_or(0) / 4
    }

    /// Examines readings with two phases, in which an own echo is the same in both.
    fn alternating(&self) -> Examination {
        let mut found = Examination::default();
        let (mut few, mut unclear, mut blurred) = (0, 0, 0.0_f64);
        for (sensor, own) in self.sensors.iter().enumerate() {
            if own.echoes().count() == 0 {
                continue;
            }
            let others = self.sensors.iter().enumerate().filter(|&(other, _)| other != sensor);
            let classes = others.filter_map(|(_, other)| own.two_classes(other));
            let Some((classes, step_us)) = classes.max_by(|a, b| a.1.total_cmp(&b.1)) else {
                few += 1;
                continue;
            };
            let scatter = self.scatter[sensor];
            // Foreign sound moves by the step of the lags, which must show.
            if scatter.same_us(scatter) > step_us {
                blurred = blurred.max(scatter.us);
            }
            let seen = own.changes(&classes, scatter).dependence();
            if seen.count < FEWEST {
                few += 1;
            } else if seen.is_foreign() {
                found.fooled.push(sensor);
                found.reasons.push(format!(
                    "{}: {:.0} % of the readings depend on which of two lags others fire with; an own echo does not",
                    self.name(sensor),
                    100.0 * seen.share
                ));
            } else if seen.share >= LEAST_SHARE + 1.0 / f64::from(seen.count).sqrt() {
                unclear += 1;
            }
        }
        if !found.fooled.is_empty() {
            found.verdict = LogVerdict::Crosstalk;
        } else if blurred > 0.0 {
            found.reasons.push(format!(
                "readings scatter by {blurred:.0} us, which hides what moves by the steps of the lags: no crosstalk of \
                 this ring can show"
            ));
            found.record =
                Some("the same with echo times in microseconds, or with larger steps of the lags".to_owned());
        } else if few + unclear == 0 && self.sensors.len() > 1 {
            found.verdict = LogVerdict::NoneSeen;
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

    /// Examines readings with constant lags: crosstalk repeats, and shows only if two sensors read each other's sound
    /// while they move.
    fn constant(&self, firing: &FiringPattern) -> Examination {
        let mut found = Examination::default();
        let period_us = firing.period_us.unwrap_or(0) as f64;
        for x in 0..self.sensors.len() {
            for y in x + 1..self.sensors.len() {
                let seen = mirrored(&self.sensors[x], &self.sensors[y], period_us);
                if seen.is_mutual() {
                    found.pairs.push((x, y));
                    found.fooled.extend([x, y]);
                    found.reasons.push(format!(
                        "{} and {}: {} of {} readings differ by twice the lag between their firings while they change \
                         by {:.1} ms, as sound on one path in both directions does, and {} nearly do",
                        self.name(x),
                        self.name(y),
                        seen.agree,
                        seen.both,
                        seen.spread_us * 1e-3,
                        seen.nearly
                    ));
                }
            }
        }
        if !found.pairs.is_empty() {
            found.verdict = LogVerdict::Crosstalk;
            return found;
        }
        let why = if self.sensors.iter().any(Series::moves) {
            "no two of them read the same sound; what one reads of another alone does not show"
        } else {
            "nothing moves: another's sound repeats as exactly as the own echo"
        };
        Examination::cannot_tell(format!("the sensors fire with lags that stay the same, and {why}"), CHANGE)
    }

    /// Examines readings in turn, where no sound of another sensor is left when a sensor listens.
    fn in_turn(&self, firing: &FiringPattern) -> Examination {
        /// Number of rounds below which rare crosstalk would not show, and the largest share of unexplained jumps of 30
        /// cm for a driving robot.
        const ROUNDS: usize = 100;
        const JUMPS: f64 = 0.0015;
        let gap_us = firing.gap_us.unwrap_or(0);
        let gap_ms = gap_us as f64 * 1e-3;
        if gap_us < QUIET_US {
            let quiet_ms = QUIET_US / 1000;
            return Examination::cannot_tell(
                format!("the sensors fire {gap_ms:.1} ms apart, and sound in a room lasts up to {quiet_ms} ms"),
                format!("1 minute with {quiet_ms} ms from one sensor to the next"),
            );
        }
        let rounds = self.sensors.iter().map(|own| own.echo_us.len()).min().unwrap_or(0);
        if rounds < ROUNDS {
            return Examination::cannot_tell(
                format!("{rounds} rounds, of which seldom crosstalk may have missed all; expected {ROUNDS}"),
                "5 minutes of the same",
            );
        }
        let odd: Vec<_> = self.sensors.iter().map(Series::odd).collect();
        let echoes: usize = odd.iter().map(|of| of.echoes).sum();
        let jumps = odd.iter().map(|of| of.jumps * of.echoes as f64).sum::<f64>() / echoes.max(1) as f64;
        let moves = odd.iter().filter(|of| of.echoes > 0).all(|of| of.stands < 0.5);
        if moves && jumps > JUMPS {
            return Examination::cannot_tell(
                format!(
                    "the robot moves, and {:.1} % of the readings jump: corners do that, and modules that fire by \
                     themselves, if the times are those of reading them",
                    100.0 * jumps
                ),
                CHANGE,
            );
        }
        Examination {
            verdict: LogVerdict::NoneSeen,
            reasons: vec![format!(
                "each sensor fires {gap_ms:.1} ms or more after the one before, when its sound has died away, and in \
                 {rounds} rounds no reading jumps as others' sound does; sound that lasts longer would not show"
            )],
            ..Examination::default()
        }
    }
}

/// Advice for recording a log that can tell.
const CHANGE: &str =
    "1 minute in the same place with lags that change, as `eeruf design` plans them, or one sensor at a time";
/// The test that distinguishes another's sound from an own echo.
fn pause(own: &str, other: &str) -> String {
    format!(
        "do not trigger {other} for 20 s, or hold a cloth before it: if {own} changes, it reads {other}; or wait 1 ms \
         more before {own} in every second round: another's sound comes 17 cm nearer then, an own echo stays"
    )
}
/// Time after which sound in a room has died away.
const QUIET_US: u64 = 30_000;

#[cfg(test)]
mod tests;
