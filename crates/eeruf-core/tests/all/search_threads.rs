//! The shortest period on threads is that of one thread, however the threads come and go: random problems, budgets and
//! numbers of threads, with a control that yields, sleeps and stops at seeded moments.
//!
//! `EERUF_THREAD_SEEDS=2000` tries so many seeds instead of a few dozen.

use std::ops::ControlFlow;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use eeruf_core::search::Progress;
use eeruf_core::search::design::{Explanation, Problem, memory_words, shortest, shortest_on_threads};

use crate::common::random::Random;

/// Far longer than any of these searches takes, on however slow a machine: only a search that hangs is still at it
/// then.
const HANGS: Duration = Duration::from_secs(300);

/// Waits for a moment of the calling thread's, so that the order in which answers come in differs.
fn linger(random: &mut Random) {
    match random.up_to(3) {
        0 => thread::yield_now(),
        1 => thread::sleep(Duration::from_micros(random.up_to(500).into())),
        2 => (0..random.up_to(5)).for_each(|_| thread::yield_now()),
        _ => {}
    }
}

/// Any conflicts between 5 to 14 sensors.
fn draw(random: &mut Random) -> (Vec<u64>, Problem<'static>) {
    let sensors = 5 + random.up_to(9) as usize;
    let (near, ring, scale) =
        (2 + random.up_to(3) as usize, random.up_to(1) == 1, [1, 1, 10][random.up_to(2) as usize]);
    let mut rows = vec![0; sensors];
    for x in 0..sensors {
        for y in 0..x {
            let apart = if ring { (x - y).min(sensors - (x - y)) } else { x - y };
            if apart < near || random.up_to(9) == 0 {
                rows[x] |= 1 << y;
                rows[y] |= 1 << x;
            }
        }
    }
    let problem = Problem {
        sensors,
        conflicts: &[],
        separation: scale * (1 + random.up_to(2)),
        interval: scale * (3 + random.up_to(15)),
        window: scale * (5 + random.up_to(50)),
        stale_echo: random.up_to(1) == 1,
    };
    (rows, problem)
}

/// Does `work` for each of so many seeds on a thread of its own, and fails if one does not come back.
fn for_each_seed(seeds: u64, work: impl Fn(u64) + Send + Copy + 'static) {
    let seeds = std::env::var("EERUF_THREAD_SEEDS").map_or(seeds, |text| text.parse().expect("a number of seeds"));
    for seed in 0..seeds {
        let (done, waits) = channel();
        let worker = thread::spawn(move || {
            work(seed);
            // Nobody waits any more only if this was given up.
            let _ = done.send(());
        });
        if waits.recv_timeout(HANGS) == Err(RecvTimeoutError::Timeout) {
            panic!("the search with seed {seed} hangs");
        }
        if let Err(panic) = worker.join() {
            std::panic::resume_unwind(panic);
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_answer_of_one_however_they_interleave() {
    for_each_seed(16, |seed| {
        let mut random = Random(seed);
        let (rows, problem) = draw(&mut random);
        let problem = Problem { conflicts: &rows, ..problem };
        let budgets = [0, 1, random.up_to(500), random.up_to(5_000), 20_000];
        let budget = u64::from(budgets[random.up_to(4) as usize]);
        let alone = shortest(&problem, budget, &mut vec![0; memory_words(problem.sensors)], &mut ()).unwrap();
        for _ in 0..2 {
            let threads = random.up_to(6) as usize;
            let mut control = |progress: &Progress| {
                assert!(progress.nodes <= budget && progress.bound <= progress.best.max(Some(alone.bound)));
                linger(&mut random);
                ControlFlow::Continue(())
            };
            assert_eq!(
                shortest_on_threads(&problem, budget, threads, &mut control),
                Ok(alone),
                "seed {seed}, {threads} threads, budget {budget}: {problem:?}"
            );
        }
    });
}

#[test]
fn a_search_that_is_stopped_at_any_moment_comes_back_with_an_honest_bound() {
    for_each_seed(16, |seed| {
        let mut random = Random(seed ^ 0xabcd);
        let (rows, problem) = draw(&mut random);
        let problem = Problem { conflicts: &rows, ..problem };
        let alone = shortest(&problem, 20_000, &mut vec![0; memory_words(problem.sensors)], &mut ()).unwrap();
        let (threads, mut polls) = (1 + random.up_to(5) as usize, random.up_to(12));
        let mut control = |_: &Progress| {
            linger(&mut random);
            polls = polls.saturating_sub(1);
            if polls > 0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let stopped = shortest_on_threads(&problem, 20_000, threads, &mut control).unwrap();
        if stopped != alone {
            assert!(!stopped.proven() || alone.bound <= stopped.period, "seed {seed}: {stopped:?}");
            assert!(
                stopped.bound <= alone.period && stopped.period >= alone.bound,
                "seed {seed}: {stopped:?} {alone:?}"
            );
            assert!(
                stopped.proven()
                    || matches!(stopped.explanation, Explanation::BudgetSpent { bound } if bound == stopped.bound)
            );
        }
    });
}
