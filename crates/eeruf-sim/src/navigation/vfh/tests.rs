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

/// Makes a grid with certain cells every 10 cm along lines.
fn walls(lines: &[([f64; 2], [f64; 2])]) -> Himm {
    let mut grid = Himm::new(201, 0.1);
    for &(from, to) in lines {
        let (from, to) = (Point::from(from), Point::from(to));
        let cells = ((to - from).norm() / 0.1).round().max(1.0);
        for i in 0..=cells as u32 {
            let cell = from + (to - from) * (f64::from(i) / cells);
            for _ in 0..5 {
                // An echo at a range of 0 changes only this cell.
                grid.echo(cell, 0.0, 0.0, 0.0);
            }
        }
    }
    grid
}

/// Drives a point along the steering directions in steps of 5 cm; returns its least distance to a cell, and its track.
fn drive(grid: &Himm, from: Point, target: Point) -> (f64, Vec<Point>) {
    let (mut place, mut track, mut nearest) = (from, vec![from], f64::INFINITY);
    while (target - place).norm() > 0.3 && track.len() < 1000 {
        let Some(steering) = VFH.steer(grid, place, target) else { break };
        place += Vector::new(libm::cos(steering.direction_rad), libm::sin(steering.direction_rad)) * 0.05;
        for (cell, _) in grid.occupied(place, 33) {
            nearest = nearest.min((cell - place).norm());
        }
        track.push(place);
    }
    (nearest, track)
}

// An obstacle vector grows with certainty squared and shrinks with distance.
#[test]
fn obstacle_vector_grows_with_certainty_squared() {
    let mut grid = Himm::new(33, 0.1);
    grid.echo(Point::new(0.05, 0.05), 0.0, 0.0, 1.0);
    let d_max = 1.6 * 2f64.sqrt();
    let expected = (3.0 / 15.0) * (3.0 / 15.0) * (1.0 - 1.0 / d_max);
    let histogram = VFH.histogram(&grid, Point::new(0.05, 0.0501));
    assert!((histogram[71] - expected).abs() < 1e-6 && histogram.iter().sum::<f64>() == histogram[71]);
    grid.echo(Point::new(0.05, 0.05), 0.0, 0.0, 1.0);
    let again = VFH.histogram(&grid, Point::new(0.05, 0.0501));
    assert!((again[71] / histogram[71] - 4.0).abs() < 1e-9);
    // Cells outside the window do not count.
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
    // Narrow valleys lie to the left and to the right, 6 and 4 sectors from straight ahead.
    (6..10).for_each(|k| smoothed[k] = 0.0);
    (64..68).for_each(|k| smoothed[k] = 0.0);
    let right = VFH.choose(&smoothed, 0.0).unwrap();
    assert_eq!(right.valley, Valley { first: 64, sectors: 4 });
    assert!((right.direction_rad - -6.0 * SECTOR_RAD).abs() < 1e-12 && !right.trapped);
    let left = VFH.choose(&smoothed, 2.0 * SECTOR_RAD).unwrap();
    assert!((left.direction_rad - 8.0 * SECTOR_RAD).abs() < 1e-12);
}

// The robot enters a wide valley nine sectors from its border, and steers for a free target directly.
#[test]
fn wide_valley_is_taken_nine_sectors_from_its_border() {
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
    // The track goes round the nearer end.
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
    let niche = walls(&[([-1.0, 0.75], [1.05, 0.75]), ([1.05, 0.75], [1.05, -0.75]), ([1.05, -0.75], [-1.0, -0.75])]);
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
