//! Results of a simulation: every reading of every sensor as arrays of equal length, with its cause and the reading
//! that the sensor would have had alone.

use std::collections::TryReserveError;

use eeruf_core::ReadingKind;

use crate::{methods::Method, scene::Bounce};

/// A sensor of a world, both counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
pub struct SensorId {
    /// The robot.
    pub robot: u16,
    /// The sensor on its ring.
    pub sensor: u8,
}

/// Cause of a reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
#[repr(u8)]
pub enum Cause {
    /// No echo came.
    Nothing,
    /// The sensor's own sound, sent by this firing.
    Own,
    /// The sensor's own sound, sent by an earlier firing.
    Stale,
    /// Crosstalk: another sensor's sound, of this robot or of another.
    Crosstalk,
    /// A burst from outside.
    External,
}

/// Marker of "no path" in [`Readings::path`].
pub const NO_PATH: u32 = u32::MAX;

/// A path along which sound reached a sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct HeardPath {
    /// The sensor that sent the sound.
    pub emitter: SensorId,
    /// The sensor that heard the sound.
    pub receiver: SensorId,
    /// Number of bounces.
    pub order: u32,
    /// The length in metres; in a moving world, the length when the path was first heard.
    pub length_m: f64,
    /// Direction of departure, in the scene's frame.
    pub departure_rad: f64,
    /// Direction in which the receiver sees the path, in the scene's frame.
    pub arrival_rad: f64,
    /// The bounces, emitter to receiver. [`Scene::bounce_points`](crate::Scene::bounce_points) gives their places.
    pub bounces: Box<[Bounce]>,
}

impl HeardPath {
    /// Returns true if the path causes *direct* crosstalk: without a bounce or by a single reflection.
    pub fn is_direct(&self) -> bool {
        self.order <= 1
    }
}

/// Readings as arrays of equal length, in the order in which the rings emitted them. Times without a value are NaN.
#[derive(Clone, Debug)]
pub struct Readings {
    /// The method that was simulated.
    pub method: Method,
    /// Duration, in seconds of true time; all firings within it have their readings in the arrays.
    pub duration_s: f64,
    /// Number of sensors in the world.
    pub sensors: usize,
    /// The robot, from 0.
    pub robot: Vec<u16>,
    /// The sensor on its ring, from 0.
    pub sensor: Vec<u8>,
    /// The period of the robot's ring, from 0.
    pub period: Vec<u32>,
    /// The phase of the firing, from 0.
    pub phase: Vec<u8>,
    /// Time of the firing, in seconds of true time.
    pub fired_s: Vec<f64>,
    /// Position of the sensor when it fired, in metres of the scene.
    pub x_m: Vec<f64>,
    /// Position of the sensor when it fired, in metres of the scene.
    pub y_m: Vec<f64>,
    /// Heading of the sensor when it fired, in radians of the scene, counter-clockwise from the x axis, in (-pi, pi].
    pub heading_rad: Vec<f64>,
    /// Verdict of the method on the reading. Methods that believe everything have only [`ReadingKind::Accepted`] and
    /// [`ReadingKind::Clear`].
    pub kind: Vec<ReadingKind>,
    /// The echo time reported by the method, in microseconds of the robot's clock: the earliest echo of the firing, or
    /// with `multi_echo` the one that repeats, or with `median` the median.
    pub t_echo_us: Vec<f64>,
    /// The earliest echo of this firing, in microseconds of the robot's clock.
    pub earliest_us: Vec<f64>,
    /// The reading that the sensor would have alone at this place in quiet air, in microseconds of true time: the first
    /// sufficiently loud arrival of its own sound between blanking and the end of the window, without fading and
    /// jitter.
    pub reference_us: Vec<f64>,
    /// Cause of `t_echo_us`.
    pub cause: Vec<Cause>,
    /// Index into `paths`, or [`NO_PATH`].
    pub path: Vec<u32>,
    /// Time when the sound behind `t_echo_us` was sent, in seconds of true time.
    pub emitted_s: Vec<f64>,
    /// The change that odometry expects of a good reading since the sensor's previous firing, in microseconds; 0 for a
    /// robot without odometry.
    pub expected_change_us: Vec<i32>,
    /// All paths that readings refer to.
    pub paths: Vec<HeardPath>,
}

impl Readings {
    /// Returns the memory for this number of readings, in bytes.
    pub const fn bytes_for(readings: u64) -> u64 {
        let whole = size_of::<[f64; 8]>() + size_of::<(u32, u32, i32)>() + size_of::<u16>();
        readings.saturating_mul((whole + size_of::<(u8, u8, ReadingKind, Cause)>()) as u64)
    }

    /// Makes empty readings.
    pub(crate) fn new(method: Method, duration_s: f64, sensors: usize) -> Self {
        Self {
            method,
            duration_s,
            sensors,
            robot: Vec::new(),
            sensor: Vec::new(),
            period: Vec::new(),
            phase: Vec::new(),
            fired_s: Vec::new(),
            x_m: Vec::new(),
            y_m: Vec::new(),
            heading_rad: Vec::new(),
            kind: Vec::new(),
            t_echo_us: Vec::new(),
            earliest_us: Vec::new(),
            reference_us: Vec::new(),
            cause: Vec::new(),
            path: Vec::new(),
            emitted_s: Vec::new(),
            expected_change_us: Vec::new(),
            paths: Vec::new(),
        }
    }

    /// Reserves room for this many more readings, if there is memory.
    pub(crate) fn try_reserve(&mut self, more: usize) -> Result<(), TryReserveError> {
        let Self { robot, sensor, period, phase, fired_s, kind, .. } = self;
        robot.try_reserve(more)?;
        sensor.try_reserve(more)?;
        period.try_reserve(more)?;
        phase.try_reserve(more)?;
        fired_s.try_reserve(more)?;
        kind.try_reserve(more)?;
        let Self { x_m, y_m, heading_rad, .. } = self;
        x_m.try_reserve(more)?;
        y_m.try_reserve(more)?;
        heading_rad.try_reserve(more)?;
        let Self { t_echo_us, earliest_us, reference_us, cause, path, emitted_s, .. } = self;
        self.expected_change_us.try_reserve(more)?;
        t_echo_us.try_reserve(more)?;
        earliest_us.try_reserve(more)?;
        reference_us.try_reserve(more)?;
        cause.try_reserve(more)?;
        path.try_reserve(more)?;
        emitted_s.try_reserve(more)
    }

    /// Returns the number of further readings that fit.
    pub(crate) fn room(&self) -> usize {
        // Columns of equal element types grow alike, and the widest grow last.
        self.emitted_s.capacity() - self.emitted_s.len()
    }

    /// Takes all readings out: the columns themselves if they are at least half full, otherwise exact copies, so that
    /// records of many short steps take no more memory than needed.
    pub(crate) fn take(&mut self) -> Self {
        if self.room() <= self.len() {
            let next = Self::new(self.method, self.duration_s, self.sensors);
            return core::mem::replace(self, next);
        }
        let copy = self.clone();
        self.clear();
        copy
    }

    /// Clears all readings, and keeps the memory.
    fn clear(&mut self) {
        let Self { robot, sensor, period, phase, fired_s, kind, .. } = self;
        robot.clear();
        sensor.clear();
        period.clear();
        phase.clear();
        fired_s.clear();
        kind.clear();
        let Self { x_m, y_m, heading_rad, .. } = self;
        x_m.clear();
        y_m.clear();
        heading_rad.clear();
        let Self { t_echo_us, earliest_us, reference_us, cause, path, emitted_s, paths, .. } = self;
        self.expected_change_us.clear();
        t_echo_us.clear();
        earliest_us.clear();
        reference_us.clear();
        cause.clear();
        path.clear();
        emitted_s.clear();
        paths.clear();
    }

    /// Returns the number of readings.
    pub fn len(&self) -> usize {
        self.robot.len()
    }

    /// Returns true if there are no readings.
    pub fn is_empty(&self) -> bool {
        self.robot.is_empty()
    }

    /// Returns the sensor of a reading.
    pub fn id(&self, reading: usize) -> SensorId {
        SensorId { robot: self.robot[reading], sensor: self.sensor[reading] }
    }

    /// Returns true if the method believes the reading: an accepted echo, even a tentative one, or confirmed free
    /// space.
    pub fn is_accepted(&self, reading: usize) -> bool {
        self.is_confirmed(reading) || self.kind[reading] == ReadingKind::Tentative
    }

    /// Returns true if the method believes the reading, and not only tentatively.
    pub fn is_confirmed(&self, reading: usize) -> bool {
        matches!(self.kind[reading], ReadingKind::Accepted | ReadingKind::Clear)
    }

    /// Returns true if the reading, if believed, would be wrong: more than `tolerance_us` off the reference, an echo
    /// although the sensor alone hears none, or no echo although it hears one.
    pub fn is_wrong(&self, reading: usize, tolerance_us: f64) -> bool {
        is_off(self.t_echo_us[reading], self.reference_us[reading], tolerance_us)
    }

    /// Returns true if the firing's earliest echo is not wrong in the sense of [`is_wrong`](Self::is_wrong).
    pub fn is_good(&self, reading: usize, tolerance_us: f64) -> bool {
        !is_off(self.earliest_us[reading], self.reference_us[reading], tolerance_us)
    }

    /// Returns the path of a reading.
    pub fn path_of(&self, reading: usize) -> Option<&HeardPath> {
        self.paths.get(self.path[reading] as usize)
    }
}

fn is_off(t_echo_us: f64, reference_us: f64, tolerance_us: f64) -> bool {
    match (t_echo_us.is_nan(), reference_us.is_nan()) {
        (true, true) => false,
        (false, false) => (t_echo_us - reference_us).abs() > tolerance_us,
        _ => true,
    }
}
