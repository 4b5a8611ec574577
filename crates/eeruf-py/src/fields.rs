//! Conversion of objects by their fields: to dicts of plain values for JSON and data frames, to text, and for pickles.

use pyo3::{
    call::PyCallArgs,
    prelude::*,
    sync::PyOnceLock,
    types::{PyDict, PyList, PyTuple},
};

/// A result: an instance of a class in `eeruf._records`, made from its fields in order.
pub(crate) fn record<'py>(py: Python<'py>, class: &str, fields: impl PyCallArgs<'py>) -> PyResult<Bound<'py, PyAny>> {
    static RECORDS: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let records = RECORDS.get_or_try_init(py, || py.import("eeruf._records").map(Bound::unbind))?;
    records.bind(py).getattr(class)?.call1(fields)
}

/// The fields of a result by name; nested results become dicts too, and tuples lists.
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

/// The fields of an object by name, unconverted.
pub(crate) fn attributes<'py>(object: &Bound<'py, PyAny>, fields: &[&str]) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(object.py());
    for field in fields {
        dict.set_item(field, object.getattr(field)?)?;
    }
    Ok(dict)
}

/// The text of a call with these keyword arguments, which can be pasted back.
pub(crate) fn call(name: &str, arguments: &Bound<'_, PyDict>) -> PyResult<String> {
    let shown = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| Ok(format!("{name}={}", value.repr()?));
    Ok(format!("{name}({})", arguments.iter().map(shown).collect::<PyResult<Vec<_>>>()?.join(", ")))
}

/// The `repr` of an object that its class can make from these fields.
pub(crate) fn repr(object: &Bound<'_, PyAny>, fields: &[&str]) -> PyResult<String> {
    call(&object.get_type().name()?.to_cow()?, &attributes(object, fields)?)
}

/// The pickled form of an object: a function that makes it again, with its arguments.
pub(crate) type Reduced<'py> = (Bound<'py, PyAny>, Bound<'py, PyTuple>);

/// The pickled form of an object that its class makes from these fields in order.
pub(crate) fn reduce<'py>(object: &Bound<'py, PyAny>, fields: &[&str]) -> PyResult<Reduced<'py>> {
    let fields = fields.iter().map(|field| object.getattr(field)).collect::<PyResult<Vec<_>>>()?;
    Ok((object.get_type().into_any(), PyTuple::new(object.py(), fields)?))
}

/// The pickled form of an object that its class makes from these keyword arguments.
pub(crate) fn reduce_by_name<'py>(object: &Bound<'py, PyAny>, arguments: Bound<'py, PyDict>) -> PyResult<Reduced<'py>> {
    let made = object.py().import("eeruf._rebuild")?.getattr("made")?;
    Ok((made, (object.get_type(), arguments).into_pyobject(object.py())?))
}

/// The methods of a frozen class around a struct of settings: keyword arguments, all with defaults, each checked
/// within its range and read back as a property; `repr`, pickling, and further methods.
macro_rules! settings {
    ($class:ident($of:ty) $signature:tt {
        $($(#[$doc:meta])* $field:ident: $type:ty = $checked:ident($range:expr),)*
    } $($more:tt)*) => {
        #[pymethods]
        impl $class {
            #[new]
            #[pyo3(signature = (*, $($field=None),*), text_signature = $signature)]
            #[allow(clippy::too_many_arguments, reason = "keyword arguments")]
            fn new($($field: Option<&Bound<'_, PyAny>>),*) -> PyResult<Self> {
                let mut of = <$of>::default();
                $(of.$field = $checked(stringify!($field), $field, of.$field, $range)?;)*
                Ok(Self(of))
            }

            $($(#[$doc])* #[getter] fn $field(&self) -> $type { self.0.$field })*

            fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
                crate::fields::repr(slf, &[$(stringify!($field)),*])
            }

            fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<crate::fields::Reduced<'py>> {
                crate::fields::reduce_by_name(slf, crate::fields::attributes(slf, &[$(stringify!($field)),*])?)
            }

            $($more)*
        }
    };
}
pub(crate) use settings;
