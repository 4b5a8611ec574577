//! Rings that differ from an even one in a single need, and random ones: found, proven and certified.

use crate::common::{Random, accepted, claim_of, from_environment, small, table};
use eeruf_period::engine::prove::prove;
use eeruf_period::engine::shortest::shortest;
use eeruf_period::engine::{Claim, Problem};

/// A line or ring in which each sensor has a gap to the next three.
fn even(layout: &str, sensors: usize, [separation, window, gap]: [u32; 3]) -> Problem {
    let pairs = (0..sensors).flat_map(|x| (x + 1..sensors).map(move |y| (x, y)));
    let near = |x: usize, y: usize| y - x < 4 || layout == "ring" && sensors - (y - x) < 4;
    Problem {
        tick_us: (1000, 1),
        separation: vec![separation; sensors],
        window: vec![window; sensors],
        stale_echo: false,
        together: vec![],
        gaps: pairs.filter(|&(x, y)| near(x, y)).map(|(x, y)| (x, y, gap, gap)).collect(),
    }
}

/// Writes a certificate by the checker's rules alone, since the search's further conclusions must not make a period
/// longer. Also returns the search's nodes.
fn certify(name: &str, problem: Problem, budget: usize) -> (String, u64) {
    let found = shortest(&problem, 1_000_000, &mut |_| true).expect("there is a schedule");
    assert_eq!(found.period, found.bound, "{name}: proven");
    let claim = Claim { problem, period: found.period, fire: found.fire, bound: found.bound };
    let text = prove(&claim, budget).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(claim_of(&text), claim, "{name}");
    (text, found.nodes)
}

#[test]
fn twins_of_the_table_are_proven_and_certified() {
    let (mut nodes, mut certificates) = (0, Vec::new());
    for (name, claim) in table(1).into_iter().filter(|(_, claim)| claim.problem.sensors() <= 12) {
        let even = claim.problem;
        let (last, middle) = (even.sensors() - 1, even.gaps.len() / 2);
        let change = |change: &dyn Fn(&mut Problem)| {
            let mut twin = even.clone();
            change(&mut twin);
            twin
        };
        for (what, twin) in [
            ("a longer window", change(&|twin| twin.window[0] += 1)),
            ("a shorter window", change(&|twin| twin.window[last / 2] -= 1)),
            ("a longer gap", change(&|twin| (twin.gaps[0].2, twin.gaps[0].3) = (16, 16))),
            ("a shorter gap", change(&|twin| (twin.gaps[middle].2, twin.gaps[middle].3) = (14, 14))),
            ("a larger separation", change(&|twin| twin.separation[0] += 1)),
            ("a smaller separation", change(&|twin| twin.separation[last] -= 1)),
        ] {
            let (text, searched) = certify(&format!("{name}, {what}"), twin, 200_000);
            nodes += searched;
            certificates.push(text);
        }
    }
    accepted("twins", &small(certificates));
    println!("{nodes} nodes together");
    assert!(nodes < 200_000, "{nodes} nodes, there were 152,502");
}

#[test]
fn long_lines_and_rings_meet_the_bound_where_one_sensor_differs() {
    let changed = |mut problem: Problem, change: fn(&mut Problem)| {
        change(&mut problem);
        problem
    };
    // Half a millisecond is the tick: 15.5 ms for one sensor, 15 ms for all others.
    let line = changed(even("line", 48, [4, 30, 30]), |line| line.window[20] = 31);
    let mut rings = vec![("line of 48", line, 218)];
    for layout in ["line", "ring"] {
        rings.push((layout, changed(even(layout, 64, [1, 25, 15]), |ring| ring.window[7] = 40), 88));
        rings.push((layout, changed(even(layout, 64, [2, 15, 15]), |ring| ring.window[7] = 16), 141));
        rings.push((
            layout,
            changed(even(layout, 64, [2, 25, 15]), |ring| (ring.gaps[20].2, ring.gaps[20].3) = (20, 20)),
            151,
        ));
    }
    for (name, problem, period) in rings {
        let found = shortest(&problem, 20_000, &mut |_| true).expect("there is a schedule");
        println!("{name}: {} to {} in {} nodes", found.bound, found.period, found.nodes);
        let claim = Claim { problem, period: found.period, fire: found.fire, bound: found.bound };
        assert_eq!((found.bound, claim.check()), (period, Ok(())), "{name}");
        assert_eq!(found.period, period, "{name}: the bound is met");
    }
}

#[test]
fn random_rings_proven_by_more_rules_are_certified_by_fewer() {
    let mut certificates = Vec::new();
    for seed in 0..from_environment("EERUF_CASES", 150) {
        let mut random = Random(seed + 1);
        for _ in 0..10 {
            random.below(2);
        }
        let sensors = 5 + random.below(3) as usize;
        let layout = if random.once_in(2) { "line" } else { "ring" };
        let mut problem = even(layout, sensors, [1, 1, 1]);
        problem.stale_echo = random.once_in(3);
        problem.separation = (0..sensors).map(|_| 2 + random.below(3)).collect();
        problem.window = (0..sensors).map(|_| 5 + random.below(25)).collect();
        for gap in &mut problem.gaps {
            (gap.2, gap.3) = (4 + random.below(8), 4 + random.below(8));
        }
        if random.once_in(2) {
            problem.gaps.retain(|_| !random.once_in(4));
        }
        certificates.push(certify(&format!("seed {seed}"), problem, 200_000).0);
    }
    accepted("random-rings", &small(certificates));
}

// A ring of 26 sensors that all differ: after 20,000 nodes descents alone have 98 ticks, repairs 75.
#[test]
fn repairs_shorten_rings_whose_sensors_all_differ() {
    let mut random = Random(5);
    let mut draw = |least: u32, most: u32| least + random.below(most - least + 1);
    let mut problem = even("ring", 26, [1, 15, 15]);
    problem.separation.iter_mut().for_each(|own| *own = draw(1, 3));
    problem.window.iter_mut().for_each(|own| *own = draw(15, 45));
    problem.gaps.iter_mut().filter(|_| draw(0, 3) == 0).for_each(|gap| gap.2 = 12);
    let found = shortest(&problem, 20_000, &mut |_| true).expect("there is a schedule");
    println!("{} [{}]", found.period, found.bound);
    assert!(found.period <= 77, "{found:?}");
}
