//! Random dither: the conventional lags plus a wait drawn anew for each sensor in each period.

use eeruf_core::{Instant, Limits, MAX_SENSORS, Micros, Phase, Scheduler};

use crate::world::Random;

/// Fires each sensor once per period, at its lag plus a random wait below `widest`.
#[derive(Clone, Debug)]
pub(crate) struct DitherFiring {
    lags: Vec<Micros>,
    period: Micros,
    widest: Micros,
    random: Random,
    start: Instant,
    /// Firing times of the present period, in order.
    due: Vec<(Micros, u8)>,
    /// The next of them.
    next: usize,
    enabled: [bool; MAX_SENSORS],
    paused: bool,
    last_fired: Option<Instant>,
}

impl DitherFiring {
    /// `lag + widest` must stay below the period.
    pub(crate) fn new(lags: Vec<Micros>, period: Micros, widest: Micros, random: Random, now: Instant) -> Self {
        let due = Vec::with_capacity(lags.len());
        let mut firing = Self {
            lags,
            period,
            widest,
            random,
            start: now,
            due,
            next: 0,
            enabled: [true; MAX_SENSORS],
            paused: false,
            last_fired: None,
        };
        firing.begin_period(now);
        firing
    }

    fn begin_period(&mut self, start: Instant) {
        self.start = start;
        self.next = 0;
        self.due.clear();
        for (sensor, lag) in self.lags.iter().enumerate() {
            let wait = self.random.between(0.0, f64::from(self.widest.as_micros())) as u32;
            // At most 64 sensors.
            self.due.push((lag.saturating_add(Micros::new(wait)), sensor as u8));
        }
        self.due.sort_unstable();
        self.skip_disabled();
    }

    fn skip_disabled(&mut self) {
        while self.due.get(self.next).is_some_and(|&(_, sensor)| self.paused || !self.is_enabled(sensor)) {
            self.next += 1;
        }
    }
}

impl Scheduler for DitherFiring {
    fn next_firing(&self) -> Option<(u8, Phase)> {
        self.due.get(self.next).map(|&(_, sensor)| (sensor, Phase::A))
    }

    fn fire(&mut self, now: Instant) {
        self.start += now.since(self.deadline());
        self.last_fired = Some(now);
        self.next += 1;
        self.skip_disabled();
    }

    fn postpone(&mut self, _sensor: u8, by: Micros) {
        self.start += by;
        self.last_fired = self.last_fired.map(|fired| fired + by);
    }

    fn end_period(&mut self, _now: Instant) -> (Phase, bool) {
        self.begin_period(self.deadline());
        (Phase::A, false)
    }

    fn deadline(&self) -> Instant {
        self.start + self.due.get(self.next).map_or(self.period, |&(due, _)| due)
    }

    fn ended(&mut self, _sensor: u8, _at: Instant) {}

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        if let Some(entry) = self.enabled.get_mut(usize::from(sensor)) {
            *entry = enabled;
        }
        self.skip_disabled();
    }

    fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
        self.skip_disabled();
    }

    fn sensors(&self) -> usize {
        self.lags.len()
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        usize::from(sensor) < self.lags.len() && self.enabled.get(usize::from(sensor)).is_some_and(|&enabled| enabled)
    }

    fn restart(&mut self, now: Instant) {
        // A clock that has jumped says nothing about when the last firing was.
        let settled = self.last_fired.map(|fired| fired + self.min_refire());
        let soon = settled.filter(|settled| settled.has_reached(now) && settled.since(now) <= self.min_refire());
        self.begin_period(soon.unwrap_or(now));
    }

    fn periods_since(&self, _phase: Phase) -> u8 {
        0
    }

    fn limits(&self) -> Limits<'_> {
        Limits { longest_window: self.min_refire(), verified_for: None }
    }

    fn min_refire(&self) -> Micros {
        self.period.saturating_sub(self.widest)
    }

    fn horizon(&self) -> Micros {
        self.period.saturating_add(self.period)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eeruf_core::check_scheduler;

    #[test]
    fn dither_keeps_the_contract_whatever_is_done_to_it() {
        let ms = Micros::from_millis;
        for seed in 0..40_u32 {
            let lags = vec![ms(0), ms(15), ms(30), ms(45)];
            let now = Instant::from_micros(u32::MAX - 500_000);
            let mut dither = DitherFiring::new(lags, ms(60), ms(14), Random::new(seed.into()), now);
            check_scheduler(&mut dither, now, 2_000, seed).unwrap();
        }
    }
}
