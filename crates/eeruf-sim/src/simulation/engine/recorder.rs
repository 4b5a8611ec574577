//! Records the readings under a method: echo, cause, and the reading that the sensor would have had alone.

use std::collections::VecDeque;

use eeruf_core::ReadingKind;

use super::filter::{Filter, Filtered, FiredReading};
use super::own::Own;
use crate::simulation::error::SimulationError;
use crate::simulation::receiver::{EXTERNAL, Echo, NEVER};
use crate::{
    geometry::Pose,
    methods::{MAX_MEDIAN, Method, OwnError},
    results::{Cause, HeardPath, NO_PATH, Readings, SensorId},
};

/// Number of readings of a sensor that always have room: more than rings emit at one moment.
const ROOM: usize = 4;

/// Recorder of the readings.
pub(crate) struct Recorder {
    readings: Readings,
    /// The caller's own filter of each robot's readings, if any.
    filters: Vec<Option<Box<dyn Filter>>>,
    /// The earliest echoes of each sensor's last firings, the latest first.
    earlier: Vec<VecDeque<Option<Echo>>>,
    ids: Vec<SensorId>,
    end: u64,
}

impl Recorder {
    /// Makes a recorder for firings before `end`, in true nanoseconds, with about this many readings.
    pub(crate) fn new(
        method: Method,
        end: u64,
        expected: u64,
        ids: &[SensorId],
        own: &mut Own,
    ) -> Result<Self, SimulationError> {
        let robots = ids.last().map_or(0, |last| usize::from(last.robot) + 1);
        let filters = (0..robots).map(|robot| own.take_filter(robot)).collect();
        let mut readings = Readings::new(method, end as f64 * 1e-9, ids.len());
        let reserved = usize::try_from(expected).map(|expected| readings.try_reserve(expected));
        if !matches!(reserved, Ok(Ok(()))) {
            return Err(SimulationError::Memory { readings: expected });
        }
        Ok(Self { readings, filters, earlier: vec![VecDeque::new(); ids.len()], ids: ids.to_vec(), end })
    }

    /// Returns a recorder in the same state; `None` if the caller's own filter cannot be copied.
    pub(crate) fn copy(&self) -> Option<Self> {
        let copy_of = |filter: &Option<Box<dyn Filter>>| match filter {
            None => Some(None),
            Some(filter) => filter.copy().map(Some),
        };
        let filters = self.filters.iter().map(copy_of).collect::<Option<_>>()?;
        let Self { readings, earlier, ids, end, .. } = self;
        Some(Self { readings: readings.clone(), filters, earlier: earlier.clone(), ids: ids.clone(), end: *end })
    }

    /// Returns true if no reading was recorded since the last `take`.
    pub(crate) fn is_empty(&self) -> bool {
        self.readings.is_empty()
    }

    /// Reserves room for some more readings of each sensor.
    pub(crate) fn make_room(&mut self) -> Result<(), SimulationError> {
        let least = ROOM * self.ids.len();
        if self.readings.room() >= least {
            return Ok(());
        }
        let readings = self.readings.len();
        let more = readings.max(2 * least);
        self.readings.try_reserve(more).map_err(|_| SimulationError::Memory { readings: (readings + more) as u64 })
    }

    /// Records the judgement of a firing, whose echo may come from `stands_for` firings earlier. `reference` is the
    /// echo time of the sensor's reading if it were alone, `fired_from` its place and heading at the trigger. Returns
    /// all readings, this one last; `None` if it does not count.
    pub(crate) fn record(
        &mut self,
        sensor: usize,
        firing: &FiredReading<'_>,
        stands_for: usize,
        triggered: u64,
        reference: u64,
        fired_from: &Pose,
    ) -> Result<Option<&Readings>, OwnError> {
        let &FiredReading { reading, echoes, fired_s, expected_change_us } = firing;
        if reading.kind == ReadingKind::Late || triggered >= self.end {
            return Ok(None);
        }
        let earliest = echoes.first().copied();
        let earlier = &mut self.earlier[sensor];
        earlier.truncate(MAX_MEDIAN - 1);
        earlier.push_front(earliest);
        let Filtered { kind, echo: chosen } = match &mut self.filters[usize::from(self.ids[sensor].robot)] {
            Some(own) => own.push(firing)?,
            None => {
                let is_it = |echo: &&Echo| Some(echo.t_echo()) == reading.t_echo;
                let before = || earlier.get(stands_for).copied().flatten();
                let echo = if stands_for == 0 { echoes.iter().find(is_it).copied() } else { before() };
                Filtered { kind: reading.kind, echo }
            }
        };
        let (cause, path, emitted_s) = match chosen {
            None => (Cause::Nothing, NO_PATH, f64::NAN),
            Some(Echo { arrival, of_this_firing, .. }) => {
                let (cause, path) = match (arrival.path, of_this_firing) {
                    (EXTERNAL, _) => (Cause::External, NO_PATH),
                    // `take`, which knows the paths, decides if it is another sensor's sound.
                    (path, true) => (Cause::Own, path),
                    (path, false) => (Cause::Stale, path),
                };
                (cause, path, arrival.sent as f64 * 1e-9)
            }
        };
        let time_us = |echo: Option<Echo>| echo.map_or(f64::NAN, |echo| f64::from(echo.t_echo_us));
        let out = &mut self.readings;
        out.robot.push(self.ids[sensor].robot);
        out.sensor.push(self.ids[sensor].sensor);
        out.period.push(reading.period);
        out.phase.push(reading.phase.0);
        out.fired_s.push(fired_s);
        out.x_m.push(fired_from.translation.x);
        out.y_m.push(fired_from.translation.y);
        out.heading_rad.push(fired_from.rotation.angle());
        out.kind.push(kind);
        out.t_echo_us.push(time_us(chosen));
        out.earliest_us.push(time_us(earliest));
        out.reference_us.push(if reference == NEVER { f64::NAN } else { reference as f64 * 1e-3 });
        out.cause.push(cause);
        out.path.push(path);
        out.emitted_s.push(emitted_s);
        out.expected_change_us.push(expected_change_us);
        Ok(Some(out))
    }

    /// Returns the readings since the last call, with this duration and only the paths that they use.
    pub(crate) fn take(&mut self, paths: &[HeardPath], duration_s: f64) -> Readings {
        let mut readings = self.readings.take();
        readings.duration_s = duration_s;
        let mut number = vec![NO_PATH; paths.len()];
        for path in readings.path.iter().filter(|&&path| path != NO_PATH) {
            number[*path as usize] = 0;
        }
        for (path, number) in paths.iter().zip(&mut number).filter(|(_, number)| **number == 0) {
            *number = readings.paths.len() as u32;
            readings.paths.push(path.clone());
        }
        for (path, cause) in readings.path.iter_mut().zip(&mut readings.cause).filter(|(path, _)| **path != NO_PATH) {
            *path = number[*path as usize];
            let heard = &readings.paths[*path as usize];
            if heard.emitter != heard.receiver {
                *cause = Cause::Crosstalk;
            }
        }
        readings
    }
}
