//! `sim.simulate`: a whole simulation in one call.

use std::sync::Arc;

use eeruf_sim::{Options, World, simulation::expected_readings};
use pyo3::prelude::*;

use crate::{
    arguments::{instance, whole, whole_or},
    memory,
    methods::{Chosen, best},
    own::Made,
    readings::Readings,
    scene::Scene,
    watch::{Background, in_background},
};

/// Drive the rings of a scene through simulated time by a method: core's own plans and judges, as on the target.
///
/// The same scene, method and seed give the same readings, bit for bit. It runs on one core, without the interpreter
/// lock; Ctrl-C ends it.
///
/// Args:
///     scene: a scene with one robot or more.
///     method: one of ``METHODS``, or a :class:`Method`.
///     periods: the number of periods of the first robot, 1 or more.
///     seed: the seed of the noise, 0 to 2^64 - 1; the scene's by default.
///     progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.
///
/// Returns:
///     Every reading.
///
/// Raises:
///     EerufError: no such method, or an argument of the wrong type or out of range; the scene has no robot; a ring's
///         listening times do not fit the method.
///     MemoryError: the readings do not fit into memory; :func:`simulate_blocks` gives them block by block.
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
    let asked = Asked::new(scene, method, periods, seed)?;
    let readings = expected_readings(&asked.world, asked.options.periods);
    let instead = "or simulate_blocks, which needs no more than a block";
    memory::check(&format!("{readings} readings"), eeruf_sim::Readings::bytes_for(readings), instead)?;
    in_background(scene.py(), progress, move |background| {
        let Asked { world, chosen: Chosen { entry, makers }, options } = asked.with_best(background)?;
        let keep_going = |share| background.go_on(Some(share), || format!("simulating {entry}"));
        let readings = entry.simulate(&world, &options, background.stop(), keep_going);
        readings.map(Readings::new).map_err(|error| Made(makers.into_iter().collect()).raise(error))
    })
}

/// The arguments of [`simulate`] and similar functions.
#[derive(Clone)]
pub(crate) struct Asked {
    pub(crate) world: Arc<World>,
    pub(crate) chosen: Chosen,
    pub(crate) options: Options,
}

impl Asked {
    pub(crate) fn new(
        scene: &Bound<'_, PyAny>,
        method: Option<&Bound<'_, PyAny>>,
        periods: Option<&Bound<'_, PyAny>>,
        seed: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let scene = instance::<Scene>("scene", scene, "an eeruf.sim.Scene")?;
        scene.get().world()?;
        let chosen = Chosen::of("method", method)?;
        let world = Arc::clone(Chosen::scene(method, scene)?.get().world()?);
        let options = Options {
            seed: seed.map(|seed| whole("seed", seed, 0..=u64::MAX)).transpose()?,
            ..Options::periods(whole_or("periods", periods, 1000, 1..=u32::MAX)?)
        };
        Ok(Self { world, chosen, options })
    }

    /// The arguments with the schedule of `eeruf_best`, if that is the method, and with the method's settings.
    pub(crate) fn with_best(mut self, background: &Background) -> PyResult<Self> {
        if let Some(robot) = self.world.robots().first() {
            let methods = std::slice::from_ref(&self.chosen.entry);
            self.options.best = best(methods, robot, background)?.map(|best| best.schedule);
        }
        self.options = self.chosen.entry.options(self.options);
        Ok(self)
    }
}
