//! Moments on a clock that wraps at 2^32 us, as rings take them.

use eeruf_core::Instant;
use pyo3::prelude::*;

use crate::arguments::{items, shown, whole, wrong};

/// Expected changes of each sensor's readings, from the argument `expected_change_us`.
pub(crate) fn expected_changes(changes: Option<&Bound<'_, PyAny>>, sensors: usize) -> PyResult<Vec<i32>> {
    let Some(changes) = changes else { return Ok(Vec::new()) };
    let name = "expected_change_us";
    let expected = format!("a sequence of {sensors} whole numbers of microseconds, one for each sensor");
    let items = items(name, changes, &expected)?;
    if items.len() != sensors {
        return Err(wrong(name, shown(changes), expected));
    }
    let each = |(index, item)| whole(&format!("{name}[{index}]"), item, i32::MIN..=i32::MAX);
    items.iter().enumerate().map(each).collect()
}

/// Time from now until a deadline, in microseconds; 0 if it has been reached.
pub(crate) fn until(deadline: Instant, now: Instant) -> u32 {
    if now.has_reached(deadline) { 0 } else { deadline.since(now).as_micros() }
}

/// A moment on a clock that wraps at 2^32 us; larger numbers are taken modulo that.
pub(crate) fn instant(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Instant> {
    whole(name, value, 0..=u64::MAX).map(|us| Instant::from_micros(us as u32))
}
