//! `nav.Himm`: histogramic in-motion mapping.

use eeruf_core::ReadingKind;
use eeruf_sim::{Air, Point, Pose};
use numpy::{PyArray1, prelude::*};
use pyo3::prelude::*;

use crate::{
    arguments::{flag, instance, number, number_or, whole_or},
    columns::read_only,
    exclusive::Exclusive,
    pose::{point_of, pose_of, to_pose},
    readings::Readings,
};

/// Largest range, in metres, up to which a reading is entered.
const FARTHEST_M: f64 = 1e3;

/// A certainty grid that range readings fill and clear while the robot drives: histogramic in-motion mapping
/// (J. Borenstein and Y. Koren, IEEE T-RA 7(4), 1991).
///
/// A reading counts only on the sensor's acoustic axis: the cell at the measured range gains 3, each cell on the way
/// there loses 1, and values stay between 0 and 15. A real obstacle is met again and again and grows quickly; a phantom
/// is met once and is cleared by the next readings that look past it.
///
/// Args:
///     side: how many cells the grid's window has on a side, 1 to 4096.
///     cell_m: how wide a cell is, in metres, above 0.
///     growth: whether cells next to filled ones grow faster (the paper's growth rate operator, for fast robots).
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range.
///
/// Example:
///     >>> from eeruf import nav
///     >>> grid = nav.Himm()
///     >>> grid.echo((0.05, 0.05, 0.0), range_m=1.0)
///     >>> grid.value((1.05, 0.05)), grid.value((9.0, 0.0))
///     (3, None)
#[pyclass(frozen, module = "eeruf.nav")]
pub(crate) struct Himm {
    pub(crate) grid: Exclusive<eeruf_sim::Himm>,
}

fn metres(name: &str, value: Option<&Bound<'_, PyAny>>, default: f64) -> PyResult<f64> {
    number_or(name, value, default, 0.0..=FARTHEST_M)
}

/// Place and heading of a sensor.
fn axis(sensor: &Bound<'_, PyAny>) -> PyResult<(Point, f64)> {
    let of: Pose = to_pose(pose_of("sensor", sensor)?);
    Ok((Point::from(of.translation.vector), of.rotation.angle()))
}

#[pymethods]
impl Himm {
    #[new]
    #[pyo3(signature = (side=None, cell_m=None, *, growth=None))]
    #[pyo3(text_signature = "(side=33, cell_m=0.1, *, growth=False)")]
    fn new(
        side: Option<&Bound<'_, PyAny>>,
        cell_m: Option<&Bound<'_, PyAny>>,
        growth: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let side = whole_or("side", side, 33, 1..=4096)?;
        let cell_m = number_or("cell_m", cell_m, 0.1, 1e-3..=1e3)?;
        let mut grid = eeruf_sim::Himm::new(side, cell_m);
        grid.growth = flag("growth", growth, false)?;
        Ok(Self { grid: Exclusive::new("Himm", grid) })
    }

    /// Number of cells the window has on a side.
    #[getter]
    fn side(&self) -> PyResult<usize> {
        Ok(self.grid.get()?.side())
    }

    /// Width of a cell, in metres.
    #[getter]
    fn cell_m(&self) -> PyResult<f64> {
        Ok(self.grid.get()?.cell_m())
    }

    /// Returns true if cells next to filled ones grow faster.
    #[getter]
    fn growth(&self) -> PyResult<bool> {
        Ok(self.grid.get()?.growth)
    }

    /// Extent of the window: (least x, greatest x, least y, greatest y) in metres, as ``imshow`` takes it.
    #[getter]
    fn extent_m(&self) -> PyResult<(f64, f64, f64, f64)> {
        let grid = self.grid.get()?;
        let (corner, width) = (grid.corner(), grid.side() as f64 * grid.cell_m());
        Ok((corner.x, corner.x + width, corner.y, corner.y + width))
    }

    /// Move the window so that a place is in its middle cell. Cells that leave it are forgotten, and new cells are
    /// empty.
    ///
    /// Args:
    ///     place: (x, y) in metres.
    ///
    /// Raises:
    ///     EerufError: an invalid place.
    ///
    /// Example:
    ///     >>> from eeruf import nav
    ///     >>> grid = nav.Himm()
    ///     >>> grid.move_to((9.05, 0.05))
    ///     >>> grid.value((9.0, 0.0)), grid.value((0.0, 0.0))
    ///     (0, None)
    fn move_to(&self, place: &Bound<'_, PyAny>) -> PyResult<()> {
        let place = point_of("place", place)?;
        self.grid.get()?.move_to(place);
        Ok(())
    }

    /// Enter an echo: an obstacle on a sensor's axis, and free space in front of it.
    ///
    /// Args:
    ///     sensor: its place and heading (x, y, heading) in metres and radians.
    ///     range_m: the distance of the obstacle, in metres, 0 to 1,000.
    ///     near_m: cells nearer than this, where the sensor is deaf, are left as they are.
    ///
    /// Raises:
    ///     EerufError: an invalid place or range.
    ///
    /// Example:
    ///     >>> from eeruf import nav
    ///     >>> grid = nav.Himm()
    ///     >>> for _ in range(9):
    ///     ...     grid.echo((0.0, 0.0, 1.57), range_m=1.0)
    ///     >>> grid.cells().round(2).tolist()
    ///     [[0.05, 0.95, 15.0]]
    #[pyo3(signature = (sensor, range_m, near_m=None), text_signature = "($self, sensor, range_m, near_m=0.0)")]
    fn echo(
        &self,
        sensor: &Bound<'_, PyAny>,
        range_m: &Bound<'_, PyAny>,
        near_m: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (at, heading) = axis(sensor)?;
        let range_m = number("range_m", range_m, 0.0..=FARTHEST_M)?;
        let near_m = metres("near_m", near_m, 0.0)?;
        self.grid.get()?.echo(at, heading, near_m, range_m);
        Ok(())
    }

    /// Enter free space on a sensor's axis.
    ///
    /// Args:
    ///     sensor: its place and heading (x, y, heading) in metres and radians.
    ///     range_m: the length of the free space, in metres, 0 to 1,000.
    ///     near_m: cells nearer than this, where the sensor is deaf, are left as they are.
    ///
    /// Raises:
    ///     EerufError: an invalid place or range.
    ///
    /// Example:
    ///     >>> from eeruf import nav
    ///     >>> grid = nav.Himm()
    ///     >>> grid.echo((0.05, 0.05, 0.0), range_m=1.0)
    ///     >>> grid.clear((0.05, 0.05, 0.0), range_m=1.5)
    ///     >>> grid.value((1.05, 0.05))
    ///     2
    #[pyo3(signature = (sensor, range_m, near_m=None), text_signature = "($self, sensor, range_m, near_m=0.0)")]
    fn clear(
        &self,
        sensor: &Bound<'_, PyAny>,
        range_m: &Bound<'_, PyAny>,
        near_m: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let (at, heading) = axis(sensor)?;
        let range_m = number("range_m", range_m, 0.0..=FARTHEST_M)?;
        let near_m = metres("near_m", near_m, 0.0)?;
        self.grid.get()?.clear(at, heading, near_m, range_m);
        Ok(())
    }

    /// Enter the readings of a simulation's ring from each sensor's true place: accepted echoes within a range are
    /// obstacles; farther ones, and readings of free space, clear the cells on the way.
    ///
    /// Args:
    ///     readings: the readings that ``Simulation.step`` returned.
    ///     range_m: the range up to which the grid is filled, in metres, 0 to 1,000.
    ///     near_m: cells nearer than this, where the sensors are deaf, are left as they are.
    ///     robot: index of the robot whose readings count, from 0.
    ///     sound_m_s: the speed of sound, in m/s, 100 to 1000.
    ///
    /// Raises:
    ///     EerufError: not readings, or an argument out of range.
    ///
    /// Example:
    ///     >>> from eeruf import nav, sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> world = sim.Simulation(sim.Scene([[5, 1.5, -5, 1.5]], robots=[robot]))
    ///     >>> grid = nav.Himm()
    ///     >>> grid.enter(world.step(1.0), range_m=2.0)
    ///     >>> x, y, value = grid.cells().T
    ///     >>> bool(1.4 < y[value == 15].min() <= y.max() < 1.7)
    ///     True
    #[pyo3(signature = (readings, range_m=None, near_m=None, *, robot=None, sound_m_s=None))]
    #[pyo3(text_signature = "($self, readings, range_m=3.0, near_m=0.0, *, robot=0, sound_m_s=343.2)")]
    fn enter(
        &self,
        readings: &Bound<'_, PyAny>,
        range_m: Option<&Bound<'_, PyAny>>,
        near_m: Option<&Bound<'_, PyAny>>,
        robot: Option<&Bound<'_, PyAny>>,
        sound_m_s: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let taken = &instance::<Readings>("readings", readings, "eeruf.sim.Readings")?.get().readings;
        let (range_m, near_m) = (metres("range_m", range_m, 3.0)?, metres("near_m", near_m, 0.0)?);
        let robot = whole_or("robot", robot, 0, 0..=u16::MAX)?;
        let c = number_or("sound_m_s", sound_m_s, Air::default().speed_of_sound(), 100.0..=1e3)?;
        let mut grid = self.grid.get()?;
        for reading in (0..taken.len()).filter(|&reading| taken.robot[reading] == robot && taken.is_accepted(reading)) {
            let (at, heading) = (Point::new(taken.x_m[reading], taken.y_m[reading]), taken.heading_rad[reading]);
            let echo_m = 0.5e-6 * c * taken.t_echo_us[reading];
            if taken.kind[reading] == ReadingKind::Clear || echo_m > range_m {
                grid.clear(at, heading, near_m, range_m);
            } else {
                grid.echo(at, heading, near_m, echo_m);
            }
        }
        Ok(())
    }

    /// The certainty of the cell that holds a point.
    ///
    /// Args:
    ///     point: (x, y) in metres.
    ///
    /// Returns:
    ///     0 to 15, or None outside the window.
    ///
    /// Raises:
    ///     EerufError: not a point.
    ///
    /// Example:
    ///     >>> from eeruf import nav
    ///     >>> nav.Himm().value((0.0, 0.0))
    ///     0
    fn value(&self, point: &Bound<'_, PyAny>) -> PyResult<Option<u8>> {
        let point = point_of("point", point)?;
        Ok(self.grid.get()?.value(point))
    }

    /// The cells that are not empty.
    ///
    /// Returns:
    ///     Array of shape (n, 3), float64: x, y (m) of the cell's middle, and its certainty, 1 to 15.
    ///
    /// Example:
    ///     >>> from eeruf import nav
    ///     >>> nav.Himm().cells().shape
    ///     (0, 3)
    fn cells<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let cells: Vec<f64> =
            occupied(&*self.grid.get()?).flat_map(|(at, value)| [at.x, at.y, f64::from(value)]).collect();
        let rows = cells.len() / 3;
        Ok(PyArray1::from_vec(py, cells).reshape([rows, 3])?.readwrite().make_nonwriteable().as_any().clone())
    }

    /// The whole window as a picture, for ``imshow(grid.to_numpy(), extent=grid.extent_m, origin="lower")``.
    ///
    /// Returns:
    ///     Array of shape (side, side), int8: a row for each y, from the least; certainties 0 to 15.
    ///
    /// Example:
    ///     >>> from eeruf import nav
    ///     >>> grid = nav.Himm(side=3)
    ///     >>> grid.echo((0.05, 0.05, 0.0), range_m=0.1)
    ///     >>> grid.to_numpy().tolist()
    ///     [[0, 0, 0], [0, 0, 3], [0, 0, 0]]
    fn to_numpy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let grid = self.grid.get()?;
        let (side, corner, cell_m) = (grid.side(), grid.corner(), grid.cell_m());
        let mut values = vec![0_i8; side * side];
        for (at, value) in occupied(&grid) {
            let index = |along: f64| ((along / cell_m).floor() as usize).min(side - 1);
            // At most 15.
            values[index(at.y - corner.y) * side + index(at.x - corner.x)] = value as i8;
        }
        read_only(py, values.into_iter())?.call_method1("reshape", (side, side))
    }

    fn __copy__(&self) -> PyResult<Self> {
        Ok(Self { grid: Exclusive::new("Himm", self.grid.get()?.clone()) })
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.__copy__()
    }

    fn __repr__(&self) -> PyResult<String> {
        let ((x, to_x, y, to_y), side) = (self.extent_m()?, self.side()?);
        Ok(format!("<Himm: {side} x {side} cells, x {x:.2} to {to_x:.2} m, y {y:.2} to {to_y:.2} m>"))
    }
}

fn occupied(grid: &eeruf_sim::Himm) -> impl Iterator<Item = (Point, u8)> + '_ {
    let half = 0.5 * grid.side() as f64 * grid.cell_m();
    let corner = grid.corner();
    // Twice the window's width covers all cells, whichever cell the middle falls into.
    grid.occupied(Point::new(corner.x + half, corner.y + half), 2 * grid.side())
}
