//! [`Stop`]: ends work under way.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

/// Ends work under way, from any thread: clones are one switch. Once stopped it stays so.
///
/// ```
/// use eeruf_sim::Stop;
/// let (stop, worker) = (Stop::default(), Stop::default().clone());
/// stop.stop();
/// assert!(stop.is_stopped() && stop.clone().is_stopped() && !worker.is_stopped());
/// ```
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Ends all work that has a clone of this one, soon.
    pub fn stop(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns true if the work should end.
    pub fn is_stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
