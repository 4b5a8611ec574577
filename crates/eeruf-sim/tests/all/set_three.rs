//! Set III: robots of one make.

use eeruf_sim::experiments::set_three::{Placing, SetThreeOptions, set_three, world_of};
use eeruf_sim::*;

fn ways() -> [Entry; 2] {
    [Method::Sequential.into(), Entry::driving()]
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
    for way in ["sequential", "driving"] {
        let figures = &json["methods"][way];
        let share = |name: &str| figures[name]["mean"].as_f64().unwrap();
        let shares: f64 = ["belief_right", "unknown", "phantom", "too_far", "faint"].map(share).iter().sum();
        assert!((shares - 1.0).abs() < 1e-9, "{way}: {shares}");
        // Others are foreign.
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
