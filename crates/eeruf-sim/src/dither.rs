//! Random dither: the conventional lags plus a wait drawn anew for each sensor in each period.

use eeruf_core::{Instant, MAX_SENSORS, Micros, Phase, Scheduler, Step};

use crate::noise::Chance;

/// Fires each sensor once per period, at its lag plus a random wait below `widest`.
#[derive(Clone, Debug)]
pub(crate) struct DitherFiring {
    lags: Vec<Micros>,
    period: Micros,
    widest: Micros,
    chance: Chance,
    start: Instant,
    /// Firing times of the present period, in order.
    due: Vec<(Micros, u8)>,
    place: usize,
    enabled: [bool; MAX_SENSORS],
}

impl DitherFiring {
    /// `lag + widest` must stay below the period.
    pub(crate) fn new(lags: Vec<Micros>, period: Micros, widest: Micros, chance: Chance, now: Instant) -> Self {
        let due = Vec::with_capacity(lags.len());
        let mut firing = Self { lags, period, widest, chance, start: now, due, place: 0, enabled: [true; MAX_SENSORS] };
        firing.begin_period(now);
        firing
    }

    fn begin_period(&mut self, start: Instant) {
        self.start = start;
        self.place = 0;
        self.due.clear();
        for (sensor, lag) in self.lags.iter().enumerate() {
            let wait = self.chance.between(0.0, f64::from(self.widest.as_micros())) as u32;
            // At most 64 sensors.
            self.due.push((lag.saturating_add(Micros::new(wait)), sensor as u8));
        }
        self.due.sort_unstable();
        self.skip_disabled();
    }

    fn skip_disabled(&mut self) {
        while self.due.get(self.place).is_some_and(|&(_, sensor)| !self.is_enabled(sensor)) {
            self.place += 1;
        }
    }
}

impl Scheduler for DitherFiring {
    fn fire(&mut self, now: Instant) -> Option<Step> {
        let &(due, sensor) = self.due.get(self.place)?;
        let deadline = self.start + due;
        if !now.has_reached(deadline) {
            return None;
        }
        let late = now.since(deadline);
        self.start += late;
        self.place += 1;
        self.skip_disabled();
        Some(Step::Fire { sensor, phase: Phase::A, late })
    }

    fn end_period(&mut self, now: Instant) -> Option<Step> {
        let deadline = self.deadline();
        if self.place < self.due.len() || !now.has_reached(deadline) {
            return None;
        }
        self.begin_period(deadline);
        Some(Step::PeriodEnded { phase: Phase::A, changed: false })
    }

    fn next_sensor(&self) -> Option<u8> {
        self.due.get(self.place).map(|&(_, sensor)| sensor)
    }

    fn deadline(&self) -> Instant {
        self.start + self.due.get(self.place).map_or(self.period, |&(due, _)| due)
    }

    fn ended(&mut self, _sensor: u8, _at: Instant) {}

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        if let Some(place) = self.enabled.get_mut(usize::from(sensor)) {
            *place = enabled;
        }
        self.skip_disabled();
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        usize::from(sensor) < self.lags.len() && self.enabled.get(usize::from(sensor)).is_some_and(|&enabled| enabled)
    }

    fn restart(&mut self, now: Instant) {
        self.begin_period(now);
    }

    fn periods_since(&self, _phase: Phase) -> u8 {
        0
    }

    fn longest_window(&self) -> Micros {
        self.period.saturating_sub(self.widest)
    }

    fn horizon(&self) -> Micros {
        self.period.saturating_add(self.period)
    }
}
