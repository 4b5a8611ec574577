//! Work on all cores, and how it ends early.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use rayon::{ThreadPoolBuilder, prelude::*};

/// Does work whose parallel iterators use all cores: on the caller's pool if it is called in one, else on one of its
/// own. Rayon's global pool does not survive a `fork`: a child that asks it for anything waits for ever.
pub(crate) fn on_all_cores<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    if rayon::current_thread_index().is_some() {
        return work();
    }
    // Where no thread can be started, on this one.
    let alone = || ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
    match ThreadPoolBuilder::new().build().or_else(|_| alone()) {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

/// Several simulations at once on all cores, the answers in the order of the jobs. What comes out does not depend on
/// the number of threads.
///
/// ```
/// assert_eq!(eeruf_sim::sweep(&[1, 2, 3], |seed| seed * seed), [1, 4, 9]);
/// ```
pub fn sweep<J: Sync, T: Send>(jobs: &[J], run: impl Fn(&J) -> T + Sync + Send) -> Vec<T> {
    on_all_cores(|| jobs.par_iter().map(run).collect())
}

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
