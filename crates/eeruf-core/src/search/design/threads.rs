//! The shortest period on several threads, with exactly the answer of one.
//!
//! A hunt is a sequence of questions, and which one comes next depends on the answers so far and nothing else; so does each answer, with the
//! nodes that it takes. So the calling thread *replays* the hunt: it takes the answers that are known, assumes that those still missing will be
//! "not found within the budget", and notes these questions. Threads work on the first of them, an answer that comes in replaces what was assumed, and
//! the replay begins again; when it meets no missing answer, it is the hunt as one thread would have gone through it. Threads that work
//! on a question which is no longer on the way are stopped.

use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::vec;
use std::vec::Vec;

use super::control::{Control, Progress};
use super::hunt::{Ask, Hunt, Meter};
use super::memory_words;
use super::problem::{Needs, Problem, ProblemError};
use super::shortest::{Shortest, shortest_period};
use super::tree::Outcome;

/// How long the calling thread waits for an answer before it asks the control again.
const PATIENCE: Duration = Duration::from_millis(10);

/// Answers that are known, and questions that are not answered yet.
pub(crate) struct Replay {
    known: Vec<Known>,
    missing: Vec<Ask>,
    /// So many missing answers end a replay.
    most: usize,
    /// How far the hunt was at the first missing answer.
    progress: Option<Progress>,
}

/// An answered question.
struct Known {
    ask: Ask,
    outcome: Outcome,
    nodes: u64,
}

impl Replay {
    /// The answer if it is known, and otherwise what is most likely.
    pub(crate) fn answer<C>(&mut self, ask: &Ask, meter: &mut Meter<'_, C>) -> Outcome {
        let known = self.known.iter().find(|known| known.ask == *ask);
        let (outcome, nodes) = match known {
            Some(known) => (known.outcome, known.nodes),
            None => {
                if self.progress.is_none() {
                    self.progress = Some(Progress {
                        nodes: meter.nodes,
                        period: ask.question.period as u32 * meter.ticks,
                        bound: meter.bound,
                        best: meter.best,
                    });
                }
                self.missing.push(*ask);
                meter.stopped |= self.missing.len() >= self.most;
                (Outcome::Spent, if meter.stopped { 0 } else { ask.budget })
            }
        };
        // The budget may end within the answer.
        let rest = meter.limit.saturating_sub(meter.nodes);
        meter.nodes += nodes.min(rest);
        if nodes > rest { Outcome::Spent } else { outcome }
    }

    /// Goes through the hunt as far as answers are known, and on until `most` are missing.
    fn run(&mut self, needs: &Needs, budget: u64, most: usize) -> Shortest {
        self.missing.clear();
        self.progress = None;
        self.most = most;
        let mut control = ();
        let mut hunt = Hunt::new(&mut [], &mut control, budget);
        hunt.replay = Some(self);
        shortest_period(needs, &mut hunt)
    }
}

/// A thread at work.
struct Worker {
    ask: Ask,
    stop: Arc<AtomicBool>,
}

/// Answers a question on a thread of its own, unless told to stop.
fn work(ask: &Ask, stop: &AtomicBool, answers: &Sender<Option<Known>>) {
    let mut memory = vec![0; memory_words(ask.question.needs.sensors)];
    let mut control =
        |_: &Progress| if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let mut hunt = Hunt::new(&mut memory, &mut control, u64::MAX);
    let outcome = hunt.decide(ask);
    let (nodes, stopped) = (hunt.meter.nodes, hunt.meter.stopped);
    // If nobody listens any more, nobody needs the answer.
    let _ = answers.send((!stopped).then_some(Known { ask: *ask, outcome, nodes }));
}

/// The shortest period, within `budget` nodes, on up to `threads` threads besides the calling one.
///
/// The answer is that of [`shortest`](super::shortest), nodes and all, whatever the number of threads; only the time differs. The control is asked on the
/// calling thread, every few milliseconds; nodes spent on questions that later turn out not to matter are not counted. If the control stops
/// the search, the best found and the bound proven by then come back.
///
/// # Errors
/// If the problem makes no sense.
pub fn shortest_on_threads<C: Control>(
    problem: &Problem<'_>,
    budget: u64,
    threads: usize,
    control: &mut C,
) -> Result<Shortest, ProblemError> {
    let needs = problem.needs()?;
    let threads = threads.max(1);
    let mut replay = Replay { known: Vec::new(), missing: Vec::new(), most: threads, progress: None };
    let (sender, answers) = channel();
    Ok(thread::scope(|scope| {
        let mut workers: Vec<Worker> = Vec::new();
        loop {
            let shortest = replay.run(&needs, budget, threads);
            for worker in &workers {
                if !replay.missing.contains(&worker.ask) {
                    worker.stop.store(true, Ordering::Relaxed);
                }
            }
            let Some(progress) = replay.progress else {
                return shortest;
            };
            workers.retain(|worker| !worker.stop.load(Ordering::Relaxed));
            for ask in &replay.missing {
                if workers.len() < threads && workers.iter().all(|worker| worker.ask != *ask) {
                    let (ask, stop, sender) = (*ask, Arc::new(AtomicBool::new(false)), sender.clone());
                    workers.push(Worker { ask, stop: Arc::clone(&stop) });
                    scope.spawn(move || work(&ask, &stop, &sender));
                }
            }
            loop {
                if control.poll(&progress).is_break() {
                    for worker in &workers {
                        worker.stop.store(true, Ordering::Relaxed);
                    }
                    return replay.run(&needs, budget, 1);
                }
                // Otherwise a thread was stopped, or none is ready yet.
                if let Ok(Some(known)) = answers.recv_timeout(PATIENCE) {
                    for worker in workers.iter().filter(|worker| worker.ask == known.ask) {
                        worker.stop.store(true, Ordering::Relaxed);
                    }
                    replay.known.push(known);
                    break;
                }
            }
        }
    }))
}
