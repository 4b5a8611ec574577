//! Display of a running search or simulation: a progress line after two seconds, and Ctrl-C or a limit that ends it
//! cleanly.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// After this time the progress line appears.
const SHOWN_AFTER: Duration = Duration::from_secs(2);

/// Returns true if Ctrl-C was pressed since the program began.
fn interrupted() -> &'static AtomicBool {
    static INTERRUPTED: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    INTERRUPTED.get_or_init(|| {
        let flag = Arc::new(AtomicBool::new(false));
        let handler = Arc::clone(&flag);
        // Where no handler can be installed, Ctrl-C ends the program at once, as it does by default.
        _ = ctrlc::set_handler(move || handler.store(true, Ordering::Relaxed));
        flag
    })
}

/// Watches one long task.
pub(crate) struct Watch {
    began: Instant,
    limit: Duration,
    bar: Option<ProgressBar>,
    interrupted: &'static AtomicBool,
}

impl Watch {
    pub(crate) fn new() -> Self {
        Self::ending_after(Duration::MAX)
    }

    /// One that ends the task when the time is over.
    pub(crate) fn ending_after(limit: Duration) -> Self {
        Self { began: Instant::now(), limit, bar: None, interrupted: interrupted() }
    }

    /// Forgets a Ctrl-C that ended one task before the next one begins. The time limit is that of all tasks.
    pub(crate) fn forget_interrupt(&self) {
        self.interrupted.store(false, Ordering::Relaxed);
    }

    /// Shows how far the task has come; `false` if it should stop.
    pub(crate) fn go_on(&mut self, how_far: impl FnOnce() -> String) -> bool {
        let elapsed = self.began.elapsed();
        if self.interrupted.load(Ordering::Relaxed) || elapsed >= self.limit {
            return false;
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

    /// The same as [`go_on`](Self::go_on), in the form that a search asks for.
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
