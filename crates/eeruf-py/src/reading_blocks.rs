//! `sim.simulate_blocks`: a long simulation in little memory.

use eeruf_sim::simulation::expected_readings;
use pyo3::prelude::*;

use crate::{
    arguments::whole_or, memory, own, readings::Readings, simulate::Asked, simulation::Simulation, watch::Watch,
};

/// Default number of periods in a block.
const BLOCK_PERIODS: u32 = 10_000;

/// The readings of a simulation block by block: an iterator that Ctrl-C interrupts.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
///     >>> blocks = list(sim.simulate_blocks(scene, periods=25, block_periods=10))
///     >>> len(blocks), sum(map(len, blocks))
///     (3, 200)
#[pyclass(frozen, module = "eeruf.typing")]
pub(crate) struct ReadingBlocks {
    simulation: Simulation,
    block_periods: u32,
    progress: Option<Py<PyAny>>,
}

#[pymethods]
impl ReadingBlocks {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Readings>> {
        if py.detach(|| self.simulation.lock().map(|under_way| under_way.simulation.is_over()))? {
            return Ok(None);
        }
        let periods = self.block_periods;
        let progress = self.progress.as_ref().map(|progress| progress.bind(py));
        self.simulation
            .go_on(py, progress, |simulation, keep_going| simulation.step_periods(periods, keep_going))
            .map(Some)
    }
}

/// Simulate like :func:`simulate`, but block by block: however long it runs, it needs only the memory of a block.
///
/// Args:
///     scene: as for :func:`simulate`.
///     method: as for :func:`simulate`.
///     periods: the number of periods of the first robot, 1 or more.
///     seed: as for :func:`simulate`.
///     block_periods: how many periods a block has at most.
///     progress: as for :func:`simulate`.
///
/// Returns:
///     An iterator of ``Readings``, which together equal those of :func:`simulate`.
///
/// Raises:
///     EerufError: as for :func:`simulate`.
///     MemoryError: a block does not fit into memory.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
///     >>> wrong = 0
///     >>> for readings in sim.simulate_blocks(scene, periods=2_000, block_periods=500):
///     ...     wrong += int((readings.is_accepted & readings.is_wrong()).sum())
///     >>> wrong < 40
///     True
#[pyfunction]
#[pyo3(signature = (scene, method=None, periods=None, seed=None, *, block_periods=None, progress=None))]
#[pyo3(text_signature = "(scene, method=\"eeruf\", periods=1000, seed=None, *, block_periods=10000, progress=None)")]
pub(crate) fn simulate_blocks(
    scene: &Bound<'_, PyAny>,
    method: Option<&Bound<'_, PyAny>>,
    periods: Option<&Bound<'_, PyAny>>,
    seed: Option<&Bound<'_, PyAny>>,
    block_periods: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<ReadingBlocks> {
    let asked = Asked::new(scene, method, periods, seed)?;
    let block_periods = whole_or("block_periods", block_periods, BLOCK_PERIODS, 1..=u32::MAX)?;
    let readings = expected_readings(&asked.world, block_periods.min(asked.options.periods));
    let bytes = eeruf_sim::Readings::bytes_for(readings);
    memory::check(&format!("{readings} readings"), bytes, "so fewer block_periods")?;
    // Raise errors now, not with the first block.
    Watch::new(progress)?;
    let own = own::own(scene.py(), None, None, asked.chosen.makers.as_deref(), asked.world.robots())?;
    let simulation = Simulation::new_from(scene.py(), asked, own, true, None)?;
    Ok(ReadingBlocks { simulation, block_periods, progress: progress.map(|progress| progress.clone().unbind()) })
}
