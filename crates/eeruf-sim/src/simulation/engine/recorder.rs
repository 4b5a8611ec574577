//! What becomes of a reading under a method, and its entry in the record: what it says, what it came from, and what the
//! sensor would have read alone.

use eeruf_core::{Micros, Reading, ReadingKind};

use crate::simulation::error::SimulationError;
use crate::simulation::options::Options;
use crate::simulation::receiver::{EXTERNAL, Heard, NEVER, Receiver};
use crate::{
    geometry::Pose,
    methods::{Belief, Method, Weighed},
    results::{Cause, HeardPath, NO_PATH, Readings, SensorId},
};

/// The most readings that a median is taken of.
const MAX_MEDIAN: usize = 15;

/// More than all rings of a world give at one moment.
const ROOM: usize = 1 << 13;

/// Writes down the readings.
pub(crate) struct Recorder {
    readings: Readings,
    belief: Belief,
    ids: Vec<SensorId>,
    end: u64,
    median_of: usize,
    /// The last readings of each sensor, for the median.
    history: Vec<History>,
}

/// The last few firings of a sensor: what each heard first, if anything.
#[derive(Clone, Copy, Default)]
struct History {
    heard: [Option<Heard>; MAX_MEDIAN],
    count: usize,
}

impl Recorder {
    /// For readings of firings before `end`, in true nanoseconds, of which about as many are expected.
    pub(crate) fn new(
        method: Method,
        options: &Options,
        end: u64,
        expected: u64,
        ids: &[SensorId],
    ) -> Result<Self, SimulationError> {
        let median_of = usize::from(options.median_of);
        if median_of == 0 || median_of > MAX_MEDIAN {
            return Err(SimulationError::Median { median_of: options.median_of });
        }
        let duration_s = end as f64 * 1e-9;
        let belief = method.belief();
        let history = if belief == Belief::Median { vec![History::default(); ids.len()] } else { Vec::new() };
        let mut readings = Readings::new(method, duration_s, ids.len());
        let reserved = usize::try_from(expected).map(|expected| readings.try_reserve(expected));
        if !matches!(reserved, Ok(Ok(()))) {
            return Err(SimulationError::Memory { readings: expected });
        }
        Ok(Self { readings, belief, ids: ids.to_vec(), end, median_of, history })
    }

    /// Whether nothing was read since the record was last taken.
    pub(crate) fn is_empty(&self) -> bool {
        self.readings.is_empty()
    }

    /// Makes sure that a few thousand more fit.
    pub(crate) fn make_room(&mut self) -> Result<(), SimulationError> {
        if self.readings.room() >= ROOM {
            return Ok(());
        }
        let readings = self.readings.len();
        let more = readings.max(ROOM);
        self.readings.try_reserve(more).map_err(|_| SimulationError::Memory { readings: (readings + more) as u64 })
    }

    /// Records what the ring makes of a firing. `reference` is the travelling time of what the sensor hears alone,
    /// `fired_from` its place and heading when it fired. The answer is all readings with this one as the last; none if
    /// it does not count.
    pub(crate) fn record(
        &mut self,
        sensor: usize,
        reading: &Reading,
        weighed: Option<Weighed>,
        receiver: &Receiver,
        reference: u64,
        fired_from: &Pose,
    ) -> Option<&Readings> {
        if reading.kind == ReadingKind::Late || receiver.fired >= self.end {
            return None;
        }
        let earliest = receiver.heard().next().copied();
        let (kind, chosen) = match self.belief {
            Belief::Repeated => {
                let t_echo_us = reading.t_echo.map(Micros::as_micros);
                let chosen = receiver.heard().find(|heard| Some(heard.t_echo_us) == t_echo_us);
                (reading.kind, chosen.copied())
            }
            Belief::All => (accepted_or_silent(earliest), earliest),
            Belief::Median => self.median(sensor, earliest),
        };
        let (cause, path, emitted_s) = match chosen {
            None => (Cause::Nothing, NO_PATH, f64::NAN),
            Some(Heard { arrival, of_this_firing, .. }) => {
                let (cause, path) = match (arrival.path, of_this_firing) {
                    (EXTERNAL, _) => (Cause::External, NO_PATH),
                    // Whether it is another sensor's sound is decided by `take`, which knows the paths.
                    (path, true) => (Cause::Own, path),
                    (path, false) => (Cause::Stale, path),
                };
                (cause, path, arrival.sent as f64 * 1e-9)
            }
        };
        let time_us = |heard: Option<Heard>| heard.map_or(f64::NAN, |heard| f64::from(heard.t_echo_us));
        let out = &mut self.readings;
        out.robot.push(self.ids[sensor].robot);
        out.sensor.push(self.ids[sensor].sensor);
        out.period.push(reading.period);
        out.phase.push(reading.phase.0);
        out.fired_s.push(receiver.fired as f64 * 1e-9);
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
        out.weighed.push(weighed);
        Some(out)
    }

    fn median(&mut self, sensor: usize, earliest: Option<Heard>) -> (ReadingKind, Option<Heard>) {
        let history = &mut self.history[sensor];
        history.heard[history.count % self.median_of] = earliest;
        history.count += 1;
        if history.count < self.median_of {
            return (if earliest.is_some() { ReadingKind::First } else { ReadingKind::NoEcho }, earliest);
        }
        let mut last = history.heard;
        let last = &mut last[..self.median_of];
        // Without echo counts as beyond all echoes.
        last.sort_by_key(|heard| heard.map_or(u32::MAX, |heard| heard.t_echo_us));
        let middle = last[(self.median_of - 1) / 2];
        (accepted_or_silent(middle), middle)
    }

    /// The record since it was last taken, of this duration, with only the paths that some reading came along.
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

fn accepted_or_silent(chosen: Option<Heard>) -> ReadingKind {
    if chosen.is_some() { ReadingKind::Accepted } else { ReadingKind::Clear }
}
