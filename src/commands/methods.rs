//! Which methods a command simulates.

use eeruf_sim::Method;

/// Those asked for, in the order of the tables; all if none is named.
pub(crate) fn chosen(asked: &[Method]) -> Vec<Method> {
    Method::ALL.into_iter().filter(|method| asked.is_empty() || asked.contains(method)).collect()
}
