//! Requirements on a schedule: needs named one by one, or a `Needs`.

use eeruf_core::{Criterion, MAX_SENSORS, Micros, Requirements, SpeedOfSound};
use eeruf_design::{LayoutKey, LayoutName, OwnedLayout, OwnedUneven, Places, RingSpec};
use eeruf_sim::AnySchedule;
use pyo3::exceptions::PyTypeError;
use pyo3::{prelude::*, types::PyDict, types::PyList};

use crate::arguments::{choice, flag, items, micros, micros_or, shown, times, whole, whole_or, wrong};
use crate::errors::EerufError;
use crate::needs::Needs;

/// Further needs of rings whose sensors are all alike, besides the common ones.
pub(crate) const ALIKE: [&str; 3] = ["neighbours", "layout", "stale_echo"];
/// Needs of single sensors and pairs.
pub(crate) const UNEVEN: [&str; 4] = ["refire_us", "intervals_us", "shared_lines", "together"];

/// A layout by its name, or by its pairs of neighbours; a line by default.
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
    value.map_or(Ok(LayoutKey::Unsaid), key)?.owned(neighbours, sensors).map_err(EerufError::new_err)
}

/// Number of adjacent sensors that count as neighbours; four by default, as in the paper (Sec. 3.1 c).
pub(crate) fn neighbours(value: Option<&Bound<'_, PyAny>>) -> PyResult<u8> {
    whole_or("neighbours", value, 4, 1..=MAX_SENSORS as u8)
}

/// The number of sensors.
pub(crate) fn sensors(value: &Bound<'_, PyAny>) -> PyResult<usize> {
    whole("sensors", value, 1..=MAX_SENSORS as u32).map(|sensors| sensors as usize)
}

/// The needs in a call, by name.
pub(crate) struct Asked<'py>(Bound<'py, PyDict>);

impl<'py> Asked<'py> {
    /// Needs from the positional arguments, and from other keywords that are known.
    pub(crate) fn of<const N: usize>(
        py: Python<'py>,
        call: &str,
        placed: [(&str, Option<&Bound<'py, PyAny>>); N],
        others: Option<&Bound<'py, PyDict>>,
        known: &[&[&str]],
    ) -> PyResult<Self> {
        let asked = PyDict::new(py);
        for (name, value) in placed {
            value.map_or(Ok(()), |value| asked.set_item(name, value))?;
        }
        for (key, value) in others.into_iter().flatten() {
            if !known.iter().flat_map(|names| *names).any(|name| key.eq(name).unwrap_or(false)) {
                return Err(PyTypeError::new_err(format!("{call}() got an unexpected keyword argument '{key}'")));
            }
            if !value.is_none() {
                asked.set_item(key, value)?;
            }
        }
        Ok(Self(asked))
    }

    pub(crate) fn get(&self, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.0.get_item(name)
    }

    /// A required need.
    pub(crate) fn must(&self, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let expected = "t_delta_us, min_interval_us and window_us, or a Needs or a ring file in place of all";
        self.get(name)?.ok_or_else(|| wrong(name, "None", expected))
    }

    /// Refuses needs given besides a `Needs`, which already has them.
    pub(crate) fn none(&self, but: &str) -> PyResult<()> {
        for (name, value) in &self.0 {
            if !name.eq(but)? {
                return Err(wrong(&name.to_string(), shown(&value), "none beside a Needs, which says it"));
            }
        }
        Ok(())
    }

    /// The ring of a search: a `Needs`, the path of a ring file, or a number of sensors and these needs.
    pub(crate) fn ring(&self, sensors: &Bound<'py, PyAny>) -> PyResult<RingSpec> {
        if let Some(needs) = Needs::given(sensors)? {
            return self.none("").map(|()| needs.ring().clone());
        }
        let (sensors, t_delta) = (self::sensors(sensors)?, each("t_delta_us", &self.must("t_delta_us")?, 0)?);
        let min_interval = micros("min_interval_us", &self.must("min_interval_us")?)?;
        let window = each("window_us", &self.must("window_us")?, 1)?;
        let spec = self.spec(sensors, t_delta, min_interval, window)?;
        OwnedUneven::can_fire_together(&spec.problem().requirements, sensors).map_err(EerufError::new_err)?;
        Ok(spec)
    }

    /// The ring for which a schedule is checked; without `t_delta_us` it is the largest that the schedule allows.
    pub(crate) fn ring_of(&self, schedule: &AnySchedule) -> PyResult<RingSpec> {
        let sensors = schedule.sensors();
        let t_delta = self.get("t_delta_us")?;
        if let Some(needs) = t_delta.as_ref().map_or(Ok(None), Needs::given)? {
            self.none("t_delta_us")?;
            if needs.ring().sensors != sensors {
                let expected = format!("needs of {sensors} sensors, as the schedule has");
                return Err(wrong("t_delta_us", format_args!("needs of {} sensors", needs.ring().sensors), expected));
            }
            return Ok(needs.ring().covering(needs.ring().t_delta_needed(schedule)));
        }
        let or_zero = |name| self.get(name)?.map_or(Ok((Micros::ZERO, vec![])), |value| each(name, &value, 0));
        let min_interval = micros_or("min_interval_us", self.get("min_interval_us")?.as_ref(), Micros::ZERO)?;
        let mut spec = self.spec(sensors, or_zero("t_delta_us")?, min_interval, or_zero("window_us")?)?;
        if t_delta.is_none() {
            let requirements = Requirements { criterion: self.criterion()?, ..spec.problem().requirements };
            spec.t_delta = schedule.verify(&requirements).max_t_delta().unwrap_or(Micros::ZERO);
        }
        Ok(spec)
    }

    /// The interpretation of (13a), (13b); exact by default.
    fn criterion(&self) -> PyResult<Criterion> {
        let criterion = self.get("criterion")?;
        choice("criterion", criterion.as_ref(), &[("exact", Criterion::Exact), ("paper", Criterion::Paper)])
    }

    /// Calls a function with these requirements on a schedule.
    pub(crate) fn check<T>(&self, schedule: &AnySchedule, answer: impl FnOnce(&Requirements<'_>) -> T) -> PyResult<T> {
        let spec = self.ring_of(schedule)?;
        Ok(answer(&Requirements { criterion: self.criterion()?, ..spec.problem().requirements }))
    }

    /// The ring with these times, one for all sensors or one for each.
    pub(crate) fn spec(
        &self,
        sensors: usize,
        (t_delta, t_deltas): (Micros, Vec<Micros>),
        min_interval: Micros,
        (window, windows): (Micros, Vec<Micros>),
    ) -> PyResult<RingSpec> {
        let neighbours = neighbours(self.get("neighbours")?.as_ref())?;
        Ok(RingSpec {
            sensors,
            tick: Micros::new(whole_or("tick_us", self.get("tick_us")?.as_ref(), 1000, 1..=u32::MAX)?),
            layout: layout(self.get("layout")?.as_ref(), neighbours, sensors)?,
            neighbours,
            not_neighbours: vec![],
            min_interval,
            window,
            listening: window,
            retrigger: Micros::ZERO,
            stale_echo: flag("stale_echo", self.get("stale_echo")?.as_ref(), false)?,
            stale_echo_by_module: false,
            c: SpeedOfSound::at_celsius_tenths(200),
            t_delta,
            speed_mm_s: None,
            handling: Micros::ZERO,
            path_change: None,
            audible: None,
            others: true,
            meets_others: false,
            turn_deg_s: None,
            modules: vec![],
            sees_by_module: false,
            places: Places::default(),
            uneven: self.uneven(sensors, t_deltas, windows)?,
        })
    }

    /// Differences between the sensors; a list of `t_delta` or windows is empty if all are equal. `None` without
    /// differences.
    fn uneven(&self, sensors: usize, t_delta: Vec<Micros>, window: Vec<Micros>) -> PyResult<Option<OwnedUneven>> {
        let [refire, intervals, lines, together] = UNEVEN.map(|name| self.get(name));
        let (refire, intervals, lines, together) = (refire?, intervals?, lines?, together?);
        let all = [&refire, &intervals, &lines, &together];
        if t_delta.is_empty() && window.is_empty() && all.iter().all(|value| value.is_none()) {
            return Ok(None);
        }
        let refire = refire.map_or(Ok((Micros::ZERO, vec![])), |value| each("refire_us", &value, 0))?;
        let refire = if refire.1.is_empty() { vec![refire.0; sensors] } else { refire.1 };
        let expected = "triples of two sensors and a time in microseconds, such as [(0, 1, 9000)]";
        let intervals = list("intervals_us", intervals.as_ref(), expected)?;
        let expected = "groups of sensors, such as [(0, 4), (1, 5)]";
        let lines = list("shared_lines", lines.as_ref(), expected)?;
        let together = list("together", together.as_ref(), expected)?;
        OwnedUneven::new(sensors, [t_delta, window, refire], &intervals, &lines, &together)
            .map(Some)
            .map_err(EerufError::new_err)
    }
}

/// Items of one type; empty without the argument.
fn list<T>(name: &str, value: Option<&Bound<'_, PyAny>>, expected: &str) -> PyResult<Vec<T>>
where
    T: for<'a, 'py> FromPyObject<'a, 'py>,
{
    let Some(value) = value else { return Ok(vec![]) };
    let item = |item: Bound<'_, PyAny>| item.extract().map_err(|_| wrong(name, shown(value), expected));
    items(name, value, expected)?.into_iter().map(item).collect()
}

/// A time for all sensors, or one for each, at least `least`; the largest then counts for all.
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
