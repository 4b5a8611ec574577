//! Requirements on a schedule, out of keyword arguments: layout, neighbours, times.

use eeruf_core::{Criterion, MAX_SENSORS, Micros, Requirements};
use eeruf_design::{LayoutKey, LayoutName, OwnedLayout, OwnedUneven};
use eeruf_sim::AnySchedule;
use pyo3::{prelude::*, types::PyList};

use crate::arguments::{choice, flag, items, micros_or, shown, times, whole, whole_or, wrong};
use crate::errors::ArgumentError;

/// A layout by its name, or by its pairs of neighbours; a line where there is none.
pub(crate) fn layout(value: Option<&Bound<'_, PyAny>>, neighbours: u8, sensors: usize) -> PyResult<OwnedLayout> {
    let expected = "\"line\", \"ring\", \"blocks\", or pairs of neighbours such as [(0, 1), (1, 2)]";
    let key = |value: &Bound<'_, PyAny>| match value.extract::<String>().as_deref() {
        Ok("line") => Ok(LayoutKey::Named(LayoutName::Line)),
        Ok("ring") => Ok(LayoutKey::Named(LayoutName::Ring)),
        Ok("blocks") => Ok(LayoutKey::Named(LayoutName::Blocks)),
        Ok(_) => Err(wrong("layout", shown(value), expected)),
        Err(_) => {
            let pairs: Vec<(usize, usize)> = value
                .try_iter()
                .and_then(|items| PyList::new(value.py(), items.collect::<PyResult<Vec<_>>>()?)?.extract())
                .map_err(|_| wrong("layout", shown(value), expected))?;
            let (last, is_wrong) = (sensors - 1, |&(x, y): &(usize, usize)| x == y || x.max(y) >= sensors);
            match pairs.iter().copied().find(is_wrong) {
                Some((x, y)) => {
                    let expected = format!("pairs of two different sensors from 0 to {last}");
                    Err(wrong("layout", format_args!("[({x}, {y})]"), expected))
                }
                None => Ok(LayoutKey::Pairs(pairs)),
            }
        }
    };
    value.map_or(Ok(LayoutKey::Unsaid), key)?.owned(neighbours, sensors).map_err(ArgumentError::new_err)
}

/// The reading of (13a), (13b); exact by default.
fn criterion(value: Option<&Bound<'_, PyAny>>) -> PyResult<Criterion> {
    choice("criterion", value, &[("exact", Criterion::Exact), ("paper", Criterion::Paper)])
}

/// Requirements on a schedule.
pub(crate) struct OwnedRequirements {
    t_delta: Micros,
    min_interval: Micros,
    layout: OwnedLayout,
    criterion: Criterion,
    window: Micros,
    stale_echo: bool,
    uneven: Option<OwnedUneven>,
}

impl OwnedRequirements {
    /// Returns true if they say what single sensors need.
    pub(crate) fn is_uneven(&self) -> bool {
        self.uneven.is_some()
    }

    /// The largest `t_delta` and window.
    pub(crate) fn most(&self) -> [Micros; 2] {
        [self.t_delta, self.window]
    }

    pub(crate) fn requirements(&self) -> Requirements<'_> {
        Requirements {
            criterion: self.criterion,
            min_interval: self.min_interval,
            layout: self.layout.layout(),
            window: self.window,
            stale_echo: self.stale_echo,
            uneven: self.uneven.as_ref().map(OwnedUneven::uneven),
            ..Requirements::new(self.t_delta)
        }
    }
}

/// Number of adjacent sensors that count as neighbours; four by default, as in the paper (Sec. 3.1 c).
pub(crate) fn neighbours(value: Option<&Bound<'_, PyAny>>) -> PyResult<u8> {
    whole_or("neighbours", value, 4, 1..=MAX_SENSORS as u8)
}

/// The number of sensors.
pub(crate) fn sensors(value: &Bound<'_, PyAny>) -> PyResult<usize> {
    whole("sensors", value, 1..=MAX_SENSORS as u32).map(|sensors| sensors as usize)
}

/// The keyword arguments of `verify`, `to_rust` and `to_c`, as Python gives them.
pub(crate) struct RequirementArguments<'a, 'py> {
    pub(crate) t_delta_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) min_interval_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) neighbours: Option<&'a Bound<'py, PyAny>>,
    pub(crate) layout: Option<&'a Bound<'py, PyAny>>,
    pub(crate) criterion: Option<&'a Bound<'py, PyAny>>,
    pub(crate) window_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) stale_echo: Option<&'a Bound<'py, PyAny>>,
    pub(crate) uneven: UnevenArguments<'a, 'py>,
}

impl<'a, 'py> RequirementArguments<'a, 'py> {
    /// Where all sensors are alike; window and stale echoes last.
    pub(crate) fn alike(
        t_delta_us: Option<&'a Bound<'py, PyAny>>,
        min_interval_us: Option<&'a Bound<'py, PyAny>>,
        neighbours: Option<&'a Bound<'py, PyAny>>,
        layout: Option<&'a Bound<'py, PyAny>>,
        criterion: Option<&'a Bound<'py, PyAny>>,
        (window_us, stale_echo): (Option<&'a Bound<'py, PyAny>>, Option<&'a Bound<'py, PyAny>>),
    ) -> Self {
        let uneven = UnevenArguments::default();
        Self { t_delta_us, min_interval_us, neighbours, layout, criterion, window_us, stale_echo, uneven }
    }
}

/// The keyword arguments that say what differs from sensor to sensor.
#[derive(Clone, Copy, Default)]
pub(crate) struct UnevenArguments<'a, 'py> {
    pub(crate) refire_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) intervals_us: Option<&'a Bound<'py, PyAny>>,
    pub(crate) shared_lines: Option<&'a Bound<'py, PyAny>>,
    pub(crate) together: Option<&'a Bound<'py, PyAny>>,
}

impl UnevenArguments<'_, '_> {
    /// Differences between the sensors, with lists of `t_delta` and window that are empty where all have the same;
    /// `None` if there are none.
    pub(crate) fn owned(
        &self,
        sensors: usize,
        t_delta: Vec<Micros>,
        window: Vec<Micros>,
    ) -> PyResult<Option<OwnedUneven>> {
        let all = [self.refire_us, self.intervals_us, self.shared_lines, self.together];
        if t_delta.is_empty() && window.is_empty() && all.iter().all(Option::is_none) {
            return Ok(None);
        }
        let refire = self.refire_us.map_or(Ok((Micros::ZERO, vec![])), |value| each("refire_us", value, 0))?;
        let refire = if refire.1.is_empty() { vec![refire.0; sensors] } else { refire.1 };
        let expected = "triples of two sensors and a time in microseconds, such as [(0, 1, 9000)]";
        let intervals = list("intervals_us", self.intervals_us, expected)?;
        let expected = "groups of sensors, such as [(0, 4), (1, 5)]";
        let lines = list("shared_lines", self.shared_lines, expected)?;
        let together = list("together", self.together, expected)?;
        OwnedUneven::new(sensors, [t_delta, window, refire], &intervals, &lines, &together)
            .map(Some)
            .map_err(ArgumentError::new_err)
    }
}

/// Items of one type; none where there is no argument.
fn list<T>(name: &str, value: Option<&Bound<'_, PyAny>>, expected: &str) -> PyResult<Vec<T>>
where
    T: for<'a, 'py> FromPyObject<'a, 'py>,
{
    let Some(value) = value else { return Ok(vec![]) };
    let item = |item: Bound<'_, PyAny>| item.extract().map_err(|_| wrong(name, shown(value), expected));
    items(name, value, expected)?.into_iter().map(item).collect()
}

/// A time for all sensors, or one for each, of `least` or more; then the largest stands for all.
pub(crate) fn each(name: &str, value: &Bound<'_, PyAny>, least: u32) -> PyResult<(Micros, Vec<Micros>)> {
    if value.hasattr("__iter__")? && value.extract::<i128>().is_err() {
        let list = times(name, value)?;
        return match list.iter().max() {
            Some(&most) if list.iter().all(|time| time.as_micros() >= least) => Ok((most, list)),
            _ => Err(wrong(name, shown(value), format_args!("one time of {least} or more for each sensor"))),
        };
    }
    whole(name, value, least..=u32::MAX).map(|us| (Micros::new(us), vec![]))
}

impl RequirementArguments<'_, '_> {
    /// Checked; without `t_delta_us` it is the most that `schedule` allows.
    pub(crate) fn owned(&self, schedule: &AnySchedule) -> PyResult<OwnedRequirements> {
        let mut requirements = self.of(schedule.sensors(), Micros::ZERO)?;
        if self.t_delta_us.is_none() {
            requirements.t_delta = schedule.verify(&requirements.requirements()).max_t_delta().unwrap_or(Micros::ZERO);
        }
        Ok(requirements)
    }

    /// Checked, for this many sensors; without `t_delta_us` it is this.
    pub(crate) fn of(&self, sensors: usize, t_delta: Micros) -> PyResult<OwnedRequirements> {
        let each_or_zero = |name, value: Option<&Bound<'_, PyAny>>| {
            value.map_or(Ok((Micros::ZERO, vec![])), |value| each(name, value, 0))
        };
        let (t_delta, t_deltas) =
            self.t_delta_us.map_or(Ok((t_delta, vec![])), |value| each("t_delta_us", value, 0))?;
        let (window, windows) = each_or_zero("window_us", self.window_us)?;
        Ok(OwnedRequirements {
            t_delta,
            min_interval: micros_or("min_interval_us", self.min_interval_us, Micros::ZERO)?,
            layout: layout(self.layout, neighbours(self.neighbours)?, sensors)?,
            criterion: criterion(self.criterion)?,
            window,
            stale_echo: flag("stale_echo", self.stale_echo, false)?,
            uneven: self.uneven.owned(sensors, t_deltas, windows)?,
        })
    }
}
