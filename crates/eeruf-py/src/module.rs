//! Modules as arguments: a name, a dict of differences from one, or one of these for each sensor.

use eeruf_sim::modules::{KEYS, Module, Value, find, names};
use pyo3::{
    prelude::*,
    types::{PyDict, PyString},
};

use crate::arguments::{items, shown, text, wrong};
use crate::errors::EerufError;

fn named(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Module> {
    let said = text(name, value, "a module's name")?;
    let known = || names().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(" or ");
    find(&said).copied().ok_or_else(|| wrong(name, shown(value), known()))
}

fn module(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Module> {
    let Ok(figures) = value.cast::<PyDict>() else { return named(name, value) };
    let like = figures.get_item("like")?.ok_or_else(|| wrong(name, shown(value), "`like`, a module's name, in it"))?;
    let mut module = named(&format!("{name}[\"like\"]"), &like)?;
    for (key, figure) in figures {
        let key = text(name, &key, "figures by their names")?;
        if key == "like" {
            continue;
        }
        let word: Option<String> = figure.extract().ok();
        let value = match (&word, figure.extract::<f64>()) {
            (Some(word), _) => Value::Word(word),
            (None, Ok(number)) => Value::Number(number),
            (None, Err(_)) => {
                return Err(wrong(&format!("{name}[\"{key}\"]"), shown(&figure), "a number or a word"));
            }
        };
        module.set(&key, value).map_err(|error| EerufError::new_err(error.to_string()))?;
    }
    module.check().map_err(|error| EerufError::new_err(error.to_string()))?;
    Ok(module)
}

/// The module of each of this many sensors.
pub(crate) fn modules(name: &str, value: &Bound<'_, PyAny>, sensors: usize) -> PyResult<Vec<Module>> {
    if value.is_instance_of::<PyString>() || value.is_instance_of::<PyDict>() {
        return Ok(vec![module(name, value)?; sensors]);
    }
    let each = items(name, value, "a module's name, a dict with `like`, or one of these for each sensor")?;
    if each.len() != sensors {
        return Err(wrong(&format!("number of {name}"), each.len(), format_args!("{sensors}, one for each sensor")));
    }
    each.iter().enumerate().map(|(index, value)| module(&format!("{name}[{index}]"), value)).collect()
}

/// A module in the form of an argument: its name, or a dict of all figures.
pub(crate) fn shown_module<'py>(py: Python<'py>, module: &Module) -> PyResult<Bound<'py, PyAny>> {
    if find(module.name) == Some(module) {
        return Ok(PyString::new(py, module.name).into_any());
    }
    let figures = PyDict::new(py);
    figures.set_item("like", module.name)?;
    for key in &KEYS {
        match key.of(module) {
            Value::Number(number) if key.is_whole() => figures.set_item(key.name, number as u32)?,
            Value::Number(number) => figures.set_item(key.name, number)?,
            Value::Word(word) => figures.set_item(key.name, word)?,
        }
    }
    Ok(figures.into_any())
}
