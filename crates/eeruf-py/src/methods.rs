//! Firing methods by name, and the schedule that `eeruf_best` fires by.

use eeruf_sim::{BestSchedule, Method, Robot, best_schedule_for};
use pyo3::prelude::*;

use crate::{
    arguments::{items, text},
    errors::{ArgumentError, Raise},
    watch::Background,
};

/// How many nodes the search for `eeruf_best` may cost, as in the program; it is proven shortest long before.
const BEST_BUDGET: u64 = 300_000;

/// The method with a name.
pub(crate) fn method(argument: &str, name: &Bound<'_, PyAny>) -> PyResult<Method> {
    let name = text(argument, name, "a name of eeruf.sim.METHODS")?;
    name.parse().map_err(|error: eeruf_sim::UnknownMethod| ArgumentError::new_err(error.to_string()))
}

/// The methods with these names, or the default.
pub(crate) fn methods(names: Option<&Bound<'_, PyAny>>, default: &[Method]) -> PyResult<Vec<Method>> {
    let Some(names) = names else { return Ok(default.to_vec()) };
    let names = items("methods", names, "a sequence of names of eeruf.sim.METHODS")?;
    names.iter().map(|name| method("methods", name)).collect()
}

/// What `eeruf_best` fires by, if it is asked for.
pub(crate) fn best(methods: &[Method], robot: &Robot, background: &Background) -> PyResult<Option<BestSchedule>> {
    let asked = methods.contains(&Method::EerufBest);
    asked
        .then(|| {
            best_schedule_for(robot, BEST_BUDGET, |_| background.go_on(None, || "designing".to_owned()))
                .map_err(Raise::raise)
        })
        .transpose()
}
