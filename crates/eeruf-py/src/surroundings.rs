//! `sim.Material` and `sim.Noise`: reflection of surfaces, and noise.

use eeruf_sim::{Physics, Room};
use pyo3::{
    prelude::*,
    types::{PyDict, PyString},
};

use crate::arguments::{flag, items, number, number_or, shown, wrong};
use crate::fields::{Reduced, reduce, repr, settings};

/// The surface of a wall or a pole.
///
/// Args:
///     reflection: the share of the pressure that a flat piece returns, 0 to 1.
///     roughness_m: the root-mean-square height of the surface, in metres.
///
/// Raises:
///     EerufError: a number out of range.
///
/// Example:
///     >>> from eeruf import sim
///     >>> sim.Scene([[5, 2, -5, 2]], materials=sim.Material(0.6, roughness_m=0.0002)).materials[0].reflection
///     0.6
#[pyclass(frozen, eq, get_all, module = "eeruf.sim")]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Material {
    /// The share of the pressure that a flat piece returns.
    reflection: f64,
    /// The root-mean-square height of the surface, in metres.
    roughness_m: f64,
}

const NAMED: [(&str, eeruf_sim::Material); 4] = [
    ("smooth", eeruf_sim::Material::SMOOTH),
    ("painted", eeruf_sim::Material::PAINTED),
    ("soft", eeruf_sim::Material::SOFT),
    ("perfect", eeruf_sim::Material::PERFECT),
];

impl Material {
    pub(crate) fn of(material: eeruf_sim::Material) -> Self {
        Self { reflection: material.reflection, roughness_m: material.roughness_m }
    }

    fn material(self) -> eeruf_sim::Material {
        eeruf_sim::Material { reflection: self.reflection, roughness_m: self.roughness_m }
    }
}

const MATERIAL: [&str; 2] = ["reflection", "roughness_m"];

#[pymethods]
impl Material {
    #[new]
    #[pyo3(signature = (reflection, roughness_m=None), text_signature = "(reflection, roughness_m=0.0)")]
    fn new(reflection: &Bound<'_, PyAny>, roughness_m: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let reflection = number("reflection", reflection, 0.0..=1.0)?;
        let roughness_m = number_or("roughness_m", roughness_m, 0.0, 0.0..=1.0)?;
        Ok(Self { reflection, roughness_m })
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        repr(slf, &MATERIAL)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &MATERIAL)
    }
}

fn one(name: &str, value: &Bound<'_, PyAny>) -> PyResult<eeruf_sim::Material> {
    if let Ok(material) = value.cast::<Material>() {
        return Ok(material.get().material());
    }
    let said = value.extract::<String>().unwrap_or_default();
    let named = NAMED.iter().find(|(known, _)| *known == said);
    let expected = "\"smooth\", \"painted\", \"soft\", \"perfect\" or an eeruf.sim.Material";
    named.map(|(_, material)| *material).ok_or_else(|| wrong(name, shown(value), expected))
}

/// One material for each of this many surfaces: the same for all, or one each.
pub(crate) fn materials(
    name: &str,
    value: Option<&Bound<'_, PyAny>>,
    surfaces: usize,
) -> PyResult<Vec<eeruf_sim::Material>> {
    let Some(value) = value else { return Ok(vec![eeruf_sim::Material::default(); surfaces]) };
    if value.is_instance_of::<PyString>() || value.is_instance_of::<Material>() {
        return Ok(vec![one(name, value)?; surfaces]);
    }
    let each = items(name, value, "one material, or one for each")?;
    if each.len() != surfaces {
        return Err(wrong(&format!("number of {name}"), each.len(), format_args!("{surfaces}, one for each")));
    }
    each.iter().enumerate().map(|(index, value)| one(&format!("{name}[{index}]"), value)).collect()
}

/// Noise of a scene.
///
/// Args:
///     fading_db_rms: rms change of each arrival's level, in dB, 0 to 20.
///     jitter_us_rms: rms error of each arrival's time, in microseconds, 0 to 10,000.
///     bursts_per_s: how many external bursts are heard per second, 0 to 10,000.
///     burst_db: their level above the threshold of hearing, in dB, -200 to 200.
///
/// Raises:
///     EerufError: a number out of range.
///
/// Example:
///     >>> from eeruf import sim
///     >>> sim.Scene([[5, 2, -5, 2]], noise=sim.Noise(bursts_per_s=5.0)).noise.bursts_per_s
///     5.0
#[pyclass(frozen, eq, module = "eeruf.sim")]
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct Noise(pub(crate) eeruf_sim::Noise);

settings! {
    Noise(eeruf_sim::Noise) "(*, fading_db_rms=1.5, jitter_us_rms=15.0, bursts_per_s=0.0, burst_db=20.0)" {
        /// Fading of each arrival's level, root mean square, in dB.
        fading_db_rms: f64 = number_or(0.0..=20.0),
        /// Jitter of each arrival, root mean square, in microseconds.
        jitter_us_rms: f64 = number_or(0.0..=1e4),
        /// Number of bursts from outside that are heard in a second.
        bursts_per_s: f64 = number_or(0.0..=1e4),
        /// Level above the threshold of hearing, in dB.
        burst_db: f64 = number_or(-200.0..=200.0),
    }
}

/// `True` for the default, `False` for none, or a `Noise`.
pub(crate) fn noise(value: Option<&Bound<'_, PyAny>>) -> PyResult<eeruf_sim::Noise> {
    let Some(value) = value else { return Ok(eeruf_sim::Noise::default()) };
    if let Ok(noise) = value.cast::<Noise>() {
        return Ok(noise.get().0);
    }
    match value.extract() {
        Ok(true) => Ok(eeruf_sim::Noise::default()),
        Ok(false) => Ok(eeruf_sim::Noise::NONE),
        Err(_) => Err(wrong("noise", shown(value), "True, False or an eeruf.sim.Noise")),
    }
}

const PHYSICS: &str = "\"plain\", \"default\", or a dict with preset, shadows, edges, narrow_panels, range_walk, \
                       interference or fading_time_s";

/// Effects of a scene: a preset's name, or the differences from one.
pub(crate) fn physics(value: Option<&Bound<'_, PyAny>>) -> PyResult<Physics> {
    let refused = |value: &Bound<'_, PyAny>| wrong("physics", shown(value), PHYSICS);
    let preset = |value: &Bound<'_, PyAny>| {
        value.extract::<String>().ok().and_then(|name| name.parse().ok()).ok_or_else(|| refused(value))
    };
    let Some(value) = value else { return Ok(Physics::DEFAULT) };
    let Ok(changes) = value.cast::<PyDict>() else { return preset(value) };
    let mut physics = changes.get_item("preset")?.map_or(Ok(Physics::DEFAULT), |name| preset(&name))?;
    for (name, change) in changes {
        match name.extract::<String>().as_deref() {
            Ok("preset") => {}
            Ok("shadows") => physics.shadows = flag("shadows", Some(&change), physics.shadows)?,
            Ok("edges") => physics.edges = flag("edges", Some(&change), physics.edges)?,
            Ok("narrow_panels") => {
                physics.narrow_panels = flag("narrow_panels", Some(&change), physics.narrow_panels)?;
            }
            Ok("range_walk") => physics.range_walk = flag("range_walk", Some(&change), physics.range_walk)?,
            Ok("interference") => physics.interference = flag("interference", Some(&change), physics.interference)?,
            Ok("fading_time_s") => physics.fading_time_s = number("fading_time_s", &change, 0.0..=3600.0)?,
            _ => return Err(refused(value)),
        }
    }
    Ok(physics)
}

const HEIGHT: &str = "\"flat\", \"room\", or a dict with ceiling_m, floor or ceiling";

/// Floor and ceiling; `None` for a flat scene.
pub(crate) fn height(value: Option<&Bound<'_, PyAny>>) -> PyResult<Option<Room>> {
    let refused = |value: &Bound<'_, PyAny>| wrong("height", shown(value), HEIGHT);
    let Some(value) = value else { return Ok(None) };
    let Ok(changes) = value.cast::<PyDict>() else {
        return match value.extract::<String>().as_deref() {
            Ok("flat") => Ok(None),
            Ok("room") => Ok(Some(Room::DEFAULT)),
            _ => Err(refused(value)),
        };
    };
    let mut room = Room::DEFAULT;
    for (name, change) in changes {
        match name.extract::<String>().as_deref() {
            Ok("ceiling_m") => room.ceiling_m = number("ceiling_m", &change, 0.0..=1e3)?,
            Ok("floor") => room.floor = one("floor", &change)?,
            Ok("ceiling") => room.ceiling = one("ceiling", &change)?,
            _ => return Err(refused(value)),
        }
    }
    Ok(Some(room))
}

/// The argument that gives this room.
pub(crate) fn shown_height<'py>(py: Python<'py>, room: Option<&Room>) -> PyResult<Bound<'py, PyAny>> {
    let all = PyDict::new(py);
    match room {
        None => return Ok(PyString::new(py, "flat").into_any()),
        Some(room) if *room == Room::DEFAULT => return Ok(PyString::new(py, "room").into_any()),
        Some(room) => {
            all.set_item("ceiling_m", room.ceiling_m)?;
            all.set_item("floor", Material::of(room.floor))?;
            all.set_item("ceiling", Material::of(room.ceiling))?;
        }
    }
    Ok(all.into_any())
}

/// The argument that gives these effects.
pub(crate) fn shown_physics<'py>(py: Python<'py>, physics: &Physics) -> PyResult<Bound<'py, PyAny>> {
    if let Some(name) = physics.name() {
        return Ok(PyString::new(py, name).into_any());
    }
    let all = PyDict::new(py);
    all.set_item("shadows", physics.shadows)?;
    all.set_item("edges", physics.edges)?;
    all.set_item("narrow_panels", physics.narrow_panels)?;
    all.set_item("range_walk", physics.range_walk)?;
    all.set_item("interference", physics.interference)?;
    all.set_item("fading_time_s", physics.fading_time_s)?;
    Ok(all.into_any())
}
