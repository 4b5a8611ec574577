//! `HoppingSettings`.

use eeruf_core::{Micros, hopping::HoppingSettings as Core, judge::TrackerSettings};
use pyo3::{prelude::*, types::PyDict};

use crate::{
    arguments::{choice, instance, whole},
    errors::{ArgumentError, Raise},
};

/// The named sets.
const NAMED: [(&str, Core); 4] =
    [("balanced", Core::BALANCED), ("quick", Core::QUICK), ("driving", Core::DRIVING), ("maps", Core::MAPS)];

/// Settings by which a hopping ring, or its tracker alone, weighs readings and fires. Immutable; they compare, hash and
/// pickle.
///
/// Args:
///     name: what to start from: ``"balanced"`` for most robots, ``"quick"`` for those that must stop early (a little
///         more is wrong), ``"driving"`` for those that drive (no solo periods), ``"maps"`` for
///         confirmed echoes alone.
///     changes: whatever is to be different, by the names of the attributes; whole numbers.
///
/// Raises:
///     ArgumentError: no such name, or not such a number.
///     HoppingError: settings that contradict each other.
///
/// Example:
///     >>> import eeruf
///     >>> settings = eeruf.HoppingSettings("quick", shift_after=5)  # lags are redrawn
///     >>> settings.votes, settings.shift_after
///     (4, 5)
///     >>> settings
///     HoppingSettings('quick', shift_after=5)
#[pyclass(frozen, eq, hash, module = "eeruf")]
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct HoppingSettings(pub(crate) Core);

impl std::hash::Hash for HoppingSettings {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        for field in FIELDS {
            (field.get)(&self.0).hash(state);
        }
    }
}

/// A setting as a whole number.
struct Field {
    name: &'static str,
    most: u32,
    get: fn(&Core) -> u32,
    set: fn(&mut Core, u32),
}

macro_rules! fields {
    ($($name:literal: $kind:ident $($part:ident).+,)*) => {
        [$(Field {
            name: $name,
            most: fields!(most $kind),
            get: |settings| fields!(get $kind settings.$($part).+),
            set: |settings, value| settings.$($part).+ = fields!(set $kind value),
        }),*]
    };
    (most time) => { u32::MAX };
    (most count) => { u8::MAX as u32 };
    (get time $value:expr) => { $value.as_micros() };
    (get count $value:expr) => { u32::from($value) };
    (set time $value:expr) => { Micros::new($value) };
    // In range, as was checked before.
    (set count $value:expr) => { $value as u8 };
}

const FIELDS: [Field; 15] = fields! {
    "t_delta_us": time tracker.t_delta,
    "near_us": time tracker.near,
    "votes": count tracker.votes,
    "score_limit": count tracker.score_limit,
    "contradiction": count tracker.contradiction,
    "solo_contradiction": count tracker.solo_contradiction,
    "tentative_votes": count tracker.tentative_votes,
    "tentative_within_us": time tracker.tentative_within,
    "solo_rate": count solo_rate,
    "solo_after": count solo_after,
    "solo_spacing": count solo_spacing,
    "shift_after": count shift_after,
    "shift_spacing": count shift_spacing,
    "shift_interval_us": time shift_interval,
    "neighbours": count neighbours,
};

/// A setting's name, value, and value in the set it is compared with.
type Difference = (&'static str, u32);

impl HoppingSettings {
    /// Of an argument: a name, or settings.
    pub(crate) fn of(name: &str, value: Option<&Bound<'_, PyAny>>) -> PyResult<Core> {
        let Some(value) = value else { return Ok(Core::BALANCED) };
        if value.is_instance_of::<pyo3::types::PyString>() {
            return choice(name, Some(value), &NAMED);
        }
        let expected = "\"balanced\" or \"quick\" or \"driving\" or \"maps\", or an eeruf.HoppingSettings";
        Ok(instance::<Self>(name, value, expected)?.get().0)
    }

    /// The named set that differs least, and the differences.
    fn differences(&self) -> (&'static str, Vec<Difference>) {
        let differing = |named: &Core| -> Vec<Difference> {
            let own = FIELDS.iter().filter(|field| (field.get)(&self.0) != (field.get)(named));
            own.map(|field| (field.name, (field.get)(&self.0))).collect()
        };
        let all = NAMED.iter().map(|(name, named)| (*name, differing(named)));
        all.min_by_key(|(_, differing)| differing.len()).unwrap_or(("balanced", Vec::new()))
    }
}

#[pymethods]
impl HoppingSettings {
    #[new]
    #[pyo3(signature = (name=None, /, **changes))]
    #[pyo3(text_signature = "(name=\"balanced\", /, **changes)")]
    fn new(name: Option<&Bound<'_, PyAny>>, changes: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut settings = choice("name", name, &NAMED)?;
        for (key, value) in changes.into_iter().flatten() {
            let key: String = key.extract()?;
            let Some(field) = FIELDS.iter().find(|field| field.name == key) else {
                let names = FIELDS.map(|field| field.name).join(", ");
                return Err(ArgumentError::new_err(format!("no setting {key}; expected one of {names}")));
            };
            (field.set)(&mut settings, whole(field.name, &value, 0..=field.most)?);
        }
        settings.tracker.check().map_err(Raise::raise)?;
        Ok(Self(settings))
    }

    /// ``T_delta``: a reading supports an echo that it differs from by no more, in microseconds; 1 to 65535.
    #[getter]
    fn t_delta_us(&self) -> u32 {
        self.0.tracker.t_delta.as_micros()
    }

    /// A reading this near a confirmed echo is accepted, in microseconds; ``t_delta_us`` to 65535.
    #[getter]
    fn near_us(&self) -> u32 {
        self.0.tracker.near.as_micros()
    }

    /// Number of phases that must support an echo before it is confirmed, 2 to 15.
    #[getter]
    fn votes(&self) -> u8 {
        self.0.tracker.votes
    }

    /// The highest score of an echo, ``votes`` to 15: the higher, the longer it is believed.
    #[getter]
    fn score_limit(&self) -> u8 {
        self.0.tracker.score_limit
    }

    /// Score that a later reading takes from a confirmed echo, 1 to 15.
    #[getter]
    fn contradiction(&self) -> u8 {
        self.0.tracker.contradiction
    }

    /// Score that it takes if the sensor fired alone, 1 to 15.
    #[getter]
    fn solo_contradiction(&self) -> u8 {
        self.0.tracker.solo_contradiction
    }

    /// Number of phases that must support an echo before it is tentative, 2 to 15; 0: none ever is.
    #[getter]
    fn tentative_votes(&self) -> u8 {
        self.0.tracker.tentative_votes
    }

    /// Tolerance of agreement for that, in microseconds; 0 to ``t_delta_us``.
    #[getter]
    fn tentative_within_us(&self) -> u32 {
        self.0.tracker.tentative_within.as_micros()
    }

    /// Credit per period towards a solo period, in 1/256, 0 to 255; 0: none is ever held.
    #[getter]
    fn solo_rate(&self) -> u8 {
        self.0.solo_rate
    }

    /// A sensor with nothing accepted for this many firings asks for a solo period.
    #[getter]
    fn solo_after(&self) -> u8 {
        self.0.solo_after
    }

    /// At least this many periods from one solo period to the next.
    #[getter]
    fn solo_spacing(&self) -> u8 {
        self.0.solo_spacing
    }

    /// After this many readings running that do not fit, a sensor draws a new lag; 0: lags stay.
    #[getter]
    fn shift_after(&self) -> u8 {
        self.0.shift_after
    }

    /// At least this many periods from one change of lags to the next.
    #[getter]
    fn shift_spacing(&self) -> u8 {
        self.0.shift_spacing
    }

    /// Least interval between firings of neighbours when a lag is drawn, in microseconds.
    #[getter]
    fn shift_interval_us(&self) -> u32 {
        self.0.shift_interval.as_micros()
    }

    /// Number of adjacent sensors that are neighbours.
    #[getter]
    fn neighbours(&self) -> u8 {
        self.0.neighbours
    }

    fn __repr__(&self) -> String {
        let (name, differences) = self.differences();
        let changes: String = differences.iter().map(|(key, value)| format!(", {key}={value}")).collect();
        format!("HoppingSettings('{name}'{changes})")
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((&'static str,), Bound<'py, PyDict>)> {
        let ((name, differences), changes) = (self.differences(), PyDict::new(py));
        for (key, value) in differences {
            changes.set_item(key, value)?;
        }
        Ok(((name,), changes))
    }
}

/// The settings of a tracker, with another `t_delta` if there is one: what depends on it gives way.
pub(crate) fn tracker_settings(
    t_delta: Option<Micros>,
    settings: Option<&Bound<'_, PyAny>>,
) -> PyResult<TrackerSettings> {
    let mut tracker = HoppingSettings::of("settings", settings)?.tracker;
    if let Some(t_delta) = t_delta {
        tracker.t_delta = t_delta;
        tracker.near = tracker.near.max(t_delta);
        tracker.tentative_within = tracker.tentative_within.min(t_delta);
    }
    tracker.check().map_err(Raise::raise)?;
    Ok(tracker)
}
