//! Display of a running search or simulation: a progress line after two seconds on a terminal, else a line a minute;
//! and Ctrl-C or a limit that ends it cleanly.

use std::io::IsTerminal as _;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::console::{note, settings};

/// Time after which the progress line appears.
const SHOWN_AFTER: Duration = Duration::from_secs(2);

/// Time after which a task without a terminal prints its progress, and then once a minute.
const SAID_AFTER: Duration = Duration::from_secs(20);
const SAID_EVERY: Duration = Duration::from_secs(60);

/// True if Ctrl-C was pressed since [`begin`].
static STOPPED: AtomicBool = AtomicBool::new(false);

/// A flag that is never raised, for tasks that cannot be ended.
static NEVER: AtomicBool = AtomicBool::new(false);

/// Forgets every Ctrl-C, for a new start of the program.
pub(crate) fn begin() {
    STOPPED.store(false, Ordering::Relaxed);
    interrupted().store(false, Ordering::Relaxed);
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
    bar: Option<ProgressBar>,
    /// Time of the next line without a terminal.
    says_at: Duration,
    interrupted: &'static AtomicBool,
}

impl Watch {
    pub(crate) fn new() -> Self {
        Self::ending_after(Duration::MAX)
    }

    /// Makes a watch that ends the task after this time.
    pub(crate) fn ending_after(limit: Duration) -> Self {
        Self { began: Instant::now(), limit, bar: None, says_at: SAID_AFTER, interrupted: interrupted() }
    }

    /// Makes a watch that never ends the task and only shows progress.
    pub(crate) fn unstoppable() -> Self {
        let (began, limit) = (Instant::now(), Duration::MAX);
        Self { began, limit, bar: None, says_at: SAID_AFTER, interrupted: &NEVER }
    }

    /// Forgets a Ctrl-C that ended one task before the next one begins. The time limit covers all tasks.
    pub(crate) fn forget_interrupt(&self) {
        self.interrupted.store(false, Ordering::Relaxed);
    }

    /// Shows the progress; `false` if the task should stop.
    pub(crate) fn go_on(&mut self, how_far: impl FnOnce() -> String) -> bool {
        let elapsed = self.began.elapsed();
        if self.interrupted.load(Ordering::Relaxed) || elapsed >= self.limit {
            return false;
        }
        if !std::io::stderr().is_terminal() {
            if elapsed >= self.says_at && !settings().quiet {
                self.says_at = elapsed + SAID_EVERY;
                note(format!("eeruf: at work for {} s: {}", elapsed.as_secs(), how_far()));
            }
            return true;
        }
        if elapsed >= SHOWN_AFTER {
            let bar = self.bar.get_or_insert_with(|| {
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
        let watch = std::cell::RefCell::new(self);
        move || watch.borrow_mut().go_on(&how_far)
    }

    /// Answers like [`go_on`](Self::go_on), in the form that a search needs.
    pub(crate) fn control_flow(&mut self, how_far: impl FnOnce() -> String) -> ControlFlow<()> {
        if self.go_on(how_far) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
