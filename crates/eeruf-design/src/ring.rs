//! Ring files: a designer's description of a ring, turned into requirements on a schedule.

use std::path::Path;

use eeruf_core::{Criterion, Micros, Requirements, SensorLimits, SpeedOfSound};
use eeruf_files::{Pose, RobotRing};
use eeruf_modules::{Air, Module, ModulesFile};
use eeruf_period::PeriodProblem;
use serde::Deserialize;

use crate::each::Each;
use crate::hearing::hearing;
use crate::layout::{LayoutKey, LayoutName, OwnedLayout};
use crate::limits::{four, neighbours_in_range, number, sensors_in_range};
use crate::places::Places;
use crate::uneven::OwnedUneven;

/// Repeatability of readings of one wall on a stationary robot, for a file that names its modules and no jitter: a
/// choice.
const USUAL_JITTER_US: u32 = 100;
/// Distance in metres up to which walls make neighbours hear each other, for a file that names its modules and no
/// interval: the paper's 15 ms between neighbours.
const USUAL_CROSSTALK_RANGE_M: f64 = 2.57;

/// The longest time for which a ring can take sound to be audible, 67 s.
const MOST_AUDIBLE_US: u32 = 1 << 26;

const fn one_millisecond() -> u32 {
    1000
}

/// The place of a sensor.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlaceFile {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) z_m: Option<f64>,
    #[serde(default)]
    pub(crate) heading_deg: f64,
}

/// A ring file for `design`: times in microseconds, or the designer's figures that replace them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RingFile {
    pub(crate) sensors: usize,
    #[serde(default = "four")]
    neighbours: u8,
    #[serde(default)]
    layout: LayoutKey,
    #[serde(default = "one_millisecond")]
    tick_us: u32,
    /// Rejection of a sensor's own echo from the previous period; by default if modules are named, since they hear
    /// farther than they see.
    stale_echo: Option<bool>,
    /// The modules: they give range and rest of each sensor unless the file does.
    module: Option<ModulesFile>,
    /// `T_delta` itself, or the sensor's jitter and the robot's speed.
    pub(crate) t_delta_us: Option<Each<u32>>,
    pub(crate) jitter_us: Option<Each<u32>>,
    speed_m_s: Option<f64>,
    /// The interval itself, or the distance of walls up to which neighbours hear each other.
    min_interval_us: Option<u32>,
    crosstalk_range_m: Option<f64>,
    /// The window itself; or else the range to see, and the least time between triggers.
    pub(crate) window_us: Option<Each<u32>>,
    pub(crate) max_range_m: Option<Each<f64>>,
    pub(crate) retrigger_us: Option<Each<u32>>,
    /// The time that the controller needs for one firing; firings are at least this far apart.
    handling_us: Option<u32>,
    /// P, if it is less than `T_delta`, and R, if it is not the module's.
    path_change_us: Option<u32>,
    audible_us: Option<u32>,
    /// True if other robots may send sound, which is the default.
    others: Option<bool>,
    /// Rate at which the robot turns on the spot.
    turn_deg_s: Option<f64>,
    temperature_c: Option<f64>,
    /// Position of each sensor on the robot, or the arc on which they stand, or the robot's URDF and their links in
    /// it.
    pub(crate) poses: Option<Vec<PlaceFile>>,
    pub(crate) spacing_deg: Option<f64>,
    pub(crate) radius_m: Option<f64>,
    pub(crate) urdf: Option<String>,
    pub(crate) links: Option<Vec<String>>,
    /// Height of the robot's base above the floor.
    pub(crate) base_height_m: Option<f64>,
    /// Pairs of sensors with an interval of their own.
    #[serde(default)]
    intervals_us: Vec<(usize, usize, u32)>,
    /// Sensors that share an echo line.
    #[serde(default)]
    shared_lines: Vec<Vec<usize>>,
    /// Sensors that fire at the same instants.
    #[serde(default)]
    together: Vec<Vec<usize>>,
}

/// Requirements of a ring file.
#[derive(Clone, Debug)]
pub struct RingSpec {
    /// Number of sensors, 1 to 64.
    pub sensors: usize,
    /// Unit of time: all times are multiples of it.
    pub tick: Micros,
    /// The arrangement.
    pub layout: OwnedLayout,
    /// Number of adjacent sensors that must not fire close together.
    pub neighbours: u8,
    /// Pairs that the number of neighbours includes but that do not hear each other at their places.
    pub not_neighbours: Vec<(usize, usize)>,
    /// The least time between the firings of two neighbours (Sec. 3.1 c).
    pub min_interval: Micros,
    /// `T_wind`, the listening time of a sensor; the longest if sensors have their own.
    pub window: Micros,
    /// The range to see, as an echo time and without the rest between triggers; the longest if sensors have their own.
    pub listening: Micros,
    /// True if `listening` comes from the modules, not from the file.
    pub sees_by_module: bool,
    /// Least time between two triggers, if all sensors are alike; zero if they have their own.
    pub retrigger: Micros,
    /// True if a sensor's own echo from the previous period must be rejected too.
    pub stale_echo: bool,
    /// True if only the modules require `stale_echo`.
    pub stale_echo_by_module: bool,
    /// The speed of sound.
    pub c: SpeedOfSound,
    /// The change that `t_delta` must cover on a stationary robot; the largest if sensors have their own.
    pub t_delta: Micros,
    /// Speed of the robot, in mm/s, if `t_delta` must cover its motion too.
    pub speed_mm_s: Option<u32>,
    /// The time that the controller needs for one firing; firings planned closer together happen one after the other.
    pub handling: Micros,
    /// P: the largest change of a foreign sound's path from one reading to the next on a stationary robot; `None` for
    /// `t_delta`.
    pub path_change: Option<Micros>,
    /// R: how long sound is audible, if the file gives it.
    pub audible: Option<Micros>,
    /// True if other robots, whose firings are unknown, may be near.
    pub others: bool,
    /// True if the file says that other robots are near.
    pub meets_others: bool,
    /// The rate at which the robot turns on the spot, in degrees a second, if the file gives it.
    pub turn_deg_s: Option<f64>,
    /// The module of each sensor, if the file names them, with the file's rest.
    pub modules: Vec<Module>,
    /// Place of each sensor on the robot, if the file gives it.
    pub places: Places,
    /// Needs of single sensors and pairs, where they are not all alike.
    pub uneven: Option<OwnedUneven>,
}

/// A figure of the modules, one for all or one for each.
fn each<T>(modules: &ModulesFile, figure: impl Fn(&Module) -> T) -> Each<T> {
    match modules {
        ModulesFile::All(module) => Each::All(figure(module)),
        ModulesFile::Of(list) => Each::Of(list.iter().map(figure).collect()),
    }
}

impl RingSpec {
    /// Returns the ring with a `t_delta` that covers this much; sensors' own ones all grow by the same amount.
    #[must_use]
    pub fn covering(&self, t_delta: Micros) -> Self {
        let more = t_delta.saturating_sub(self.t_delta);
        let uneven = self.uneven.as_ref().map(|uneven| uneven.with_t_deltas(|t_delta| t_delta.saturating_add(more)));
        let path_change = self.path_change.map(|change| change.saturating_add(more));
        Self { t_delta, uneven, path_change, ..self.clone() }
    }

    /// Requirements on a schedule.
    pub fn problem(&self) -> PeriodProblem<'_> {
        let requirements = Requirements {
            t_delta: self.t_delta,
            criterion: Criterion::Exact,
            min_interval: self.min_interval,
            layout: self.layout.layout(),
            window: self.window,
            blanking: Micros::ZERO,
            audible: self.audible,
            stale_echo: self.stale_echo,
            uneven: self.uneven.as_ref().map(OwnedUneven::uneven),
        };
        PeriodProblem { sensors: self.sensors, requirements, tick: self.tick }
    }

    /// Requirements in the form that a table of two phases passes to its ring, with P included.
    pub fn table_requirements(&self) -> Requirements<'_> {
        let requirements = self.problem().requirements;
        let more = |path_change: Micros| path_change.saturating_add(Micros::new(1));
        let criterion = self.path_change.map_or(requirements.criterion, |change| Criterion::Margin(more(change)));
        Requirements { criterion, ..requirements }
    }

    /// The ring in the form that scenes take.
    pub fn robot_ring(&self) -> RobotRing {
        let requirements = self.problem().requirements;
        let limits = (0..self.sensors).map(|sensor| SensorLimits {
            t_delta: requirements.t_delta_of(sensor),
            // A rest before the next trigger is not listening time.
            window: requirements.window_of(sensor).min(self.listening),
        });
        RobotRing {
            sensors: self.sensors,
            poses: self.places.poses.clone(),
            heights_m: self.places.heights_m(),
            modules: self.modules.clone(),
            limits: limits.collect(),
            together: requirements.uneven.map_or(vec![], |uneven| uneven.together.to_vec()),
            speed_m_s: f64::from(self.speed_mm_s.unwrap_or(0)) / 1e3,
            neighbours: self.neighbours,
            path_change: self.path_change,
            audible: self.audible,
        }
    }
}

impl RingFile {
    /// The layout, less the pairs that do not hear each other off walls up to `crosstalk_m` away, if the file names
    /// modules and their places. The default layout is then a ring, since it is known which sensors hear each other.
    fn neighbours_by_places(
        &self,
        poses: &[Pose],
        modules: &[Module],
        air: Air,
        crosstalk_m: f64,
    ) -> Result<(OwnedLayout, Vec<(usize, usize)>), String> {
        let layout = |key: &LayoutKey| key.owned(self.neighbours, self.sensors);
        if poses.is_empty() || modules.is_empty() || crosstalk_m == 0.0 || !self.layout.counts_neighbours() {
            return Ok((layout(&self.layout)?, vec![]));
        }
        let widest = match self.layout {
            LayoutKey::Unsaid => layout(&LayoutKey::Named(LayoutName::Ring))?,
            _ => layout(&self.layout)?,
        };
        Ok(widest.of_those_that_hear(&hearing(poses, modules, air, crosstalk_m)))
    }

    /// Requirements of this ring file, or of a text without a file, or the first error.
    pub(crate) fn spec(&self, file: Option<&Path>) -> Result<RingSpec, String> {
        sensors_in_range(self.sensors)?;
        neighbours_in_range(self.neighbours)?;
        let celsius = number("temperature_c", self.temperature_c.unwrap_or(20.0), -100.0, 100.0)?;
        let c = SpeedOfSound::at_celsius_tenths((10.0 * celsius).round() as i16);
        let metres = |name, metres: f64| -> Result<Micros, String> {
            let mm = (1000.0 * number(name, metres, 0.0, 1000.0)?).round();
            Ok(c.echo_time(mm as u32))
        };
        let speed =
            |speed| -> Result<u32, String> { Ok((1000.0 * number("speed_m_s", speed, 0.0, 100.0)?).round() as u32) };
        let turn_deg_s = self.turn_deg_s.map(|deg_s| number("turn_deg_s", deg_s, 0.0, 1000.0)).transpose()?;
        let sensors = self.sensors;
        let (t_delta, speed_mm_s) = match (&self.t_delta_us, &self.jitter_us, self.speed_m_s) {
            (Some(t_delta), None, None) => (t_delta.list("t_delta_us", sensors)?, None),
            (None, Some(jitter), None) => (jitter.list("jitter_us", sensors)?, None),
            (None, Some(jitter), Some(metres)) => (jitter.list("jitter_us", sensors)?, Some(speed(metres)?)),
            (None, None, metres) if self.module.is_some() => {
                (vec![USUAL_JITTER_US; sensors], metres.map(speed).transpose()?)
            }
            (None, None, _) => {
                let message = "module: missing; expected `module = \"hc-sr04\"` or another, or t_delta_us or jitter_us";
                return Err(message.to_owned());
            }
            _ => return Err("expected either t_delta_us, or jitter_us with or without speed_m_s".to_owned()),
        };
        let t_delta: Vec<Micros> = t_delta.into_iter().map(Micros::new).collect();
        let min_interval = match (self.min_interval_us, self.crosstalk_range_m) {
            (Some(us), None) => Micros::new(us),
            (None, Some(range)) => metres("crosstalk_range_m", range)?,
            (None, None) if self.module.is_some() => metres("crosstalk_range_m", USUAL_CROSSTALK_RANGE_M)?,
            _ => return Err("expected either min_interval_us or crosstalk_range_m".to_owned()),
        };
        let mut modules = self.module.as_ref().map(|modules| modules.list(sensors)).transpose()?.unwrap_or_default();
        let of_modules = self.module.as_ref().filter(|_| self.window_us.is_none());
        let max_range_m = self.max_range_m.clone().or(of_modules.map(|them| each(them, Module::sees_to_m)));
        let retrigger_us = self.retrigger_us.clone().or(of_modules.map(|them| each(them, |module| module.rest_us)));
        let window: Vec<Micros> = match (&self.window_us, &max_range_m) {
            (Some(us), None) => us.list("window_us", sensors)?.into_iter().map(Micros::new).collect(),
            (None, Some(range)) => {
                let range = range.list("max_range_m", sensors)?.into_iter().map(|range| metres("max_range_m", range));
                range.collect::<Result<_, _>>()?
            }
            _ => return Err("expected one of window_us, max_range_m and module".to_owned()),
        };
        let refire = retrigger_us.as_ref().map(|us| us.list("retrigger_us", sensors)).transpose()?;
        let refire: Vec<Micros> = refire.unwrap_or_default().into_iter().map(Micros::new).collect();
        if let Some(rest) = &self.retrigger_us {
            for (module, rest_us) in modules.iter_mut().zip(rest.list("retrigger_us", sensors)?) {
                module.rest_us = rest_us;
            }
        }
        let path_change = self.path_change_us.map(Micros::new);
        let least_t_delta = t_delta.iter().copied().min().unwrap_or_default();
        if let Some(change) = path_change.filter(|&change| change == Micros::ZERO || change > least_t_delta) {
            return Err(format!(
                "path_change_us = {}; expected 1 to the smallest T_delta of a robot that stands, {}; a larger T_delta \
                 allows more",
                change.as_micros(),
                least_t_delta.as_micros()
            ));
        }
        if let Some(us) = self.audible_us.filter(|us| !(1..=MOST_AUDIBLE_US).contains(us)) {
            return Err(format!("audible_us = {us}; expected 1 to {MOST_AUDIBLE_US}"));
        }
        let lists = [self.t_delta_us.as_ref(), self.jitter_us.as_ref(), self.window_us.as_ref()];
        let are_lists = lists.into_iter().chain([retrigger_us.as_ref()]).flatten().any(Each::is_list)
            || max_range_m.as_ref().is_some_and(Each::is_list);
        let pairs = !(self.intervals_us.is_empty() && self.shared_lines.is_empty() && self.together.is_empty());
        let is_uneven = are_lists || pairs;
        let largest = |times: &[Micros]| times.iter().copied().max().unwrap_or_default();
        let largest_t_delta = largest(&t_delta);
        // If all sensors are alike, they listen until they may be triggered again.
        let largest_window = if is_uneven { largest(&window) } else { largest(&window).max(largest(&refire)) };
        if largest_window == Micros::ZERO || (is_uneven && window.contains(&Micros::ZERO)) {
            return Err("a listening window of 0 us; expected window_us or max_range_m above zero".to_owned());
        }
        let (intervals, lines, together) = (&self.intervals_us, &self.shared_lines, &self.together);
        let (listening, retrigger) = (largest(&window), if is_uneven { Micros::ZERO } else { largest(&refire) });
        let uneven = || OwnedUneven::new(sensors, [t_delta, window, refire], intervals, lines, together);
        let uneven = is_uneven.then(uneven).transpose()?;
        let places = self.places(file)?;
        let crosstalk_m = f64::from(c.distance_mm(min_interval)) / 1e3;
        let (layout, not_neighbours) =
            self.neighbours_by_places(&places.poses, &modules, Air::at(celsius), crosstalk_m)?;
        let spec = RingSpec {
            sensors: self.sensors,
            tick: Micros::new(self.tick_us),
            layout,
            neighbours: self.neighbours,
            not_neighbours,
            min_interval,
            window: largest_window,
            listening,
            sees_by_module: self.window_us.is_none() && self.max_range_m.is_none(),
            retrigger,
            stale_echo: self.stale_echo.unwrap_or(self.module.is_some()),
            stale_echo_by_module: self.stale_echo.is_none(),
            c,
            t_delta: largest_t_delta,
            speed_mm_s,
            handling: Micros::new(self.handling_us.unwrap_or(0)),
            path_change,
            audible: self.audible_us.map(Micros::new),
            others: self.others.unwrap_or(true),
            meets_others: self.others == Some(true),
            turn_deg_s,
            modules,
            places,
            uneven,
        };
        OwnedUneven::can_fire_together(&spec.problem().requirements, sensors)?;
        Ok(spec)
    }
}
