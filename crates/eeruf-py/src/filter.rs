//! `EchoFilter`: the paper's filter alone, without a ring.

use eeruf_core::{MAX_SENSORS, Micros, SensorError, judge::Verdict};
use numpy::prelude::*;
use pyo3::prelude::*;

use crate::{
    arguments::{in_microseconds, matrix, micros, times_of, whole, whole_or, wrong},
    columns::{Codes, room},
    errors::{EerufError, Raise},
    exclusive::Exclusive,
    requirements,
    ring::MAX_ECHOES,
    ring_events::Reading,
    watch::Watch,
};

/// Compares the consecutive readings of each sensor, and accepts those that are near-identical (Eq. 11).
///
/// Args:
///     sensors: how many, 1 to 64.
///     t_delta_us: ``T_delta``: readings that differ by no more are near-identical.
///     consecutive: how many readings in a row must agree, 2 to 8.
///     echoes: the most echoes of one firing that a sensor reports, 1 to 8; the earliest that repeats is accepted.
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range; fewer than 2 or more than 8 readings to compare.
///
/// Example:
///     >>> import eeruf
///     >>> filter = eeruf.EchoFilter(sensors=1, t_delta_us=500)
///     >>> [filter.push(0, us).kind for us in (9_000, 9_300, 12_000)]
///     ['first', 'accepted', 'rejected']
#[pyclass(frozen, module = "eeruf")]
pub(crate) struct EchoFilter {
    filter: Exclusive<Filter>,
    /// Number of sensors.
    #[pyo3(get)]
    sensors: usize,
    /// ``T_delta``, in microseconds.
    #[pyo3(get)]
    t_delta_us: u32,
    /// Number of readings in a row that must agree.
    #[pyo3(get)]
    consecutive: u8,
    /// Number of echoes of one firing that count.
    #[pyo3(get)]
    echoes: usize,
}

/// Number of rows between two checks for Ctrl-C.
const ROWS_A_LOOK: usize = 4096;

/// A filter for one echo of a firing, which is smaller and faster, or for several.
#[derive(Clone)]
enum Filter {
    One(Box<eeruf_core::EchoFilter<MAX_SENSORS>>),
    Several(Box<eeruf_core::EchoFilter<MAX_SENSORS, MAX_ECHOES>>),
}

impl Filter {
    fn push(&mut self, sensor: u8, echoes: &[Micros], expected_change_us: i32) -> Result<Verdict, SensorError> {
        match self {
            Self::One(filter) => filter.push_echoes(sensor, echoes, expected_change_us),
            Self::Several(filter) => filter.push_echoes(sensor, echoes, expected_change_us),
        }
    }
}

#[pymethods]
impl EchoFilter {
    #[new]
    #[pyo3(signature = (sensors, t_delta_us, consecutive=None, *, echoes=None))]
    #[pyo3(text_signature = "(sensors, t_delta_us, consecutive=2, *, echoes=1)")]
    fn new(
        sensors: &Bound<'_, PyAny>,
        t_delta_us: &Bound<'_, PyAny>,
        consecutive: Option<&Bound<'_, PyAny>>,
        echoes: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (sensors, t_delta) = (requirements::sensors(sensors)?, micros("t_delta_us", t_delta_us)?);
        let consecutive = whole_or("consecutive", consecutive, 2, 0..=u8::MAX)?;
        let echoes = whole_or("echoes", echoes, 1, 1..=MAX_ECHOES as u32)? as usize;
        let filter = if echoes == 1 {
            eeruf_core::EchoFilter::new(t_delta, consecutive).map(|filter| Filter::One(Box::new(filter)))
        } else {
            eeruf_core::EchoFilter::new(t_delta, consecutive).map(|filter| Filter::Several(Box::new(filter)))
        };
        let filter = filter.map_err(|error| EerufError::new_err(format!("{error:#}")))?;
        let filter = Exclusive::new("EchoFilter", filter);
        Ok(Self { filter, sensors, t_delta_us: t_delta.as_micros(), consecutive, echoes })
    }

    /// Judge one firing of a sensor.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///     t_echo_us: the time of its echo after firing in whole microseconds, or None for no echo.
    ///     expected_change_us: expected change of a good reading since the previous one, by the robot's own
    ///         motion: ``-2 v dt / c`` for an object approached at ``v``.
    ///
    /// Returns:
    ///     The reading, without phase and period, which a filter does not know.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> filter = eeruf.EchoFilter(1, 100)
    ///     >>> [filter.push(0, us, expected_change_us=-400).kind for us in (9_000, 8_610)]
    ///     ['first', 'accepted']
    #[pyo3(signature = (sensor, t_echo_us, expected_change_us=None))]
    #[pyo3(text_signature = "($self, sensor, t_echo_us, expected_change_us=0)")]
    fn push(
        &self,
        sensor: &Bound<'_, PyAny>,
        t_echo_us: Option<&Bound<'_, PyAny>>,
        expected_change_us: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Reading> {
        let sensor = self.sensor(sensor)?;
        let echo = t_echo_us.map(|echo| micros("t_echo_us", echo)).transpose()?;
        let change = whole_or("expected_change_us", expected_change_us, 0, i32::MIN..=i32::MAX)?;
        let verdict = self.filter.get()?.push(sensor, echo.as_slice(), change).map_err(Raise::raise)?;
        Ok(Reading::of_filter(sensor, &verdict))
    }

    /// Judge one firing of a sensor that reports several echoes.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///     t_echoes_us: the times of its echoes after firing in whole microseconds, in any order; the earliest
    ///         ``echoes`` count.
    ///     expected_change_us: as for ``push``.
    ///
    /// Returns:
    ///     The reading, without phase and period, which a filter does not know.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor or an invalid time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> filter = eeruf.EchoFilter(1, 100, echoes=8)
    ///     >>> firings = [9_000, 14_000], [14_000, 9_000], [3_000, 9_000]
    ///     >>> [filter.push_echoes(0, firing).t_echo_us for firing in firings]
    ///     [9000, 9000, 9000]
    #[pyo3(signature = (sensor, t_echoes_us, expected_change_us=None))]
    #[pyo3(text_signature = "($self, sensor, t_echoes_us, expected_change_us=0)")]
    fn push_echoes(
        &self,
        sensor: &Bound<'_, PyAny>,
        t_echoes_us: &Bound<'_, PyAny>,
        expected_change_us: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Reading> {
        let sensor = self.sensor(sensor)?;
        let mut echoes = times_of("t_echoes_us", t_echoes_us, "echo")?;
        echoes.sort_unstable();
        echoes.truncate(self.echoes);
        let change = whole_or("expected_change_us", expected_change_us, 0, i32::MIN..=i32::MAX)?;
        let verdict = self.filter.get()?.push(sensor, &echoes, change).map_err(Raise::raise)?;
        Ok(Reading::of_filter(sensor, &verdict))
    }

    /// Judge many firings at once, without the interpreter lock.
    ///
    /// Args:
    ///     t_echo_us: array of shape (periods, sensors): echo times in microseconds, rounded to whole ones; NaN for no
    ///         echo. An array of contiguous float64 is read in place, anything else is converted first.
    ///
    /// Returns:
    ///     Array of int8 of the same shape: indices into ``eeruf.KINDS``.
    ///
    /// Raises:
    ///     EerufError: a wrong shape, or a time that is negative or 2^32 or more; the filter is then unchanged.
    ///
    /// Example:
    ///     >>> import eeruf, numpy
    ///     >>> kinds = eeruf.EchoFilter(2, 500).push_many([[9_000, 7_000], [9_100, numpy.nan]])
    ///     >>> [[eeruf.KINDS[kind] for kind in row] for row in kinds]
    ///     [['first', 'first'], ['accepted', 'no_echo']]
    fn push_many<'py>(&self, py: Python<'py>, t_echo_us: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let echoes = matrix("t_echo_us", t_echo_us, self.sensors)?;
        let echoes = echoes.as_slice().map_err(|error| EerufError::new_err(error.to_string()))?;
        if let Some(at) = echoes.iter().position(|&us| !(us.is_nan() || (0.0..=f64::from(u32::MAX)).contains(&us))) {
            let name = format!("t_echo_us[{}, {}]", at / self.sensors, at % self.sensors);
            return Err(wrong(&name, echoes[at], format_args!("0 to {} microseconds, or nan for no echo", u32::MAX)));
        }
        in_microseconds("t_echo_us", echoes.iter().copied())?;
        let mut kinds = room(echoes.len())?;
        kinds.resize(echoes.len(), 0_i8);
        let (mut filter, sensors) = (self.filter.get()?, self.sensors);
        let filter = &mut *filter;
        let (mut watch, before) = (Watch::new(None)?, filter.clone());
        let pushed = py.detach(|| {
            for (number, (row, kinds)) in echoes.chunks_exact(sensors).zip(kinds.chunks_exact_mut(sensors)).enumerate()
            {
                if number % ROWS_A_LOOK == 0 && !watch.go_on(None, String::new) {
                    break;
                }
                for (sensor, (&us, kind)) in (0..).zip(row.iter().zip(kinds)) {
                    // Rounded to whole microseconds, which core counts in; in range, as was just checked.
                    let echo = (!us.is_nan()).then(|| Micros::new(us.round() as u32));
                    *kind = filter.push(sensor, echo.as_slice(), 0)?.kind as i8;
                }
            }
            Ok(())
        });
        // If it ends early, the filter is unchanged.
        watch.outcome(pushed.map_err(|error: SensorError| error.raise())).inspect_err(|_| *filter = before)?;
        let kinds = numpy::PyArray1::from_vec(py, kinds).reshape([echoes.len() / self.sensors, self.sensors])?;
        Codes::Kinds.name(kinds.as_any())
    }

    /// Forget the readings of a sensor, so that its next one is compared with nothing.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> filter = eeruf.EchoFilter(1, 500)
    ///     >>> kinds = [filter.push(0, 9_000).kind]
    ///     >>> filter.forget(0)
    ///     >>> kinds + [filter.push(0, 9_000).kind]
    ///     ['first', 'first']
    fn forget(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.sensor(sensor)?;
        match &mut *self.filter.get()? {
            Filter::One(filter) => filter.forget(sensor),
            Filter::Several(filter) => filter.forget(sensor),
        }
        .map_err(Raise::raise)
    }

    fn __copy__(&self) -> PyResult<Self> {
        Ok(Self { filter: Exclusive::new("EchoFilter", self.filter.get()?.clone()), ..*self })
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.__copy__()
    }

    fn __repr__(&self) -> String {
        let Self { sensors, t_delta_us, consecutive, echoes, .. } = self;
        format!("EchoFilter(sensors={sensors}, t_delta_us={t_delta_us}, consecutive={consecutive}, echoes={echoes})")
    }
}

impl EchoFilter {
    fn sensor(&self, sensor: &Bound<'_, PyAny>) -> PyResult<u8> {
        // At most 64.
        whole("sensor", sensor, 0..=self.sensors as u8 - 1)
    }
}
