//! The vector field histogram (VFH): from a certainty grid to where to steer and how fast to go.
//!
//! J. Borenstein and Y. Koren, "The vector field histogram - fast obstacle avoidance for mobile robots", IEEE Transactions on
//! Robotics and Automation 7(3), 1991, pp. 278-288. In two steps: the cells around the robot become a histogram of obstacle
//! density over 72 sectors of 5 degrees; then, among its valleys, the one nearest the target is steered for.
//!
//! Directions are in the scene's frame, in radians counter-clockwise.

use core::f64::consts::{PI, TAU};

use crate::{
    himm::{Himm, MAX_VALUE},
    plane::{Point, Vector, wrap_angle},
};

/// How many sectors the histogram has.
pub const SECTORS: usize = 72;
/// The width of a sector in radians: 5 degrees.
pub const SECTOR_RAD: f64 = TAU / SECTORS as f64;

/// An obstacle density for each sector; sector `k` begins at `k` times 5 degrees.
pub type Histogram = [f64; SECTORS];

/// The method's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vfh {
    /// How many cells the active window has on a side. 33 as in the paper.
    pub window: usize,
    /// `l`: over how many sectors to either side the histogram is smoothed. 5 as in the paper.
    pub smoothing: usize,
    /// A sector with a lower density is free. Densities are in units of a fully certain cell beside the robot.
    pub threshold: f64,
    /// `s_max`: a valley of more sectors is wide. 18 as in the paper.
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
    /// The paper's window, smoothing and valleys; the density figures suit robots about 0.8 m wide at up to 1 m/s.
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
    /// Its first sector.
    pub first: usize,
    /// How many sectors it has; [`SECTORS`] if nothing is near.
    pub sectors: usize,
}

/// Where to steer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steering {
    /// The direction.
    pub direction_rad: f64,
    /// The valley that was chosen.
    pub valley: Valley,
    /// The direction leads away from the target, more than 90 degrees off: the way there is blocked, and the robot is, or
    /// soon will be, in a dead end.
    pub trapped: bool,
}

impl Vfh {
    /// The polar histogram around a place: the sum of what each cell of the active window contributes,
    ///
    /// ```text
    /// m = c^2 (a - b d)        with a - b d_max = 0
    /// ```
    ///
    /// with `c` its certainty as a share of the highest, `d` its distance, and `d_max` that of the window's corner.
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

    /// The smoothed histogram: each density becomes the weighted mean of its neighbours' within `l` sectors,
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

    /// The valleys of a smoothed histogram, by their first sectors; none if every direction is blocked.
    pub fn valleys(&self, smoothed: &Histogram) -> Vec<Valley> {
        let free = |k: usize| smoothed[k % SECTORS] < self.threshold;
        let Some(blocked) = (0..SECTORS).find(|&k| !free(k)) else {
            return vec![Valley { first: 0, sectors: SECTORS }];
        };
        // Once round from a blocked sector, so that no valley is cut in two.
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

    /// Where to steer to come to a target in the direction `target_rad`: into the valley nearest to it. `None` if every
    /// direction is blocked.
    ///
    /// A narrow valley is steered through its middle. Of a wide one only the `s_max` sectors nearest to the target count as the
    /// valley, so that an obstacle is passed at a distance of half as many sectors, unless the target itself lies farther from
    /// it.
    pub fn choose(&self, smoothed: &Histogram, target_rad: f64) -> Option<Steering> {
        let valleys = self.valleys(smoothed);
        let target = wrap_angle(target_rad);
        let nearest = valleys.into_iter().min_by(|a, b| off(a, target).total_cmp(&off(b, target)))?;
        let direction_rad = self.through(&nearest, target);
        let trapped = wrap_angle(direction_rad - target).abs() > 0.5 * PI;
        Some(Steering { direction_rad, valley: nearest, trapped })
    }

    /// All steps at once: where to steer from `place` to come to `target`.
    ///
    /// ```
    /// use eeruf_sim::{Himm, Point, vfh::Vfh};
    /// let free = Himm::new(33, 0.1);
    /// let steering = Vfh::default().steer(&free, Point::origin(), Point::new(0.0, 5.0)).unwrap();
    /// assert!((steering.direction_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-12 && !steering.trapped);
    /// ```
    pub fn steer(&self, grid: &Himm, place: Point, target: Point) -> Option<Steering> {
        self.choose(&self.smoothed(&self.histogram(grid, place)), direction(target - place))
    }

    /// The speed in m/s for the density in the direction of motion and the rate of turn in rad/s:
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

    /// The direction that a valley is taken in.
    fn through(&self, valley: &Valley, target: f64) -> f64 {
        if valley.sectors == SECTORS {
            return target;
        }
        let half = 0.5 * valley.sectors as f64 * SECTOR_RAD;
        let middle = valley.first as f64 * SECTOR_RAD + half;
        let from_middle = wrap_angle(target - middle);
        // As far from either border as half of a wide valley, or in the middle of a narrow one.
        let slack = (half - 0.5 * self.wide as f64 * SECTOR_RAD).max(0.0);
        wrap_angle(middle + from_middle.clamp(-slack, slack))
    }
}

/// How far a direction is outside a valley, in radians; none inside.
fn off(valley: &Valley, direction_rad: f64) -> f64 {
    let half = 0.5 * valley.sectors as f64 * SECTOR_RAD;
    let middle = valley.first as f64 * SECTOR_RAD + half;
    (wrap_angle(direction_rad - middle).abs() - half).max(0.0)
}

fn direction(way: Vector) -> f64 {
    way.y.atan2(way.x)
}

/// The sector that a direction lies in.
pub fn sector_of(direction_rad: f64) -> usize {
    // Rounding may take a direction just below none to a full turn; what is no number counts as none.
    (direction_rad.rem_euclid(TAU) / SECTOR_RAD) as usize % SECTORS
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    const VFH: Vfh = Vfh {
        window: 33,
        smoothing: 5,
        threshold: 0.35,
        wide: 18,
        density_max: 3.0,
        speed_max_m_s: 1.0,
        speed_min_m_s: 0.04,
        turn_max_rad_s: 2.0,
    };

    /// A grid with certain cells every 10 cm along lines.
    fn walls(lines: &[([f64; 2], [f64; 2])]) -> Himm {
        let mut grid = Himm::new(201, 0.1);
        for &(from, to) in lines {
            let (from, to) = (Point::from(from), Point::from(to));
            let cells = ((to - from).norm() / 0.1).round().max(1.0);
            for i in 0..=cells as u32 {
                let cell = from + (to - from) * (f64::from(i) / cells);
                for _ in 0..5 {
                    // From beside the cell, so that nothing else is touched.
                    grid.echo(cell, 0.0, 0.0, 0.0);
                }
            }
        }
        grid
    }

    /// Drives a point along the steering directions, 5 cm at a time; the nearest that it came to a cell, and where it was.
    fn drive(grid: &Himm, from: Point, target: Point) -> (f64, Vec<Point>) {
        let (mut place, mut track, mut nearest) = (from, vec![from], f64::INFINITY);
        while (target - place).norm() > 0.3 && track.len() < 1000 {
            let Some(steering) = VFH.steer(grid, place, target) else { break };
            place += Vector::new(steering.direction_rad.cos(), steering.direction_rad.sin()) * 0.05;
            for (cell, _) in grid.occupied(place, 33) {
                nearest = nearest.min((cell - place).norm());
            }
            track.push(place);
        }
        (nearest, track)
    }

    #[test]
    fn an_obstacle_vector_grows_with_certainty_squared_and_shrinks_with_distance() {
        let mut grid = Himm::new(33, 0.1);
        grid.echo(Point::new(0.05, 0.05), 0.0, 0.0, 1.0);
        let d_max = 1.6 * 2f64.sqrt();
        let expected = (3.0f64 / 15.0).powi(2) * (1.0 - 1.0 / d_max);
        let histogram = VFH.histogram(&grid, Point::new(0.05, 0.0501));
        assert!((histogram[71] - expected).abs() < 1e-6 && histogram.iter().sum::<f64>() == histogram[71]);
        grid.echo(Point::new(0.05, 0.05), 0.0, 0.0, 1.0);
        let again = VFH.histogram(&grid, Point::new(0.05, 0.0501));
        assert!((again[71] / histogram[71] - 4.0).abs() < 1e-9);
        // Beyond the window nothing counts.
        assert_eq!(VFH.histogram(&grid, Point::new(-0.75, 0.05)), [0.0; SECTORS]);
    }

    #[test]
    fn smoothing_spreads_a_peak_over_eleven_sectors_like_a_tent() {
        let mut histogram = [0.0; SECTORS];
        histogram[1] = 11.0;
        let smoothed = VFH.smoothed(&histogram);
        let tent: Vec<f64> = (0..SECTORS).map(|k| smoothed[(k + 67) % SECTORS]).take(13).collect();
        assert_eq!(tent, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0, 0.0]);
        assert_eq!(Vfh { smoothing: 0, ..VFH }.smoothed(&histogram), histogram);
    }

    #[test]
    fn valleys_are_found_once_each_also_across_the_first_sector() {
        let mut smoothed = [1.0; SECTORS];
        for k in [70, 71, 0, 1, 2, 30, 31] {
            smoothed[k] = 0.0;
        }
        let [low, high] = [Valley { first: 30, sectors: 2 }, Valley { first: 70, sectors: 5 }];
        assert_eq!(VFH.valleys(&smoothed), [low, high]);
        assert_eq!(VFH.valleys(&[0.0; SECTORS]), [Valley { first: 0, sectors: SECTORS }]);
        assert_eq!(VFH.valleys(&[1.0; SECTORS]), []);
    }

    #[test]
    fn of_two_valleys_the_one_nearer_to_the_target_is_chosen() {
        let mut smoothed = [1.0; SECTORS];
        // Narrow ones to the left and to the right, 6 and 4 sectors from straight ahead.
        (6..10).for_each(|k| smoothed[k] = 0.0);
        (64..68).for_each(|k| smoothed[k] = 0.0);
        let right = VFH.choose(&smoothed, 0.0).unwrap();
        assert_eq!(right.valley, Valley { first: 64, sectors: 4 });
        assert!((right.direction_rad - -6.0 * SECTOR_RAD).abs() < 1e-12 && !right.trapped);
        let left = VFH.choose(&smoothed, 2.0 * SECTOR_RAD).unwrap();
        assert!((left.direction_rad - 8.0 * SECTOR_RAD).abs() < 1e-12);
    }

    #[test]
    fn a_wide_valley_is_taken_nine_sectors_from_its_border_and_a_free_target_directly() {
        let mut smoothed = [0.0; SECTORS];
        (0..5).for_each(|k| smoothed[k] = 1.0);
        let beside = VFH.choose(&smoothed, 6.0 * SECTOR_RAD).unwrap().direction_rad;
        assert!((beside - 14.0 * SECTOR_RAD).abs() < 1e-12);
        let free = VFH.choose(&smoothed, 3.0).unwrap().direction_rad;
        assert!((free - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_wall_ahead_is_steered_around() {
        let wall = walls(&[([2.05, -1.05], [2.05, 0.65])]);
        let (nearest, track) = drive(&wall, Point::new(0.05, 0.05), Point::new(4.0, 0.0));
        assert!((track[track.len() - 1] - Point::new(4.0, 0.0)).norm() <= 0.3);
        assert!(nearest > 0.3, "{nearest}");
        // Round the nearer end.
        assert!(track.iter().all(|place| place.y > -0.2));
    }

    #[test]
    fn a_doorway_is_passed_through_its_middle() {
        let wall = walls(&[([2.05, 0.65], [2.05, 6.05]), ([2.05, -0.65], [2.05, -6.05])]);
        let (nearest, track) = drive(&wall, Point::new(0.05, 0.35), Point::new(4.0, 0.6));
        assert!((track[track.len() - 1] - Point::new(4.0, 0.6)).norm() <= 0.3);
        assert!(nearest > 0.45, "{nearest}");
    }

    #[test]
    fn a_dead_end_is_recognised() {
        let niche =
            walls(&[([-1.0, 0.75], [1.05, 0.75]), ([1.05, 0.75], [1.05, -0.75]), ([1.05, -0.75], [-1.0, -0.75])]);
        let steering = VFH.steer(&niche, Point::new(0.35, 0.0), Point::new(4.0, 0.0)).unwrap();
        assert!(steering.trapped && steering.direction_rad.abs() > FRAC_PI_2);
        let closed = walls(&[
            ([-0.55, 0.75], [0.55, 0.75]),
            ([0.55, 0.75], [0.55, -0.75]),
            ([0.55, -0.75], [-0.55, -0.75]),
            ([-0.55, -0.75], [-0.55, 0.75]),
        ]);
        assert_eq!(VFH.steer(&closed, Point::origin(), Point::new(4.0, 0.0)), None);
    }

    #[test]
    fn speed_falls_with_the_density_ahead_and_with_the_rate_of_turn() {
        let mut smoothed = [0.0; SECTORS];
        smoothed[9] = 1.5;
        assert_eq!(VFH.speed(&smoothed, 0.0, 0.0), 1.0);
        assert!((VFH.speed(&smoothed, FRAC_PI_4 + 0.01, 0.0) - 0.54).abs() < 1e-12);
        assert!((VFH.speed(&smoothed, 0.0, -1.0) - 0.54).abs() < 1e-12);
        assert_eq!(VFH.speed(&smoothed, 0.0, 9.0), 0.04);
        smoothed[9] = 99.0;
        assert_eq!(VFH.speed(&smoothed, FRAC_PI_4 + 0.01, 0.0), 0.04);
    }
}
