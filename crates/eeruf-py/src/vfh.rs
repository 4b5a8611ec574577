//! `nav.Vfh`: the vector field histogram, and its result, `Steering`.

use std::sync::MutexGuard;

use eeruf_sim::Point;
use pyo3::prelude::*;

use crate::{
    arguments::{instance, number_or, whole_or},
    columns::read_only,
    fields::{record, settings},
    himm::Himm,
    pose::{point_of, pose_of, to_pose},
};

/// Default rate of turn for a steering error of a radian, in rad/s.
const TURN_GAIN: f64 = 3.0;

/// The vector field histogram (J. Borenstein and Y. Koren, IEEE T-RA 7(3), 1991): from a certainty grid to direction
/// and speed.
///
/// The cells around the robot become a histogram of obstacle density over 72 sectors of 5 degrees; the robot steers
/// for the valley nearest the target. Directions are in the scene's frame, counter-clockwise.
///
/// Args:
///     window: how many cells the active window has on a side, 1 to 4096.
///     smoothing: the number of sectors to either side over which the histogram is smoothed (the paper's l), 0 to 35.
///     threshold: a sector with a lower density is free; densities are in units of a fully certain cell beside the
///         robot. The default suits robots about 0.8 m wide; smaller ones need more.
///     wide: a valley of more sectors is wide (s_max), 1 to 72.
///     density_max: the density ahead at which the robot goes no faster than ``speed_min_m_s`` (h_m).
///     speed_max_m_s: V_max, in m/s.
///     speed_min_m_s: V_min, in m/s.
///     turn_max_rad_s: the rate of turn at which it goes no faster than ``speed_min_m_s`` (Omega_max), in rad/s.
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range.
///
/// Example:
///     >>> from eeruf import nav
///     >>> grid = nav.Himm()
///     >>> for _ in range(5):
///     ...     grid.echo((0.05, 0.05, 0.0), range_m=0.6)  # something stands ahead
///     >>> steering = nav.Vfh().steer(grid, place=(0.05, 0.05), target=(5.0, 0.0))
///     >>> 0.3 < abs(steering.direction_rad) < 1.2, steering.trapped
///     (True, False)
#[pyclass(frozen, module = "eeruf.nav")]
pub(crate) struct Vfh(eeruf_sim::Vfh);

fn grid_of<'a>(grid: &'a Bound<'_, PyAny>) -> PyResult<MutexGuard<'a, eeruf_sim::Himm>> {
    instance::<Himm>("grid", grid, "an eeruf.nav.Himm")?.get().grid.get()
}

settings! {
    Vfh(eeruf_sim::Vfh) "(*, window=33, smoothing=5, threshold=0.35, wide=18, density_max=3.0, speed_max_m_s=1.0, \
            speed_min_m_s=0.04, turn_max_rad_s=2.0943951023931953)" {
        /// Number of cells the active window has on a side.
        window: usize = whole_or(1..=4096),
        /// Number of sectors to either side over which the histogram is smoothed.
        smoothing: usize = whole_or(0..=35),
        /// Density below which a sector is free.
        threshold: f64 = number_or(0.0..=1e6),
        /// Number of sectors above which a valley is wide.
        wide: usize = whole_or(1..=72),
        /// The density ahead at which the robot goes no faster than its lowest speed.
        density_max: f64 = number_or(1e-6..=1e6),
        /// The highest speed, in m/s.
        speed_max_m_s: f64 = number_or(0.0..=50.0),
        /// The lowest speed, in m/s.
        speed_min_m_s: f64 = number_or(0.0..=50.0),
        /// The rate of turn at which it goes no faster than its lowest speed, in rad/s.
        turn_max_rad_s: f64 = number_or(1e-6..=50.0),
    }

    /// The smoothed histogram around a place.
    ///
    /// Args:
    ///     grid: an ``eeruf.nav.Himm``.
    ///     place: (x, y) in metres.
    ///
    /// Returns:
    ///     Array of 72 densities, float64; sector k begins at k times 5 degrees.
    ///
    /// Raises:
    ///     EerufError: not a grid, or an invalid place.
    ///
    /// Example:
    ///     >>> from eeruf import nav
    ///     >>> grid = nav.Himm()
    ///     >>> grid.echo((0.05, 0.05, 0.0), range_m=1.0)
    ///     >>> int(nav.Vfh(smoothing=0).histogram(grid, (0.05, 0.0)).argmax())
    ///     0
    fn histogram<'py>(&self, grid: &Bound<'py, PyAny>, place: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let smoothed = self.0.smoothed(&self.0.histogram(&*grid_of(grid)?, point_of("place", place)?));
        read_only(place.py(), smoothed.into_iter())
    }

    /// The direction to steer in from a place to reach a target.
    ///
    /// Args:
    ///     grid: an ``eeruf.nav.Himm``.
    ///     place: where the robot is, (x, y) in metres.
    ///     target: where it should go, (x, y) in metres.
    ///
    /// Returns:
    ///     A ``Steering``, or None if every direction is blocked.
    ///
    /// Raises:
    ///     EerufError: not a grid, or an invalid point.
    ///
    /// Example:
    ///     >>> from eeruf import nav
    ///     >>> nav.Vfh().steer(nav.Himm(), place=(0, 0), target=(5, 0))
    ///     Steering(direction_rad=0.0, valley=(0, 72), trapped=False)
    fn steer<'py>(
        &self,
        grid: &Bound<'py, PyAny>,
        place: &Bound<'_, PyAny>,
        target: &Bound<'_, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (place, target): (Point, Point) = (point_of("place", place)?, point_of("target", target)?);
        let steering = self.0.steer(&*grid_of(grid)?, place, target);
        let of_python = |steering: eeruf_sim::navigation::Steering| {
            let valley = (steering.valley.first, steering.valley.sectors);
            record(grid.py(), "Steering", (steering.direction_rad, valley, steering.trapped))
        };
        steering.map(of_python).transpose()
    }

    /// Compute speeds for ``Simulation.set_velocity`` that drive from a pose to a target: the farther off the heading,
    /// the slower. If every direction is blocked, the robot stops and turns on the spot.
    ///
    /// Args:
    ///     grid: an ``eeruf.nav.Himm``.
    ///     pose: where the robot is, (x, y, heading) in metres and radians.
    ///     target: where it should go, (x, y) in metres.
    ///     turn_rad_s: its current rate of turn, in rad/s, -50 to 50.
    ///     turn_gain: the rate of turn for a steering error of one radian, in rad/s, 0 to 100.
    ///
    /// Returns:
    ///     The speed ahead in m/s, and the rate of turn in rad/s.
    ///
    /// Raises:
    ///     EerufError: not a grid, or an invalid pose, point or number.
    ///
    /// Example:
    ///     >>> from eeruf import nav
    ///     >>> nav.Vfh().drive(nav.Himm(), pose=(0, 0, 0), target=(5, 0))
    ///     (1.0, 0.0)
    #[pyo3(signature = (grid, pose, target, turn_rad_s=None, *, turn_gain=None))]
    #[pyo3(text_signature = "($self, grid, pose, target, turn_rad_s=0.0, *, turn_gain=3.0)")]
    fn drive(
        &self,
        grid: &Bound<'_, PyAny>,
        pose: &Bound<'_, PyAny>,
        target: &Bound<'_, PyAny>,
        turn_rad_s: Option<&Bound<'_, PyAny>>,
        turn_gain: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<(f64, f64)> {
        let (pose, target) = (to_pose(pose_of("pose", pose)?), point_of("target", target)?);
        let turn_rad_s = number_or("turn_rad_s", turn_rad_s, 0.0, -50.0..=50.0)?;
        let turn_gain = number_or("turn_gain", turn_gain, TURN_GAIN, 0.0..=100.0)?;
        let turn_most = self.0.turn_max_rad_s;
        Ok(self.0.drive(&*grid_of(grid)?, &pose, target, turn_rad_s, turn_gain, turn_most))
    }
}
