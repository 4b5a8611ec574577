//! Output of `--json`.

use serde::{Serialize, Serializer};

/// Writes the output of `--json`: one object on one line.
pub(crate) fn to_json(answer: &impl Serialize) -> String {
    // Our own types have named fields, numbers and strings, which always serialise.
    serde_json::to_string(answer).unwrap_or_default()
}

/// Serializes an object whose keys keep the order in which methods are listed.
pub(crate) fn in_order<S: Serializer, N: Serialize, T: Serialize>(
    entries: &[(N, T)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(entries.iter().map(|(method, entry)| (method, entry)))
}
