//! The firing pattern of a ring, from the times of its readings, and what agreement of readings proves for it.

/// Pattern in which the sensors of a ring fire relative to each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pattern {
    /// All sensors fire at the same instant.
    AtOnce,
    /// Sensors fire one after the other, each after the echoes of the one before.
    InTurn,
    /// Sensors fire with the same lag in every round, shorter than echoes last.
    ConstantLags,
    /// Each pair of sensors has two lags, as with the paper's two phases.
    Alternating,
    /// Each pair of sensors has more than two lags.
    Several,
    /// Lags never repeat.
    Flow,
    /// The log does not show the pattern.
    #[default]
    Unknown,
}

impl Pattern {
    /// The name, as `eeruf logs --json` prints it.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::AtOnce => "at once",
            Self::InTurn => "in turn",
            Self::ConstantLags => "constant lags",
            Self::Alternating => "alternating",
            Self::Several => "several lags",
            Self::Flow => "flow",
            Self::Unknown => "unknown",
        }
    }
}

/// The firing pattern of a log.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FiringPattern {
    /// The pattern.
    pub pattern: Pattern,
    /// The median interval between two readings of one sensor.
    pub period_us: Option<u64>,
    /// The shortest interval between consecutive firings of different sensors (the 5 % quantile).
    pub gap_us: Option<u64>,
    /// The least difference between the two lags of a pair; agreement within a `t_delta` below it excludes crosstalk.
    pub least_change_us: Option<u64>,
    /// Number of pairs of sensors with only one lag, and of all pairs.
    pub constant_pairs: (usize, usize),
    /// Reason why the log does not show the pattern, if it does not.
    pub why: String,
}

impl FiringPattern {
    /// Says what agreement of a sensor's consecutive readings within this `t_delta` proves for the pattern.
    pub fn proves(&self, t_delta_us: Option<u32>) -> String {
        let repeats = "the sound of another sensor repeats as exactly as the own echo, so that agreement of \
                       consecutive readings shows nothing about crosstalk";
        match self.pattern {
            Pattern::AtOnce => format!("the sensors fire at the same instant: {repeats}"),
            Pattern::ConstantLags => format!("the sensors fire with constant lags: {repeats}"),
            Pattern::InTurn => format!(
                "the sensors fire in turn, {:.1} ms apart: sound that lasts longer than that reaches the next sensor \
                 with a constant lag, and agreement does not show it",
                self.gap_us.unwrap_or(0) as f64 * 1e-3
            ),
            Pattern::Alternating => {
                let least = self.least_change_us.unwrap_or(0);
                let (constant, pairs) = self.constant_pairs;
                let but = match constant {
                    0 => String::new(),
                    _ => format!("; {constant} of {pairs} pairs keep one lag, and agreement shows nothing for them"),
                };
                let within = t_delta_us.is_none_or(|t_delta| u64::from(t_delta) < least);
                if within {
                    format!(
                        "lags alternate by at least {least} us: readings that agree within less are no direct \
                         crosstalk between consecutive firings{but}"
                    )
                } else {
                    format!(
                        "lags alternate by {least} us for some pairs: a t_delta of {} us is not below that, and \
                         crosstalk of these pairs agrees{but}",
                        t_delta_us.unwrap_or(0)
                    )
                }
            }
            Pattern::Several => {
                "each pair has several lags: crosstalk agrees only where a lag comes twice in succession".to_owned()
            }
            Pattern::Flow => {
                "lags are never the same twice: readings that agree several times in succession are seldom \
                              crosstalk, but the log does not prove it"
                    .to_owned()
            }
            Pattern::Unknown => format!(
                "the log does not say when each sensor fired ({}): if the ring fires at once or with constant lags, \
                 agreement shows nothing about crosstalk; it does if lags alternate, as `eeruf design` plans them",
                self.why
            ),
        }
    }
}

/// Number of times that are kept for the pattern.
const MOST_STAMPS: usize = 1 << 15;
/// Difference above which two lags are distinct.
const TOLERANCE_NS: u64 = 100_000;

/// The first times of a log.
#[derive(Default)]
pub(crate) struct Stamps {
    firings: Vec<(u64, u32)>,
    longest_echo_ns: u64,
    has_untimed: bool,
}

impl Stamps {
    pub(crate) fn push(&mut self, sensor: usize, at_ns: Option<u64>, range_m: Option<f64>) {
        match at_ns {
            Some(at_ns) if self.firings.len() < MOST_STAMPS => self.firings.push((at_ns, sensor as u32)),
            Some(_) => {}
            None => self.has_untimed = true,
        }
        if let Some(range_m) = range_m.filter(|range_m| *range_m < 20.0) {
            self.longest_echo_ns = self.longest_echo_ns.max((2e9 * range_m / 343.2) as u64);
        }
    }

    /// The pattern. In a table with one time for each row, that is the time of the row, not of a firing.
    pub(crate) fn pattern(mut self, sensors: usize, one_time_a_row: bool) -> FiringPattern {
        let unknown = |why: &str| FiringPattern { why: why.to_owned(), ..FiringPattern::default() };
        if sensors < 2 {
            return unknown("one sensor");
        }
        if self.has_untimed || self.firings.is_empty() {
            return unknown("no times");
        }
        self.firings.sort_unstable();
        let mut times = vec![vec![]; sensors];
        for &(at, sensor) in &self.firings {
            if let Some(own) = times.get_mut(sensor as usize) {
                own.push(at);
            }
        }
        times.retain(|own| own.len() >= 4);
        let periods: Vec<_> =
            times.iter().filter_map(|own| median(own.windows(2).map(|two| two[1] - two[0]))).collect();
        let Some(period) = median(periods.into_iter()).filter(|&period| period > 0 && times.len() >= 2) else {
            return unknown("fewer than 4 readings of two sensors");
        };
        let mut gaps: Vec<_> =
            self.firings.windows(2).filter(|two| two[0].1 != two[1].1).map(|two| two[1].0 - two[0].0).collect();
        gaps.sort_unstable();
        let gap = gaps.get(gaps.len() / 20).copied().unwrap_or(0);
        let found =
            FiringPattern { period_us: Some(period / 1000), gap_us: Some(gap / 1000), ..FiringPattern::default() };
        if one_time_a_row {
            return FiringPattern { why: "one time for all readings of a row or a message".to_owned(), ..found };
        }
        let is_coarse = self.firings.iter().all(|(at, _)| at % 1_000_000 == 0);
        of_lags(&times, period, gap.saturating_sub(self.longest_echo_ns.max(15_000_000)) > 0, found, is_coarse)
    }
}

fn median(values: impl Iterator<Item = u64>) -> Option<u64> {
    let mut values: Vec<_> = values.collect();
    values.sort_unstable();
    values.get(values.len() / 2).copied()
}

/// The lags of a pair: their clusters, each with mean and number, and the range of the middle 80 %.
struct Lags {
    clusters: Vec<(f64, usize)>,
    spread: i64,
    widest: i64,
}

impl Lags {
    fn of(reference: &[u64], other: &[u64], period: u64, tolerance: u64) -> Option<Self> {
        let mut lags = vec![];
        let mut next = 0;
        for &at in reference {
            while next < other.len() && other[next].saturating_add(tolerance) < at {
                next += 1;
            }
            let Some(&follows) = other.get(next) else { break };
            // Damaged times may be anything.
            let lag = i128::from(follows) - i128::from(at);
            if lag < 2 * i128::from(period) {
                lags.extend(i64::try_from(lag));
            }
        }
        lags.sort_unstable();
        let (low, high) = (lags.get(lags.len() / 10)?, lags.get(lags.len() * 9 / 10)?);
        let spread = high - low;
        let (mut clusters, mut widest) = (vec![], 0);
        let mut start = 0;
        for end in 1..=lags.len() {
            if end == lags.len() || lags[end] - lags[end - 1] > tolerance as i64 {
                let own = &lags[start..end];
                // A rare lag comes from a lost reading.
                if own.len() * 50 >= lags.len() && own.len() > 1 {
                    widest = widest.max(own[own.len() - 1] - own[0]);
                    clusters.push((
                        own.iter().map(|&lag| i128::from(lag)).sum::<i128>() as f64 / own.len() as f64,
                        own.len(),
                    ));
                }
                start = end;
            }
        }
        Some(Self { clusters, spread, widest })
    }
}

fn of_lags(
    times: &[Vec<u64>],
    period: u64,
    is_in_turn: bool,
    mut found: FiringPattern,
    is_coarse: bool,
) -> FiringPattern {
    /// Number of a sensor's firings that suffices.
    const ENOUGH: usize = 400;
    let tolerance = if is_coarse { 1_000_000 } else { TOLERANCE_NS };
    let (mut constant, mut two, mut more, mut smeared, mut at_once, mut pairs) = (0, 0, 0, 0, 0, 0);
    let mut least = f64::INFINITY;
    let (mut widest_smear, mut widest_lag) = (0, 0);
    for (x, reference) in times.iter().enumerate() {
        for (y, other) in times.iter().enumerate() {
            // All pairs of a large ring would say the same.
            if x == y || (times.len() > 16 && x > 4) {
                continue;
            }
            let reference = &reference[..reference.len().min(ENOUGH)];
            let Some(lags) = Lags::of(reference, other, period, tolerance) else { continue };
            pairs += 1;
            let counted: usize = lags.clusters.iter().map(|cluster| cluster.1).sum();
            if lags.widest > 20 * tolerance as i64 || counted * 10 < reference.len().min(other.len()) * 7 {
                smeared += 1;
                widest_smear = widest_smear.max(lags.spread);
                continue;
            }
            widest_lag = widest_lag.max(lags.widest);
            match lags.clusters[..] {
                [(lag, _)] => {
                    constant += 1;
                    at_once += usize::from(lag.abs() <= tolerance as f64);
                }
                [(a, _), (b, _)] => {
                    two += 1;
                    least = least.min((b - a).abs());
                }
                _ => more += 1,
            }
        }
    }
    found.constant_pairs = (constant, pairs);
    found.pattern = if pairs > 0 && at_once == pairs {
        Pattern::AtOnce
    } else if is_in_turn {
        Pattern::InTurn
    } else if smeared * 2 > pairs {
        if i128::from(widest_smear) * 10 > i128::from(period) {
            Pattern::Flow
        } else {
            found.why = format!("its times are off by {:.1} ms", widest_smear as f64 * 1e-6);
            Pattern::Unknown
        }
    } else if constant + smeared == pairs && is_coarse && widest_lag > 0 {
        "its times are whole milliseconds, too coarse for lags".clone_into(&mut found.why);
        Pattern::Unknown
    } else if constant + smeared == pairs {
        Pattern::ConstantLags
    } else if two > more {
        found.least_change_us = Some((least / 1000.0) as u64);
        Pattern::Alternating
    } else {
        Pattern::Several
    };
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pattern of 6 sensors that fire at these times, in microseconds, in each of 200 rounds.
    fn pattern(fires_at: impl Fn(u64, u64) -> u64) -> FiringPattern {
        let mut stamps = Stamps::default();
        for round in 0..200 {
            (0..6).for_each(|sensor| stamps.push(sensor as usize, Some(1000 * fires_at(round, sensor) + 1), Some(2.0)));
        }
        stamps.pattern(6, false)
    }

    #[test]
    fn each_pattern_is_recognised_by_its_lags() {
        let jitter = |round: u64, sensor: u64| (round * 7919 + sensor * 104_729) % 41;
        let of = |fires_at: &dyn Fn(u64, u64) -> u64| {
            pattern(|round, sensor| fires_at(round, sensor) + jitter(round, sensor))
        };
        assert_eq!(of(&|round, _| 60_000 * round).pattern, Pattern::AtOnce);
        assert_eq!(of(&|round, sensor| 240_000 * round + 40_000 * sensor).pattern, Pattern::InTurn);
        assert_eq!(of(&|round, sensor| 60_000 * round + 5000 * sensor).pattern, Pattern::ConstantLags);
        let alternating = of(&|round, sensor| 60_000 * round + 5000 * sensor + 1500 * ((sensor + 1) * (round % 2)));
        assert_eq!(alternating.pattern, Pattern::Alternating);
        assert!(alternating.least_change_us.unwrap().abs_diff(1500) < 50, "{alternating:?}");
        assert!(alternating.proves(Some(500)).contains("at least"), "{}", alternating.proves(Some(500)));
        assert!(alternating.proves(Some(2000)).contains("not below"), "{}", alternating.proves(Some(2000)));
        let several = |round: u64, sensor: u64| 60_000 * round + 5000 * sensor + 400 * ((sensor + 1) * (round % 7) % 7);
        assert_eq!(of(&several).pattern, Pattern::Several);
        let random = |round: u64, sensor: u64| {
            let mixed = (round * 64 + sensor + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            60_000 * round + ((mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 33) % 59_000
        };
        assert_eq!(of(&random).pattern, Pattern::Flow);
    }

    #[test]
    fn log_without_times_of_firing_tells_no_pattern() {
        let mut stamps = Stamps::default();
        (0..100).for_each(|round| (0..2).for_each(|sensor| stamps.push(sensor, Some(60_000_000 * round), Some(1.0))));
        assert_eq!(stamps.pattern(2, true).pattern, Pattern::Unknown);
        let mut stamps = Stamps::default();
        stamps.push(0, None, None);
        assert_eq!(stamps.pattern(2, false).why, "no times");
    }
}
