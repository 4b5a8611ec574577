//! Schedules of many phases for a ring: the shortest period, how long it must be at least, and the file.

use eeruf_core::{
    Layout, MAX_SENSORS, Micros, Phase,
    hopping::{HoppingCode, HoppingListening, HoppingSchedule},
    phases::{Audible, PhaseCriterion, PhaseRequirements, PhaseTable, PhaseVerification},
};
use serde::Deserialize;

use crate::ring::RingSpec;

/// A schedule of many phases as it stands in a file: a code with lags, or a table of firing times.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhaseFile {
    period_us: u32,
    step_us: Option<u32>,
    phases: Option<u8>,
    first_multiplier: Option<u8>,
    t_lag_us: Option<Vec<u32>>,
    t_fire_us: Option<Vec<Vec<u32>>>,
}

/// A schedule of many phases.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PhaseSchedule {
    sensors: usize,
    period: Micros,
    /// A row of firing times for each phase.
    rows: Vec<[Micros; MAX_SENSORS]>,
    /// The code that it is made of, if it is.
    hopping: Option<HoppingSchedule<MAX_SENSORS>>,
}

impl PhaseFile {
    /// Returns true if a text is meant as such a file and not one of two phases; it need not be right.
    pub fn is_meant(text: &str) -> bool {
        let keys = toml::from_str::<toml::Table>(text).unwrap_or_default();
        ["step_us", "phases", "t_fire_us", "first_multiplier"].iter().any(|&key| keys.contains_key(key))
    }

    /// The schedule.
    ///
    /// # Errors
    /// A message that names the key, its value and what is expected.
    pub fn schedule(&self) -> Result<PhaseSchedule, String> {
        let period = Micros::new(self.period_us);
        match (self.step_us, self.phases, &self.t_lag_us, &self.t_fire_us) {
            (Some(step), Some(phases), Some(lags), None) => {
                let first = self.first_multiplier.unwrap_or(1);
                let code = HoppingCode::of(lags.len(), phases, first, Micros::new(step));
                let mut all = [Micros::ZERO; MAX_SENSORS];
                for (lag, &us) in all.iter_mut().zip(lags) {
                    *lag = Micros::new(us);
                }
                let made = code.and_then(|code| HoppingSchedule::new(code, period, all));
                made.map(PhaseSchedule::from).map_err(|error| error.to_string())
            }
            (None, None, None, Some(table)) if self.first_multiplier.is_none() => PhaseSchedule::of(period, table),
            _ => {
                Err("expected either step_us, phases and t_lag_us, one number for each sensor, or t_fire_us, one list \
                      of such numbers for each phase"
                    .to_owned())
            }
        }
    }
}

impl From<HoppingSchedule<MAX_SENSORS>> for PhaseSchedule {
    fn from(hopping: HoppingSchedule<MAX_SENSORS>) -> Self {
        let phases = hopping.code().phases().into();
        let rows = hopping.table::<{ HoppingCode::MAX_PHASES as usize }>();
        let rows = rows.into_iter().take(phases).collect();
        Self { sensors: hopping.code().sensors(), period: hopping.period(), rows, hopping: Some(hopping) }
    }
}

impl PhaseSchedule {
    /// Of a table of firing times.
    fn of(period: Micros, table: &[Vec<u32>]) -> Result<Self, String> {
        let sensors = table.first().map_or(0, Vec::len);
        crate::limits::sensors_in_range(sensors)?;
        if !(2..=usize::from(HoppingCode::MAX_PHASES)).contains(&table.len()) {
            return Err(format!("t_fire_us has {} phases; expected 2 to {}", table.len(), HoppingCode::MAX_PHASES));
        }
        if period == Micros::ZERO || period > eeruf_core::MAX_PERIOD {
            return Err(format!("a period of {period}; expected 1 us to {}", eeruf_core::MAX_PERIOD));
        }
        let mut rows = vec![[Micros::ZERO; MAX_SENSORS]; table.len()];
        for (phase, (row, times)) in rows.iter_mut().zip(table).enumerate() {
            if times.len() != sensors {
                let found = times.len();
                return Err(format!(
                    "t_fire_us[{phase}] has {found} numbers; expected {sensors}, as many as t_fire_us[0]"
                ));
            }
            for (sensor, (time, &us)) in row.iter_mut().zip(times).enumerate() {
                *time = Micros::new(us);
                if *time >= period {
                    return Err(format!("t_fire_us[{phase}][{sensor}] is {us}; expected less than period_us"));
                }
            }
        }
        Ok(Self { sensors, period, rows, hopping: None })
    }

    /// Number of sensors that fire.
    pub fn sensors(&self) -> usize {
        self.sensors
    }

    /// Number of phases of a cycle.
    pub fn phases(&self) -> usize {
        self.rows.len()
    }

    /// `T_p`.
    pub fn period(&self) -> Micros {
        self.period
    }

    /// The code with its lags, if it is made of one: what a `HoppingRing` fires by.
    pub fn hopping(&self) -> Option<&HoppingSchedule<MAX_SENSORS>> {
        self.hopping.as_ref()
    }

    /// When a sensor fires in a phase.
    pub fn t_fire(&self, phase: Phase, sensor: usize) -> Option<Micros> {
        self.rows.get(usize::from(phase.0))?[..self.sensors].get(sensor).copied()
    }

    /// The table, for the conditions.
    pub fn table(&self) -> PhaseTable<'_, MAX_SENSORS> {
        PhaseTable::new(self.period, &self.rows).with_sensors(self.sensors)
    }

    /// Works out whether it keeps what is asked of it, all pairs, phases and ages: nothing is taken as proven.
    pub fn verify<'r>(&self, requirements: &'r PhaseRequirements<'r>) -> PhaseVerification<'r> {
        self.table().verify(requirements)
    }
}

/// The shortest period for a ring that hops in time.
#[derive(Clone, Debug)]
pub struct HoppingDesign {
    /// The schedule.
    pub schedule: HoppingSchedule<MAX_SENSORS>,
    /// No schedule of many phases that separates sound of every age has a shorter period.
    pub period_bound: Micros,
    /// Nor a narrower code than this, the width of which is that of the waits.
    pub width_bound: Micros,
    /// Reason of the bound.
    pub reason: &'static str,
}

impl HoppingDesign {
    /// Returns true if the period is the shortest that there is, for any schedule of this many phases or more.
    pub fn proven(&self) -> bool {
        self.schedule.period() == self.period_bound
    }

    /// The shortest period with a linear congruence of at least this many phases, 2 to 67, and lags that keep the
    /// neighbours' interval.
    ///
    /// # Errors
    /// Phases, step, window or period out of range, and a stale echo condition, which these codes do not keep.
    pub fn shortest(sensors: usize, phases: u8, requirements: &PhaseRequirements<'_>) -> Result<Self, String> {
        if requirements.stale_echo {
            return Err(
                "stale_echo = true; expected false with many phases: a sensor's own sound does not move by the \
                        step of a congruence"
                    .to_owned(),
            );
        }
        let (window, most) = (requirements.audible.window, HoppingListening::MAX_WINDOW);
        if window > most {
            return Err(format!("a listening window of {window}; expected at most {most} with many phases"));
        }
        let step = requirements.separation();
        let code = HoppingCode::shortest(sensors, phases, step).map_err(|error| error.to_string())?;
        // Which multipliers the sensors have matters to neighbours; the first one lets a sensor fire again soonest.
        let others = (0..code.phases()).filter_map(|a| HoppingCode::of(sensors, code.phases(), a, step).ok());
        let found = std::iter::once(code).chain(others).filter_map(|code| shortest(code, requirements));
        let schedule = found.min_by_key(HoppingSchedule::period).ok_or_else(|| {
            format!("no period up to {}; expected fewer sensors or shorter times", eeruf_core::MAX_PERIOD)
        })?;
        let (period_bound, reason) = period_bound(sensors, requirements);
        let width_bound = Micros::new((sensors as u32 - 1).saturating_mul(step.as_micros()));
        Ok(Self { schedule, period_bound, width_bound, reason })
    }
}

impl RingSpec {
    /// Requirements on a schedule of many phases for this ring; sound is heard for as long as the window.
    pub fn phase_requirements(&self, criterion: PhaseCriterion) -> PhaseRequirements<'_> {
        PhaseRequirements {
            t_delta: self.t_delta,
            criterion,
            audible: Audible::new(self.window),
            min_interval: self.min_interval,
            layout: self.layout.layout(),
            stale_echo: self.stale_echo && !self.stale_echo_by_module,
        }
    }

    /// As [`HoppingDesign::shortest`], for this ring.
    ///
    /// # Errors
    /// As there, and what sensors or pairs need of their own, but for their `t_delta` and windows, of which the largest
    /// counts.
    pub fn hopping(&self, phases: u8, criterion: PhaseCriterion) -> Result<HoppingDesign, String> {
        if self.handling != Micros::ZERO {
            return Err("handling_us in a ring file for many phases; expected it for two phases only".to_owned());
        }
        if let Some(key) = self.uneven.as_ref().and_then(|uneven| uneven.not_in_many_phases(self.window)) {
            return Err(format!(
                "{key}; expected no such key with many phases: their schedules keep one interval between neighbours \
                 and one window for all sensors"
            ));
        }
        HoppingDesign::shortest(self.sensors, phases, &self.phase_requirements(criterion))
    }
}

/// No schedule of many phases that separates sound of every age is shorter (theory.md, section 9.3).
fn period_bound(sensors: usize, requirements: &PhaseRequirements<'_>) -> (Micros, &'static str) {
    let us = |time: Micros| u64::from(time.as_micros());
    let others = sensors as u64 - 1;
    let code = us(requirements.audible.window) + others * us(requirements.separation());
    let spacing = clique(requirements.layout, sensors) as u64 * us(requirements.min_interval);
    let (bound, reason) = if code >= spacing {
        (code, "the window and the code: of K sensors one must fire (K - 1) D sooner again than a period later")
    } else {
        (spacing, "the neighbours: this many fire in each period, each this long after the one before")
    };
    (Micros::new(u32::try_from(bound).unwrap_or(u32::MAX)), reason)
}

/// A large set of sensors all of which are neighbours of each other, the first found from each sensor on.
fn clique(layout: Layout<'_>, sensors: usize) -> usize {
    let grown = |from: usize| {
        let mut members = vec![from];
        for sensor in 0..sensors {
            if members.iter().all(|&member| layout.neighbours(sensors, member, sensor)) {
                members.push(sensor);
            }
        }
        members.len()
    };
    // A single sensor is no set of neighbours.
    (0..sensors).map(grown).filter(|&members| members > 1).max().unwrap_or(0)
}

/// In a period of the second sensor's, the first one's firing must be at least `apart` later than the other's, give
/// and take `periods` of them.
struct Bound {
    from: usize,
    to: usize,
    apart: i64,
    periods: i64,
}

/// The shortest period of a code, with lags in the order in which neighbours take turns: a system of difference
/// constraints, solved by relaxation (Bellman-Ford) for each period that bisection asks about.
fn shortest(code: HoppingCode, requirements: &PhaseRequirements<'_>) -> Option<HoppingSchedule<MAX_SENSORS>> {
    let sensors = code.sensors();
    let bounds = bounds(code, requirements);
    let us = |time: Micros| i64::from(time.as_micros());
    let window = us(requirements.audible.window) + us(code.longest_drop());
    // As a ring needs it: no path reads the same with two ages, and there is room for a lag and the code.
    let least = window.max(2 * us(code.width()) + us(code.step()));
    let lags = |period: i64| {
        let room = period - us(code.width()) - 1;
        let mut lags = vec![0_i64; sensors];
        // With more rounds than sensors there is a circle of constraints that this period does not satisfy.
        for _ in 0..=sensors {
            let mut changed = false;
            for &Bound { from, to, apart, periods } in &bounds {
                let later = lags[from] + apart - periods * period;
                if later > lags[to] {
                    (lags[to], changed) = (later, true);
                }
            }
            if lags.iter().any(|&lag| lag > room) {
                return None;
            }
            if !changed {
                return Some(lags);
            }
        }
        None
    };
    let (mut low, mut high) = (least, us(eeruf_core::MAX_PERIOD));
    lags(high)?;
    while low < high {
        let middle = i64::midpoint(low, high);
        if lags(middle).is_some() {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    let mut all = [Micros::ZERO; MAX_SENSORS];
    for (lag, us) in all.iter_mut().zip(lags(high)?) {
        *lag = Micros::new(us as u32);
    }
    HoppingSchedule::new(code, Micros::new(high as u32), all).ok()
}

/// Bounds on the lags of neighbours, if neighbours take turns in the order of the first free turn of each sensor.
fn bounds(code: HoppingCode, requirements: &PhaseRequirements<'_>) -> Vec<Bound> {
    let (sensors, layout) = (code.sensors(), requirements.layout);
    let interval = i64::from(requirements.min_interval.as_micros());
    let mut turns = vec![0; sensors];
    for sensor in 0..sensors {
        let taken: Vec<usize> =
            (0..sensor).filter(|&x| layout.neighbours(sensors, x, sensor)).map(|x| turns[x]).collect();
        turns[sensor] = (0..).find(|turn| !taken.contains(turn)).unwrap_or(0);
    }
    let wait = |sensor, phase: u8| i64::from(code.wait(sensor, phase).as_micros());
    let mut bounds = vec![];
    for (x, y) in (0..sensors).flat_map(|x| (0..sensors).map(move |y| (x, y))) {
        if interval == 0 || turns[x] >= turns[y] || !layout.neighbours(sensors, x, y) {
            continue;
        }
        let most = |difference: &dyn Fn(u8) -> i64| (0..code.phases()).map(difference).max().unwrap_or(0);
        // y after x in each period, and x after y in the next.
        let within = most(&|phase| wait(x, phase) - wait(y, phase));
        let across = most(&|phase| wait(y, phase) - wait(x, phase + 1));
        bounds.push(Bound { from: x, to: y, apart: interval + within, periods: 0 });
        bounds.push(Bound { from: y, to: x, apart: interval + across, periods: 1 });
    }
    bounds
}
