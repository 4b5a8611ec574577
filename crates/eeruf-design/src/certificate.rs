//! The certificate of a design: from the search it uses only the schedule and the bound.

use core::fmt;

use eeruf_core::Micros;
use eeruf_files::AnySchedule;
use eeruf_period::PeriodProblem;
use eeruf_period::engine::prove::{NoProof, prove_what_can_be};

/// Returns a certificate, as text, that no period is shorter than the schedule's, or than `bound`. If its proof would
/// have more than `budget` nodes, or if `go_on`, called with the nodes so far, returns false, the certificate is for a
/// lower bound.
///
/// # Errors
/// The claim is wrong.
pub fn certify(
    problem: &PeriodProblem<'_>,
    schedule: &AnySchedule,
    bound: Option<Micros>,
    budget: usize,
    go_on: impl FnMut(usize) -> bool,
) -> Result<String, NoProof> {
    prove_what_can_be(&problem.claim(schedule, bound), budget, go_on)
}

/// The claim that a certificate states, and the size of its proof. Nothing is checked: `checker/check_period.py` does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stated {
    /// The period of the schedule, in ticks.
    pub period: u32,
    /// Proven bound of the period, in ticks.
    pub bound: u32,
    /// Upper limit of the nodes of the proof's tree: two for each branching, or one per sensor if it branches on the
    /// next sensor to fire.
    pub nodes: usize,
    /// A tick is `tick_us.0 / tick_us.1` microseconds.
    tick_us: (u32, u32),
}

impl Stated {
    /// The claim of a certificate that this crate wrote; `None` for other texts.
    #[must_use]
    pub fn read(certificate: &str) -> Option<Self> {
        let numbers = |word: &str| {
            let mut lines = certificate.lines().filter_map(|line| line.strip_prefix(word)?.strip_prefix(' '));
            lines.next()?.split(' ').map(|number| number.parse().ok()).collect::<Option<Vec<u32>>>()
        };
        let (tick, period, bound) = (numbers("tick_us")?, numbers("period")?, numbers("no_period_below")?);
        let sensors = *numbers("sensors")?.first()? as usize;
        let nodes = |line: &str| match line.split(' ').next() {
            Some("a" | "b" | "sign" | "rank" | "split") => 2,
            Some("next") => sensors,
            _ => 0,
        };
        Some(Self {
            period: *period.first()?,
            bound: *bound.first()?,
            nodes: certificate.lines().map(nodes).sum::<usize>() + 1,
            tick_us: (*tick.first()?, *tick.get(1)?),
        })
    }

    /// This many ticks in whole microseconds, rounded down.
    #[must_use]
    pub fn micros(&self, ticks: u32) -> u64 {
        u64::from(ticks) * u64::from(self.tick_us.0) / u64::from(self.tick_us.1)
    }
}

impl fmt::Display for Stated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let us = |ticks| Fraction(u64::from(ticks) * u64::from(self.tick_us.0), u64::from(self.tick_us.1));
        if self.bound == self.period {
            write!(f, "{} us is the shortest period", us(self.period))?;
        } else {
            write!(f, "no period below {} us; schedule of {} us", us(self.bound), us(self.period))?;
        }
        write!(f, " (tick {} us)", us(1))
    }
}

/// A fraction, printed in lowest terms.
struct Fraction(u64, u64);

impl fmt::Display for Fraction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (mut divisor, mut rest) = (self.0, self.1);
        while rest > 0 {
            (divisor, rest) = (rest, divisor % rest);
        }
        match self.1 / divisor {
            1 => write!(f, "{}", self.0 / divisor),
            under => write!(f, "{}/{under}", self.0 / divisor),
        }
    }
}
