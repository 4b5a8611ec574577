//! A ring file means the same everywhere: in a scene, in the tables that `design` emits, in the ring and the driver
//! that fire by it. The test reads the file as plain TOML, and compares each of them with it.

use std::collections::BTreeMap;

use eeruf_core::{Instant, Micros, Ring, RingConfig, plan::ScheduledFiring};
use eeruf_design::{Effort, RingSpec};
use eeruf_hc_sr04::{HcSr04Ring, Settings};
use eeruf_sim::modules::{Module, ModulesFile, PulseTimes};

use crate::common::{C, Scratch, compile_and_run, eeruf};
use crate::rings_in_scenes::scene;
use crate::started::{FORMS, rings, run_c};

/// A ring file of several makes, with every key that has to reach the ring.
const MIXED: &str = r#"
sensors = 4
layout = "ring"
neighbours = 2
module = ["hc-sr04", { like = "hc-sr04", hold_us = 130_000 }, "ping", { like = "jsn-sr04t", blanking_us = 900 }]
max_range_m = [2.0, 1.5, 1.0, 2.5]
retrigger_us = [45_000, 45_000, 30_000, 45_000]
jitter_us = [150, 200, 250, 300]
speed_m_s = 0.3
crosstalk_range_m = 0.5
intervals_us = [[0, 2, 2_000]]
shared_lines = [[0, 1]]
together = [[1, 3]]
handling_us = 400
path_change_us = 120
audible_us = 30_000
tick_us = 100
"#;

/// A ring of one custom module, for the driver; the file gives the window.
const ALIKE: &str = r#"
sensors = 3
layout = "ring"
module = { like = "hc-sr04", hold_us = 290_000, trigger_us = 20, rest_us = 25_000, blanking_us = 300 }
window_us = 26_000
t_delta_us = 400
min_interval_us = 5_000
handling_us = 600
path_change_us = 90
audible_us = 40_000
"#;

/// The values of a ring file, key by key.
struct Said {
    file: toml::Table,
    sensors: usize,
    modules: Vec<Module>,
}

impl Said {
    fn new(text: &str) -> Self {
        let file: toml::Table = text.parse().unwrap();
        let sensors = usize::try_from(file["sensors"].as_integer().unwrap()).unwrap();
        let modules = file.get("module").map(|modules| modules.clone().try_into::<ModulesFile>().unwrap());
        let modules = modules.map_or(vec![], |modules| modules.list(sensors).unwrap());
        Self { file, sensors, modules }
    }

    /// Returns one number, or one for each sensor.
    fn each(&self, key: &str) -> Option<Vec<f64>> {
        let number = |value: &toml::Value| value.as_float().unwrap_or_else(|| value.as_integer().unwrap() as f64);
        self.file.get(key).map(|value| match value {
            toml::Value::Array(list) => list.iter().map(number).collect(),
            one => vec![number(one); self.sensors],
        })
    }

    fn us(&self, key: &str) -> Option<u32> {
        self.file.get(key).map(|value| u32::try_from(value.as_integer().unwrap()).unwrap())
    }

    /// Returns lists of numbers; none without the key.
    fn lists(&self, key: &str) -> Vec<Vec<u32>> {
        self.file.get(key).map_or(vec![], |value| value.clone().try_into().unwrap())
    }

    fn windows_us(&self) -> Vec<f64> {
        let of_modules = || self.modules.iter().map(Module::sees_to_m).collect();
        let far = || self.each("max_range_m").unwrap_or_else(of_modules);
        // There and back at 343.2 m/s.
        self.each("window_us").unwrap_or_else(|| far().into_iter().map(|m| 2e6 * m / 343.2).collect())
    }

    /// Windows of a table: identical sensors listen until they may be triggered again.
    fn listens_us(&self) -> Vec<f64> {
        let lists = ["window_us", "max_range_m", "retrigger_us", "t_delta_us", "jitter_us", "module"];
        let pairs = ["intervals_us", "shared_lines", "together"];
        let is_uneven = lists.iter().any(|key| self.file.get(*key).is_some_and(toml::Value::is_array))
            || pairs.iter().any(|key| self.file.contains_key(*key));
        let rests = if is_uneven { vec![0.0; self.sensors] } else { self.rests_us() };
        self.windows_us().into_iter().zip(rests).map(|(window, rest)| window.max(rest)).collect()
    }

    /// The least time between two triggers of each sensor, beside its window.
    fn rests_us(&self) -> Vec<f64> {
        let none = vec![0.0; self.sensors];
        let of_modules = || self.modules.iter().map(|module| f64::from(module.rest_us)).collect::<Vec<_>>();
        let modules = if self.modules.is_empty() || self.file.contains_key("window_us") { none } else { of_modules() };
        self.each("retrigger_us").unwrap_or(modules)
    }

    /// `T_delta` of each sensor on a robot that stands.
    fn t_deltas_us(&self) -> Vec<f64> {
        let said = self.each("t_delta_us").or_else(|| self.each("jitter_us"));
        said.unwrap_or_else(|| vec![100.0; self.sensors])
    }

    /// Change of readings by motion between two firings of a sensor by this table.
    fn motion_us(&self, table: &Table) -> f64 {
        let [a, b] = &table.fire;
        let apart = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
        2.0 * self.each("speed_m_s").map_or(0.0, |speed| speed[0]) * f64::from(table.period + apart) / 343.2
    }
}

/// An emitted table, and the settings that go with it.
#[derive(Debug, PartialEq)]
struct Table {
    period: u32,
    fire: [Vec<u32>; 2],
    /// The settings that a driver takes; `None` in the form `toml`, which is a table alone.
    rest: Option<Listening>,
}

#[derive(Debug, PartialEq)]
struct Listening {
    t_delta: Vec<u32>,
    window: Vec<u32>,
    path_change: Option<u32>,
    stale_echo: bool,
}

/// Returns the whole numbers in Rust source text.
fn numbers(text: &str) -> Vec<u32> {
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_').map(|word| word.replace('_', ""));
    let number = |word: String| match word.strip_prefix("0b") {
        Some(bits) => u32::from_str_radix(bits, 2).ok(),
        None => word.parse().ok(),
    };
    words.filter_map(number).collect()
}

/// Returns the numbers after this text, up to this end; none without it.
fn after(text: &str, key: &str, end: char) -> Option<Vec<u32>> {
    let (_, rest) = text.split_once(key)?;
    Some(numbers(rest.split(end).next().unwrap()))
}

fn one(text: &str, key: &str) -> Option<u32> {
    after(text, key, ')').map(|found| found[0])
}

/// Returns firing times, given or from lags and waits.
fn fire(list: impl Fn(&str) -> Option<Vec<u32>>) -> [Vec<u32>; 2] {
    ["a", "b"].map(|phase| {
        list(&format!("t_fire_{phase}_us")).unwrap_or_else(|| {
            let waits = list(&format!("t_wait_{phase}_us")).unwrap();
            list("t_lag_us").unwrap().iter().zip(waits).map(|(lag, wait)| lag + wait).collect()
        })
    })
}

fn of_toml(text: &str) -> Table {
    let file: toml::Table = text.parse().unwrap();
    let list = |key: &str| file.get(key).map(|list| list.clone().try_into().unwrap());
    Table { period: file["period_us"].clone().try_into().unwrap(), fire: fire(list), rest: None }
}

fn of_rust(text: &str) -> Table {
    let fire = fire(|key| after(text, &format!("{key}: ["), ']'));
    let all = |time| vec![time; fire[0].len()];
    let each = |key: &str| after(text, &format!(" {key}: &["), ']').filter(|list| !list.is_empty());
    let rest = Listening {
        t_delta: each("t_delta").unwrap_or_else(|| all(one(text, "..Requirements::new(").unwrap())),
        window: each("window").unwrap_or_else(|| all(one(text, "window: Micros::new(").unwrap())),
        path_change: one(text, "Criterion::Margin(").map(|margin| margin - 1),
        stale_echo: text.contains("stale_echo: true"),
    };
    Table { period: after(text, "period_us: ", ',').unwrap()[0], fire, rest: Some(rest) }
}

/// The table of a C header, from a program that includes it, and all other values of the header.
fn of_c(emitted: &str, form: usize) -> (Table, BTreeMap<String, Vec<u32>>) {
    let [_, schedule, settings] = FORMS[form];
    let said = run_c("say", emitted, [schedule, settings]).unwrap();
    let line = |line: &str| line.split_once(' ').map(|(name, rest)| (name.to_owned(), numbers(rest))).unwrap();
    let said: BTreeMap<_, _> = said.lines().map(line).collect();
    assert_eq!(said["verified"], [1]);
    let rest = Listening {
        t_delta: said["t_delta"].clone(),
        window: said["window"].clone(),
        path_change: said.get("path_change").map(|change| change[0]),
        stale_echo: said["stale_echo"] == [1],
    };
    let fire = ["t_fire_a", "t_fire_b"].map(|name| said[name].clone());
    (Table { period: said["period"][0], fire, rest: Some(rest) }, said)
}

fn close(found: &[u32], said: &[f64]) -> bool {
    found.len() == said.len() && found.iter().zip(said).all(|(found, said)| (f64::from(*found) - said).abs() <= 2.0)
}

/// Returns the firings of a table in three periods, in order: time and sensor.
fn firings(table: &Table) -> Vec<(u32, usize)> {
    let period = |k: u32| table.fire[k as usize % 2].iter().enumerate().map(move |(x, at)| (at + k * table.period, x));
    let mut all: Vec<_> = (0..3).flat_map(period).collect();
    all.sort_unstable();
    all
}

/// Checks that the table keeps the file's values for single sensors and pairs.
fn keeps(table: &Table, said: &Said) {
    let (windows, rests) = (said.windows_us(), said.rests_us());
    let in_one = |key: &str, x: usize, y: usize| {
        said.lists(key).iter().any(|set| [x, y].iter().all(|&sensor| set.contains(&(sensor as u32))))
    };
    let all = firings(table);
    for (k, &(before, x)) in all.iter().enumerate() {
        for &(at, y) in &all[k + 1..] {
            let gap = f64::from(at - before);
            if x == y {
                assert!(gap >= windows[x].floor().max(rests[x]), "sensor {x} again after {gap} us");
                continue;
            }
            if in_one("together", x, y) {
                assert!(at == before || gap > 1_000.0, "{x} and {y} fire {gap} us apart, not together");
                continue;
            }
            if in_one("shared_lines", x, y) {
                assert!(gap >= windows[x].floor(), "{y} fires on the line of {x}, which listens, after {gap} us");
            }
            assert!(gap >= f64::from(said.us("handling_us").unwrap_or(0)), "{x} and {y} fire {gap} us apart");
            for pair in said.lists("intervals_us") {
                if [x, y].iter().all(|&sensor| pair[..2].contains(&(sensor as u32))) {
                    assert!(at - before >= pair[2], "{x} and {y} fire {gap} us apart");
                }
            }
        }
    }
}

/// Returns the robot of a scene with this ring and this table.
fn scene_says(file: &str, text: &str, said: &Said, emitted: &str, table: &Table) {
    let mut more = String::new();
    if !["poses", "spacing_deg"].iter().any(|key| said.file.contains_key(*key)) {
        let places: Vec<_> = (0..said.sensors)
            .map(|x| x as f64 * 360.0 / said.sensors as f64)
            .map(|deg| {
                format!(
                    "{{ x_m = {:?}, y_m = {:?}, heading_deg = {deg:?} }}",
                    0.2 * deg.to_radians().cos(),
                    0.2 * deg.to_radians().sin()
                )
            })
            .collect();
        more += &format!("sensors = [{}]\n", places.join(", "));
    }
    let world = scene(file, &format!("{more}[robot.schedule]\n{emitted}")).unwrap_or_else(|why| panic!("{text}{why}"));
    let robot = &world.robots()[0];
    let us = |of: &dyn Fn(usize) -> Micros| (0..said.sensors).map(|x| of(x).as_micros()).collect::<Vec<_>>();
    let limits = |x: usize| robot.limits.get(x).copied();
    let window = us(&|x| limits(x).map_or(robot.window, |limits| limits.window));
    let t_delta = us(&|x| limits(x).map_or(robot.t_delta, |limits| limits.t_delta));
    let listens = table.rest.as_ref().unwrap();
    assert!(close(&window, &said.windows_us()), "{file}: {window:?} {:?}", said.windows_us());
    let emitted_t_delta: Vec<_> = listens.t_delta.iter().map(|us| f64::from(*us)).collect();
    assert!(close(&t_delta, &emitted_t_delta), "{file}: {t_delta:?} {emitted_t_delta:?}");
    let path_change: Vec<_> = robot.path_change.iter().map(|change| change.as_micros()).collect();
    let emitted: Vec<_> = listens.path_change.iter().map(|us| f64::from(*us)).collect();
    assert!(close(&path_change, &emitted), "{file}: {path_change:?} {emitted:?}");
    let sets = |sets: &[Vec<u32>]| -> Vec<u64> {
        sets.iter().map(|set| set.iter().fold(0, |bits, sensor| bits | 1 << sensor)).collect()
    };
    assert_eq!(robot.together, sets(&said.lists("together")), "{file}");
    assert_eq!(u32::from(robot.neighbours), said.us("neighbours").unwrap_or(4), "{file}");
    assert_eq!([robot.schedule.unwrap().period(), robot.period].map(Micros::as_micros), [table.period; 2], "{file}");
    if let Some(places) = said.file.get("poses") {
        let x_m: Vec<_> = robot.sensors.iter().map(|pose| pose.translation.x).collect();
        let said: Vec<_> = places.as_array().unwrap().iter().map(|place| place["x_m"].as_float().unwrap()).collect();
        assert_eq!(x_m, said, "{file}");
    }
    for (x, module) in said.modules.iter().enumerate() {
        let rest_us = said.each("retrigger_us").map_or(module.rest_us, |rests| rests[x] as u32);
        assert_eq!(robot.module_of(x), Module { rest_us, ..*module }, "{file}: sensor {x}");
        assert_eq!(robot.blanking_of(x).as_micros(), module.blanking_us, "{file}: sensor {x}");
    }
    if !said.modules.is_empty() {
        let hears = said.modules.iter().map(|module| 2e3 * f64::from(module.hears_to_mm) / 343.2);
        let audible = said.us("audible_us").map_or(hears.fold(0.0, f64::max), f64::from);
        assert!(close(&[robot.audible.as_micros()], &[audible]), "{file}: {} {audible}", robot.audible);
    }
}

/// The settings of the driver of these modules; `None` if they are of several kinds, or do not answer by pulses.
fn settings(said: &Said, table: &Table) -> Option<Settings> {
    let module = said.modules.first().filter(|first| said.modules.iter().all(|module| module == *first))?;
    let mut settings = Settings::of(module)?;
    let rests = said.each("retrigger_us");
    if let Some(rests) = rests {
        settings.min_retrigger = Micros::new(rests[0] as u32);
    } else if said.file.contains_key("window_us") {
        let refires = |x: usize| table.period - table.fire[0][x].abs_diff(table.fire[1][x]);
        let shortest = (0..said.sensors).map(refires).min().unwrap();
        settings.min_retrigger = settings.min_retrigger.min(Micros::new(shortest));
    }
    Some(settings)
}

/// A ring by the table of the library, and the driver around it.
fn driver_says(file: &str, text: &str, said: &Said, table: &Table, c: &BTreeMap<String, Vec<u32>>) -> bool {
    let design = RingSpec::from_text(text).unwrap().shortest(&Effort::default(), &mut ()).unwrap();
    let verified = design.schedule.verified_each(&design.spec.table_requirements()).unwrap();
    let blanking = Micros::new(c.get("blanking").map_or(0, |blanking| blanking[0]));
    let config = RingConfig::new().with_blanking(blanking);
    let plan = ScheduledFiring::with_limits(verified.schedule(), verified.own_limits(), Instant::default());
    let ring = Ring::<_, _, 64, 1, 4>::remembering(plan, config, Instant::default()).unwrap();
    let listens = table.rest.as_ref().unwrap();
    for x in 0..said.sensors {
        let sensor = x as u8;
        assert_eq!(ring.t_delta_of(sensor).as_micros(), listens.t_delta[x], "{file}");
        assert_eq!(ring.window_of(sensor).as_micros(), listens.window[x], "{file}");
        let path_change = listens.path_change.unwrap_or(listens.t_delta[x]);
        assert_eq!(ring.path_change_of(sensor).as_micros(), path_change, "{file}");
    }
    assert_eq!(ring.audible().as_micros(), c["audible"][0], "{file}");
    let settings = settings(said, table);
    assert_eq!(settings.is_some(), c.contains_key("settings"), "{file}");
    let Some(settings) = settings else { return false };
    let Settings { deaf, shortest, latest_rise, longest, longest_hold, min_retrigger, trigger, .. } = settings;
    let times = [deaf, shortest, latest_rise, longest, longest_hold, min_retrigger].map(Micros::as_micros);
    let times = [&times[..], &[settings.missing_after.into(), trigger.as_micros()]].concat();
    assert_eq!(c["settings"], times, "{file}");
    let PulseTimes { longest_us, .. } = said.modules[0].pulse_times().unwrap();
    assert_eq!((longest.as_micros(), trigger.as_micros()), (longest_us, said.modules[0].trigger_us), "{file}");
    let driver = HcSr04Ring::by_hardware(ring, settings).unwrap();
    assert_eq!(driver.ring().blanking(), blanking, "{file}");
    true
}

/// A driver has the settings of one kind of module: for several, a table has none and lists the sensors.
fn names_other_kinds(file: &str, form: &str, emitted: &str, said: &Said) {
    let others = said.modules.iter().enumerate().filter(|&(_, module)| *module != said.modules[0]);
    let others: Vec<_> = others.map(|(sensor, _)| sensor.to_string()).collect();
    let reason = emitted.lines().find_map(|line| line.split_once("No settings of one driver: sensors "));
    let expected = (!others.is_empty()).then(|| format!("{} are of another kind than sensor 0.", others.join(", ")));
    let reason = reason.map(|(_, reason)| reason.trim_end_matches(" */"));
    assert_eq!(reason, expected.as_deref(), "{file}: {form}");
}

/// Checks what every part makes of a ring file; returns true if a driver is among them.
fn says_the_same_everywhere(file: &str) -> bool {
    let text = std::fs::read_to_string(file).unwrap();
    let said = Said::new(&text);
    let emit = |form: &str| {
        let emitted = eeruf(&["design", file, "--period-only", "--emit", form]);
        assert_eq!(emitted.code, Some(0), "{file}: {}", emitted.err);
        emitted.out
    };
    let [toml, rust, c, arduino] = ["toml", "rust", "c", "arduino"].map(emit);
    for (form, emitted) in [("rust", &rust), ("c", &c), ("arduino", &arduino)] {
        names_other_kinds(file, form, emitted, &said);
    }
    let (table, c) = of_c(&c, 0);
    let (arduino, by_arduino) = of_c(&arduino, 1);
    let listens = table.rest.as_ref().unwrap();
    // Every form is the same table for the same sensors.
    assert_eq!(of_toml(&toml), Table { rest: None, fire: table.fire.clone(), ..table }, "{file}");
    assert_eq!(of_rust(&rust), table, "{file}\n{rust}");
    assert_eq!(arduino, table, "{file}");
    assert_eq!((&by_arduino["audible"], by_arduino.get("settings")), (&c["audible"], c.get("settings")), "{file}");
    // It is what the file says.
    let motion = said.motion_us(&table);
    let t_deltas: Vec<_> = said.t_deltas_us().into_iter().map(|us| us + motion).collect();
    assert!(close(&listens.t_delta, &t_deltas), "{file}: {:?} {t_deltas:?}", listens.t_delta);
    assert!(close(&listens.window, &said.listens_us()), "{file}: {:?} {:?}", listens.window, said.listens_us());
    let path_change: Vec<_> = said.us("path_change_us").map(|us| f64::from(us) + motion).into_iter().collect();
    assert!(close(&listens.path_change.map_or(vec![], |us| vec![us]), &path_change), "{file}: {path_change:?}");
    let stale_echo = said.file.get("stale_echo").map_or(!said.modules.is_empty(), |stale| stale.as_bool().unwrap());
    assert_eq!(listens.stale_echo, stale_echo, "{file}");
    let longest = table.period * if stale_echo { 2 } else { 1 };
    assert_eq!(c["audible"], [said.us("audible_us").map_or(longest, |us| us.min(longest))], "{file}");
    let in_rust = one(&rust, "audible: Some(");
    assert_eq!(in_rust, said.us("audible_us"), "{file}");
    let deaf = said.modules.iter().map(|module| module.blanking_us).min();
    assert_eq!((one(&rust, "with_blanking("), c.get("blanking").map(|us| us[0])), (deaf, deaf), "{file}");
    let apart = said
        .us("min_interval_us")
        .map_or_else(|| 2e6 * said.each("crosstalk_range_m").map_or(2.57, |range| range[0]) / 343.2, f64::from);
    assert!(close(&[one(&rust, "min_interval: Micros::new(").unwrap()], &[apart]), "{file}: {apart}");
    let bits = |set: &Vec<u32>| set.iter().fold(0, |bits, sensor| bits | 1 << sensor);
    for (key, name) in [("shared_lines", "shared_lines: &["), ("together", "together: &[")] {
        let sets: Vec<u32> = said.lists(key).iter().map(bits).collect();
        assert_eq!(after(&rust, name, ']').unwrap_or_default(), sets, "{file}: {key}");
    }
    assert_eq!(after(&rust, "intervals: &[", ']').unwrap_or_default(), said.lists("intervals_us").concat(), "{file}");
    keeps(&table, &said);
    // Sensors of one group fire together, and no others have one.
    for x in 0..said.sensors {
        let group: Vec<_> =
            (0..said.sensors).filter(|&y| c["group"][x] > 0 && c["group"][y] == c["group"][x]).collect();
        let together = said.lists("together").into_iter().find(|set| set.contains(&(x as u32)));
        let together: Vec<_> = together.unwrap_or_default().into_iter().map(|sensor| sensor as usize).collect();
        assert_eq!(group, together, "{file}");
    }
    scene_says(file, &text, &said, &toml, &table);
    driver_says(file, &text, &said, &table, &c)
}

#[test]
fn shipped_ring_file_says_the_same_everywhere() {
    let rings = rings();
    assert!(rings.len() >= 8, "{rings:?}");
    let driven = rings.iter().filter(|file| says_the_same_everywhere(file.to_str().unwrap())).count();
    assert_eq!(driven, 6, "ring files that name one kind of module");
}

#[test]
fn every_key_of_a_ring_file_reaches_its_ring() {
    for (text, has_driver) in [(MIXED, false), (ALIKE, true)] {
        let (_folder, file) = Scratch::new("ring.toml", text);
        assert_eq!(says_the_same_everywhere(file.to_str().unwrap()), has_driver, "{text}");
    }
    for (more, expected) in [
        ("path_change_us = 401", "path_change_us = 401; expected 1 to the smallest T_delta"),
        ("path_change_us = 0", "path_change_us = 0; expected 1 to the smallest T_delta"),
        ("audible_us = 67_108_865", "audible_us = 67108865; expected 1 to 67108864"),
    ] {
        let (key, _) = more.split_once(" =").unwrap();
        let without: Vec<_> = ALIKE.lines().filter(|line| !line.starts_with(key)).collect();
        let error = RingSpec::from_text(&format!("{}\n{more}", without.join("\n"))).unwrap_err();
        assert!(error.message().starts_with(expected), "{error}");
    }
}

/// Checks that the name of a module and a number of sensors make the same ring in Rust, C and MicroPython as a file.
#[test]
fn ring_of_a_module_alone_is_that_of_its_file() {
    let (folder, file) = Scratch::new("ring.toml", "sensors = 8\nmodule = \"hc-sr04\"\nlayout = \"ring\"\n");
    let emitted = eeruf(&["design", file.to_str().unwrap(), "--way", "flow", "--emit", "c"]).out;
    std::fs::write(folder.path().join("ring.h"), &emitted).unwrap();
    let equal = ["window_us", "blanking_us", "least_us", "most_us", "rest_us", "dice_us", "t_delta_us", "near_us"]
        .map(|number| format!("mine.{number} == eeruf_flow_config.{number}"));
    let text = format!(
        "#include \"eeruf.h\"\n#include \"ring.h\"\nint main(void) {{\n    \
         const EerufFlowConfig mine = EERUF_FLOW_HC_SR04(8);\n    return !({});\n}}\n",
        equal.join(" && ")
    );
    compile_and_run(&folder, &text, C);
    let python = "import sys; sys.path.insert(0, 'c/micropython'); import eeruf\n\
        f = eeruf.Flow(8, seed=1, **eeruf.HC_SR04)\n\
        print(f'{f.window_us}u, {f.blanking_us}u, {f.least_us}u, {f.most_us}u, {f.rest_us}u, {f.dice_us}u', end='')";
    let mut said = std::process::Command::new("python3");
    let said = said.args(["-c", python]).current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap().stdout;
    assert!(said.len() > 20 && emitted.contains(std::str::from_utf8(&said).unwrap()), "{emitted}");
    let ring = eeruf_hc_sr04::flow_ring::<8>(&eeruf_hc_sr04::modules::HC_SR04).unwrap();
    let of_ring = format!("{}u, {}u, ", ring.window().as_micros(), ring.blanking().as_micros());
    assert!(said.starts_with(of_ring.as_bytes()), "{of_ring}");
}
