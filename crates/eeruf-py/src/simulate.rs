//! `sim.simulate`.

use eeruf_sim::{Method, Options, simulate_while};
use pyo3::prelude::*;

use crate::{
    arguments::{instance, whole, whole_or},
    errors::Raise,
    methods::{self, best},
    readings::Readings,
    scene::Scene,
    watch::in_background,
};

/// Drive the rings of a scene through simulated time by a method: core's own scheduler and filter, as on the target.
///
/// The same scene, method and seed give the same readings, bit for bit. It runs on one core, without the interpreter
/// lock; Ctrl-C ends it.
///
/// Args:
///     scene: with one robot or more.
///     method: one of ``METHODS``.
///     periods: for how many periods of the first robot, 1 or more.
///     seed: of the noise, 0 to 2^64 - 1; the scene's by default.
///     progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.
///
/// Returns:
///     Every reading.
///
/// Raises:
///     ArgumentError: no such method, or something of the wrong type or out of range.
///     SceneError: the scene has no robot.
///     SimulationError: a ring cannot fire by the method as it should listen.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
///     >>> sim.simulate(scene, method="conventional", periods=10)
///     <Readings: 80 of 8 sensors, conventional, 0.600 s>
#[pyfunction]
#[pyo3(signature = (scene, method=None, periods=None, seed=None, *, progress=None))]
#[pyo3(text_signature = "(scene, method=\"eeruf\", periods=1000, seed=None, *, progress=None)")]
pub(crate) fn simulate(
    scene: &Bound<'_, PyAny>,
    method: Option<&Bound<'_, PyAny>>,
    periods: Option<&Bound<'_, PyAny>>,
    seed: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Readings> {
    let scene = instance::<Scene>("scene", scene, "an eeruf.sim.Scene")?;
    scene.get().world()?;
    let method = method.map_or(Ok(Method::Eeruf), |name| methods::method("method", name))?;
    let mut options = Options {
        seed: seed.map(|seed| whole("seed", seed, 0..=u64::MAX)).transpose()?,
        ..Options::periods(whole_or("periods", periods, 1000, 1..=u32::MAX)?)
    };
    let (py, scene) = (scene.py(), scene.clone().unbind());
    in_background(py, progress, move |background| {
        let world = scene.get().world()?;
        if let Some(robot) = world.robots().first() {
            options.best = best(&[method], robot, background)?.map(|best| best.schedule);
        }
        let keep_going = |share| background.go_on(Some(share), || format!("simulating {method}"));
        simulate_while(world, method, &options, keep_going).map(Readings).map_err(Raise::raise)
    })
}
