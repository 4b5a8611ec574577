//! Arguments: errors name the argument, its value and the expectation.

use core::fmt::Display;
use std::ops::RangeInclusive;

use eeruf_core::Micros;
use numpy::{PyReadonlyArray2, prelude::*};
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

use crate::errors::{EerufError, warn};

/// The error `NAME = VALUE; expected EXPECTED`.
pub(crate) fn wrong(name: &str, value: impl Display, expected: impl Display) -> PyErr {
    EerufError::new_err(format!("{name} = {value}; expected {expected}"))
}

/// The error for an argument that NumPy refused; Ctrl-C while NumPy was at work stays what it is.
pub(crate) fn refused_by_numpy(error: PyErr, py: Python<'_>, wrong: impl FnOnce() -> PyErr) -> PyErr {
    if error.is_instance_of::<PyException>(py) { wrong() } else { error }
}

pub(crate) fn shown(value: &Bound<'_, PyAny>) -> String {
    let text = value.repr().map_or_else(|_| "?".to_owned(), |text| text.to_string());
    if text.chars().count() > 60 { text.chars().take(57).collect::<String>() + "..." } else { text }
}

/// A whole number within a range.
pub(crate) fn whole<T: TryFrom<i128> + TryInto<i128> + Copy>(
    name: &str,
    value: &Bound<'_, PyAny>,
    range: RangeInclusive<T>,
) -> PyResult<T> {
    let bound = |end: &T| (*end).try_into().unwrap_or_default();
    let (least, most) = (bound(range.start()), bound(range.end()));
    // No bool: `sensors=True` is a slip, not a number.
    let number = if value.is_instance_of::<pyo3::types::PyBool>() { None } else { value.extract::<i128>().ok() };
    let within = number.filter(|number| (least..=most).contains(number));
    let (number, within) = within
        .and_then(|number| Some((number, T::try_from(number).ok()?)))
        .ok_or_else(|| wrong(name, shown(value), format_args!("a whole number from {least} to {most}")))?;
    plausible(name, number as f64, value.py())?;
    Ok(within)
}

/// Warns about a value that is legal but implausible.
fn plausible(name: &str, number: f64, py: Python<'_>) -> PyResult<()> {
    let key = name.split_once('[').map_or(name, |(list, _)| list);
    // Files call a time so; here it is the number of a period.
    let doubt = if key == "period" { None } else { eeruf_files::doubt(key, number) };
    doubt.map_or(Ok(()), |doubt| warn(py, format_args!("{name} = {doubt}")))
}

/// A finite number above zero.
pub(crate) fn above_zero(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    let number = value.extract().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| wrong(name, shown(value), "a number above 0"))
}

/// A time in whole microseconds.
pub(crate) fn micros(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Micros> {
    whole(name, value, 0..=u32::MAX).map(Micros::new)
}

/// A time in whole microseconds, or the default if there is none.
pub(crate) fn micros_or(name: &str, value: Option<&Bound<'_, PyAny>>, default: Micros) -> PyResult<Micros> {
    value.map_or(Ok(default), |value| micros(name, value))
}

/// A whole number, or the default if there is none.
pub(crate) fn whole_or<T: TryFrom<i128> + TryInto<i128> + Copy>(
    name: &str,
    value: Option<&Bound<'_, PyAny>>,
    default: T,
    range: RangeInclusive<T>,
) -> PyResult<T> {
    value.map_or(Ok(default), |value| whole(name, value, range))
}

/// A whole number, or `None` if there is none.
pub(crate) fn whole_or_none<T: TryFrom<i128> + TryInto<i128> + Copy>(
    name: &str,
    value: Option<&Bound<'_, PyAny>>,
    range: RangeInclusive<T>,
) -> PyResult<Option<T>> {
    value.map(|value| whole(name, value, range)).transpose()
}

/// A Boolean, of Python or `NumPy`.
pub(crate) fn flag(name: &str, value: Option<&Bound<'_, PyAny>>, default: bool) -> PyResult<bool> {
    let Some(value) = value else { return Ok(default) };
    value.extract().map_err(|_| wrong(name, shown(value), "True or False"))
}

/// A string.
pub(crate) fn text(name: &str, value: &Bound<'_, PyAny>, expected: &str) -> PyResult<String> {
    value.extract().map_err(|_| wrong(name, shown(value), expected))
}

/// One of a few strings, or the first of them if there is none.
pub(crate) fn choice<T: Copy>(name: &str, value: Option<&Bound<'_, PyAny>>, of: &[(&str, T)]) -> PyResult<T> {
    let said = value.map(|value| value.extract::<String>().unwrap_or_default());
    let found = of.iter().find(|(text, _)| said.as_deref().is_none_or(|said| said == *text));
    found.map(|(_, choice)| *choice).ok_or_else(|| {
        let expected = of.iter().map(|(text, _)| format!("\"{text}\"")).collect::<Vec<_>>().join(" or ");
        wrong(name, value.map(shown).unwrap_or_default(), expected)
    })
}

/// An instance of one of our classes.
pub(crate) fn instance<'a, 'py, T: pyo3::PyTypeInfo>(
    name: &str,
    value: &'a Bound<'py, PyAny>,
    expected: &str,
) -> PyResult<&'a Bound<'py, T>> {
    value.cast().map_err(|_| wrong(name, shown(value), expected))
}

/// Several items: any sequence or iterator, but not a string.
pub(crate) fn items<'py>(name: &str, value: &Bound<'py, PyAny>, expected: &str) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let refused = || wrong(name, shown(value), expected);
    if value.is_instance_of::<pyo3::types::PyString>() {
        return Err(refused());
    }
    value.try_iter().map_err(|_| refused())?.collect()
}

/// A number within a range, not NaN.
pub(crate) fn number(name: &str, value: &Bound<'_, PyAny>, range: RangeInclusive<f64>) -> PyResult<f64> {
    match value.extract::<f64>() {
        Ok(number) if range.contains(&number) => plausible(name, number, value.py()).map(|()| number),
        _ => Err(wrong(name, shown(value), format_args!("a number from {} to {}", range.start(), range.end()))),
    }
}

/// Refuses an angle above a limit in radians: it is probably in degrees.
pub(crate) fn in_radians(name: &str, given: f64, most: f64) -> PyResult<f64> {
    if given.abs() <= most {
        return Ok(given);
    }
    let likely = given.to_radians();
    let expected = format!("radians from -{most:.4} to {most:.4}; likely degrees: {given} degrees are {likely:.4}");
    Err(wrong(name, given, expected))
}

/// Refuses echo times that are all too short for any sensor: they are probably in another unit.
pub(crate) fn in_microseconds(name: &str, times: impl Iterator<Item = f64>) -> PyResult<()> {
    let most = times.filter(|time| !time.is_nan()).fold(0.0, f64::max);
    // 100 us are 17 mm; an echo of 43 m takes 0.25 s.
    let likely = match most {
        0.0 | 100.0.. => return Ok(()),
        ..0.25 => "seconds: microseconds are a million times that",
        _ => "metres or milliseconds: an object 1 m away has an echo of 5830 microseconds",
    };
    Err(wrong(name, format_args!("{most} at most"), format_args!("microseconds, 100 or more; likely {likely}")))
}

/// A number within a range, or the default if there is none.
pub(crate) fn number_or(
    name: &str,
    value: Option<&Bound<'_, PyAny>>,
    default: f64,
    range: RangeInclusive<f64>,
) -> PyResult<f64> {
    value.map_or(Ok(default), |value| number(name, value, range))
}

/// One time for each sensor, in whole microseconds.
pub(crate) fn times(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<Micros>> {
    times_of(name, value, "sensor")
}

/// Times in whole microseconds.
pub(crate) fn times_of(name: &str, value: &Bound<'_, PyAny>, each: &str) -> PyResult<Vec<Micros>> {
    let expected = format!("a sequence of whole numbers of microseconds, one for each {each}");
    let items = items(name, value, &expected)?.into_iter().enumerate();
    let times = items.map(|(index, item)| micros(&format!("{name}[{index}]"), &item)).collect::<PyResult<Vec<_>>>()?;
    let numbers: Vec<_> = times.iter().map(|time| f64::from(time.as_micros())).collect();
    if let Some(doubt) = eeruf_files::doubt_list(name, &numbers) {
        warn(value.py(), format_args!("{name}: {doubt}"))?;
    }
    Ok(times)
}

/// A contiguous, aligned array of this type: the array itself if it is one, otherwise a copy. Unpickled buffers may
/// begin at any address.
pub(crate) fn native<'py>(value: &Bound<'py, PyAny>, dtype: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
    value.py().import("numpy")?.call_method1("require", (value, dtype, ["C", "A"]))
}

/// A matrix of floats with this many columns.
pub(crate) fn matrix<'py>(
    name: &str,
    value: &Bound<'py, PyAny>,
    columns: usize,
) -> PyResult<PyReadonlyArray2<'py, f64>> {
    let expected = || format!("an array of floats of shape (n, {columns})");
    let refused = |error| refused_by_numpy(error, value.py(), || wrong(name, shown(value), expected()));
    let array = native(value, Some("float64")).map_err(refused)?;
    let empty = array.getattr("size")?.extract::<usize>()? == 0;
    let array = if empty { array.call_method1("reshape", ((0, columns),))? } else { array };
    match array.extract::<PyReadonlyArray2<'py, f64>>() {
        Ok(matrix) if matrix.shape()[1] == columns => Ok(matrix),
        _ => Err(wrong(&format!("shape of {name}"), array.getattr("shape")?, expected())),
    }
}

/// Points, with heights if each has one: an array of shape (2,), (3,), (n, 2) or (n, 3), in metres.
pub(crate) fn points_in_space(
    name: &str,
    value: &Bound<'_, PyAny>,
) -> PyResult<(Vec<eeruf_sim::Point>, Option<Vec<f64>>)> {
    let expected = "an array of floats of shape (n, 2), or (n, 3) in a scene with height, in metres";
    let array = at_least_2d(name, value, expected)?;
    let columns = array.getattr("shape")?.get_item(1)?.extract::<usize>()?;
    let matrix = matrix(name, &array, if columns == 3 { 3 } else { 2 })?;
    let heights_m = || matrix.as_array().rows().into_iter().map(|row| row[2]).collect();
    Ok((in_plane(&matrix), (columns == 3).then(heights_m)))
}

/// One point or several: an array of shape (2,) or (n, 2), in metres.
pub(crate) fn points(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<eeruf_sim::Point>> {
    let array = at_least_2d(name, value, "an array of floats of shape (2,) or (n, 2), in metres")?;
    Ok(in_plane(&matrix(name, &array, 2)?))
}

fn at_least_2d<'py>(name: &str, value: &Bound<'py, PyAny>, expected: &str) -> PyResult<Bound<'py, PyAny>> {
    let array = value.py().import("numpy")?.call_method1("atleast_2d", (value,));
    array.map_err(|error| refused_by_numpy(error, value.py(), || wrong(name, shown(value), expected)))
}

fn in_plane(rows: &PyReadonlyArray2<'_, f64>) -> Vec<eeruf_sim::Point> {
    rows.as_array().rows().into_iter().map(|row| eeruf_sim::Point::new(row[0], row[1])).collect()
}
