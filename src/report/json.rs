//! What `--json` prints.

use eeruf_sim::Method;
use serde::{Serialize, Serializer};

/// What `--json` prints: one object on one line.
pub(crate) fn to_json(answer: &impl Serialize) -> String {
    // Our own types: named fields, numbers and strings, which always serialise.
    serde_json::to_string(answer).unwrap_or_default()
}

/// As an object whose keys keep the order in which methods are listed.
pub(crate) fn in_order<S: Serializer, T: Serialize>(entries: &[(Method, T)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(entries.iter().map(|(method, entry)| (method, entry)))
}
