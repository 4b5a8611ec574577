//! Methods that a command simulates.

use eeruf_sim::Method;

/// Returns the requested methods in the order of the tables; by default the usual ones, with those of sketches if
/// `sketched`.
pub(crate) fn chosen(asked: &[Method], sketched: bool) -> Vec<Method> {
    let usual = |method: &Method| asked.is_empty() && !method.is_on_demand() && (sketched || !method.is_sketch());
    Method::ALL.into_iter().filter(|method| usual(method) || asked.contains(method)).collect()
}
