//! A value under a key, for the files that are written.

use toml::{Table, Value};

pub(super) fn set(table: &mut Table, key: &str, value: impl Into<Value>) {
    table.insert(key.to_owned(), value.into());
}
