//! A check that a result fits into memory before it is computed, since the system ends an interpreter that runs out of
//! memory.

use std::fs;

use pyo3::{exceptions::PyMemoryError, prelude::*};

/// Refuses a result that certainly does not fit into memory, with its size and an alternative.
pub(crate) fn check(what: &str, bytes: u64, instead: &str) -> PyResult<()> {
    match available() {
        Some(available) if bytes > available => {
            let (needed, there) = (bytes.div_ceil(1_000_000), available / 1_000_000);
            Err(PyMemoryError::new_err(format!("{what} take {needed} MB; expected at most {there} MB, {instead}")))
        }
        _ => Ok(()),
    }
}

/// Number of bytes available, if the system reports it, as Linux does.
fn available() -> Option<u64> {
    let line = |file: &str, key: &str| -> Option<u64> {
        let text = fs::read_to_string(file).ok()?;
        text.lines().find_map(|line| line.strip_prefix(key)?.split_whitespace().next()?.parse().ok())
    };
    let free = line("/proc/meminfo", "MemAvailable:").map(|kilobytes| kilobytes.saturating_mul(1024));
    let group = line("/sys/fs/cgroup/memory.max", "").zip(line("/sys/fs/cgroup/memory.current", ""));
    let left = group.map(|(most, used)| most.saturating_sub(used));
    free.into_iter().chain(left).min()
}
