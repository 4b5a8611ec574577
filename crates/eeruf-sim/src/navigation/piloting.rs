//! Parameters for steering a robot by its readings; a search for pilots varies them.

use super::Vfh;

/// Parameters of the steering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piloting {
    /// The vector field histogram; its highest speed is the platform's.
    pub vfh: Vfh,
    /// Rate of turn for a steering error of a radian, in rad/s.
    pub turn_gain: f64,
    /// Range in metres beyond which an echo is not entered into the grid, but only clears the cells before it.
    pub range_m: f64,
    /// True if cells next to certain ones grow faster, see [`Himm::growth`](super::Himm::growth).
    pub growth: bool,
}

impl Piloting {
    /// Result of an earlier search that optimised mainly `eeruf`, the same for every method.
    pub const SHARED: Self = tuned(3, 0.03, 13, 0.7, 360.0, 3.0, 2.75, true);
}

/// Makes the published method with the parameters that a search varies, in the order of a table's columns.
#[expect(clippy::too_many_arguments, reason = "a row of a table")]
pub(crate) const fn tuned(
    smoothing: usize,
    threshold: f64,
    wide: usize,
    density_max: f64,
    turn_max_deg_s: f64,
    turn_gain: f64,
    range_m: f64,
    growth: bool,
) -> Piloting {
    let vfh = Vfh {
        smoothing,
        threshold,
        wide,
        density_max,
        turn_max_rad_s: turn_max_deg_s.to_radians(),
        window: 33,
        speed_max_m_s: 1.0,
        speed_min_m_s: 0.04,
    };
    Piloting { vfh, turn_gain, range_m, growth }
}
