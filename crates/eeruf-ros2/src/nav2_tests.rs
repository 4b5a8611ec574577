//! The update rules of Nav2's costmap layers, from `range_sensor_layer.cpp`, `obstacle_layer.cpp`,
//! `observation_buffer.cpp` and `raytrace_line_2d.hpp` of navigation2 a3a97043, applied to the readings of a simulated
//! ring.

use std::sync::Arc;

use eeruf_core::Micros;
use eeruf_sim::World;

use crate::diagnosis::Diagnosis;
use crate::parameters::Parameters;
use crate::placing::Place;
use crate::range::Scale;
use crate::ros::cloud::scan;
use crate::ros::messages::{Header, LaserScan};
use crate::simulated::{Simulator, placing};
use crate::view::View;

const FREE: u8 = 0;
const LETHAL: u8 = 254;
const UNKNOWN: u8 = 255;
/// Half the side of the map, a square about the robot.
const HALF_M: f64 = 4.5;

struct Grid {
    cell_m: f64,
    across: i32,
    costs: Vec<u8>,
}

impl Grid {
    fn new(cell_m: f64, cost: u8) -> Self {
        let across = (2.0 * HALF_M / cell_m).round() as i32;
        Self { cell_m, across, costs: vec![cost; (across * across) as usize] }
    }

    fn cell(&self, [x, y]: [f64; 2]) -> [i32; 2] {
        [x, y].map(|metres| ((metres + HALF_M) / self.cell_m).floor() as i32)
    }

    fn index(&self, [x, y]: [i32; 2]) -> Option<usize> {
        let inside = (0..self.across).contains(&x) && (0..self.across).contains(&y);
        inside.then(|| (y * self.across + x) as usize)
    }

    fn middle(&self, index: usize) -> [f64; 2] {
        let (x, y) = (index as i32 % self.across, index as i32 / self.across);
        [x, y].map(|cell| (f64::from(cell) + 0.5) * self.cell_m - HALF_M)
    }
}

/// Pose of the robot: x, y, heading.
type At = [f64; 3];

fn place_on_map(at: At, place: &Place) -> At {
    let (sin, cos) = at[2].sin_cos();
    [at[0] + cos * place.x_m - sin * place.y_m, at[1] + sin * place.x_m + cos * place.y_m, at[2] + place.yaw_rad]
}

fn polar(at: At, metres: f64) -> [f64; 2] {
    [at[0] + metres * at[2].cos(), at[1] + metres * at[2].sin()]
}

/// The distance from `at` and the angle from straight ahead.
fn bearing(at: At, [x, y]: [f64; 2]) -> (f64, f64) {
    let (dx, dy) = (x - at[0], y - at[1]);
    let angle = dy.atan2(dx) - at[2];
    (dx.hypot(dy), angle.sin().atan2(angle.cos()))
}

trait Layer {
    /// Updates the costmap with the last scan and the ranges since then; returns the costs of the master grid.
    fn update(&mut self, scan: Option<(At, &LaserScan)>, ranges: &[(At, f32)]) -> Grid;
}

/// The obstacle layer, with the parameters of the shipped file that its rules use.
struct Obstacles {
    grid: Grid,
    raytrace_max_range: f64,
    obstacle_max_range: f64,
}

impl Obstacles {
    fn shipped(cell_m: f64) -> Self {
        let file = include_str!("../../../ros2/config/nav2.yaml");
        let value = |key: &str| {
            let mut values = file.lines().filter_map(|line| line.trim().strip_prefix(key)?.strip_prefix(": "));
            values.next().unwrap_or_else(|| panic!("{key} is not in the file"))
        };
        for (key, expected) in [
            ("plugins", "[\"obstacle_layer\", \"inflation_layer\"]"),
            ("plugin", "\"nav2_costmap_2d::ObstacleLayer\""),
            ("track_unknown_space", "true"),
            ("topic", "/eeruf/scan"),
            ("data_type", "LaserScan"),
            ("marking", "true"),
            ("clearing", "true"),
            ("inf_is_valid", "true"),
        ] {
            assert_eq!(value(key), expected, "{key}");
        }
        let heights = |key: &str| file.lines().filter(|line| line.trim().starts_with(key)).count();
        // Both for the layer and for the source, whose maximum would be 0.
        assert_eq!((heights("min_obstacle_height: -0.5"), heights("max_obstacle_height: 2.0")), (2, 2));
        let metres = |key| value(key).parse().unwrap();
        let [raytrace_max_range, obstacle_max_range] = ["raytrace_max_range", "obstacle_max_range"].map(metres);
        // A clear ray frees up to the node's maximum range and marks nothing there.
        let max_m = f64::from(Parameters::default().max_range_m);
        assert!(raytrace_max_range >= max_m && obstacle_max_range + 2.0 * cell_m <= max_m, "{obstacle_max_range}");
        Self { grid: Grid::new(cell_m, UNKNOWN), raytrace_max_range, obstacle_max_range }
    }

    fn cells(&self, metres: f64) -> f64 {
        (metres / self.grid.cell_m).ceil()
    }

    /// Clears the cells of a line, up to the raytrace range.
    fn trace(&mut self, from: [i32; 2], to: [i32; 2]) {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let scale = (self.cells(self.raytrace_max_range) / f64::from(dx).hypot(f64::from(dy))).min(1.0);
        let x_is_longer = dx.abs() >= dy.abs();
        let (long, short) = if x_is_longer { (dx.abs(), dy.abs()) } else { (dy.abs(), dx.abs()) };
        let sign = |of: i32| if of > 0 { 1 } else { -1 };
        let (mut cell, mut error) = (from, long / 2);
        for step in 0..=(scale * f64::from(long)) as i32 {
            if step > 0 {
                cell[usize::from(!x_is_longer)] += if x_is_longer { sign(dx) } else { sign(dy) };
                error += short;
                if error >= long {
                    cell[usize::from(x_is_longer)] += if x_is_longer { sign(dy) } else { sign(dx) };
                    error -= long;
                }
            }
            if let Some(index) = self.grid.index(cell) {
                self.grid.costs[index] = FREE;
            }
        }
    }
}

impl Layer for Obstacles {
    fn update(&mut self, scan: Option<(At, &LaserScan)>, _: &[(At, f32)]) -> Grid {
        if let Some((at, scan)) = scan {
            let valid = |&range: &f32| if range == f32::INFINITY { scan.range_max - 1e-4 } else { range };
            let heading = |n: usize| f64::from(scan.angle_min + scan.angle_increment * n as f32);
            let ranges = scan.ranges.iter().map(valid).enumerate();
            let held = ranges.filter(|(_, range)| (scan.range_min..scan.range_max).contains(range));
            let points: Vec<_> =
                held.map(|(n, range)| polar([at[0], at[1], at[2] + heading(n)], f64::from(range))).collect();
            let origin = self.grid.cell([at[0], at[1]]);
            for &point in &points {
                self.trace(origin, self.grid.cell(point));
            }
            for &point in &points {
                let cell = self.grid.cell(point);
                let away = f64::from(cell[0] - origin[0]).hypot(f64::from(cell[1] - origin[1])).floor();
                let near =
                    bearing(at, point).0 <= self.obstacle_max_range && away <= self.cells(self.obstacle_max_range);
                if let Some(index) = self.grid.index(cell).filter(|_| near) {
                    self.grid.costs[index] = LETHAL;
                }
            }
        }
        Grid { costs: self.grid.costs.clone(), ..self.grid }
    }
}

/// The range layer, `phi` 1.2, clearing at the maximum: cones alone, or this project's file of e124fa7.
struct Ranges {
    grid: Grid,
    half_view: f64,
    max_m: f32,
    /// Cells marked by the obstacle layer, which cleared none. With `inflate_cone` 1.0 the box of a cone is updated.
    as_shipped: Option<Vec<bool>>,
}

impl Ranges {
    fn new(cell_m: f64) -> Self {
        Self { grid: Grid::new(cell_m, 127), half_view: 0.26, max_m: 4.0, as_shipped: None }
    }

    fn as_shipped(cell_m: f64) -> Self {
        let ranges = Self::new(cell_m);
        Self { as_shipped: Some(vec![false; ranges.grid.costs.len()]), ..ranges }
    }

    fn model(&self, range: f64, phi: f64, theta: f64) -> f64 {
        let gamma = if theta.abs() > self.half_view { 0.0 } else { 1.0 - (theta / self.half_view).powi(2) };
        let lambda = (1.0 - f64::midpoint(1.0, (2.0 * (phi - 1.2)).tanh())) * gamma;
        let wide = self.grid.cell_m * range;
        if phi < range - 2.0 * wide {
            (1.0 - lambda) * 0.5
        } else if phi < range - wide {
            lambda * 0.5 * ((phi - (range - 2.0 * wide)) / wide).powi(2) + (1.0 - lambda) * 0.5
        } else if phi < range + wide {
            lambda * (0.5 - 0.5 * ((range - phi) / wide).powi(2)) + 0.5
        } else {
            0.5
        }
    }
}

impl Layer for Ranges {
    fn update(&mut self, _: Option<(At, &LaserScan)>, ranges: &[(At, f32)]) -> Grid {
        for &(at, range) in ranges {
            // +Inf was sent as the maximum, and ranges that are too close are dropped.
            let clear = range >= self.max_m;
            let range = f64::from(range.min(self.max_m));
            if range < 0.0 {
                continue;
            }
            let target = self.grid.cell(polar(at, range));
            if let Some(index) = self.grid.index(target) {
                self.grid.costs[index] = 233;
                self.as_shipped.iter_mut().for_each(|marked| marked[index] |= !clear);
            }
            let side = |turn: f64| self.grid.cell(polar([at[0], at[1], at[2] + turn], 1.2 * range));
            let [o, a, b] = [self.grid.cell([at[0], at[1]]), side(-self.half_view), side(self.half_view)];
            let orient =
                |a: [i32; 2], b: [i32; 2], c: [i32; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            for index in 0..self.grid.costs.len() {
                let cell = self.grid.cell(self.grid.middle(index));
                let is_between = |axis: usize| {
                    let corners = [o, a, b, target].map(|corner| corner[axis]);
                    corners.iter().min() <= Some(&cell[axis]) && Some(&cell[axis]) <= corners.iter().max()
                };
                let is_updated = if self.as_shipped.is_some() {
                    is_between(0) && is_between(1)
                } else {
                    orient(a, b, cell) >= 0 && orient(b, o, cell) >= 0 && orient(o, a, cell) >= 0
                };
                if !is_updated {
                    continue;
                }
                let (phi, theta) = bearing(at, self.grid.middle(index));
                let sensor = if clear { 0.0 } else { self.model(range, phi, theta) };
                let prior = f64::from(self.grid.costs[index]) / 254.0;
                let occupied = sensor * prior;
                let probability = occupied / (occupied + (1.0 - sensor) * (1.0 - prior));
                // NaN becomes 0, as it does in Nav2.
                self.grid.costs[index] = (254.0 * probability) as u8;
            }
        }
        let cost = |&cost: &u8| match cost {
            204..=254 => LETHAL,
            0..50 => FREE,
            _ => UNKNOWN,
        };
        let mut costs: Vec<_> = self.grid.costs.iter().map(cost).collect();
        for (index, _) in self.as_shipped.iter().flatten().enumerate().filter(|&(_, &is_marked)| is_marked) {
            costs[index] = LETHAL;
        }
        Grid { costs, ..self.grid }
    }
}

/// A case: sensors on a circle of 20 cm, a wall ahead, maybe a person who crosses 1.5 m ahead, or a turn.
#[derive(Clone, Copy, Debug)]
struct Case {
    spacing_deg: f64,
    wall_m: f64,
    person: bool,
    turn_deg_s: f64,
}

impl Case {
    fn world(&self) -> World {
        let Self { spacing_deg, wall_m, person, .. } = self;
        // One of the sensors looks straight at the wall.
        let (x, ahead) = (0.2 + wall_m, spacing_deg / 2.0);
        let mut text = format!(
            "seed = 5\nmax_order = 3\n[[wall]]\npoints_m = [[{x}, -1.0], [{x}, 1.0]]\nfaces = \"both\"\n\
             [[robot]]\npose = {{ x_m = 0.0, y_m = 0.0, heading_deg = {ahead} }}\nmodule = \"hc-sr04\"\n\
             ring = {{ sensors = 8, spacing_deg = {spacing_deg:.1}, radius_m = 0.2 }}\n"
        );
        if *person {
            text += "[[fault]]\nkind = \"leg\"\nradius_m = 0.15\nfrom_m = [1.5, -1.5]\nto_m = [1.5, 1.5]\n\
                     from_s = 2.0\nto_s = 5.0\n";
        }
        World::from_text("nav2.toml".as_ref(), &text).unwrap()
    }
}

/// Counts over all updates after the first second.
#[derive(Clone, Copy, Debug, Default)]
struct Shares {
    /// Directions in which a sensor has seen the wall for a second; and how many have no mark up to the wall.
    walls: [u32; 2],
    /// Number of marked cells that every sensor has seen through for a second, and of those still marked.
    left: [u32; 2],
}

/// Duration of a case, in seconds; the intervals of costmap and scan are in steps.
const LASTS_S: f64 = 8.0;
const UPDATE_STEPS: u32 = 10;
const SCAN_STEPS: u32 = 5;
const STEP_S: f64 = 0.02;

fn played(case: Case, cell_m: f64, layer: &mut dyn Layer) -> Shares {
    let world = Arc::new(case.world());
    let places = placing(&world, 0.0).places;
    let parameters = Parameters { sensors: places.len() as u8, ..Parameters::default() };
    let (scale, half_view) = (Scale::new(&parameters), f64::from(parameters.field_of_view_rad / 2.0));
    let mut diagnosis = Diagnosis::new(&parameters, 0.0);
    let mut simulator = Simulator::new(world, "flow").unwrap();
    let mut alone = vec![None::<f64>; places.len()];
    let (mut shares, mut ranges, mut last) = (Shares::default(), Vec::new(), None);
    let grid = Grid::new(cell_m, UNKNOWN);
    let (mut marked, mut seen_through) = (vec![false; grid.costs.len()], vec![None; grid.costs.len()]);
    let mut seen = [None; 180];
    let wall_m = 0.2 + case.wall_m;
    for step in 1..=(LASTS_S / STEP_S) as u32 {
        let now_s = f64::from(step) * STEP_S;
        simulator.drive(0.0, case.turn_deg_s.to_radians()).unwrap();
        for read in simulator.step(STEP_S).unwrap() {
            let sensor = read.firing.sensor;
            let at = usize::from(sensor);
            let (kind, t_echo) = (read.firing.kind, read.firing.t_echo);
            diagnosis.reading(now_s, sensor, kind, t_echo, Micros::ZERO, None);
            alone[at] = read.truth.map(|t_echo| scale.metres(t_echo)).filter(|&metres| metres < 4.0);
            let course = simulator.course().unwrap();
            let on_map = place_on_map([course.x_m, course.y_m, course.yaw_rad], &places[at]);
            ranges.extend(scale.distance(kind, t_echo).map(|distance| (on_map, distance.number())));
        }
        let course = simulator.course().unwrap();
        let at = [course.x_m, course.y_m, course.yaw_rad];
        if step % SCAN_STEPS == 0 {
            let views: Vec<(View, f32)> = diagnosis.views(now_s, &scale).map(|(view, _)| (view, 0.0)).collect();
            last = Some((at, scan(Header::default(), &places, &views, parameters.field_of_view_rad, &scale)));
        }
        if step % UPDATE_STEPS != 0 {
            continue;
        }
        let map = layer.update(last.as_ref().map(|(at, scan)| (*at, scan)), &ranges);
        ranges.clear();
        let sensors: Vec<At> = places.iter().map(|place| place_on_map(at, place)).collect();
        // Sensors whose cone holds the point, or a part of its cell: its distance, and the range they see alone.
        let looking = |point, part_m: f64| {
            let from = sensors.iter().zip(&alone).map(move |(&sensor, alone)| (bearing(sensor, point), *alone));
            let held = from.filter(move |((metres, angle), _)| angle.abs() < half_view + part_m / metres);
            held.map(|((metres, _), alone)| (metres, alone.unwrap_or(f64::INFINITY)))
        };
        let for_a_second = |since: &mut Option<f64>, holds: bool| {
            *since = holds.then(|| since.unwrap_or(now_s));
            since.is_some_and(|since| now_s - since >= 1.0)
        };
        for (n, since) in (-90..).zip(&mut seen) {
            let heading = f64::from(n) * 0.5_f64.to_radians();
            let to_wall = wall_m / heading.cos();
            let point = polar([0.0, 0.0, heading], to_wall);
            let is_seen = point[1].abs() < 1.0 && looking(point, 0.0).any(|(metres, alone)| alone < metres + cell_m);
            if for_a_second(since, is_seen) {
                let way = (0..).map(|n| f64::from(n) * cell_m / 4.0).take_while(|&metres| metres <= to_wall + cell_m);
                let mut cells = way.filter_map(|metres| map.index(map.cell(polar([0.0, 0.0, heading], metres))));
                shares.walls[0] += 1;
                shares.walls[1] += u32::from(!cells.any(|index| map.costs[index] == LETHAL));
            }
        }
        for (index, &cost) in map.costs.iter().enumerate() {
            marked[index] |= cost == LETHAL;
            if !marked[index] {
                continue;
            }
            let point = map.middle(index);
            // The wall is sometimes heard off a sensor's axis: an arc at its distance is not a remnant.
            let is_of_wall = sensors.iter().any(|&at| (bearing(at, point).0 - (wall_m - at[0])).abs() < 2.0 * cell_m);
            let through = |(metres, alone): (f64, f64)| metres < 3.7 && alone > metres + 2.0 * cell_m && !is_of_wall;
            let is_seen_through = looking(point, 0.0).next().is_some() && looking(point, cell_m).all(through);
            if for_a_second(&mut seen_through[index], is_seen_through) {
                shares.left[0] += 1;
                shares.left[1] += u32::from(cost == LETHAL);
            }
        }
    }
    shares
}

/// Walls at three distances, a person in front of a wall, a turn; sensors far apart, and with overlapping cones.
fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for spacing_deg in [45.0, 15.0] {
        let case = |wall_m, person, turn_deg_s| Case { spacing_deg, wall_m, person, turn_deg_s };
        cases.extend([0.3, 1.0, 3.0].map(|wall_m| case(wall_m, false, 0.0)));
        cases.extend([case(3.0, true, 0.0), case(1.0, false, 15.0)]);
    }
    cases
}

/// Runs all cases with cells of 5 and 10 cm.
fn all(layer: impl Fn(f64) -> Box<dyn Layer>, expected: impl Fn(Case, Shares) -> bool) {
    for cell_m in [0.05, 0.1] {
        for case in cases() {
            let shares = played(case, cell_m, &mut *layer(cell_m));
            assert!(expected(case, shares), "{case:?}, cells of {cell_m} m: {shares:?}");
        }
    }
}

#[test]
fn obstacle_layer_keeps_walls_and_forgets_persons() {
    all(
        |cell_m| Box::new(Obstacles::shipped(cell_m)),
        |case, Shares { walls, left }| {
            let is_played = walls[0] > 500 && (!case.person || left[0] > 150);
            is_played && [walls, left].iter().all(|counts| 100 * counts[1] < counts[0].max(1))
        },
    );
}

// The reason why this project has no file for it: beyond `phi` only a single cell is marked, and free cells stay free.
#[test]
fn range_layer_frees_walls_that_sensors_see() {
    all(
        |cell_m| Box::new(Ranges::new(cell_m)),
        |case, Shares { walls, .. }| {
            let overlaps_or_beyond_phi = case.spacing_deg < 30.0 || case.wall_m > 2.0;
            !overlaps_or_beyond_phi || 100 * walls[1] > 4 * walls[0]
        },
    );
}

// Clear cones erase walls that still stand, and every mark of a person who has left stays.
#[test]
fn file_of_e124fa7_fails_the_model() {
    all(
        |cell_m| Box::new(Ranges::as_shipped(cell_m)),
        |case, Shares { walls, left }| {
            let frees_walls = case.turn_deg_s != 0.0 || 100 * walls[1] > 15 * walls[0];
            frees_walls && (!case.person || left[0] > 20 && left[1] == left[0])
        },
    );
}
