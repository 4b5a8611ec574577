//! Parallel work on all cores, and its cancellation.

use std::{
    process,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder, prelude::*};

/// A thread pool for parallel iterators, separate for each process. No thread survives a `fork`, so a child that used
/// its parent's pool would wait forever. Rayon's global pool is never used.
#[derive(Debug, Default)]
pub struct Threads {
    number: usize,
    /// The pool, and the process that started it.
    pool: Mutex<Option<(u32, Arc<ThreadPool>)>>,
}

impl Threads {
    /// Makes a pool of this many threads, started on demand; 0 for one per core.
    pub const fn new(number: usize) -> Self {
        Self { number, pool: Mutex::new(None) }
    }

    /// Returns a separate pool with the same number of threads.
    #[must_use]
    pub const fn others(&self) -> Self {
        Self::new(self.number)
    }

    /// Returns the pool of this process.
    ///
    /// # Errors
    /// No thread can be started.
    pub fn pool(&self) -> Result<Arc<ThreadPool>, ThreadPoolBuildError> {
        let mut pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        match &*pool {
            Some((process, pool)) if *process == process::id() => return Ok(Arc::clone(pool)),
            _ => forget(&mut pool),
        }
        let begun = Arc::new(ThreadPoolBuilder::new().num_threads(self.number).build()?);
        *pool = Some((process::id(), Arc::clone(&begun)));
        Ok(begun)
    }
}

/// Drops a pool; a parent's pool is only forgotten, since its threads do not exist in this process.
fn forget(pool: &mut Option<(u32, Arc<ThreadPool>)>) {
    if let Some((process, pool)) = pool.take()
        && process != process::id()
    {
        core::mem::forget(pool);
    }
}

impl Drop for Threads {
    fn drop(&mut self) {
        forget(self.pool.get_mut().unwrap_or_else(PoisonError::into_inner));
    }
}

/// Runs work whose parallel iterators use all cores: on the caller's pool if there is one, otherwise on a new one.
pub(crate) fn on_all_cores<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    if rayon::current_thread_index().is_some() {
        return work();
    }
    // If no thread can be started, the work runs on this one.
    let alone = || ThreadPoolBuilder::new().num_threads(1).use_current_thread().build().map(Arc::new);
    match Threads::new(0).pool().or_else(|_| alone()) {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

/// Runs several simulations at once on all cores. The answers are in the order of the jobs and do not depend on the
/// number of threads.
///
/// ```
/// assert_eq!(eeruf_sim::sweep(&[1, 2, 3], |seed| seed * seed), [1, 4, 9]);
/// ```
pub fn sweep<J: Sync, T: Send>(jobs: &[J], run: impl Fn(&J) -> T + Sync + Send) -> Vec<T> {
    on_all_cores(|| jobs.par_iter().map(run).collect())
}

/// A switch that ends running work from any thread: all clones are one switch, and it cannot be reset.
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
    /// Ends all work that has a clone of this switch.
    pub fn stop(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Returns true if the work should end.
    pub fn is_stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
