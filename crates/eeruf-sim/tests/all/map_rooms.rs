//! Places in maps: in free space, reproducible by number, and with room to drive.

use core::f64::consts::TAU;

use eeruf_sim::experiments::rooms::{DRIVING_S, RoomGroup, RoomPlan};
use eeruf_sim::{Motion, Noise, OccupancyGrid, Point, Pose, Robot, Transducer, World};

fn ring(radius_m: f64) -> Robot {
    Robot::ring(Pose::identity(), 12, TAU / 12.0, radius_m, Transducer::POLAROID_6500)
}

/// Returns places in a map whose right room has a corner that was not seen.
fn flat(numbers: core::ops::Range<u64>, radius_m: f64) -> Result<Vec<RoomPlan>, String> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/maps/flat.yaml");
    let grid = OccupancyGrid::read(file.as_ref()).unwrap();
    RoomGroup::of_map("flat".to_owned(), &grid, numbers, radius_m).map(|group| group.rooms)
}

#[test]
fn places_in_a_map_are_free_and_of_their_numbers() {
    let plans = flat(0..300, 0.15).unwrap();
    let (mut rooms, mut square) = ([0, 0], 0);
    for plan in &plans {
        let at = plan.pose.translation.vector;
        rooms[usize::from(at.x > 1.0)] += 1;
        // The distances are to the walls' inner sides, the post, and the corner that was not seen.
        let free_m = [at.x + 2.4, 3.9 - at.x, at.y + 1.4, 2.4 - at.y].into_iter().fold(f64::INFINITY, f64::min);
        assert!(free_m >= 0.35, "{}: {at:?}", plan.number);
        let post = Point::new(2.55, 1.95);
        assert!((post - Point::from(at)).norm() >= 0.35, "{}: {at:?}", plan.number);
        let unseen_m = (3.3 - at.x).max(0.0).hypot((at.y + 0.8).max(0.0));
        assert!(unseen_m >= 0.35, "{}: {at:?}", plan.number);
        plan.world(&ring(0.15), 0.0).unwrap();
        let tilt_deg = plan.pose.rotation.angle().to_degrees().rem_euclid(90.0);
        square += usize::from(!(2.001..87.999).contains(&tilt_deg));
    }
    assert!(rooms.iter().all(|&places| places > 60), "{rooms:?}");
    assert!((150..180).contains(&square), "{square}");
    assert_eq!(flat(7..8, 0.15).unwrap()[0], plans[7]);
    // A robot wider than the free space has no place.
    let error = flat(0..1, 2.0).unwrap_err();
    assert!(error.ends_with("free cells; expected some with space around them for a robot 4.00 m wide"), "{error}");
}

#[test]
fn robots_that_drive_in_a_map_meet_nothing() {
    let mut slowest: f64 = 1.0;
    for plan in flat(0..60, 0.25).unwrap() {
        let world = plan.world(&ring(0.25), 0.5).unwrap();
        let robot = &world.robots()[0];
        let ends = robot.motion.at(&robot.pose, DRIVING_S).pose;
        let stands = Robot { pose: ends, motion: Motion::Still, ..ring(0.25) };
        World::new(plan.scene().unwrap(), vec![stands], Noise::default()).unwrap();
        let Motion::Constant { velocity, .. } = robot.motion else { panic!("{} stands", plan.number) };
        slowest = slowest.min(velocity.norm());
    }
    assert!(slowest > 0.05, "{slowest}");
}
