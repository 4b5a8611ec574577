//! Random dither: the conventional lags plus a wait redrawn for each sensor in each period.

use eeruf_core::{Micros, Phase};

use super::firing::{FiringMethod, FiringPeriod, OwnError};
use super::ring_runner::{RingStart, Started, Way, planned};
use super::schedules::{self, widest_dither};
use crate::world::Random;

pub(super) const WAY: Way =
    Way { ring: dithered, refire: |robot, _, _| robot.window, ..Way::by_table(schedules::conventional) };

/// Starts a ring that fires at the schedule's lags plus random waits.
fn dithered(start: &RingStart<'_>) -> Started {
    let schedule = &start.plan.schedule;
    let (lags, period) = (schedule.t_lag().to_vec(), schedule.period());
    let widest = widest_dither(start.robot);
    let dither = Dither { lags, period, widest, random: start.random };
    planned(Box::new(dither), start.robot, &start.judging, period.saturating_sub(widest), start.now)
}

/// Fires each sensor once per period, at its lag plus a random wait below `widest`.
#[derive(Clone, Debug)]
struct Dither {
    lags: Vec<Micros>,
    period: Micros,
    /// Largest wait that keeps each firing within the period.
    widest: Micros,
    random: Random,
}

impl FiringMethod for Dither {
    fn plan(&mut self, _period: u32) -> Result<FiringPeriod, OwnError> {
        let mut firings = Vec::with_capacity(self.lags.len());
        for (sensor, lag) in self.lags.iter().enumerate() {
            let wait = self.random.between(0.0, f64::from(self.widest.as_micros())) as u32;
            // At most 64 sensors.
            firings.push((lag.saturating_add(Micros::new(wait)), sensor as u8));
        }
        Ok(FiringPeriod { length: self.period, phase: Phase::A, firings })
    }

    fn copy(&self) -> Option<Box<dyn FiringMethod>> {
        Some(Box::new(self.clone()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::firing::PeriodFiring;
    use eeruf_core::{Instant, plan::check_plan};

    #[test]
    fn dither_keeps_the_contract_whatever_is_done_to_it() {
        let ms = Micros::from_millis;
        for seed in 0..40_u32 {
            let lags = vec![ms(0), ms(15), ms(30), ms(45)];
            let now = Instant::from_micros(u32::MAX - 500_000);
            let dither = Dither { lags, period: ms(60), widest: ms(14), random: Random::new(seed.into()) };
            let mut firing = PeriodFiring::new(Box::new(dither), 4, ms(46), now);
            check_plan(&mut firing, now, 2_000, seed).unwrap();
            assert_eq!(firing.error(), None);
        }
    }
}
