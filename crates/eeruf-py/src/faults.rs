//! `faults` of a scene: dicts with the keys of scene files.

use eeruf_sim::Fault;
use pyo3::{
    prelude::*,
    types::{PyBool, PyDict, PyList, PyString},
};
use toml::{Table, Value};

use crate::arguments::{items, shown, text, wrong};
use crate::errors::EerufError;

/// A value in TOML's form.
fn value_of(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    let refused = || wrong(name, shown(value), "a number, a text, a list or a dict of these");
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(Value::from(flag.is_true()));
    }
    // A schedule, or anything else with `to_toml`.
    if let Ok(text) = value.call_method0("to_toml").and_then(|text| text.extract::<String>()) {
        return text.parse::<Table>().map(Value::Table).map_err(|error| EerufError::new_err(error.to_string()));
    }
    if value.is_instance_of::<PyString>() {
        return Ok(Value::from(value.extract::<String>()?));
    }
    if let Ok(table) = value.cast::<PyDict>() {
        return table_of(name, table).map(Value::Table);
    }
    if let Ok(whole) = value.extract::<i64>() {
        return Ok(Value::from(whole));
    }
    if let Ok(number) = value.extract::<f64>() {
        return Ok(Value::from(number));
    }
    let list = value.try_iter().map_err(|_| refused())?;
    list.map(|item| value_of(name, &item?)).collect::<PyResult<Vec<_>>>().map(Value::Array)
}

/// A dict as a table.
pub(crate) fn table_of(name: &str, dict: &Bound<'_, PyDict>) -> PyResult<Table> {
    let pair = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let key = text(name, &key, "keys that are texts")?;
        let value = value_of(&if name.is_empty() { key.clone() } else { format!("{name}[\"{key}\"]") }, &value)?;
        Ok((key, value))
    };
    dict.iter().map(pair).collect()
}

/// The faults in these dicts.
pub(crate) fn faults(value: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<Fault>> {
    let Some(value) = value else { return Ok(vec![]) };
    let expected = "a sequence of dicts, such as {\"kind\": \"cut\", \"sensors\": [2]}";
    let tables = items("faults", value, expected)?.into_iter().enumerate().map(|(index, fault)| {
        let name = format!("faults[{index}]");
        let dict = fault.cast::<PyDict>().map_err(|_| wrong(&name, shown(&fault), expected))?;
        table_of(&name, dict)
    });
    let tables = tables.collect::<PyResult<Vec<_>>>()?;
    Fault::list_from(tables).map_err(EerufError::new_err)
}

fn shown_value<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::String(text) => PyString::new(py, text).into_any(),
        Value::Integer(whole) => whole.into_pyobject(py)?.into_any(),
        Value::Float(number) => number.into_pyobject(py)?.into_any(),
        Value::Boolean(flag) => PyBool::new(py, *flag).to_owned().into_any(),
        Value::Array(list) => {
            let list = list.iter().map(|value| shown_value(py, value)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, list)?.into_any()
        }
        Value::Table(table) => shown_table(py, table)?.into_any(),
        Value::Datetime(_) => py.None().into_bound(py),
    })
}

/// A table as a dict.
pub(crate) fn shown_table<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, value) in table {
        dict.set_item(key, shown_value(py, value)?)?;
    }
    Ok(dict)
}

/// Faults in the form of arguments.
pub(crate) fn shown_faults<'py>(py: Python<'py>, faults: &[Fault]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    faults.iter().map(|fault| shown_table(py, &fault.to_table())).collect()
}
