//! Firings that wait for each other: a controller needs some time for each, and handles one after the other.
//!
//! A schedule may let sensors fire at the same instant that do not hear each other. The controller fires them one by
//! one, so that all but the first come late, and differently in each phase, since other firings coincide there. Proofs
//! for the planned times do not hold for the real ones, and readings become ambiguous. So firings are moved apart by
//! the time that one takes, within the slack of the schedule.

use eeruf_core::{MAX_SENSORS, Micros, Phase};
use eeruf_files::AnySchedule;
use eeruf_period::Random;

use crate::ring::RingSpec;

/// Number of attempts to move firings apart.
const TRIES: u32 = 5_000;
const SEED: u64 = 1;

impl RingSpec {
    /// Returns the schedule with all firings apart by the time that the controller needs for one: the attempt with the
    /// most separation; `None` if no attempt meets the ring's needs. Sensors declared `together` still fire together.
    pub(crate) fn moved_apart(&self, schedule: &AnySchedule) -> Option<AnySchedule> {
        if self.handling == Micros::ZERO {
            return Some(*schedule);
        }
        let requirements = self.problem().requirements;
        // Sensors that fire together count as one for the controller.
        let units: Vec<usize> =
            (0..self.sensors).filter(|&x| (0..x).all(|y| !requirements.fire_together(x, y))).collect();
        let mut random = Random::new(SEED);
        let ways = (0..TRIES).filter_map(|_| {
            let mut t_fire = [[Micros::ZERO; MAX_SENSORS]; 2];
            // Sensors that coincide in both phases keep their order, which moves them alike, and crosstalk less.
            let ranks: Vec<u64> = units.iter().map(|_| random.bits()).collect();
            for (phase, times) in [Phase::A, Phase::B].into_iter().zip(&mut t_fire) {
                let planned = |unit: usize| schedule.t_fire(phase, unit).unwrap_or_default();
                let mut order: Vec<usize> = (0..units.len()).collect();
                order.sort_by_key(|&at| (planned(units[at]), ranks[at]));
                let at: Vec<Micros> = order.iter().map(|&at| planned(units[at])).collect();
                for (&place, moved) in order.iter().zip(apart(&at, self.handling, &mut random)) {
                    for (x, time) in times.iter_mut().enumerate().take(self.sensors) {
                        if x == units[place] || requirements.fire_together(x, units[place]) {
                            *time = moved;
                        }
                    }
                }
            }
            self.is_met_apart(&t_fire, schedule.period())
        });
        ways.max_by_key(|way| way.verify(&requirements).max_t_delta())
    }

    /// The schedule of these firing times, if it meets the ring's needs and keeps all firings apart. All are moved to
    /// the middle of the period, so that work at its end delays no firing.
    fn is_met_apart(&self, t_fire: &[[Micros; MAX_SENSORS]; 2], period: Micros) -> Option<AnySchedule> {
        let times = t_fire.each_ref().map(|times| times.get(..self.sensors).unwrap_or_default());
        let first = times.map(|times| times.iter().copied().min().unwrap_or_default());
        let last = times.map(|times| times.iter().copied().max().unwrap_or_default());
        let silence = |one: usize, next: usize| (period.saturating_add(first[next])).checked_sub(last[one]);
        if silence(0, 1)?.min(silence(1, 0)?) < self.handling {
            return None;
        }
        let [before, after] = [first.into_iter().min()?, period.checked_sub(last.into_iter().max()?)?];
        let centred = |time: &Micros| {
            Micros::new((time.as_micros() + after.as_micros() / 2).saturating_sub(before.as_micros() / 2))
        };
        let centred = times.map(|times| times.iter().map(centred).collect::<Vec<_>>());
        let lags = vec![Micros::ZERO; self.sensors];
        let schedule = AnySchedule::from_slices(period, &lags, centred.each_ref().map(Vec::as_slice)).ok()?;
        let spec = self.covering(self.t_delta_needed(&schedule));
        schedule.verify(&spec.problem().requirements).ok().then_some(schedule)
    }
}

/// Moves ascending instants apart by at least `least`: an instant too soon after another is delayed, and some of those
/// that coincide are moved earlier.
fn apart(planned: &[Micros], least: Micros, random: &mut Random) -> Vec<Micros> {
    let mut moved = planned.to_vec();
    for group in moved.chunk_by_mut(|one, next| one == next) {
        let earlier = random.bits() % group.len() as u64;
        let lead = least.as_micros().saturating_mul(earlier as u32);
        for time in group {
            *time = time.saturating_sub(Micros::new(lead));
        }
    }
    let mut soonest = Micros::ZERO;
    for time in &mut moved {
        *time = (*time).max(soonest);
        soonest = time.saturating_add(least);
    }
    moved
}
