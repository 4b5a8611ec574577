//! Results as dicts of plain values, for JSON and data frames.

use pyo3::{
    prelude::*,
    types::{PyDict, PyList, PyTuple},
};

/// The fields of a result by their names; results in it become dicts too, and tuples lists.
pub(crate) fn to_dict<'py>(result: &Bound<'py, PyAny>, fields: &[&str]) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(result.py());
    for field in fields {
        dict.set_item(field, plain(&result.getattr(field)?)?)?;
    }
    Ok(dict)
}

fn plain<'py>(value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
    if value.is_instance_of::<PyTuple>() || value.is_instance_of::<PyList>() {
        let items = value.try_iter()?.map(|item| plain(&item?)).collect::<PyResult<Vec<_>>>()?;
        return Ok(PyList::new(value.py(), items)?.into_any());
    }
    if value.hasattr("to_dict")? { value.call_method0("to_dict") } else { Ok(value.clone()) }
}
