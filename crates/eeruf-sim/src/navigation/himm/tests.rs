use super::*;
use core::f64::consts::{FRAC_PI_2, PI};

const ORIGIN: Point = Point::new(0.05, 0.05);

#[test]
fn a_wall_fills_where_sensors_look_along_their_axes() {
    let mut grid = Himm::new(65, 0.1);
    // A robot drives along a wall 1 m to its left and looks at it from eleven places.
    for step in 0..=10 {
        let place = Point::new(0.05 + 0.1 * f64::from(step), 0.05);
        for _ in 0..4 {
            grid.echo(place, FRAC_PI_2, 0.0, 1.0);
        }
    }
    for step in 0..=10 {
        let x = 0.05 + 0.1 * f64::from(step);
        assert_eq!(grid.value(Point::new(x, 1.05)), Some(12));
        assert!((0..10).all(|row| grid.value(Point::new(x, 0.05 + 0.1 * f64::from(row))) == Some(0)));
    }
    assert_eq!(grid.occupied(ORIGIN, 65).count(), 11);
}

// A phantom is cleared by the next three readings that look past it.
#[test]
fn phantom_is_cleared_by_three_readings_past_it() {
    let mut grid = Himm::new(65, 0.1);
    grid.echo(ORIGIN, 0.0, 0.0, 1.0);
    let phantom = Point::new(1.05, 0.05);
    for left in [2, 1, 0, 0] {
        grid.echo(ORIGIN, 0.0, 0.0, 2.0);
        assert_eq!(grid.value(phantom), Some(left));
    }
    grid.echo(ORIGIN, 0.0, 0.0, 1.0);
    grid.clear(ORIGIN, 0.0, 0.0, 1.5);
    assert_eq!(grid.value(phantom), Some(2));
    // A reading says nothing about the range in which the sensor is deaf.
    grid.clear(ORIGIN, 0.0, 1.2, 1.5);
    assert_eq!(grid.value(phantom), Some(2));
}

#[test]
fn values_stay_between_0_and_15() {
    let mut grid = Himm::new(65, 0.1);
    for _ in 0..40 {
        grid.echo(ORIGIN, 0.0, 0.0, 1.0);
    }
    assert_eq!(grid.value(Point::new(1.05, 0.05)), Some(15));
    assert_eq!(grid.value(Point::new(0.55, 0.05)), Some(0));
}

#[test]
fn an_axis_crosses_every_cell_on_its_way_once() {
    for degrees in 0..360 {
        let mut grid = Himm::new(65, 0.1);
        grid.values.fill(9);
        let heading = f64::from(degrees).to_radians();
        grid.echo(ORIGIN, heading, 0.0, 2.0);
        let (mut less, mut more) = (0, 0);
        for (cell, value) in grid.occupied(ORIGIN, 65).filter(|&(_, value)| value != 9) {
            let way = cell - ORIGIN;
            let aside = (way.y * libm::cos(heading) - way.x * libm::sin(heading)).abs();
            assert!(aside <= 0.0708 && way.norm() < 2.08, "{degrees}: {cell}");
            (less, more) = (less + u32::from(value == 8), more + u32::from(value == 12));
            assert!(value == 8 || value == 12, "{degrees}");
        }
        // The axis crosses as many cells as columns and rows.
        let expected = 20.0 * (libm::cos(heading).abs() + libm::sin(heading).abs());
        assert!(more == 1 && (f64::from(less) - expected).abs() <= 2.0, "{degrees}: {less}");
    }
}

#[test]
fn the_growth_rate_operator_lets_cells_grow_beside_certain_ones() {
    let mut grid = Himm::new(65, 0.1);
    grid.growth = true;
    grid.echo(ORIGIN, 0.0, 0.0, 1.0);
    assert_eq!(grid.value(Point::new(1.05, 0.05)), Some(3));
    // Beside the certain cell the gain is 3 + 3 / 2.
    grid.echo(Point::new(0.05, 0.15), 0.0, 0.0, 1.0);
    assert_eq!(grid.value(Point::new(1.05, 0.15)), Some(4));
    grid.echo(Point::new(0.05, 0.25), 0.0, 0.0, 1.0);
    assert_eq!(grid.value(Point::new(1.05, 0.25)), Some(5));
}

#[test]
fn the_window_moves_with_the_robot_and_forgets_what_it_leaves() {
    let mut grid = Himm::new(33, 0.1);
    grid.echo(ORIGIN, 0.0, 0.0, 1.0);
    grid.echo(ORIGIN, PI, 0.0, 1.0);
    let (ahead, behind) = (Point::new(1.05, 0.05), Point::new(-0.95, 0.05));
    assert_eq!((grid.value(ahead), grid.value(behind)), (Some(3), Some(3)));
    grid.move_to(Point::new(1.05, 0.05));
    assert_eq!((grid.value(ahead), grid.value(behind)), (Some(3), None));
    grid.move_to(ORIGIN);
    assert_eq!((grid.value(ahead), grid.value(behind)), (Some(3), Some(0)));
    grid.move_to(Point::new(-900.0, 7e7));
    grid.move_to(ORIGIN);
    assert_eq!(grid.occupied(ORIGIN, 33).count(), 0);
}

#[test]
fn what_is_no_number_changes_nothing() {
    let mut grid = Himm::new(0, f64::NAN);
    assert_eq!((grid.side(), grid.cell_m()), (1, 0.1));
    grid.echo(Point::new(f64::NAN, 0.0), 0.0, 0.0, 1.0);
    grid.echo(Point::origin(), 0.0, 0.0, f64::INFINITY);
    grid.echo(Point::origin(), 0.0, 0.0, f64::NAN);
    grid.clear(Point::origin(), 0.0, f64::NAN, -1.0);
    assert_eq!(grid.value(Point::origin()), Some(0));
    grid.move_to(Point::new(f64::INFINITY, f64::NAN));
}
