//! A guard that admits one call at a time, and the error for a second one.

use std::sync::{Mutex, MutexGuard, TryLockError};

use pyo3::PyResult;

use crate::errors::EerufError;

/// The state of an object that works without the interpreter lock, so that two threads may use it at once.
pub(crate) struct Exclusive<T> {
    state: Mutex<T>,
    /// The name of the class.
    name: &'static str,
}

impl<T> Exclusive<T> {
    pub(crate) const fn new(name: &'static str, state: T) -> Self {
        Self { state: Mutex::new(state), name }
    }

    /// Returns the state, or an error if another call has it, since waiting for that call could take forever.
    pub(crate) fn get(&self) -> PyResult<MutexGuard<'_, T>> {
        match self.state.try_lock() {
            Ok(state) => Ok(state),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => {
                let name = self.name;
                let advice = format!(
                    "this {name} is in use by another call; expected one at a time: one {name} a thread, or a lock"
                );
                Err(EerufError::new_err(advice))
            }
        }
    }
}
