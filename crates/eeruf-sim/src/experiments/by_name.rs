//! Methods and what belongs to them, as a map from their names in JSON.

use serde::{Serialize, Serializer, ser::SerializeMap};

use crate::methods::Method;

/// Serialises pairs as a map, in their order.
pub(super) fn by_name<S: Serializer, T: Serialize>(entries: &[(Method, T)], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(entries.len()))?;
    for (method, entry) in entries {
        map.serialize_entry(method, entry)?;
    }
    map.end()
}
