//! `Readings` from their columns, the form in a pickle.

use std::collections::HashSet;

use eeruf_core::{MAX_SENSORS, ReadingKind};
use eeruf_sim::{Cause, HeardPath, NO_PATH, SensorId, world::MAX_ROBOTS};
use numpy::PyReadonlyArray1;
use pyo3::{prelude::*, types::PyDict};

use crate::{
    arguments::{in_microseconds, instance, native, number, whole, wrong},
    methods::method as method_named,
    readings::{CAUSES, Readings},
};

/// The causes in the order of their codes, like [`CAUSES`].
const CAUSE_OF: [Cause; 5] = [Cause::Nothing, Cause::Own, Cause::Stale, Cause::Crosstalk, Cause::External];

fn item<'py>(columns: &Bound<'py, PyDict>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    columns.get_item(name)?.ok_or_else(|| wrong(name, "missing", "a column of Readings"))
}

fn column<T: numpy::Element + Copy>(columns: &Bound<'_, PyDict>, name: &str) -> PyResult<Vec<T>> {
    let column = item(columns, name)?;
    let aligned = native(&column, None).map_err(|_| wrong(name, &column, "a column of Readings"))?;
    let array: PyReadonlyArray1<'_, T> = aligned.extract().map_err(|_| wrong(name, &column, "a column of Readings"))?;
    Ok(array.as_array().iter().copied().collect())
}

/// A column of whole numbers from 0 to below `end`.
fn index<T: TryFrom<i64>>(columns: &Bound<'_, PyDict>, name: &str, end: i64) -> PyResult<Vec<T>> {
    let each = |value: i64| {
        let within = Some(value).filter(|value| (0..end).contains(value)).and_then(|value| T::try_from(value).ok());
        within.ok_or_else(|| wrong(name, value, format_args!("0 to {}", end - 1)))
    };
    column::<i64>(columns, name)?.into_iter().map(each).collect()
}

fn heard_paths(columns: &Bound<'_, PyDict>) -> PyResult<Vec<HeardPath>> {
    let ends = |robot, sensor| -> PyResult<Vec<SensorId>> {
        let robots: Vec<u16> = index(columns, robot, MAX_ROBOTS as i64)?;
        let sensors: Vec<u8> = index(columns, sensor, MAX_SENSORS as i64)?;
        equally_long(robots.len(), &[sensors.len()])?;
        Ok(robots.into_iter().zip(sensors).map(|(robot, sensor)| SensorId { robot, sensor }).collect())
    };
    let walls: Vec<Vec<i64>> = item(columns, "walls")?
        .extract()
        .map_err(|_| wrong("walls", "not a list of tuples", "the bounces of each path"))?;
    let (emitter, receiver) = (ends("emitter_robot", "emitter")?, ends("receiver_robot", "receiver")?);
    let order: Vec<u32> = index(columns, "order", i64::from(u32::MAX))?;
    let length_m: Vec<f64> = column(columns, "length_m")?;
    let angles: (Vec<f64>, Vec<f64>) = (column(columns, "departure_rad")?, column(columns, "arrival_rad")?);
    let lengths = [emitter.len(), receiver.len(), order.len(), length_m.len(), angles.0.len(), angles.1.len()];
    equally_long(walls.len(), &lengths)?;
    let path = |path: usize| HeardPath {
        emitter: emitter[path],
        receiver: receiver[path],
        order: order[path],
        length_m: length_m[path],
        departure_rad: angles.0[path],
        arrival_rad: angles.1[path],
        bounces: walls[path].iter().map(|&number| eeruf_sim::Bounce::numbered(number)).collect(),
    };
    Ok((0..walls.len()).map(path).collect())
}

fn equally_long(expected: usize, lengths: &[usize]) -> PyResult<()> {
    match lengths.iter().find(|&&length| length != expected) {
        Some(length) => Err(wrong("length of a column", length, expected)),
        None => Ok(()),
    }
}

/// Readings from their columns, the form in a pickle.
#[pyfunction]
#[pyo3(name = "_readings_from_columns", signature = (method, duration_s, sensors, columns, paths))]
pub(crate) fn readings_from_columns(
    method: &Bound<'_, PyAny>,
    duration_s: &Bound<'_, PyAny>,
    sensors: &Bound<'_, PyAny>,
    columns: &Bound<'_, PyAny>,
    paths: &Bound<'_, PyAny>,
) -> PyResult<Readings> {
    let columns = instance::<PyDict>("columns", columns, "a dict of columns")?;
    let paths = instance::<PyDict>("paths", paths, "a dict of columns")?;
    let duration_s = number("duration_s", duration_s, 0.0..=f64::MAX)?;
    let sensors = whole("sensors", sensors, 0..=(MAX_ROBOTS * MAX_SENSORS) as u64)? as usize;
    let robot: Vec<u16> = index(columns, "robot", MAX_ROBOTS as i64)?;
    let code = |name, codes: usize| -> PyResult<Vec<usize>> {
        let values: Vec<i8> = column(columns, name)?;
        let code = |value: i8| usize::try_from(value).ok().filter(|&code| code < codes);
        let each = |value| code(value).ok_or_else(|| wrong(name, value, format_args!("0 to {}", codes - 1)));
        values.into_iter().map(each).collect()
    };
    let paths = heard_paths(paths)?;
    let path = |index: i64| match u32::try_from(index) {
        Ok(path) if (path as usize) < paths.len() => Ok(path),
        Err(_) if index == -1 => Ok(NO_PATH),
        _ => Err(wrong("path", index, format_args!("-1 to {}", paths.len() as i64 - 1))),
    };
    let path = column::<i64>(columns, "path")?.into_iter().map(path).collect::<PyResult<Vec<_>>>()?;
    let readings = eeruf_sim::Readings {
        method: method_named("method", method)?,
        duration_s,
        sensors,
        sensor: index(columns, "sensor", MAX_SENSORS as i64)?,
        period: index(columns, "period", i64::from(u32::MAX))?,
        phase: index(columns, "phase", i64::from(u8::MAX) + 1)?,
        fired_s: column(columns, "fired_s")?,
        x_m: column(columns, "x_m")?,
        y_m: column(columns, "y_m")?,
        heading_rad: column(columns, "heading_rad")?,
        kind: code("kind", ReadingKind::ALL.len())?.into_iter().map(|kind| ReadingKind::ALL[kind]).collect(),
        t_echo_us: column(columns, "t_echo_us")?,
        earliest_us: column(columns, "earliest_us")?,
        reference_us: column(columns, "reference_us")?,
        cause: code("cause", CAUSES.len())?.into_iter().map(|cause| CAUSE_OF[cause]).collect(),
        emitted_s: column(columns, "emitted_s")?,
        expected_change_us: column(columns, "expected_change_us")?,
        path,
        paths,
        robot,
    };
    in_microseconds("t_echo_us", readings.t_echo_us.iter().copied())?;
    let lengths = [
        readings.sensor.len(),
        readings.period.len(),
        readings.phase.len(),
        readings.fired_s.len(),
        readings.x_m.len(),
        readings.y_m.len(),
        readings.heading_rad.len(),
        readings.kind.len(),
        readings.t_echo_us.len(),
        readings.earliest_us.len(),
        readings.reference_us.len(),
        readings.cause.len(),
        readings.path.len(),
        readings.emitted_s.len(),
        readings.expected_change_us.len(),
    ];
    equally_long(readings.robot.len(), &lengths)?;
    let seen: HashSet<SensorId> = (0..readings.len()).map(|reading| readings.id(reading)).collect();
    if sensors < seen.len() {
        return Err(wrong(
            "sensors",
            sensors,
            format_args!("{} or more, as many as there are readings of", seen.len()),
        ));
    }
    Ok(Readings::new(readings))
}
