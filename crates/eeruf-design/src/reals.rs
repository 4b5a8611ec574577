//! The cost of the tick: the shortest period over the reals, for the needs in exact microseconds.
//!
//! A schedule in ticks of any length keeps these needs, so no tick, however fine, beats a period proven here.

use eeruf_core::{Micros, Phase};
use eeruf_files::AnySchedule;

use crate::find::RingDesign;
use eeruf_period::PeriodProblem;
use eeruf_period::engine::reals::shortest_over_reals;

/// The shortest period with real firing times in place of whole ticks, for the needs in exact microseconds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RealPeriod {
    /// The period in microseconds as a fraction in lowest terms: numerator and denominator.
    pub period_us: (u64, u64),
    /// True if no real period is shorter. Otherwise it is the least that the firing orders found so far give.
    pub proven: bool,
    /// The certificate that no real period is shorter, if it is proven and the proof needs no more than the rules of
    /// certificates.
    pub certificate: Option<String>,
}

impl RealPeriod {
    /// The period in microseconds.
    #[must_use]
    pub fn us(&self) -> f64 {
        self.period_us.0 as f64 / self.period_us.1 as f64
    }

    /// Gain over the shortest period in whole ticks, in microseconds.
    #[must_use]
    pub fn gain_us(&self, period: Micros) -> f64 {
        (u64::from(period.as_micros()) * self.period_us.1).saturating_sub(self.period_us.0) as f64
            / self.period_us.1 as f64
    }
}

/// The default budget in nodes: about the time that 20,000 nodes take for 24 sensors.
#[must_use]
pub fn real_budget(sensors: usize) -> usize {
    20_000 * 24 * 24 / sensors.max(24).pow(2)
}

impl RingDesign {
    /// Finds the shortest period over the reals, beginning with the orders of this design; `None` if the design is not
    /// proven itself, or numbers become too large. Where `t_delta` must cover motion it stays as the design has it.
    pub fn over_reals(&self, budget: usize, go_on: impl FnMut(usize) -> bool) -> Option<RealPeriod> {
        self.found.proven.then(|| over_reals(&self.spec.problem(), &self.schedule, budget, go_on))?
    }
}

/// Finds the shortest period over the reals, beginning with the orders of any schedule that meets the problem.
pub fn over_reals(
    problem: &PeriodProblem<'_>,
    schedule: &AnySchedule,
    budget: usize,
    go_on: impl FnMut(usize) -> bool,
) -> Option<RealPeriod> {
    // A need rounded up to ticks would hide what finer ticks gain.
    let exact = PeriodProblem { tick: Micros::new(1), ..*problem };
    let fire = [Phase::A, Phase::B].map(|phase| {
        (0..problem.sensors).map(|sensor| schedule.t_fire(phase, sensor).unwrap_or_default().as_micros()).collect()
    });
    let found = shortest_over_reals(&exact.in_ticks(), &fire, budget, go_on)?;
    let (numerator, denominator) = (u64::from(found.period), u64::from(found.denominator));
    let divisor = greatest_common_divisor(numerator, denominator);
    let period_us = (numerator / divisor, denominator / divisor);
    Some(RealPeriod { period_us, proven: found.proven, certificate: found.certificate })
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a.max(1) } else { greatest_common_divisor(b, a % b) }
}
