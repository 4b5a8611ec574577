//! Schedules of many phases: the file.

use core::fmt::Write as _;

use eeruf_core::{
    MAX_SENSORS, Micros, Phase, Requirements,
    conditions::Verification,
    hopping::{HoppingCode, HoppingSchedule},
    phases::PhaseTable,
};
use eeruf_files::emit::Emit as _;
use serde::Deserialize;

use crate::uneven::sets;

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
    /// Sensors that fire at the same instants: they share the waits of the first of them.
    #[serde(default)]
    together: Vec<Vec<usize>>,
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
    /// Sets of sensors that fire together by it.
    together: Vec<u64>,
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
                let together = sets("together", &self.together, lags.len())?;
                for &set in &together {
                    let members = || (0..lags.len()).filter(move |&sensor| set >> sensor & 1 == 1);
                    if let Some(other) = members().find(|&sensor| lags[sensor] != lags[set.trailing_zeros() as usize]) {
                        let (first, lag) = (set.trailing_zeros(), lags[other]);
                        return Err(format!(
                            "together: sensor {other} has a lag of {lag}; expected {}, that of sensor {first}",
                            lags[first as usize]
                        ));
                    }
                }
                made.map(|made| PhaseSchedule::hops(made, together)).map_err(|error| error.to_string())
            }
            (None, None, None, Some(table)) if self.first_multiplier.is_none() && self.together.is_empty() => {
                PhaseSchedule::of(period, table)
            }
            _ => {
                Err("expected either step_us, phases and t_lag_us, one number for each sensor, or t_fire_us, one list \
                      of such numbers for each phase"
                    .to_owned())
            }
        }
    }
}

impl PhaseSchedule {
    /// Of a code with lags, where these sets of sensors fire together.
    pub(crate) fn hops(hopping: HoppingSchedule<MAX_SENSORS>, together: Vec<u64>) -> Self {
        let phases = hopping.code().phases().into();
        let rows = hopping.table_together::<{ HoppingCode::MAX_PHASES as usize }>(&together);
        let rows = rows.into_iter().take(phases).collect();
        let sensors = hopping.code().sensors();
        Self { sensors, period: hopping.period(), rows, hopping: Some(hopping), together }
    }

    /// Sets of sensors that fire together by it, bit x for sensor x.
    pub fn together(&self) -> &[u64] {
        &self.together
    }

    /// The file of a code with lags.
    pub fn to_toml(&self) -> Option<String> {
        let mut text = self.hopping.as_ref()?.to_toml();
        if !self.together.is_empty() {
            let members = |&set: &u64| (0..self.sensors).filter(|x| set >> x & 1 == 1).collect::<Vec<_>>();
            // Writing to a string does not fail.
            _ = writeln!(text, "together = {:?}", self.together.iter().map(members).collect::<Vec<_>>());
        }
        Some(text)
    }

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
        Ok(Self { sensors, period, rows, hopping: None, together: vec![] })
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

    /// When a sensor fires in a phase; `None` for one out of range.
    pub fn t_fire(&self, phase: Phase, sensor: usize) -> Option<Micros> {
        self.rows.get(usize::from(phase.0))?[..self.sensors].get(sensor).copied()
    }

    /// The table, for the conditions.
    pub fn table(&self) -> PhaseTable<'_, MAX_SENSORS> {
        PhaseTable::new(self.period, &self.rows).with_sensors(self.sensors)
    }

    /// Works out whether it keeps what is asked of it, all limits, pairs, phases and ages: nothing is taken as proven.
    pub fn verify<'r>(&self, requirements: &'r Requirements<'r>) -> Verification<'r, MAX_SENSORS> {
        self.table().verify(requirements)
    }
}
