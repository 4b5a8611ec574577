//! The shortest period on several threads, with exactly the answer of one, by *speculation*.
//!
//! A bisection is a sequence of probes. Which one comes next depends on the outcomes so far and nothing else; so does
//! each outcome, with the nodes that it takes. So the calling thread *replays* the bisection: it takes the outcomes
//! that are known, assumes that those still missing will be "budget spent", and collects these probes. Threads work on
//! the first of them. An outcome that comes in replaces what was assumed, and the replay starts again; when it meets no
//! missing outcome, it is the bisection as one thread would have gone through it. Threads that work on a probe which is
//! no longer on the way are stopped.

use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::vec;
use std::vec::Vec;

use super::bisect::{Bisection, Known, Probe, Replay};
use super::problem::{CheckedProblem, Problem};
use super::shortest::{Shortest, shortest_period};
use super::solver;
use crate::search::common::{Control, ProblemError, Progress};

/// How long the calling thread waits for an outcome before it polls the control again.
const POLL_EVERY: Duration = Duration::from_millis(10);

/// Goes through the bisection as far as outcomes are known, and on until `most` are missing.
fn run(replay: &mut Replay, problem: &CheckedProblem, budget: u64, most: usize) -> Shortest {
    replay.missing.clear();
    replay.progress = None;
    replay.most = most;
    let mut control = ();
    let mut bisection = Bisection::new(&mut [], &mut control, budget);
    bisection.replay = Some(replay);
    shortest_period(problem, &mut bisection)
}

/// A thread at work.
struct Worker {
    probe: Probe,
    stop: Arc<AtomicBool>,
}

/// Runs a probe on a thread of its own, until stopped.
fn work(probe: &Probe, stop: &AtomicBool, outcomes: &Sender<Option<Known>>) {
    let mut memory = vec![0; solver::memory_words(probe.query.problem.sensors)];
    let mut control =
        |_: &Progress| if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let mut bisection = Bisection::new(&mut memory, &mut control, u64::MAX);
    let outcome = bisection.probe(probe);
    let (nodes, stopped) = (bisection.meter.nodes, bisection.meter.stopped);
    // If nobody listens any more, nobody needs the outcome.
    let _ = outcomes.send((!stopped).then_some(Known { probe: *probe, outcome, nodes }));
}

/// The shortest period, within `budget` nodes, on up to `threads` threads besides the calling one.
///
/// The answer is that of [`shortest`](super::shortest), nodes and all, whatever the number of threads; only the time
/// differs. The control is polled on the calling thread, every few milliseconds; nodes spent on probes that later turn
/// out not to matter are not counted. If the control stops the search, the best found and the bound proven by then come
/// back.
///
/// # Errors
/// If the problem makes no sense.
pub fn shortest_on_threads<C: Control>(
    problem: &Problem<'_>,
    budget: u64,
    threads: usize,
    control: &mut C,
) -> Result<Shortest, ProblemError> {
    let problem = problem.checked()?;
    let threads = threads.max(1);
    let mut replay = Replay { known: Vec::new(), missing: Vec::new(), most: threads, progress: None };
    let (sender, outcomes) = channel();
    Ok(thread::scope(|scope| {
        let mut workers: Vec<Worker> = Vec::new();
        loop {
            let shortest = run(&mut replay, &problem, budget, threads);
            for worker in &workers {
                if !replay.missing.contains(&worker.probe) {
                    worker.stop.store(true, Ordering::Relaxed);
                }
            }
            let Some(progress) = replay.progress else {
                return shortest;
            };
            workers.retain(|worker| !worker.stop.load(Ordering::Relaxed));
            for probe in &replay.missing {
                if workers.len() < threads && workers.iter().all(|worker| worker.probe != *probe) {
                    let (probe, stop, sender) = (*probe, Arc::new(AtomicBool::new(false)), sender.clone());
                    workers.push(Worker { probe, stop: Arc::clone(&stop) });
                    scope.spawn(move || work(&probe, &stop, &sender));
                }
            }
            loop {
                if control.poll(&progress).is_break() {
                    for worker in &workers {
                        worker.stop.store(true, Ordering::Relaxed);
                    }
                    return run(&mut replay, &problem, budget, 1);
                }
                // Otherwise a thread was stopped, or none is ready yet.
                if let Ok(Some(known)) = outcomes.recv_timeout(POLL_EVERY) {
                    for worker in workers.iter().filter(|worker| worker.probe == known.probe) {
                        worker.stop.store(true, Ordering::Relaxed);
                    }
                    replay.known.push(known);
                    break;
                }
            }
        }
    }))
}
