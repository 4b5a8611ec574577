//! `Adaptation`: adaptive scheduling (end of Sec. 3.1).

use std::sync::Arc;

use eeruf_core::{MAX_SENSORS, Micros, Requirements, RingEvent, SpeedOfSound, VerifiedSchedule, adaptation::OnLadder};
use pyo3::prelude::*;

use crate::{
    arguments::{instance, items, micros, number, number_or, whole_or, wrong},
    errors::Raise,
    exclusive::Exclusive,
    ring::Ring,
    ring_events::to_core,
    schedule::Schedule,
};

type Rung = VerifiedSchedule<MAX_SENSORS>;

/// A rung: a schedule that must reject crosstalk.
fn rung(name: &str, schedule: &Bound<'_, PyAny>, t_delta: Micros) -> PyResult<Rung> {
    let schedule = instance::<Schedule>(name, schedule, "an eeruf.Schedule")?.get().0;
    schedule.verified(&Requirements::new(t_delta)).map_err(Raise::raise)
}

/// Adaptive scheduling (end of Sec. 3.1): fire more slowly if too many readings are rejected, and faster again once few
/// are.
///
/// It watches the rejection rate over windows of periods. One noisy window moves one rung up, to a longer period;
/// only several consecutive calm windows move one rung down.
///
/// Args:
///     schedules: a ``Schedule`` for each rung, from the shortest period to the longest, all with the same number of
///         sensors. The ring begins with the first.
///     t_delta_us: ``T_delta`` of the ring, at which each schedule must reject crosstalk.
///     noisy: the rejection rate, a fraction of 1, above which it fires more slowly.
///     calm: the rejection rate up to which a window is calm.
///     window_periods: how many periods a window has, 1 to 255.
///     patience: how many consecutive calm windows it takes to fire faster, 1 to 255.
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range; a schedule does not reject crosstalk at this
///         ``t_delta_us``; the schedules do not form a ladder.
///
/// Example:
///     >>> import eeruf
///     >>> fast, slow = eeruf.tables.TABLE_I_D.scaled(3, 5), eeruf.tables.TABLE_I_D
///     >>> ring = eeruf.Ring(fast, t_delta_us=500, window_us=36_000)
///     >>> adaptation = eeruf.Adaptation([fast, slow], t_delta_us=500)
///     >>> noise_us = 0
///     >>> while adaptation.rung == 0:  # everything that is heard is noise
///     ...     now_us = ring.next_deadline_us
///     ...     while event := ring.poll(now_us):
///     ...         if isinstance(event, eeruf.Fire):
///     ...             noise_us = (noise_us + 7_000) % 30_000
///     ...             ring.echo(event.sensor, now_us + 1_000 + noise_us)
///     ...         _ = adaptation.adapt(ring, event)
///     >>> adaptation.rejection_rate > 0.9, adaptation.schedule == slow
///     (True, True)
#[pyclass(frozen, module = "eeruf")]
pub(crate) struct Adaptation {
    adaptation: Exclusive<OnLadder<Arc<[Rung]>>>,
}

/// Converts a fraction of 1 to thousandths.
fn permille(name: &str, value: Option<&Bound<'_, PyAny>>, default: u16) -> PyResult<u16> {
    // At most 1000.
    value.map_or(Ok(default), |share| number(name, share, 0.0..=1.0).map(|share| (1e3 * share).round() as u16))
}

#[pymethods]
impl Adaptation {
    #[new]
    #[pyo3(signature = (schedules, t_delta_us, *, noisy=None, calm=None, window_periods=None, patience=None))]
    #[pyo3(text_signature = "(schedules, t_delta_us, *, noisy=0.3, calm=0.1, window_periods=16, patience=4)")]
    fn new(
        schedules: &Bound<'_, PyAny>,
        t_delta_us: &Bound<'_, PyAny>,
        noisy: Option<&Bound<'_, PyAny>>,
        calm: Option<&Bound<'_, PyAny>>,
        window_periods: Option<&Bound<'_, PyAny>>,
        patience: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let expected = "schedules, from the shortest period to the longest";
        let t_delta = micros("t_delta_us", t_delta_us)?;
        let schedules = items("schedules", schedules, expected)?;
        let named = || schedules.iter().enumerate().map(|(index, of)| (format!("schedules[{index}]"), of));
        let (noisy, calm) = (permille("noisy", noisy, 300)?, permille("calm", calm, 100)?);
        if calm > noisy {
            return Err(wrong(
                "calm",
                f64::from(calm) / 1e3,
                format_args!("at most noisy = {}", f64::from(noisy) / 1e3),
            ));
        }
        let window = whole_or("window_periods", window_periods, 16, 1..=u8::MAX)?;
        let patience = whole_or("patience", patience, 4, 1..=u8::MAX)?;
        let rungs = named().map(|(name, of)| rung(&name, of, t_delta)).collect::<PyResult<Arc<[_]>>>()?;
        let mut adaptation = OnLadder::new(rungs).map_err(Raise::raise)?;
        (adaptation.noisy_permille, adaptation.calm_permille) = (noisy, calm);
        (adaptation.window, adaptation.patience) = (window, patience);
        Ok(Self { adaptation: Exclusive::new("Adaptation", adaptation) })
    }

    /// Read an event of a ring, and change the ring's schedule if another one is better. Only ends of periods
    /// matter.
    ///
    /// Args:
    ///     ring: an ``eeruf.Ring`` that began with the first schedule.
    ///     event: an event that its ``poll`` returned.
    ///
    /// Returns:
    ///     True if the schedule changes; the ring makes the change when the current period ends.
    ///
    /// Raises:
    ///     EerufError: not a ring, not an event, or a ring with another number of sensors; the ring refuses the
    ///         schedule. Both then continue as before.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> adaptation = eeruf.Adaptation([eeruf.tables.TABLE_I_D], t_delta_us=500)
    ///     >>> adaptation.adapt(ring, ring.poll(ring.next_deadline_us))
    ///     False
    fn adapt(&self, ring: &Bound<'_, PyAny>, event: &Bound<'_, PyAny>) -> PyResult<bool> {
        let ring = instance::<Ring>("ring", ring, "an eeruf.Ring")?;
        let RingEvent::PeriodEnded(stats) = to_core("event", event)? else { return Ok(false) };
        let mut ring = ring.get().0.get()?;
        let mut adaptation = self.adaptation.get()?;
        let rungs = Arc::clone(adaptation.rungs());
        adaptation.adapt_to(&stats, |rung| ring.change_schedule(rungs[rung].schedule()))
    }

    /// The rung in use, 0 for the shortest period.
    #[getter]
    fn rung(&self) -> PyResult<usize> {
        Ok(self.adaptation.get()?.rung())
    }

    /// The schedule in use.
    #[getter]
    fn schedule(&self) -> PyResult<Schedule> {
        // The ring is always on one of the rungs.
        let rung = self.rung()?;
        Ok(Schedule(*self.adaptation.get()?.rungs()[rung].schedule()))
    }

    /// The share of compared readings that were rejected in the last complete window; None before the first, or if
    /// nothing was compared in it.
    #[getter]
    fn rejection_rate(&self) -> PyResult<Option<f64>> {
        let permille = self.adaptation.get()?.rejection_permille();
        Ok(permille.map(|permille| f64::from(permille) / 1e3))
    }

    /// The fastest motion, in m/s, at which good readings still pass on the rung in use: a reading changes by
    /// ``2 v dt / c`` (Sec. 3.1).
    ///
    /// Args:
    ///     t_delta_us: ``T_delta`` of the ring.
    ///     sound_m_s: the speed of sound, in m/s, 100 to 1000.
    ///
    /// Raises:
    ///     EerufError: an argument is out of range.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.Adaptation([eeruf.tables.TABLE_I_D], t_delta_us=999).max_speed_m_s(t_delta_us=999)
    ///     1.382
    #[pyo3(signature = (t_delta_us, sound_m_s=None), text_signature = "($self, t_delta_us, sound_m_s=343.2)")]
    fn max_speed_m_s(&self, t_delta_us: &Bound<'_, PyAny>, sound_m_s: Option<&Bound<'_, PyAny>>) -> PyResult<f64> {
        let t_delta = micros("t_delta_us", t_delta_us)?;
        let c = number_or("sound_m_s", sound_m_s, 343.2, 100.0..=1e3)?;
        let c = SpeedOfSound::from_mm_per_s((1e3 * c).round() as u32);
        Ok(f64::from(self.adaptation.get()?.max_speed_mm_s(t_delta, c)) / 1e3)
    }

    fn __copy__(&self) -> PyResult<Self> {
        Ok(Self { adaptation: Exclusive::new("Adaptation", self.adaptation.get()?.clone()) })
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.__copy__()
    }

    fn __repr__(&self) -> PyResult<String> {
        let rung = self.rung()?;
        let adaptation = self.adaptation.get()?;
        let (rungs, period) = (adaptation.rungs().len(), adaptation.rungs()[rung].period());
        Ok(format!("<Adaptation: rung {rung} of {rungs}, {}>", period.as_micros()))
    }
}
