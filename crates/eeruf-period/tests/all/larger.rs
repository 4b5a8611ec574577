//! Tests of the search by brute force over firing times: shortest periods, decisions near them and elsewhere, and
//! preferences, for random rings of up to six identical sensors and 40 ticks.
//!
//! The brute force follows the definition in the documentation of `Problem` and shares nothing with the search. Each
//! sensor has a set of possible pairs of firing times. Placing one sensor removes the pairs of others that no longer
//! fit; the sensor with the fewest pairs is next.
//!
//! `EERUF_BRUTE_FORCE=10000` judges this many problems instead of 200 in each test, and `EERUF_BRUTE_FORCE_SEED` draws
//! others.

use crate::alike::Alike;
use crate::common::Random;
use crate::solver::{MOST_TICKS, Needs, brute_force};
use eeruf_period::engine::search::{Decided, FiringTimes, Search};
use eeruf_period::engine::spare::most_to_spare;

/// A budget that suffices for all questions here, and ends a broken search too.
const BUDGET: u64 = 1_000_000;

/// A random line, ring, set of blocks or graph, with up to five neighbours.
fn conflicts(sensors: usize, random: &mut Random) -> Vec<u64> {
    let (layout, n) = (random.up_to(3), 1 + random.up_to(4) as usize);
    let odds = random.up_to(3);
    let mut rows = vec![0; sensors];
    for x in 0..sensors {
        for y in 0..x {
            let conflict = match layout {
                0 => x - y < n,
                1 => x - y < n || sensors - (x - y) < n,
                2 => x / n == y / n,
                _ => random.up_to(3) <= odds,
            };
            if conflict {
                rows[x] |= 1 << y;
                rows[y] |= 1 << x;
            }
        }
    }
    rows
}

/// A random problem with up to six sensors, whose numbers leave room for a period of up to about 40 ticks.
fn draw(random: &mut Random) -> (Vec<u64>, Alike<'static>) {
    let sensors = 1 + random.up_to(5) as usize;
    let problem = Alike {
        conflicts: &[],
        separation: 1 + random.up_to(4),
        interval: random.up_to(8),
        window: random.up_to(25),
        stale_echo: random.up_to(1) == 1,
    };
    (conflicts(sensors, random), problem)
}

fn needs(problem: &Alike<'_>, period: u32) -> Needs {
    Needs {
        conflicts: problem.conflicts.to_vec(),
        separation: problem.separation as i32,
        interval: problem.interval as i32,
        window: problem.window as i32,
        stale_echo: problem.stale_echo,
        period: period as i32,
    }
}

fn times([a, b]: &FiringTimes) -> Vec<(i32, i32)> {
    a.iter().zip(b).map(|(&a, &b)| (a as i32, b as i32)).collect()
}

fn assert_meets(problem: &Alike<'_>, period: u32, firing: &FiringTimes) {
    assert_eq!(firing[0].len(), problem.sensors());
    assert!(needs(problem, period).met_by(&times(firing)), "{problem:?} at {period}: {:?}", times(firing));
}

/// Number of questions answered, and of those too large to try, by the number of sensors.
#[derive(Default, Debug)]
struct Tally {
    yes: [u32; 7],
    no: [u32; 7],
    unjudged: [u32; 7],
}

impl Tally {
    /// Asserts that no schedule meets this problem.
    fn assert_none(&mut self, problem: &Alike<'_>, period: u32) {
        match brute_force(&needs(problem, period)) {
            Some(found) => {
                assert!(!found, "there is a schedule: {problem:?} at {period}");
                self.no[problem.sensors()] += 1;
            }
            None => self.unjudged[problem.sensors()] += 1,
        }
    }

    /// Asserts that the result is right and that nothing was kept back.
    fn assert_decided(&mut self, problem: &Alike<'_>, period: u32) {
        match Search::new(&problem.problem()).decide(period, BUDGET, &mut |_| true) {
            Decided::Found(firing) => {
                assert_meets(problem, period, &firing);
                self.yes[problem.sensors()] += 1;
            }
            Decided::Refuted => self.assert_none(problem, period),
            Decided::Open | Decided::Stopped => panic!("no budget was set: {problem:?} at {period}"),
        }
    }

    /// Asserts that enough questions were answered for each number of sensors, with both answers.
    fn assert_enough(&self, both: bool) {
        println!("{self:?}");
        for sensors in 2..=6 {
            let (yes, no, unjudged) = (self.yes[sensors], self.no[sensors], self.unjudged[sensors]);
            assert!(no >= 10 && (!both || yes >= 3), "{sensors} sensors: {yes} found, {no} refuted");
            assert!(5 * unjudged <= yes + no, "{sensors} sensors: {unjudged} of {} not judged", yes + no);
        }
    }
}

/// Runs a check on `part` hundredths of the requested problems.
fn for_each_problem(part: u32, seed: u64, mut check: impl FnMut(&Alike<'_>, &mut Random)) {
    let number = |name| std::env::var(name).ok().map(|text: String| text.parse::<u64>().expect(name));
    let problems = number("EERUF_BRUTE_FORCE").unwrap_or(200) * u64::from(part) / 100;
    let mut random = Random(seed ^ number("EERUF_BRUTE_FORCE_SEED").unwrap_or(0) << 8);
    for _ in 0..problems {
        let (rows, problem) = draw(&mut random);
        check(&Alike { conflicts: &rows, ..problem }, &mut random);
    }
}

#[test]
fn no_period_is_shorter_than_the_shortest() {
    let mut tally = Tally::default();
    for_each_problem(100, 1, |problem, _| {
        let found = problem.shortest(BUDGET);
        assert_eq!(found.bound, found.period);
        assert_meets(problem, found.period, &found.fire);
        if found.period > 1 {
            tally.assert_none(problem, (found.period - 1).min(MOST_TICKS));
        }
    });
    tally.assert_enough(false);
}

#[test]
fn decisions_are_right_at_any_period() {
    let mut tally = Tally::default();
    for_each_problem(100, 2, |problem, random| {
        tally.assert_decided(problem, 1 + random.up_to(MOST_TICKS - 1));
    });
    tally.assert_enough(true);
}

// The preferred schedule is best in separation then interval then window.
#[test]
fn preferred_schedule_is_best_in_order() {
    let mut tally = Tally::default();
    let mut better = [0; 3];
    for_each_problem(60, 5, |problem, _| {
        let found = problem.shortest(BUDGET);
        let period = found.period;
        if period > MOST_TICKS {
            return;
        }
        let best = most_to_spare(&problem.problem(), period, found.fire, BUDGET, &mut |_| true);
        assert_eq!(best.proven, [true; 3]);
        // Without an interval there is none to grow.
        let has_gaps = problem.interval > 0 && problem.conflicts.iter().any(|&row| row != 0);
        let no_separation = problem.sensors() == 1 && !problem.stale_echo;
        let separation = if no_separation { 1 } else { problem.separation + best.more[0] };
        let interval = if has_gaps { problem.interval + best.more[1] } else { problem.interval };
        let window = problem.window.max(1) + best.more[2];
        let all = Alike { separation, interval, window, ..*problem };
        assert_meets(&all, period, &best.fire);
        if !no_separation {
            tally.assert_none(&Alike { separation: separation + 1, ..*problem }, period);
        }
        if has_gaps {
            tally.assert_none(&Alike { interval: interval + 1, window: problem.window, ..all }, period);
        }
        tally.assert_none(&Alike { window: window + 1, ..all }, period);
        better[0] += u32::from(!no_separation && best.more[0] > 0);
        better[1] += u32::from(has_gaps && best.more[1] > 0);
        better[2] += u32::from(best.more[2] > 0);
    });
    println!("better than asked for: {better:?}");
    assert!(better.iter().all(|&often| often >= 5), "there was something to prefer: {better:?}");
    tally.assert_enough(false);
}

#[test]
fn one_tick_less_of_a_need_is_decided_rightly() {
    let mut tally = Tally::default();
    for_each_problem(60, 6, |problem, _| {
        let period = problem.shortest(BUDGET).period;
        if !(2..=MOST_TICKS).contains(&period) {
            return;
        }
        let Alike { separation, interval, window, .. } = *problem;
        let less = [
            (separation > 1).then(|| Alike { separation: separation - 1, ..*problem }),
            (interval > 0).then(|| Alike { interval: interval - 1, ..*problem }),
            (window > 0).then(|| Alike { window: window - 1, ..*problem }),
        ];
        for less in less.into_iter().flatten() {
            tally.assert_decided(&less, period - 1);
        }
    });
    tally.assert_enough(true);
}

/// Returns true if a schedule exists, by trying all times of one sensor after the other and checking all needs at the
/// end.
fn nested_loops(needs: &Needs, times: &mut Vec<(i32, i32)>) -> bool {
    if times.len() == needs.conflicts.len() {
        return needs.met_by(times);
    }
    (0..needs.period).any(|a| {
        (0..needs.period).any(|b| {
            times.push((a, b));
            let found = nested_loops(needs, times);
            times.pop();
            found
        })
    })
}

#[test]
fn the_brute_force_prunes_nothing_that_nested_loops_find() {
    let mut random = Random(7);
    let mut answers = [0, 0];
    for _ in 0..400 {
        let sensors = 1 + random.up_to(2) as usize;
        let needs = Needs {
            conflicts: conflicts(sensors, &mut random),
            separation: 1 + random.up_to(2) as i32,
            interval: random.up_to(3) as i32,
            window: random.up_to(6) as i32,
            stale_echo: random.up_to(1) == 1,
            period: 1 + random.up_to(if sensors < 3 { 8 } else { 5 }) as i32,
        };
        let found = nested_loops(&needs, &mut Vec::new());
        assert_eq!(brute_force(&needs), Some(found), "{needs:?}");
        answers[usize::from(found)] += 1;
    }
    assert!(answers.iter().all(|&often| often >= 50), "{answers:?}");
}
