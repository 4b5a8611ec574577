//! Methods that a command simulates.

use eeruf_sim::Method;

/// Returns the methods asked for, in the order of the tables; if none is named the usual ones, and those of sketches if
/// `sketched`.
pub(crate) fn chosen(asked: &[Method], sketched: bool) -> Vec<Method> {
    let usual = |method: &Method| asked.is_empty() && !method.is_on_demand() && (sketched || !method.is_sketch());
    Method::ALL.into_iter().filter(|method| usual(method) || asked.contains(method)).collect()
}
