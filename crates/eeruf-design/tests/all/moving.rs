//! Rings that move: compares the proven period with all schedules of tiny rings, each at its own `t_delta`.

use crate::common::Random;
use eeruf_core::Micros;
use eeruf_design::{Effort, NoDesign, RingDesign, RingSpec};

fn design(spec: &RingSpec, budget: u64) -> Result<RingDesign, NoDesign> {
    spec.shortest(&Effort { budget, what_if: false, atlas: "" }, &mut ())
}

/// A tiny ring file at up to 3 m/s, or sometimes 40 m/s, where motion needs several ticks. Ticks are so coarse that all
/// schedules can be tried.
fn random_ring(seed: u64) -> String {
    let mut random = Random(seed + 1);
    for _ in 0..10 {
        random.below(2);
    }
    let sensors = 2 + random.below(2);
    let tick = 500 + 100 * random.below(26);
    let mut pick = |most: u32| tick * random.below(most) + tick / 4 * random.below(4);
    let (interval, window, jitter) = (pick(3), pick(4) + 600, pick(1) / 2);
    let jitters: Vec<u32> = (0..sensors).map(|_| random.below(tick)).collect();
    let jitter = if random.below(3) == 0 { format!("{jitters:?}") } else { jitter.to_string() };
    format!(
        "sensors = {sensors}\nneighbours = {}\njitter_us = {jitter}\nspeed_m_s = {}\nmin_interval_us = {interval}\n\
         window_us = {window}\ntick_us = {tick}\nstale_echo = {}\n",
        1 + random.below(3),
        f64::from(random.below(if seed.is_multiple_of(3) { 40_001 } else { 3001 })) / 1000.0,
        random.below(4) == 0
    )
}

/// Returns true if some schedule of this period, in ticks, serves at the `t_delta` that it needs.
fn feasible(spec: &RingSpec, period: u32) -> bool {
    let tick = i64::from(spec.tick.as_micros());
    let pairs: Vec<(i64, i64)> =
        (0..i64::from(period)).flat_map(|a| (0..i64::from(period)).map(move |b| (a * tick, b * tick))).collect();
    extend(spec, i64::from(period) * tick, &pairs, &mut Vec::new())
}

fn extend(spec: &RingSpec, period: i64, pairs: &[(i64, i64)], fire: &mut Vec<(i64, i64)>) -> bool {
    if fire.len() == spec.sensors {
        return keeps_separations(spec, period, fire);
    }
    pairs.iter().any(|&pair| {
        fire.push(pair);
        let found = last_fits(spec, period, fire) && extend(spec, period, pairs, fire);
        fire.pop();
        found
    })
}

/// Returns true if the last sensor keeps its window, and its interval from all before it, over five periods.
fn last_fits(spec: &RingSpec, period: i64, fire: &[(i64, i64)]) -> bool {
    let y = fire.len() - 1;
    let line = |x: usize| (0..5).map(move |n| n * period + if n % 2 == 0 { fire[x].0 } else { fire[x].1 });
    let problem = spec.problem();
    let window = i64::from(problem.requirements.window_of(y).as_micros());
    let refires = line(y).zip(line(y).skip(1)).all(|(one, next)| next - one >= window);
    refires
        && (0..y).all(|x| {
            let gap = i64::from(problem.requirements.gap_after(spec.sensors, x, y).as_micros());
            line(x).all(|one| line(y).all(|other| gap == 0 || (one - other).abs() >= gap))
        })
}

/// Returns true if all |d| are as far apart as the longest time between two firings requires.
fn keeps_separations(spec: &RingSpec, period: i64, fire: &[(i64, i64)]) -> bool {
    let change = |x: usize| (fire[x].0 - fire[x].1).abs();
    let longest = period + (0..spec.sensors).map(change).max().unwrap_or(0);
    let motion = 2 * i64::from(spec.speed_mm_s.unwrap_or(0)) * longest;
    let more = (motion + i64::from(spec.c.mm_per_s()) - 1) / i64::from(spec.c.mm_per_s());
    let problem = spec.problem();
    let t_delta = |x: usize| i64::from(problem.requirements.t_delta_of(x).as_micros()) + more;
    (0..spec.sensors).all(|y| {
        (!spec.stale_echo || change(y) > t_delta(y))
            && (0..y).all(|x| (change(x) - change(y)).abs() > 2 * t_delta(x).max(t_delta(y)))
    })
}

#[test]
fn moving_rings_match_trying_all_schedules() {
    let cases = std::env::var("EERUF_CASES").map_or(300, |cases| cases.parse().expect("a number"));
    let (mut proven, mut none, mut longer) = (0, 0, 0);
    for seed in 100..100 + cases {
        let text = random_ring(seed);
        let spec = RingSpec::from_text(&text).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
        let most = if spec.sensors == 2 { 16 } else { 10 };
        let tried = (1..=most).find(|&period| feasible(&spec, period));
        match design(&spec, 100_000) {
            Ok(found) => {
                let period = found.schedule.period().as_micros() / spec.tick.as_micros();
                assert!(found.found.proven, "seed {seed}: {:?}\n{text}", found.found);
                match tried {
                    Some(tried) => assert_eq!(period, tried, "seed {seed}\n{text}"),
                    None => assert!(period > most, "seed {seed}: {period}\n{text}"),
                }
                assert!(found.schedule.verify(&found.spec.problem().requirements).ok(), "seed {seed}\n{text}");
                assert!(found.bound <= found.found.bound && found.bounding.t_delta <= found.t_delta, "seed {seed}");
                proven += usize::from(tried.is_some());
                longer += usize::from(found.reason.starts_with("motion"));
            }
            Err(why) => {
                assert_eq!((why, tried), (NoDesign::TooFast, None), "seed {seed}\n{text}");
                none += 1;
            }
        }
    }
    println!("{proven} of {cases} proven, {none} too fast, {longer} longer than the bound for the least t_delta");
    assert!(proven * 2 > cases as usize && longer > 0, "{proven}, {longer}");
}

#[test]
fn robot_that_is_too_fast_gets_no_schedule() {
    for sensors in [8, 64] {
        let ring = format!(
            "sensors = {sensors}\njitter_us = 60\nspeed_m_s = 100\nmin_interval_us = 8000\nwindow_us = 14_000\n"
        );
        let spec = RingSpec::from_text(&ring).expect("a ring");
        assert_eq!(design(&spec, 10_000).map(|found| found.found.value), Err(NoDesign::TooFast), "{sensors}");
    }
}

#[test]
fn slow_ring_of_ten_is_not_called_shortest_too_early() {
    // The ring's t_delta depends on the largest |d|: 32.4 ms was once called the shortest period, and 32.3 ms serves.
    let spec = RingSpec::from_text(
        "sensors = 10\nneighbours = 4\nlayout = \"line\"\njitter_us = 0\nspeed_m_s = 0.197\nmin_interval_us = 8000\n\
         window_us = 14_000\ntick_us = 100\n",
    )
    .expect("a ring");
    let found = design(&spec, 1_000_000).expect("a schedule");
    assert!(found.schedule.period() <= Micros::new(32_300), "{:?}", found.found);
    assert!(found.schedule.verify(&spec.covering(spec.t_delta_needed(&found.schedule)).problem().requirements).ok());
    assert!(found.found.bound <= found.found.value);
}
