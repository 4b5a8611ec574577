//! Set III: robots of one make.

use eeruf_core::Micros;
use eeruf_sim::experiments::set_three::{Placing, SetThreeOptions, set_three, world_of};
use eeruf_sim::*;

fn ways() -> [Entry; 2] {
    [Method::Sequential, Method::Flow].map(Entry::from)
}

fn asked(seeds: u64, methods: &[Entry]) -> SetThreeOptions {
    SetThreeOptions { seeds, periods: 20, methods: methods.to_vec(), ..SetThreeOptions::default() }
}

#[test]
fn figures_depend_on_neither_threads_nor_other_methods() {
    let on = |threads, methods: &[Entry]| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| set_three(&asked(4, methods), &|_| true)).unwrap()
    };
    let both = on(1, &ways());
    assert_eq!(both, on(2, &ways()));
    assert_eq!(on(2, &ways()[1..]).methods[0], both.methods[1]);
}

#[test]
fn json_names_ways_and_groups() {
    let json = serde_json::to_value(set_three(&asked(7, &ways()), &|_| true).unwrap()).unwrap();
    for way in ["sequential", "flow"] {
        let figures = &json["methods"][way];
        let share = |name: &str| figures[name]["mean"].as_f64().unwrap();
        let shares: f64 = ["belief_right", "unknown", "phantom", "too_far", "faint"].map(share).iter().sum();
        assert!((shares - 1.0).abs() < 1e-9, "{way}: {shares}");
        // Sound of other robots is a part of foreign sound.
        assert!(share("others_of_accepted") <= share("foreign_of_accepted"), "{way}");
        assert!(share("others_of_accepted") > 0.0 && share("others_at_worst") >= share("others_of_accepted"), "{way}");
    }
    let groups = json["groups"].as_array().unwrap();
    let placings = |by: &str| -> u64 {
        let of = groups.iter().filter(|group| group.get(by).is_some());
        of.map(|group| group["placings"].as_u64().unwrap()).sum()
    };
    assert_eq!((placings("arrangement"), placings("robots")), (7, 7));
}

#[test]
fn robots_out_of_reach_take_nothing_from_each_other() {
    let mut placing = Placing::random(20_000);
    placing.room_m = [90.0, 8.0];
    placing.robots.truncate(2);
    for (robot, x) in placing.robots.iter_mut().zip([-40.0, 40.0]) {
        robot.pose = Pose::new(Vector::new(x, 0.0), 0.3);
    }
    let method = Method::Simultaneous;
    let world = world_of(&asked(1, &ways()), &placing, &method.into()).unwrap();
    let readings = simulate(&world, method, &Options::periods(20)).unwrap();
    let heard = readings.paths.iter().filter(|path| path.emitter.robot != path.receiver.robot).count();
    assert_eq!(heard, 0);
}

#[test]
fn nothing_to_do_is_refused() {
    let error = |asked: &SetThreeOptions| set_three(asked, &|_| true).unwrap_err().to_string();
    assert_eq!(error(&asked(0, &ways())), "0 seeds; expected at least one");
    assert_eq!(error(&asked(1, &[])), "no methods; expected at least one");
    assert_eq!(set_three(&asked(2, &ways()), &|_| false).unwrap_err().to_string(), "stopped");
}

const TODAY: [Method; 6] =
    [Method::InTurn, Method::Arrays, Method::Groups, Method::SyncLine, Method::FreeRunning, Method::Table];

/// A firing of a placing's robots: time in ns, robot, sensor, and the earliest edge and its cause.
type Fired = (u64, u16, u8, u64, Cause);

fn fired(number: u64, entry: &Entry) -> Vec<Fired> {
    let placing = Placing::random(number);
    let world = world_of(&asked(1, &ways()), &placing, entry).unwrap().with_seed(number);
    let of = entry.simulate(&world, &Options::periods(20), &Stop::default(), |_| true).unwrap();
    let ns = |us: f64| (1e3 * us).round() as u64;
    let one = |k: usize| (ns(1e6 * of.fired_s[k]), of.robot[k], of.sensor[k], ns(of.earliest_us[k]), of.cause[k]);
    let mut all: Vec<_> = (0..of.len()).map(one).collect();
    all.sort_unstable_by_key(|&(at, robot, sensor, ..)| (at, robot, sensor));
    all
}

// A ping timer as long as the window fires one by one, groups with it are the far groups, and a sync line that rests
// for a period fires all at once every period.
#[test]
fn todays_ways_so_set_are_the_methods_they_resemble() {
    let by = |method: Method, turn: u32, rest: u32| {
        let sketch = Sketch { turn: Micros::new(turn), rest: Some(Micros::new(rest)), ..Sketch::default() };
        Entry::from(method).with_sketch(sketch)
    };
    for (today, method) in [
        (by(Method::InTurn, 36_001, 65_000), Method::Sequential),
        (by(Method::Groups, 36_001, 65_000), Method::FarGroups),
        (by(Method::SyncLine, 0, 100_000), Method::Simultaneous),
    ] {
        for number in [20_000, 20_005, 20_013] {
            let (today, method) = (fired(number, &today), fired(number, &method.into()));
            assert!(today.len() > 80, "{number}: {}", today.len());
            let other = today.iter().zip(&method).find(|(one, other)| one != other);
            assert_eq!((other, today.len()), (None, method.len()), "{number}");
        }
    }
}

// Two arrays of six in a corridor would finish before the first module has rested.
#[test]
fn todays_ways_let_every_module_rest() {
    let soonest = |entry: &Entry| -> u64 {
        let mut last = std::collections::BTreeMap::new();
        let steps = fired(20_004, entry)
            .into_iter()
            .filter_map(|(at, robot, sensor, ..)| last.insert((robot, sensor), at).map(|before| at - before));
        steps.min().unwrap()
    };
    for method in TODAY {
        // Drifts are up to 5000 ppm in free-running modules, and 50 ppm in all robots.
        assert!(soonest(&method.into()) >= 64_600_000, "{method}: {}", soonest(&method.into()));
    }
    assert!(soonest(&Entry::from(Method::Arrays).with_sketch(Sketch::default())) < 60_000_000);
}

#[test]
fn todays_ways_take_others_sound_more_often_than_flow() {
    let methods = Entry::all(TODAY.into_iter().chain([Method::Flow]));
    let found = set_three(&asked(12, &methods), &|_| true).unwrap();
    let others: Vec<_> = found.methods.iter().map(|(_, figures)| figures.others_of_accepted.unwrap().mean).collect();
    let (flow, today) = others.split_last().unwrap();
    assert!(today.iter().all(|others| *others > 0.15 && *others > 2.0 * flow), "{others:?}");
    // When firing at once as often as the modules allow, a sensor hears its neighbours more than other robots.
    let (_, sync_line) = &found.methods[3];
    let foreign = sync_line.foreign_of_accepted.unwrap().mean;
    assert!(foreign > 1.5 * sync_line.others_of_accepted.unwrap().mean, "{sync_line:?}");
}
