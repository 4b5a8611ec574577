//! A robot: its transducers, its place and motion, its clock, and the settings of its firing and listening.

use eeruf_core::{
    EachSensor, Layout, MAX_SENSORS, Micros, Requirements, SensorLimits, SpeedOfSound, Uneven, VerifiedSchedule,
    conditions::Violation,
};

use eeruf_files::AnySchedule;
use eeruf_modules::{HC_SR04, Module, POLAROID_6500, PRESETS};

use super::clock::Clock;
use super::motion::Motion;
use super::sketch::Sketch;
use crate::{
    acoustics::{Beam, GainProfile, Transducer},
    geometry::{Pose, Vector, pose_of},
    scene::{Body, DEFAULT_HEIGHT_M},
};

/// Largest number of robots in one world: a choice beyond any use, since more is a mistake in the input.
pub const MAX_ROBOTS: usize = 64;
/// A robot with its ring. Make one with [`Robot::ring`], then change the fields that differ.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Place and heading of each sensor relative to the robot, 1 to 64 of them.
    pub sensors: Vec<Pose>,
    /// The kind of transducer. Robots hear each other if their [bands overlap](Transducer::hears); the bands of the
    /// presets do not.
    pub transducer: Transducer,
    /// The module of each sensor; [`transducer`](Self::transducer) then belongs to the first one. Empty, the default,
    /// if that transducer describes all sensors.
    pub modules: Vec<Module>,
    /// The outline, which reflects and shades the sound of others and may not overlap a wall, a pole or another body.
    /// For the robot's own sensors it only blocks sound from behind. The default is none: the robot is transparent, and
    /// the disc of [`radius_m`](Self::radius_m) must be free.
    pub body: Option<Body>,
    /// Level in dB of the sound that the mounting carries straight from one of the sensors to another, relative to two
    /// sensors that face each other at the same distance. The transducers' patterns count if they are louder. `None`,
    /// the default, for a mounting that carries no sound.
    pub coupling_db: Option<f64>,
    /// The height of each sensor above the floor in metres, if the scene has a [room](crate::Room). Empty, the default,
    /// for [`DEFAULT_HEIGHT_M`].
    pub heights_m: Vec<f64>,
    /// Pose of the robot at the start.
    pub pose: Pose,
    /// Motion from the start pose on.
    pub motion: Motion,
    /// The clock.
    pub clock: Clock,
    /// True if the ring must expect other robots even if the world has none. The default is false: the robot knows if
    /// it is alone. Then a moving robot with [`Method::Flow`](crate::Method::Flow) believes each echo.
    pub others: bool,
    /// Delay from the start of the simulation, by the robot's clock, until its ring begins to fire.
    pub start: Micros,
    /// The schedule that the `eeruf` methods use; `None` for the paper's own (see
    /// [`table_i_d_for`](crate::table_i_d_for)).
    pub schedule: Option<AnySchedule>,
    /// `T_p`, for all methods that do not have their own schedule. The default is 60 ms.
    pub period: Micros,
    /// `T_delta`: the greatest difference of near-identical consecutive readings. The default is 0.5 ms.
    pub t_delta: Micros,
    /// `T_wind`: the time for which a sensor listens. The default is 36 ms, for 6.2 m.
    pub window: Micros,
    /// Deaf time of a sensor after it has fired; the shortest if sensors differ.
    pub blanking: Micros,
    /// Deaf time of each sensor, if they differ. Empty by default.
    pub blankings: Vec<Micros>,
    /// With immediate refiring, the least time from a sensor's echo to its next firing. The default is 36 ms, its
    /// listening time: with much less it hears its last sound fade away in the room, just after blanking, every time.
    pub min_refire: Micros,
    /// Number of adjacent sensors that must not fire close together; the conventional lags repeat after this number.
    /// The default is 4.
    pub neighbours: u8,
    /// Number of consecutive readings that must agree, 2 to 8. The default is 2, as in the paper.
    pub consecutive: u8,
    /// Window and `T_delta` of each sensor, if they differ, for the robot's own [`schedule`](Self::schedule). Other
    /// methods use [`window`](Self::window) and [`t_delta`](Self::t_delta) for all sensors, which are then the largest
    /// values. Empty by default.
    pub limits: Vec<SensorLimits>,
    /// The settings of a sketch that fires the robot's ring.
    pub firing: Sketch,
    /// Time for which methods that fire one by one assume sound to be audible. The default is 0, for as long as sensors
    /// listen; [`with_modules`](Self::with_modules) sets the modules' own time.
    pub audible: Micros,
    /// Listening time with flow, for a robot too fast to wait for everything that its modules hear. `None`, the
    /// default, for its window.
    pub reach: Option<Micros>,
    /// P: the largest change of a foreign sound's path from one reading to the next, for rings that fire by tables.
    /// `None`, the default, for [`t_delta`](Self::t_delta).
    pub path_change: Option<Micros>,
    /// Sets of sensors that the robot's own schedule fires together, bit x for sensor x.
    pub together: Vec<u64>,
    /// True if odometry gives the ring the expected change of a good reading by the robot's own motion.
    pub odometry: bool,
}

impl Robot {
    /// Makes a robot with `sensors` transducers `spacing_rad` apart on an arc of radius `radius_m`, its middle ahead.
    ///
    /// ```
    /// use eeruf_sim::{Pose, Robot, Transducer};
    /// let robot = Robot::ring(Pose::identity(), 8, 15f64.to_radians(), 0.3, Transducer::POLAROID_6500);
    /// assert!((robot.sensors[0].rotation.angle() + 52.5f64.to_radians()).abs() < 1e-12);
    /// assert_eq!(robot.blanking.as_micros(), 2380);
    /// ```
    pub fn ring(pose: Pose, sensors: usize, spacing_rad: f64, radius_m: f64, transducer: Transducer) -> Self {
        let first_rad = -0.5 * spacing_rad * sensors.saturating_sub(1) as f64;
        Self::with_sensors(
            pose,
            ring_of(&Pose::identity(), sensors, radius_m, first_rad, spacing_rad).collect(),
            transducer,
        )
    }

    /// Makes a robot with transducers at any places relative to it.
    pub fn with_sensors(pose: Pose, sensors: Vec<Pose>, transducer: Transducer) -> Self {
        Self {
            sensors,
            transducer,
            modules: vec![],
            body: None,
            coupling_db: None,
            heights_m: vec![],
            pose,
            motion: Motion::Still,
            clock: Clock::default(),
            others: false,
            start: Micros::ZERO,
            schedule: None,
            period: Micros::from_millis(60),
            t_delta: Micros::new(500),
            window: Micros::from_millis(36),
            blanking: Micros::new((transducer.blanking_s * 1e6).round() as u32),
            blankings: vec![],
            min_refire: Micros::from_millis(36),
            neighbours: 4,
            consecutive: 2,
            limits: vec![],
            firing: Sketch::default(),
            audible: Micros::ZERO,
            reach: None,
            path_change: None,
            together: vec![],
            odometry: false,
        }
    }

    /// Returns true if the robot's sensors are not all alike.
    pub(crate) fn is_uneven(&self) -> bool {
        !self.limits.is_empty() || !self.together.is_empty()
    }

    /// Verifies that a schedule rejects crosstalk with each sensor's `T_delta`; returns it with all sensors' limits.
    ///
    /// # Errors
    /// The first condition that the schedule violates.
    pub fn verified(
        &self,
        schedule: &AnySchedule,
    ) -> Result<VerifiedSchedule<MAX_SENSORS, 2, EachSensor<MAX_SENSORS>>, Violation> {
        self.asking(Micros::MAX, |requirements| schedule.verified_each(requirements))
    }

    /// Calls a function with the sensors' requirements, with no `t_delta` above `most`.
    pub(crate) fn asking<T>(&self, most: Micros, answer: impl FnOnce(&Requirements<'_>) -> T) -> T {
        let t_delta: Vec<_> = self.limits.iter().map(|limits| limits.t_delta.min(most)).collect();
        let window: Vec<_> = self.limits.iter().map(|limits| limits.window).collect();
        let uneven = Uneven { t_delta: &t_delta, window: &window, together: &self.together, ..Uneven::NONE };
        answer(&Requirements {
            layout: Layout::Line(1),
            window: self.window,
            uneven: self.is_uneven().then_some(uneven),
            ..Requirements::new(self.t_delta.min(most))
        })
    }

    /// Returns the robot with its sensors at these heights in metres, one each. If all are [`DEFAULT_HEIGHT_M`], none
    /// are stored, so that equal robots compare as equal.
    #[must_use]
    pub fn with_heights(self, heights_m: Vec<f64>) -> Self {
        let usual = heights_m.len() == self.sensors.len() && heights_m.iter().all(|&it| it == DEFAULT_HEIGHT_M);
        Self { heights_m: if usual { vec![] } else { heights_m }, ..self }
    }

    /// Returns the robot with these modules, one for each sensor, with their deaf times, and sound
    /// [audible](Self::audible) for as long as they hear it at 20 degrees C.
    ///
    /// ```
    /// use eeruf_sim::{Pose, Robot, Transducer, modules::{HC_SR04, PING}};
    /// let robot = Robot::ring(Pose::identity(), 2, 0.3, 0.2, Transducer::HC_SR04).with_modules(vec![HC_SR04, PING]);
    /// assert_eq!([0, 1].map(|sensor| robot.blanking_of(sensor).as_micros()), [117, 115]);
    /// assert_eq!([0, 1].map(|sensor| robot.transducer_of(sensor).max_range_m), [4.0, 3.0]);
    /// ```
    #[must_use]
    pub fn with_modules(mut self, modules: Vec<Module>) -> Self {
        let Some(first) = modules.first().copied() else { return self };
        self.transducer = Transducer::of(&first);
        let alike = modules.iter().all(|module| *module == first);
        let blankings = modules.iter().map(|module| Micros::new(module.blanking_us)).collect();
        let hears = modules.iter().map(|module| SpeedOfSound::AT_20_CELSIUS.echo_time(module.hears_to_mm)).max();
        self.audible = hears.unwrap_or_default();
        // Modules are kept only if they differ in more than their transducer, so that equal robots compare as equal.
        self.modules.clear();
        if !(alike && self.module_of(0) == first) {
            self.modules = modules;
        }
        self.with_blankings(blankings)
    }

    /// Returns the robot with this gain and this pattern near 90 degrees for all sensors; `None` keeps their own.
    #[must_use]
    pub fn with_pattern(mut self, gain: Option<GainProfile>, beam: Option<Beam>) -> Self {
        let own = self.transducer;
        self.transducer = Transducer { gain: gain.unwrap_or(own.gain), beam: beam.unwrap_or(own.beam), ..own };
        for module in &mut self.modules {
            *module = Module { gain: gain.unwrap_or(module.gain), beam: beam.unwrap_or(module.beam), ..*module };
        }
        self
    }

    /// Sets the blanking time of each sensor.
    #[must_use]
    pub fn with_blankings(mut self, blankings: Vec<Micros>) -> Self {
        self.blanking = blankings.iter().copied().min().unwrap_or(self.blanking);
        let alike = blankings.iter().all(|&blanking| blanking == self.blanking);
        self.blankings = if alike && blankings.len() == self.sensors.len() { vec![] } else { blankings };
        self
    }

    /// Returns the transducer of a sensor.
    pub fn transducer_of(&self, sensor: usize) -> Transducer {
        self.modules.get(sensor).map_or(self.transducer, Transducer::of)
    }

    /// Returns the transducers of all sensors.
    pub fn transducers(&self) -> impl Iterator<Item = Transducer> + '_ {
        (0..self.sensors.len()).map(|sensor| self.transducer_of(sensor))
    }

    /// Returns the deaf time of a sensor after it has fired.
    pub fn blanking_of(&self, sensor: usize) -> Micros {
        self.blankings.get(sensor).copied().unwrap_or(self.blanking)
    }

    /// Returns the module of a sensor: its own, or the preset of its transducer, or the nearest equivalent.
    pub fn module_of(&self, sensor: usize) -> Module {
        if let Some(module) = self.modules.get(sensor) {
            return *module;
        }
        let Transducer { gain, beam, .. } = self.transducer;
        let known = PRESETS.iter().map(|&preset| Module { gain, beam, ..*preset });
        let known = known.into_iter().find(|module| Transducer::of(module) == self.transducer);
        known.unwrap_or_else(|| {
            let like = if self.transducer.frequency_hz > 45e3 { POLAROID_6500 } else { HC_SR04 };
            self.transducer.described(&like)
        })
    }

    /// Returns the longest rest from trigger to trigger that one of the robot's modules needs.
    pub fn module_rest(&self) -> Micros {
        (0..self.sensors.len()).map(|sensor| Micros::new(self.module_of(sensor).rest_us)).max().unwrap_or_default()
    }

    /// Returns the robot with its settings for flow. With a [`reach`](Self::reach), its quiet lasts no longer than the
    /// reach and the tail, so the robot never believes a single echo, even alone.
    #[must_use]
    pub fn by_flow(self) -> Self {
        let Some(reach) = self.reach.filter(|&reach| reach < self.window) else { return self };
        let tail = Micros::new(reach.as_micros() / 9 * 2);
        Self { window: reach, audible: reach.saturating_add(tail), others: true, ..self }
    }

    /// Returns the height of a sensor above the floor, in metres.
    pub fn height_m(&self, sensor: usize) -> f64 {
        self.heights_m.get(sensor).copied().unwrap_or(DEFAULT_HEIGHT_M)
    }

    /// Returns the amplitude for [`coupling_db`](Self::coupling_db); 0 without coupling.
    pub(crate) fn coupling(&self) -> f64 {
        self.coupling_db.map_or(0.0, |db| libm::exp10(db / 20.0))
    }

    /// Returns the radius in metres of the smallest disc about the robot's middle that contains all its sensors.
    pub fn radius_m(&self) -> f64 {
        self.sensors.iter().map(|sensor| offset(sensor).norm()).fold(0.0, f64::max)
    }

    /// Returns the outline that must be free: the body, or without one the disc that contains all sensors.
    pub fn outline(&self) -> Body {
        // A body without extent still needs a free place.
        self.body.unwrap_or(Body::Disc(self.radius_m().max(1e-6)))
    }
}

/// Returns the position of a sensor relative to its robot's middle.
pub(crate) fn offset(sensor: &Pose) -> Vector {
    sensor.translation.vector
}

/// Returns transducers evenly spread over an arc of a circle, facing outwards.
///
/// `pose` is the robot's pose. The first sensor stands `first_rad` from its heading, each next one `spacing_rad`
/// further.
///
/// ```
/// use eeruf_sim::{Pose, ring_of};
/// let ring: Vec<_> = ring_of(&Pose::identity(), 24, 0.3, 0.0, 15f64.to_radians()).collect();
/// assert!((ring[6].translation.y - 0.3).abs() < 1e-15);
/// ```
pub fn ring_of(
    pose: &Pose,
    sensors: usize,
    radius_m: f64,
    first_rad: f64,
    spacing_rad: f64,
) -> impl Iterator<Item = Pose> {
    let pose = *pose;
    eeruf_files::arc(sensors, radius_m, first_rad, spacing_rad).map(move |sensor| pose * pose_of(&sensor))
}
