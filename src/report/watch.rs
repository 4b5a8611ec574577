//! Display of a running search or simulation: a progress line after two seconds on a terminal, else a line a minute;
//! and Ctrl-C or a limit that ends it cleanly.

use std::io::IsTerminal as _;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::console::{note, settings};

/// Time after which the progress line appears.
const SHOWN_AFTER: Duration = Duration::from_secs(2);

/// Time after which a command without a terminal prints its progress, and the time between two such lines.
const SAID: [Duration; 2] = [Duration::from_secs(20), Duration::from_secs(60)];

/// The progress of the task under way, after a colon; empty if it reports none.
static PROGRESS: Mutex<String> = Mutex::new(String::new());

/// True if Ctrl-C was pressed since [`begin`].
static STOPPED: AtomicBool = AtomicBool::new(false);

/// A flag that is never raised, for tasks that cannot be ended.
static NEVER: AtomicBool = AtomicBool::new(false);

/// Forgets every Ctrl-C, for a new start of the program.
pub(crate) fn begin() {
    STOPPED.store(false, Ordering::Relaxed);
    interrupted().store(false, Ordering::Relaxed);
}

/// Without a terminal, prints progress until the result is dropped, also for commands that have no [`Watch`].
pub(crate) fn said() -> Sender<()> {
    let (running, ended) = channel();
    if !settings().quiet && !std::io::stderr().is_terminal() {
        // Where no thread can be started, nothing is printed.
        _ = thread::Builder::new().spawn(move || say(&ended, SAID));
    }
    running
}

/// Prints the progress after the first duration, then each time the second has passed, until the sender is dropped.
fn say(ended: &Receiver<()>, [mut pause, every]: [Duration; 2]) {
    let began = Instant::now();
    while ended.recv_timeout(pause) == Err(RecvTimeoutError::Timeout) {
        pause = every;
        note(format!("eeruf: at work for {} s{}", began.elapsed().as_secs(), progress()));
    }
}

fn progress() -> MutexGuard<'static, String> {
    PROGRESS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns true if Ctrl-C ended a task.
pub(crate) fn was_stopped() -> bool {
    STOPPED.load(Ordering::Relaxed)
}

/// The flag of a Ctrl-C that ends the task under way.
fn interrupted() -> &'static AtomicBool {
    static INTERRUPTED: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    INTERRUPTED.get_or_init(|| {
        let flag = Arc::new(AtomicBool::new(false));
        let handler = Arc::clone(&flag);
        // Where no handler can be installed, Ctrl-C ends the program at once, as it does by default.
        _ = ctrlc::set_handler(move || {
            STOPPED.store(true, Ordering::Relaxed);
            handler.store(true, Ordering::Relaxed);
        });
        flag
    })
}

/// Watches one long task.
pub(crate) struct Watch {
    began: Instant,
    limit: Duration,
    bar: OnceLock<ProgressBar>,
    interrupted: &'static AtomicBool,
}

impl Watch {
    pub(crate) fn new() -> Self {
        Self::ending_after(Duration::MAX)
    }

    /// Makes a watch that ends the task after this time.
    pub(crate) fn ending_after(limit: Duration) -> Self {
        Self { began: Instant::now(), limit, bar: OnceLock::new(), interrupted: interrupted() }
    }

    /// Makes a watch that never ends the task and only shows progress.
    pub(crate) fn unstoppable() -> Self {
        Self { began: Instant::now(), limit: Duration::MAX, bar: OnceLock::new(), interrupted: &NEVER }
    }

    /// Forgets a Ctrl-C that ended one task before the next one begins. The time limit covers all tasks.
    pub(crate) fn forget_interrupt(&self) {
        self.interrupted.store(false, Ordering::Relaxed);
    }

    /// Shows the progress; `false` if the task should stop.
    pub(crate) fn go_on(&self, how_far: impl FnOnce() -> String) -> bool {
        let elapsed = self.began.elapsed();
        if self.interrupted.load(Ordering::Relaxed) || elapsed >= self.limit {
            return false;
        }
        if !std::io::stderr().is_terminal() {
            *progress() = format!(": {}", how_far());
            return true;
        }
        if elapsed >= SHOWN_AFTER {
            let bar = self.bar.get_or_init(|| {
                let bar = ProgressBar::new_spinner();
                if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed}, Ctrl-C stops)") {
                    bar.set_style(style);
                }
                bar.enable_steady_tick(Duration::from_millis(100));
                bar
            });
            bar.set_message(how_far());
        }
        true
    }

    /// Returns a function that tells whether a task should continue, for a task that reports no progress.
    pub(crate) fn asked(self, how_far: impl Fn() -> String) -> impl Fn() -> bool {
        move || self.go_on(&how_far)
    }

    /// Answers like [`go_on`](Self::go_on), in the form that a search asks for.
    pub(crate) fn control_flow(&self, how_far: impl FnOnce() -> String) -> ControlFlow<()> {
        if self.go_on(how_far) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        progress().clear();
        if let Some(bar) = self.bar.get() {
            bar.finish_and_clear();
        }
    }
}
