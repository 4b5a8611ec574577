//! The vector field histogram (VFH): from a certainty grid to direction and speed.
//!
//! J. Borenstein and Y. Koren, "The vector field histogram - fast obstacle avoidance for mobile robots", IEEE
//! Transactions on Robotics and Automation 7(3), 1991, pp. 278-288. The cells around the robot become a histogram of
//! obstacle density over 72 sectors of 5 degrees. The robot then steers for the valley of the histogram that is nearest
//! to the target.
//!
//! Directions are in the scene's frame, in radians counter-clockwise.

use core::f64::consts::{PI, TAU};

#[cfg(test)]
mod tests;

use super::himm::{Himm, MAX_VALUE};
use crate::geometry::{Point, Pose, Vector, wrap_angle};

/// Number of sectors of the histogram, as in the VFH paper.
pub const SECTORS: usize = 72;
/// The width of a sector in radians: 5 degrees.
pub const SECTOR_RAD: f64 = TAU / SECTORS as f64;

/// An obstacle density for each sector; sector `k` begins at `k` times 5 degrees.
pub type Histogram = [f64; SECTORS];

/// The method's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vfh {
    /// Number of cells on a side of the active window, 33 as in the paper.
    pub window: usize,
    /// `l`: number of sectors to either side over which the histogram is smoothed, 5 as in the paper.
    pub smoothing: usize,
    /// Density below which a sector is free, in units of a fully certain cell beside the robot.
    pub threshold: f64,
    /// `s_max`: number of sectors above which a valley is wide, 18 as in the paper.
    pub wide: usize,
    /// `h_m`: the density ahead at which the robot goes no faster than `speed_min_m_s`.
    pub density_max: f64,
    /// `V_max`, in m/s.
    pub speed_max_m_s: f64,
    /// `V_min`, in m/s.
    pub speed_min_m_s: f64,
    /// `Omega_max`: the rate of turn at which the robot goes no faster than `speed_min_m_s`, in rad/s.
    pub turn_max_rad_s: f64,
}

impl Default for Vfh {
    /// The paper's window, smoothing and valleys. The density figures suit robots about 0.8 m wide at up to 1 m/s.
    fn default() -> Self {
        Self {
            window: 33,
            smoothing: 5,
            threshold: 0.35,
            wide: 18,
            density_max: 3.0,
            speed_max_m_s: 1.0,
            speed_min_m_s: 0.04,
            turn_max_rad_s: 120f64.to_radians(),
        }
    }
}

/// A run of free sectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Valley {
    /// The first sector.
    pub first: usize,
    /// Number of sectors of the valley; [`SECTORS`] if nothing is near.
    pub sectors: usize,
}

/// A direction to steer in, and a speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steering {
    /// The direction.
    pub direction_rad: f64,
    /// The valley that was chosen.
    pub valley: Valley,
    /// True if the direction leads away from the target, by more than 90 degrees: the way there is blocked, and the
    /// robot is in a dead end or about to enter one.
    pub trapped: bool,
}

impl Vfh {
    /// Computes the polar histogram around a place: the sum over the cells of the active window of
    ///
    /// ```text
    /// m = c^2 (a - b d)        with a - b d_max = 0
    /// ```
    ///
    /// with the certainty `c` as a share of the highest, the cell's distance `d`, and the corner's distance `d_max`.
    pub fn histogram(&self, grid: &Himm, place: Point) -> Histogram {
        let mut histogram = [0.0; SECTORS];
        let d_max = core::f64::consts::SQRT_2 * 0.5 * self.window.saturating_sub(1) as f64 * grid.cell_m();
        if !(d_max > 0.0) {
            return histogram;
        }
        for (cell, value) in grid.occupied(place, self.window) {
            let way = cell - place;
            let certainty = f64::from(value) / f64::from(MAX_VALUE);
            let magnitude = certainty * certainty * (1.0 - way.norm() / d_max).max(0.0);
            histogram[sector_of(direction(way))] += magnitude;
        }
        histogram
    }

    /// Smooths a histogram: each density becomes the weighted mean of the densities within `l` sectors,
    ///
    /// ```text
    /// h'_k = (h_{k-l} + 2 h_{k-l+1} + ... + (l+1) h_k + ... + 2 h_{k+l-1} + h_{k+l}) / (2 l + 1)
    /// ```
    ///
    /// The paper prints `l h_k` in the middle; with 2 l + 1 terms that rise by one, it is `l + 1`.
    pub fn smoothed(&self, histogram: &Histogram) -> Histogram {
        let l = self.smoothing.min(SECTORS / 2 - 1);
        let mut smoothed = [0.0; SECTORS];
        for (k, sum) in smoothed.iter_mut().enumerate() {
            for i in 0..=2 * l {
                let weight = (i + 1).min(2 * l + 1 - i) as f64;
                *sum += weight * histogram[(k + SECTORS + i - l) % SECTORS];
            }
            *sum /= (2 * l + 1) as f64;
        }
        smoothed
    }

    /// Finds the valleys of a smoothed histogram, by their first sectors; none if every direction is blocked.
    pub fn valleys(&self, smoothed: &Histogram) -> Vec<Valley> {
        let free = |k: usize| smoothed[k % SECTORS] < self.threshold;
        let Some(blocked) = (0..SECTORS).find(|&k| !free(k)) else {
            return vec![Valley { first: 0, sectors: SECTORS }];
        };
        // Start behind a blocked sector, so that no valley is cut in two.
        let mut valleys: Vec<Valley> = Vec::new();
        for k in blocked + 1..blocked + SECTORS {
            match valleys.last_mut() {
                _ if !free(k) => {}
                Some(valley) if valley.first + valley.sectors == k => valley.sectors += 1,
                _ => valleys.push(Valley { first: k, sectors: 1 }),
            }
        }
        for valley in &mut valleys {
            valley.first %= SECTORS;
        }
        valleys.sort_by_key(|valley| valley.first);
        valleys
    }

    /// Returns the direction to steer in for a target in the direction `target_rad`: into the nearest valley. `None` if
    /// every direction is blocked.
    ///
    /// The robot steers through the middle of a narrow valley. In a wide valley only the `s_max` sectors nearest to the
    /// target count, so that the robot passes an obstacle at a distance of half as many sectors, unless the target
    /// itself is farther from the obstacle.
    pub fn choose(&self, smoothed: &Histogram, target_rad: f64) -> Option<Steering> {
        let valleys = self.valleys(smoothed);
        let target = wrap_angle(target_rad);
        let nearest = valleys.into_iter().min_by(|a, b| off(a, target).total_cmp(&off(b, target)))?;
        let direction_rad = self.through(&nearest, target);
        let trapped = wrap_angle(direction_rad - target).abs() > 0.5 * PI;
        Some(Steering { direction_rad, valley: nearest, trapped })
    }

    /// Runs all steps and returns the direction to steer in from `place` to reach `target`.
    ///
    /// ```
    /// use eeruf_sim::{Himm, Point, Vfh};
    /// let free = Himm::new(33, 0.1);
    /// let steering = Vfh::default().steer(&free, Point::origin(), Point::new(0.0, 5.0)).unwrap();
    /// assert!((steering.direction_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-12 && !steering.trapped);
    /// ```
    pub fn steer(&self, grid: &Himm, place: Point, target: Point) -> Option<Steering> {
        self.choose(&self.smoothed(&self.histogram(grid, place)), direction(target - place))
    }

    /// Returns the speed in m/s for the density in the direction of motion and the rate of turn in rad/s:
    ///
    /// ```text
    /// V' = V_max (1 - min(h'_c, h_m) / h_m)        V = V' (1 - Omega / Omega_max) + V_min, at most V_max
    /// ```
    pub fn speed(&self, smoothed: &Histogram, heading_rad: f64, turn_rad_s: f64) -> f64 {
        let density = smoothed[sector_of(heading_rad)];
        let calm = 1.0 - (density / self.density_max).clamp(0.0, 1.0);
        let straight = 1.0 - (turn_rad_s.abs() / self.turn_max_rad_s).clamp(0.0, 1.0);
        (self.speed_max_m_s * calm * straight + self.speed_min_m_s).min(self.speed_max_m_s)
    }

    /// Returns the speed ahead in m/s and the rate of turn in rad/s for driving from a pose to a target. The rate is
    /// `turn_gain` rad/s per radian of steering error, at most `turn_most_rad_s`; the larger the error, the lower the
    /// speed. A blocked robot stops and turns on the spot. `turn_rad_s` is the current rate of turn.
    ///
    /// ```
    /// use eeruf_sim::{Himm, Point, Pose, Vfh};
    /// let free = Himm::new(33, 0.1);
    /// let (speed, turn) = Vfh::default().drive(&free, &Pose::identity(), Point::new(5.0, 0.0), 0.0, 3.0, 2.0);
    /// assert_eq!((speed, turn), (1.0, 0.0));
    /// ```
    pub fn drive(
        &self,
        grid: &Himm,
        pose: &Pose,
        target: Point,
        turn_rad_s: f64,
        turn_gain: f64,
        turn_most_rad_s: f64,
    ) -> (f64, f64) {
        let (place, heading) = (Point::from(pose.translation.vector), pose.rotation.angle());
        let smoothed = self.smoothed(&self.histogram(grid, place));
        let Some(steering) = self.choose(&smoothed, direction(target - place)) else {
            return (0.0, 0.5 * turn_most_rad_s);
        };
        let error = wrap_angle(steering.direction_rad - heading);
        let turn = (turn_gain * error).clamp(-turn_most_rad_s, turn_most_rad_s);
        (self.speed(&smoothed, heading, turn_rad_s) * libm::cos(error).max(0.0), turn)
    }

    /// Returns the direction in which the robot enters a valley.
    fn through(&self, valley: &Valley, target: f64) -> f64 {
        if valley.sectors == SECTORS {
            return target;
        }
        let half = 0.5 * valley.sectors as f64 * SECTOR_RAD;
        let middle = valley.first as f64 * SECTOR_RAD + half;
        let from_middle = wrap_angle(target - middle);
        // Stay at least half a wide valley from either border, or in the middle of a narrow valley.
        let slack = (half - 0.5 * self.wide as f64 * SECTOR_RAD).max(0.0);
        wrap_angle(middle + from_middle.clamp(-slack, slack))
    }
}

/// Returns the angle of a direction outside a valley, in radians; 0 inside.
fn off(valley: &Valley, direction_rad: f64) -> f64 {
    let half = 0.5 * valley.sectors as f64 * SECTOR_RAD;
    let middle = valley.first as f64 * SECTOR_RAD + half;
    (wrap_angle(direction_rad - middle).abs() - half).max(0.0)
}

fn direction(way: Vector) -> f64 {
    libm::atan2(way.y, way.x)
}

/// Returns the sector that contains a direction.
pub fn sector_of(direction_rad: f64) -> usize {
    // Rounding may turn a direction just below 0 into a full turn; NaN counts as 0.
    (direction_rad.rem_euclid(TAU) / SECTOR_RAD) as usize % SECTORS
}
