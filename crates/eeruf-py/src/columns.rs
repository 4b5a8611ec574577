//! Arrays of results: made on first use, kept, and read-only, so that loops over them do not copy, and that writing
//! to them fails instead of being lost.

use numpy::{Element, PyArray1, prelude::*};
use pyo3::{exceptions::PyMemoryError, prelude::*, sync::PyOnceLock};

/// `N` columns, by index.
pub(crate) struct Columns<const N: usize>([PyOnceLock<Py<PyAny>>; N]);

impl<const N: usize> Default for Columns<N> {
    fn default() -> Self {
        Self([const { PyOnceLock::new() }; N])
    }
}

impl<const N: usize> Columns<N> {
    /// The column at an index, made from these values on first use.
    pub(crate) fn get<'py, T: Element>(
        &self,
        py: Python<'py>,
        place: usize,
        values: impl ExactSizeIterator<Item = T>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let made = self.0[place].get_or_try_init(py, || Ok::<_, PyErr>(read_only(py, values)?.unbind()))?;
        Ok(made.bind(py).clone())
    }

    /// The column at an index, of codes that can be compared with their names.
    pub(crate) fn codes<'py>(
        &self,
        py: Python<'py>,
        place: usize,
        codes: Codes,
        values: impl ExactSizeIterator<Item = i8>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let made = self.0[place].get_or_try_init(py, || codes.name(&read_only(py, values)?).map(Bound::unbind))?;
        Ok(made.bind(py).clone())
    }
}

/// Meanings of the codes of an array.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Codes {
    Kinds,
    Causes,
}

impl Codes {
    /// The array of codes in a form that can be compared with their names.
    pub(crate) fn name<'py>(self, codes: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let class = if matches!(self, Self::Kinds) { "Kinds" } else { "Causes" };
        codes.call_method1("view", (codes.py().import("eeruf._codes")?.getattr(class)?,))
    }
}

/// An array that cannot be written to.
pub(crate) fn read_only<T: Element>(
    py: Python<'_>,
    values: impl ExactSizeIterator<Item = T>,
) -> PyResult<Bound<'_, PyAny>> {
    let mut elements = room(values.len())?;
    elements.extend(values);
    Ok(of_vec(py, elements))
}

/// A read-only array over a vector's memory.
pub(crate) fn of_vec<T: Element>(py: Python<'_>, elements: Vec<T>) -> Bound<'_, PyAny> {
    PyArray1::from_vec(py, elements).readwrite().make_nonwriteable().as_any().clone()
}

/// A vector with room for this many elements, if there is memory.
pub(crate) fn room<T>(elements: usize) -> PyResult<Vec<T>> {
    let mut vector = Vec::new();
    let reserved = vector.try_reserve_exact(elements);
    reserved
        .map_err(|_| PyMemoryError::new_err(format!("an array of {elements} elements of {} bytes", size_of::<T>())))?;
    Ok(vector)
}

/// The methods of a class whose properties are arrays, each an expression of the object, and further methods.
macro_rules! arrays {
    ($class:ident {
        $($(#[$doc:meta])* $name:ident: |$this:ident, $py:ident| $array:expr;)*
    } $($more:tt)*) => {
        #[pymethods]
        impl $class {
            $($(#[$doc])* #[getter] fn $name<'py>(&self, $py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
                let $this = self;
                $array
            })*

            $($more)*
        }
    };
}
pub(crate) use arrays;
