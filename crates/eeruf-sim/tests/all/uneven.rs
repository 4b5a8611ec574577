//! Robots whose sensors are not all alike.

use std::path::Path;

use eeruf_core::{Micros, ReadingKind};
use eeruf_sim::*;

/// A room of 3 m by 2 m, and a ring of four: two sensors see 3 m, two that fire together 0.4 m.
const WORLD: &str = r#"
seed = 7
max_order = 3

[[wall]]
points_m = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [0.0, 0.0]]

[[robot]]
pose = { x_m = 1.5, y_m = 0.9, heading_deg = 45.0 }
ring = { sensors = 4, spacing_deg = 90.0, radius_m = 0.2 }
transducer = "hc_sr04"
window_us = [18_000, 18_000, 2_500, 3_000]
t_delta_us = [600, 300, 150, 150]
together = [[2, 3]]
schedule = { period_us = 25_000, t_fire_a_us = [1_000, 10_000, 6_000, 6_000], t_fire_b_us = [3_000, 6_000, 0, 0] }
"#;

fn world(text: &str) -> Result<World, String> {
    World::from_text(Path::new("w.toml"), text).map_err(|error| error.to_string())
}

// Each sensor of an uneven robot hears as far as its own window, and its readings are accepted there.
#[test]
fn uneven_sensors_hear_as_far_as_their_windows() {
    let robot = world(WORLD).unwrap();
    assert_eq!(robot.robots()[0].window, Micros::from_millis(18));
    let readings = simulate(&robot, Method::Eeruf, &Options::periods(800)).unwrap();
    let (mut accepted, mut longest, mut all) = ([0; 4], [0.0_f64; 4], [0; 4]);
    for (at, &sensor) in readings.sensor.iter().enumerate() {
        let sensor = usize::from(sensor);
        all[sensor] += 1;
        accepted[sensor] += u32::from(readings.kind[at] == ReadingKind::Accepted);
        // A missing echo is NaN.
        longest[sensor] = longest[sensor].max(readings.t_echo_us[at]);
    }
    for (sensor, window) in [18_000.0, 18_000.0, 2_500.0, 3_000.0].into_iter().enumerate() {
        assert!(all[sensor] > 700 && longest[sensor] <= window, "sensor {sensor}: {all:?} {longest:?}");
    }
    // The walls are 0.9 m and more from the middle: only sensors with a long window see them.
    assert!(accepted[0] > 300 && accepted[1] > 300 && accepted[2] == 0, "{accepted:?}");
    assert!(longest[0] > 3_000.0 && longest[1] > 3_000.0, "{longest:?}");
    // Other methods listen for the longest window with every sensor.
    let sequential = simulate(&robot, Method::Sequential, &Options::periods(100)).unwrap();
    let far = |&(at, &sensor): &(usize, &u8)| sensor >= 2 && sequential.t_echo_us[at] > 3_000.0;
    assert!(sequential.sensor.iter().enumerate().any(|reading| far(&reading)));
}

#[test]
fn an_uneven_robot_is_written_as_it_is_read() {
    let parts = WorldParts::from_text(Path::new("w.toml"), WORLD).unwrap();
    let text = parts.to_toml();
    assert_eq!(WorldParts::from_text(Path::new("again.toml"), &text).unwrap().to_toml(), text);
    assert!(text.contains("together = [[2, 3]]") && text.contains("window_us = [18000, 18000, 2500, 3000]"), "{text}");
}

#[test]
fn what_is_wrong_with_an_uneven_robot_is_said_in_one_line() {
    let with = |from: &str, to: &str| world(&WORLD.replace(from, to)).unwrap_err();
    let few = with("[18_000, 18_000, 2_500, 3_000]", "[18_000, 18_000]");
    assert!(few.ends_with("2 values; expected one for all, or one for each of 4 sensors"), "{few}");
    let none = with("2_500", "0");
    assert!(none.ends_with("expected more than t_delta_us and the blanking time"), "{none}");
    let alone = with("[[2, 3]]", "[[2, 4]]");
    assert!(alone.ends_with("[2, 4]; expected two or more different sensors from 0 to 3"), "{alone}");
    // If they fire apart, the two sensors that fire together would be taken for each other.
    let unverified = world(&WORLD.replace("together = [[2, 3]]", "")).unwrap();
    let error = simulate(&unverified, Method::Eeruf, &Options::periods(4)).unwrap_err().to_string();
    assert!(error.contains("crosstalk between sensors 3 and 4 moves by 0 us"), "{error}");
}
