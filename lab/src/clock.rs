//! A clock for measurements on a busy machine.

use std::fs::read_to_string;
use std::sync::LazyLock;
use std::time::Instant;

static BEGIN: LazyLock<Instant> = LazyLock::new(Instant::now);

/// Returns this thread's processor time in seconds if Linux reports it, or else the wall-clock time.
pub(crate) fn core_seconds() -> f64 {
    let stat = read_to_string("/proc/thread-self/schedstat").ok();
    let ns = stat.and_then(|stat| stat.split(' ').next()?.parse::<f64>().ok());
    ns.map_or_else(|| BEGIN.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}
