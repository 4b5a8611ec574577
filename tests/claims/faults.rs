//! Faults in a scene show in readings for as long as they last; scene files name them.

use std::path::Path;

use eeruf_core::ReadingKind;
use eeruf_sim::{Cause, Method, Options, Readings, World, simulate};

/// Four HC-SR04 in a closed room, fired by a table of their own; 60 ms a period.
const SCENE: &str = r#"
seed = 5
max_order = 2

[noise]
fading_db_rms = 0.0
jitter_us_rms = 0.0

[[wall]]
points_m = [[-2.0, -1.5], [2.0, -1.5], [2.0, 1.5], [-2.0, 1.5]]
closed = true

[[robot]]
pose = { x_m = 0.0, y_m = 0.0 }
ring = { sensors = 4, spacing_deg = 90.0, radius_m = 0.2 }
module = "hc-sr04"
schedule = { period_us = 60000, t_fire_a_us = [0, 15000, 30000, 45000], t_fire_b_us = [5000, 22000, 36000, 54000] }
"#;

const PERIODS: u32 = 200;
/// Times at which the faults of most tests begin and end, in seconds.
const BEGINS: f64 = 3.0;
const ENDS: f64 = 9.0;

fn read(fault: &str) -> Readings {
    let text = format!("{SCENE}\n[[fault]]\n{fault}\n");
    let world = World::from_text(Path::new("scene.toml"), &text).unwrap();
    simulate(&world, Method::Eeruf, &Options::periods(PERIODS)).unwrap()
}

/// A fault of a sensor from `BEGINS` to `ENDS`.
fn timed(kind: &str, sensors: &str, more: &str) -> Readings {
    read(&format!("kind = \"{kind}\"\nsensors = {sensors}\nfrom_s = {BEGINS:?}\nto_s = {ENDS:?}\n{more}"))
}

fn is_during(readings: &Readings, k: usize) -> bool {
    // A pair of readings at either end has one from outside.
    (BEGINS + 0.2..ENDS - 0.2).contains(&readings.fired_s[k])
}

fn is_apart(readings: &Readings, k: usize) -> bool {
    !(BEGINS - 0.2..ENDS + 0.2).contains(&readings.fired_s[k])
}

/// Returns the share of a sensor's readings at these times for which a condition holds.
fn share(readings: &Readings, sensor: u8, when: fn(&Readings, usize) -> bool, what: impl Fn(usize) -> bool) -> f64 {
    let all: Vec<_> = (0..readings.len()).filter(|&k| readings.sensor[k] == sensor && when(readings, k)).collect();
    assert!(all.len() > 30, "sensor {sensor}: {}", all.len());
    all.iter().filter(|&&k| what(k)).count() as f64 / all.len() as f64
}

fn accepted(readings: &Readings, sensor: u8, when: fn(&Readings, usize) -> bool) -> f64 {
    share(readings, sensor, when, |k| readings.kind[k] == ReadingKind::Accepted)
}

fn without_echo(readings: &Readings, sensor: u8, when: fn(&Readings, usize) -> bool) -> f64 {
    share(readings, sensor, when, |k| readings.earliest_us[k].is_nan())
}

/// Checks that sensors other than the faulty ones always believe their walls.
fn others_are_well(readings: &Readings, faulty: &[u8]) {
    for sensor in (0..4).filter(|sensor| !faulty.contains(sensor)) {
        let well = [is_during, is_apart].map(|when| accepted(readings, sensor, when));
        assert!(well.into_iter().all(|share| share > 0.97), "sensor {sensor}: {well:?}");
    }
    for &sensor in faulty {
        assert!(accepted(readings, sensor, is_apart) > 0.97, "sensor {sensor}");
    }
}

#[test]
fn lost_echoes_are_as_many_as_the_scene_says() {
    let readings = timed("lost", "[1]", "share = 0.3");
    let lost = without_echo(&readings, 1, is_during);
    assert!((lost - 0.3).abs() < 0.12, "{lost}");
    others_are_well(&readings, &[1]);
}

#[test]
fn noise_comes_before_the_echo_and_is_not_believed() {
    // A wall at 1.8 m is heard after 10.5 ms; at 100 a second a part of 1 - exp(-1.05) is heard before.
    let noisy = timed("noise", "[0]", "per_s = 100.0");
    let external = share(&noisy, 0, is_during, |k| noisy.cause[k] == Cause::External);
    assert!((external - 0.65).abs() < 0.15, "{external}");
    others_are_well(&noisy, &[0]);
    let uniform = timed("uniform_noise", "[0]", "share = 1.0");
    // Anywhere in 36 ms, so before the echo in 10.4 of 35.9.
    let external = share(&uniform, 0, is_during, |k| uniform.cause[k] == Cause::External);
    assert!((external - 0.29).abs() < 0.14, "{external}");
    others_are_well(&uniform, &[0]);
    for readings in [noisy, uniform] {
        let believed = share(&readings, 0, is_during, |k| {
            readings.cause[k] == Cause::External && readings.kind[k] == ReadingKind::Accepted
        });
        assert!(believed < 0.1, "{believed}");
    }
}

#[test]
fn exchanged_wires_make_two_sensors_read_each_other_or_nothing() {
    let tell = |kind: &str| {
        let readings = timed(kind, "[0, 1]", "");
        others_are_well(&readings, &[0, 1]);
        [0, 1].map(|sensor| (accepted(&readings, sensor, is_during), without_echo(&readings, sensor, is_during)))
    };
    for kind in ["echo_wires", "trigger_wires"] {
        // Waits alternate, so what the other one's sound gives is not believed.
        for (believed, _) in tell(kind) {
            assert!(believed < 0.05, "{kind}: {believed}");
        }
    }
    // Sensor 0 fires 15 and 17 ms before sensor 1: it hears that one's wall, 7.6 ms later, within its window of 36 ms.
    let [(_, first), (_, second)] = tell("echo_wires");
    assert!(first < 0.05, "{first}");
    // Sensor 0's next echo comes 45 ms after sensor 1's firing, when that listens no more.
    assert!(second > 0.95, "{second}");
}

#[test]
fn a_late_trigger_moves_the_wall_by_as_much() {
    let readings = timed("late_trigger", "[2]", "us = 400");
    let mean = |when: fn(&Readings, usize) -> bool| {
        let of = (0..readings.len()).filter(|&k| readings.sensor[k] == 2 && when(&readings, k));
        let times: Vec<_> = of.map(|k| readings.earliest_us[k]).collect();
        times.iter().sum::<f64>() / times.len() as f64
    };
    assert!((mean(is_during) - mean(is_apart) - 400.0).abs() < 2.0);
    others_are_well(&readings, &[2]);
}

#[test]
fn another_table_fires_at_other_times_and_ends() {
    let other = "kind = \"other_table\"\nfrom_s = 3.0\nto_s = 9.0\nschedule = { period_us = 90_000, \
                 t_fire_a_us = [0, 20_000, 40_000, 60_000], t_fire_b_us = [8_000, 30_000, 50_000, 75_000] }";
    let readings = read(other);
    let fired = |from_s: f64, to_s: f64| {
        (0..readings.len())
            .filter(|&k| readings.sensor[k] == 0 && (from_s..to_s).contains(&readings.fired_s[k]))
            .count()
    };
    assert_eq!([fired(0.6, 2.4), fired(4.5, 6.3), fired(9.6, 11.4)], [30, 20, 30]);
}

#[test]
fn a_clock_that_drifts_stretches_what_it_measures() {
    let readings = read("kind = \"clock_drift\"\nppm = 20_000.0\nfrom_s = 3.0\nto_s = 9.0");
    let mean = |when: fn(&Readings, usize) -> bool| {
        let of = (0..readings.len()).filter(|&k| readings.sensor[k] == 0 && when(&readings, k));
        let times: Vec<_> = of.map(|k| readings.earliest_us[k]).collect();
        times.iter().sum::<f64>() / times.len() as f64
    };
    assert!((mean(is_during) / mean(is_apart) - 1.02).abs() < 1e-3, "{} {}", mean(is_during), mean(is_apart));
}

// A line without edges gives no echo and only a missing sensor is silent.
#[test]
fn line_without_edges_gives_no_echo() {
    for kind in ["missing", "stuck", "cut"] {
        let readings = timed(kind, "[3]", "");
        assert_eq!(without_echo(&readings, 3, is_during), 1.0, "{kind}");
        others_are_well(&readings, &[3]);
    }
    // Six milliseconds apart sensors hear each other: one whose line is cut is heard still, one that does not exist is
    // not.
    let text = SCENE.replace("spacing_deg = 90.0", "spacing_deg = 5.0");
    let text = text.lines().filter(|line| !line.starts_with("schedule")).collect::<Vec<_>>().join("\n");
    let text = format!("{text}\nperiod_us = 24_000\nwindow_us = 14_000\n");
    let heard = |kind: &str| {
        let world = format!("{text}\n[[fault]]\nkind = \"{kind}\"\nsensors = [3]\n");
        let world = World::from_text(Path::new("scene.toml"), &world).unwrap();
        let readings = simulate(&world, Method::Conventional, &Options::periods(50)).unwrap();
        let crosstalk = (0..readings.len()).filter(|&k| readings.cause[k] == Cause::Crosstalk);
        crosstalk.filter(|&k| readings.paths[readings.path[k] as usize].emitter.sensor == 3).count()
    };
    assert_eq!(heard("missing"), 0);
    assert_eq!(heard("stuck"), 0);
    assert!(heard("cut") > 0);
}

#[test]
fn lost_edges_lose_one_echo_of_so_many() {
    for (kind, every, expected) in [("lost_rises", 5, 0.2), ("lost_falls", 4, 0.25)] {
        let readings = timed(kind, "[2]", &format!("every = {every}"));
        let lost = without_echo(&readings, 2, is_during);
        assert!((lost - expected).abs() < 0.02, "{kind}: {lost}");
        others_are_well(&readings, &[2]);
    }
}

#[test]
fn a_low_glitch_is_an_echo_of_a_pulse_and_a_high_one_of_an_edge() {
    let at =
        |readings: &Readings, us: f64| share(readings, 1, is_during, |k| (readings.earliest_us[k] - us).abs() < 2.0);
    let glitch = "after_us = 1_000\nwidth_us = 50";
    let low = timed("glitch_low", "[1]", glitch);
    assert!(at(&low, 1_000.0) > 0.99);
    others_are_well(&low, &[1]);
    assert_eq!(at(&timed("glitch_high", "[1]", glitch), 1_000.0), 0.0);
    // A Polaroid's line rises with the echo; it is deaf for 2.38 ms.
    let edge = |kind: &str| {
        let text = SCENE.replace("hc-sr04", "polaroid-6500");
        let fault =
            format!("kind = \"{kind}\"\nsensors = [1]\nafter_us = 3_000\nwidth_us = 50\nfrom_s = 3.0\nto_s = 9.0");
        let world = World::from_text(Path::new("scene.toml"), &format!("{text}\n[[fault]]\n{fault}\n")).unwrap();
        at(&simulate(&world, Method::Eeruf, &Options::periods(PERIODS)).unwrap(), 3_000.0)
    };
    assert!(edge("glitch_high") > 0.99);
    assert_eq!(edge("glitch_low"), 0.0);
}

#[test]
fn a_leg_that_walks_by_is_read_while_it_is_there() {
    let leg = "kind = \"leg\"\nradius_m = 0.05\nfrom_m = [0.9, -1.2]\nto_m = [0.9, 1.2]\nfrom_s = 3.0\nto_s = 9.0";
    let readings = read(leg);
    // Ahead of sensor 0, which the ring turns by -135 degrees, stands no leg; sensor 1 looks along -45 degrees.
    let near = |sensor: u8, from_s: f64, to_s: f64| {
        let of = (0..readings.len()).filter(|&k| readings.sensor[k] == sensor);
        let of = of.filter(|&k| (from_s..to_s).contains(&readings.fired_s[k]));
        of.map(|k| readings.earliest_us[k]).fold(f64::INFINITY, f64::min)
    };
    let before: Vec<f64> = (0..4).map(|sensor| near(sensor, 0.5, 3.0)).collect();
    let during: Vec<f64> = (0..4).map(|sensor| near(sensor, 3.1, 9.0)).collect();
    let after: Vec<f64> = (0..4).map(|sensor| near(sensor, 9.2, 12.0)).collect();
    assert_eq!(before, after);
    assert!(during.iter().zip(&before).any(|(during, before)| *during < before - 2_000.0), "{during:?} {before:?}");
    assert!(during[0] == before[0] || during[3] == before[3], "{during:?} {before:?}");
}

#[test]
fn a_door_that_opens_lets_a_sensor_see_farther() {
    let text = SCENE.replace("spacing_deg = 90.0", "spacing_deg = 360.0").replace("sensors = 4", "sensors = 1");
    let text = text.lines().filter(|line| !line.starts_with("schedule")).collect::<Vec<_>>().join("\n");
    let door = "kind = \"door\"\nhinge_m = [1.0, -0.6]\nlength_m = 0.9\nfrom_deg = 90.0\nto_deg = 0.0\nfrom_s = 3.0\n\
                to_s = 9.0";
    let world = World::from_text(Path::new("scene.toml"), &format!("{text}\n[[fault]]\n{door}\n")).unwrap();
    let readings = simulate(&world, Method::Sequential, &Options::periods(PERIODS)).unwrap();
    let mean = |when: fn(f64) -> bool| {
        let of: Vec<_> = (0..readings.len()).filter(|&k| when(readings.fired_s[k])).collect();
        of.iter().map(|&k| readings.earliest_us[k]).sum::<f64>() / of.len() as f64
    };
    // 0.8 m, then 1.8 m.
    let [shut, open] = [mean(|at| at < 2.9), mean(|at| at > 9.1)];
    assert!((shut - 1.6 / 343.2e-6).abs() < 300.0 && (open - 3.6 / 343.2e-6).abs() < 300.0, "{shut} {open}");
}

// A scene with faults is written as it is read and wrong ones are refused.
#[test]
fn faulty_scene_is_written_as_read() {
    let refused = |fault: &str| {
        World::from_text(Path::new("s.toml"), &format!("{SCENE}\n[[fault]]\n{fault}\n")).unwrap_err().to_string()
    };
    for (fault, expected) in [
        ("kind = \"bat\"", "fault 1: kind is \"bat\"; expected lost, noise, "),
        ("kind = \"lost\"", "fault 1: no share; expected one with kind \"lost\""),
        ("kind = \"lost\"\nshare = 1.5", "fault 1: share is 1.5; expected 0 to 1"),
        ("kind = \"cut\"\nshare = 0.5", "fault 1: share with kind \"cut\"; expected no such key"),
        (
            "kind = \"cut\"\nsensors = [4]",
            "fault 1: sensors is 4; expected numbers below its robot's number of sensors: they count from 0",
        ),
        (
            "kind = \"cut\"\nrobot = 1",
            "fault 1: robot is 1; expected a number below that of the robots: they count from 0",
        ),
        ("kind = \"cut\"\nfrom_s = 2.0\nto_s = 1.0", "fault 1: to_s is 1; expected more than from_s"),
        ("kind = \"echo_wires\"\nsensors = [1]", "fault 1: sensors is 1; expected two different ones"),
        ("kind = \"leg\"\nradius_m = 0.1\nfrom_m = [0, 1]\nto_m = [1, 1]", "fault 1: to_s is inf; expected a time"),
        ("kind = \"clock_drift\"\nppm = nan", "fault 1: ppm is NaN; expected -100000 to 100000"),
        ("kind = \"cut\"\nsince = 1", "since: unknown key"),
    ] {
        let error = refused(fault);
        assert!(error.contains(expected) && error.starts_with("s.toml, line "), "{fault}: {error}");
    }
    let all = [
        "kind = \"lost\"\nshare = 0.25",
        "kind = \"noise\"\nper_s = 3.0",
        "kind = \"uniform_noise\"\nshare = 0.5",
        "kind = \"echo_wires\"\nsensors = [1, 2]",
        "kind = \"trigger_wires\"\nsensors = [0, 3]",
        "kind = \"late_trigger\"\nus = 90",
        "kind = \"clock_drift\"\nppm = -50.0",
        "kind = \"missing\"",
        "kind = \"stuck\"",
        "kind = \"cut\"\nsensors = [1]\nfrom_s = 1.5\nto_s = 2.5",
        "kind = \"lost_rises\"\nevery = 3",
        "kind = \"lost_falls\"\nevery = 7",
        "kind = \"glitch_low\"\nafter_us = 30\nwidth_us = 5",
        "kind = \"glitch_high\"\nafter_us = 500\nwidth_us = 1000",
        "kind = \"leg\"\nradius_m = 0.05\nfrom_m = [0.9, -1.2]\nto_m = [0.9, 1.2]\nto_s = 4.0",
        "kind = \"door\"\nhinge_m = [-1.0, 0.5]\nlength_m = 0.5\nfrom_deg = 0.0\nto_deg = 80.0\nfrom_s = 1.0",
        "kind = \"other_table\"\nschedule = { period_us = 90_000, t_fire_a_us = [0, 20_000, 40_000, 60_000], \
         t_fire_b_us = [8_000, 30_000, 50_000, 75_000] }",
    ];
    let text = all.iter().fold(SCENE.to_owned(), |text, fault| format!("{text}\n[[fault]]\n{fault}\n"));
    let parts = eeruf_sim::WorldParts::from_text(Path::new("s.toml"), &text).unwrap();
    let mut kinds: Vec<_> = parts.faults.iter().map(|fault| fault.kind.name()).collect();
    assert_eq!(kinds.len(), all.len());
    kinds.sort_unstable();
    let mut names = eeruf_sim::FaultKind::NAMES;
    names.sort_unstable();
    assert_eq!(kinds, names);
    let again = eeruf_sim::WorldParts::from_text(Path::new("again.toml"), &parts.to_toml()).unwrap();
    assert_eq!(again.faults, parts.faults);
    assert_eq!(again.to_toml(), parts.to_toml());
}
