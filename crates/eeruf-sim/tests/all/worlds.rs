//! World files: all shipped files work, and invalid files cause one clear line.

use std::path::Path;

use eeruf_core::Micros;
use eeruf_sim::*;

const WALL: &str = "[[wall]]\npoints_m = [[3, -2], [3, 2]]\n";
const ROBOT: &str =
    "[[robot]]\npose = { x_m = 0, y_m = 0 }\nring = { sensors = 8, spacing_deg = 15, radius_m = 0.3 }\n";

fn error(text: &str) -> String {
    World::from_text(Path::new("w.toml"), text).unwrap_err().to_string()
}

/// Returns the error for a robot with more lines after `WALL`: the robot has lines 3 to 5, the others begin at 6.
fn robot_error(more: &str) -> String {
    error(&format!("{WALL}{ROBOT}{more}"))
}

#[test]
fn the_worlds_that_are_shipped_can_be_simulated() {
    for name in ["alcove", "wall", "lab", "pole-course"] {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{name}.toml"));
        let world = World::from_toml(&file).unwrap();
        let readings = simulate(&world, Method::Eeruf, &Options::periods(4)).unwrap();
        assert!(readings.len() > 20, "{name}");
    }
}

// A bad world gets one line that names file, line, field, value and expected value.
#[test]
fn bad_world_gets_one_line_with_its_place() {
    assert_eq!(error(WALL), "w.toml: 0 robots; expected 1 to 64");
    let crossing = format!("{WALL}[[wall]]\npoints_m = [[2, 0], [4, 0]]\n{ROBOT}");
    assert_eq!(error(&crossing), "w.toml, line 4: walls 0 and 1 cross at (3.0000, 0.0000); end one of them there");
    let touching = format!("{WALL}{ROBOT}").replace("x_m = 0", "x_m = 2.9");
    let expected = "w.toml, line 4: robot 1 touches wall 0; expected it to stand free at its pose. It has no body, so \
                    it takes up a disc of ";
    assert!(error(&touching).starts_with(expected), "{}", error(&touching));
    assert!(error(&touching).ends_with("give its own outline, such as body = { box_m = [0.4, 0.3] } in a file"));
    let nan = format!("{WALL}{ROBOT}").replace("y_m = 0", "y_m = nan");
    assert_eq!(error(&nan), "w.toml, line 4: robot 1: pose is NaN; expected a number within 100000 m");
    let none = format!("{WALL}{ROBOT}").replace("sensors = 8", "sensors = 0");
    assert_eq!(error(&none), "w.toml, line 5: robot 1 has 0 sensors; expected 1 to 64");
    assert_eq!(robot_error("neighbours = 0"), "w.toml, line 6: robot 1: neighbours is 0; expected 1 to 64");
    assert_eq!(
        robot_error("# a comment on window_us\nwindow_us = 2000"),
        "w.toml, line 7: robot 1: window_us is 2000; expected more than the blanking time"
    );
    assert_eq!(
        robot_error("schedule = { period_us = 10, t_fire_a_us = [1], t_fire_b_us = [2] }"),
        "w.toml, line 6: robot 1: a schedule for 1 sensors; expected one for its 8"
    );
    assert_eq!(
        robot_error("motion = { speed_m_s = 1.0 }"),
        "w.toml, line 6: robot 1: motion needs either waypoints_m and speed_m_s, or velocity_m_s, turn_deg_s or both"
    );
    assert_eq!(
        robot_error("clock = { drift_ppm = 1e9 }"),
        "w.toml, line 6: robot 1: drift_ppm is 1000000000; expected -1000 to 1000"
    );
    assert_eq!(
        robot_error("[noise]\nfading_db_rms = -1.0"),
        "w.toml, line 7: noise: fading_db_rms is -1; expected 0 to 20"
    );
    assert_eq!(
        robot_error("schedule = { period_us = 10 }"),
        "w.toml, line 6: schedule: expected either t_lag_us, t_wait_a_us and t_wait_b_us, \
         or t_fire_a_us and t_fire_b_us, one number for each sensor"
    );
}

#[test]
fn patience_of_an_older_file_is_refused_by_name() {
    for value in ["0", "3", "\"much\""] {
        assert_eq!(
            robot_error(&format!("patience = {value}")),
            "w.toml, line 6: robot 1: patience; expected no such key: a filter that waited for an echo let crosstalk \
             in one phase starve the wall. Delete the line"
        );
    }
}

#[test]
fn an_unknown_field_or_word_is_named_with_its_line() {
    let unknown = robot_error("windw_us = 3");
    assert!(unknown.starts_with("w.toml, line 6: windw_us: unknown key; did you mean `window_us`?"), "{unknown}");
    let preset = robot_error("transducer = \"bat\"");
    assert!(
        preset.starts_with("w.toml, line 6: transducer: module: no preset \"bat\"; expected polaroid-6500, hc-sr04, "),
        "{preset}"
    );
    let negative = robot_error("period_us = -5");
    assert!(
        negative.starts_with("w.toml, line 6: period_us: integer `-5`; expected a whole number from 0 to 4294967295"),
        "{negative}"
    );
    let missing = World::from_toml(Path::new("no-such.toml")).unwrap_err().to_string();
    assert!(missing.starts_with("no-such.toml: "), "{missing}");
}

#[test]
fn a_window_beyond_the_schedules_own_refire_time_is_refused() {
    let schedule = "[100, 200, 300, 400, 500, 600, 700, 800]";
    let more = format!(
        "window_us = 36000\nschedule = {{ period_us = 20000, t_fire_a_us = {schedule}, t_fire_b_us = {schedule} }}"
    );
    assert_eq!(
        robot_error(&more),
        "w.toml, line 6: robot 1: window_us is 36000; expected at most 20000, after which a sensor of its schedule \
         fires again"
    );
}

#[test]
fn an_unknown_method_is_answered_with_the_list_of_all() {
    let error = "erruf".parse::<Method>().unwrap_err().to_string();
    assert!(error.starts_with("no method `erruf`; expected simultaneous, sequential"), "{error}");
    for method in Method::ALL {
        assert!(error.contains(method.as_str()), "{error}");
        assert_eq!(method.as_str().parse(), Ok(method));
    }
}

// A world written to a file and read again is equal, bit for bit.
#[test]
fn world_file_round_trips_bit_for_bit() {
    let walls = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0], [-2.0, -2.0]];
    let outline = Outline::new(&[[-0.2, -0.1], [0.2, -0.1], [0.1, 0.2]]).unwrap();
    let odd = Physics { fading_time_s: 0.3, narrow_panels: false, interference: true, ..Physics::DEFAULT };
    for number in 0..38_u32 {
        let physics = [Physics::PLAIN, Physics::DEFAULT, odd][number as usize % 3];
        let turned = 0.37 * f64::from(number) - 5.0;
        let rough = Material { reflection: 0.87, roughness_m: 0.3e-3 };
        let mut room: Vec<_> = Wall::polyline(&walls).map(|wall| wall.with_material(rough)).collect();
        room[1].faces = Faces::Open;
        let pole = Pole { material: Material::SOFT, ..Pole::new(0.9, 1.1, 0.05) };
        let air = Air { temperature_c: 3.5, humidity_percent: 61.0, pressure_kpa: 99.5 };
        let gain = [GainProfile::SquareRoot, GainProfile::Polaroid6500][number as usize % 2];
        let beam = [Beam::Continuous, Beam::CutAt90][number as usize % 2];
        let transducer = Transducer { gain, beam, ..Transducer::HC_SR04 };
        let low = Room { ceiling_m: 2.1, floor: rough, ceiling: Material::SOFT };
        let height = [None, Some(Room::DEFAULT), Some(low)][number as usize % 3];
        let standing = Robot {
            schedule: Some(table_i_d_for(6, Micros::from_millis(60), 4).unwrap()),
            clock: Clock { offset_us: 77, drift_ppm: -31.5 },
            blanking: Micros::new(1234),
            consecutive: 3,
            body: [None, Some(Body::Disc(0.25)), Some(Body::Box(0.4, 0.3))][number as usize % 3],
            ..Robot::ring(Pose::new(Vector::new(-0.8, 0.1), turned), 6, 0.3 + 0.001 * turned, 0.2, transducer)
        };
        let poses = vec![Pose::new(Vector::new(0.1, 0.02), turned), Pose::new(Vector::new(-0.1, 0.0), 3.0 - turned)];
        let moving = Robot {
            motion: Motion::Constant { velocity: Vector::new(0.05, -0.02), turn_rad_s: 0.1 * turned },
            odometry: true,
            coupling_db: (number % 2 == 0).then_some(-41.5),
            heights_m: vec![0.25, 1.1],
            body: (number % 2 == 1).then_some(Body::Polygon(outline)),
            ..Robot::with_sensors(Pose::new(Vector::new(0.6, -0.4), -turned), poses, transducer)
        };
        let noise = Noise { fading_db_rms: 2.0, jitter_us_rms: 20.0, bursts_per_s: 4.0, burst_db: 12.0 };
        let scene = Scene::new(room, vec![pole], air).and_then(|scene| scene.with_room(height)).unwrap();
        let world = World::new(scene, vec![standing, moving], noise)
            .unwrap()
            .with_seed(u64::MAX - u64::from(number))
            .with_max_order(3)
            .and_then(|world| world.with_physics(physics))
            .unwrap();
        let text = world_file(
            world.scene(),
            world.robots(),
            &world.noise(),
            &world.physics(),
            world.max_order(),
            world.seed(),
            world.faults(),
        );
        let again = World::from_text("again.toml".as_ref(), &text).unwrap();
        assert!(again.robots() == world.robots(), "{text}");
        assert_eq!((again.scene().walls(), again.scene().poles()), (world.scene().walls(), world.scene().poles()));
        assert_eq!((again.scene().air(), again.noise()), (world.scene().air(), world.noise()));
        assert_eq!(again.physics(), physics);
        assert_eq!((again.max_order(), again.seed()), (3, u64::MAX - u64::from(number)));
    }
}

// Headings that no angle has change by a last bit when they are first written, and not again.
#[test]
fn headings_move_by_a_last_bit_once() {
    let mut moved = 0;
    for spacing_deg in [7.5, 15.0, 361.0, 1530.0, 10_000.1, 1e9] {
        let pose = "pose = { x_m = 0, y_m = 0, heading_deg = 1234.5 }";
        let text = format!("[[robot]]\n{pose}\nring = {{ sensors = 64, spacing_deg = {spacing_deg}, radius_m = 0.3 }}");
        let read = |text: &str| WorldParts::from_text(Path::new("w.toml"), text).unwrap();
        let (first, again) = (read(&text), read(&read(&text).to_toml()));
        assert_eq!(first.to_toml(), again.to_toml(), "{spacing_deg}");
        for (before, after) in first.robots[0].sensors.iter().zip(&again.robots[0].sensors) {
            moved += u32::from(before != after);
            assert!((before.inverse() * after).rotation.angle().abs() < 4e-16, "{spacing_deg}");
        }
    }
    assert!(moved > 0, "no heading was without an angle");
}
