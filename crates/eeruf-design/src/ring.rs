//! Ring files: what a designer knows of a ring, turned into what a schedule must meet.

use eeruf_core::search::PeriodProblem;
use eeruf_core::{Criterion, Micros, Requirements, SpeedOfSound};
use serde::Deserialize;

use crate::layout::{LayoutKey, OwnedLayout};
use crate::limits::{four, neighbours_in_range, number, sensors_in_range};
use crate::text::{TextError, parse};

const fn one_millisecond() -> u32 {
    1000
}

/// A ring file for `design`: times in microseconds, or what a designer knows instead of them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RingFile {
    sensors: usize,
    #[serde(default = "four")]
    neighbours: u8,
    #[serde(default)]
    layout: LayoutKey,
    #[serde(default = "one_millisecond")]
    tick_us: u32,
    #[serde(default)]
    stale_echo: bool,
    /// `T_delta` itself, or the sensor's repeatability with jitter, and how fast the robot moves.
    t_delta_us: Option<u32>,
    jitter_us: Option<u32>,
    speed_m_s: Option<f64>,
    /// The interval itself, or how far walls may be from which neighbours hear each other.
    min_interval_us: Option<u32>,
    crosstalk_range_m: Option<f64>,
    /// The window itself, or the range to see, and how soon a sensor may be triggered again.
    window_us: Option<u32>,
    max_range_m: Option<f64>,
    retrigger_us: Option<u32>,
    temperature_c: Option<f64>,
}

/// What a ring file asks for.
#[derive(Clone, Debug)]
pub struct RingSpec {
    /// How many sensors, 1 to 64.
    pub sensors: usize,
    /// All times are multiples of this.
    pub tick: Micros,
    /// How they stand.
    pub layout: OwnedLayout,
    /// The least time between the firings of two neighbours (Sec. 3.1 c).
    pub min_interval: Micros,
    /// `T_wind`: how long a sensor listens.
    pub window: Micros,
    /// Whether a sensor's own echo from the period before must be rejected too.
    pub stale_echo: bool,
    /// How fast sound is.
    pub c: SpeedOfSound,
    /// What `t_delta` must cover on a robot that stands.
    pub t_delta: Micros,
    /// How fast the robot moves, in mm/s, if `t_delta` must cover that too.
    pub speed_mm_s: Option<u32>,
}

impl RingSpec {
    /// Reads the text of a ring file.
    ///
    /// # Errors
    /// The first thing wrong with it.
    pub fn from_text(text: &str) -> Result<Self, TextError> {
        Ok(parse::<RingFile>(text)?.spec()?)
    }

    /// What a schedule must meet if `t_delta` must cover this much.
    pub fn problem(&self, t_delta: Micros) -> PeriodProblem<'_> {
        let requirements = Requirements {
            t_delta,
            criterion: Criterion::Exact,
            min_interval: self.min_interval,
            layout: self.layout.layout(),
            window: self.window,
            stale_echo: self.stale_echo,
            uneven: None,
        };
        PeriodProblem { sensors: self.sensors, requirements, tick: self.tick }
    }
}

impl RingFile {
    /// What it asks for.
    ///
    /// # Errors
    /// The first thing wrong with it: the key, its value and what is expected.
    pub fn spec(&self) -> Result<RingSpec, String> {
        sensors_in_range(self.sensors)?;
        neighbours_in_range(self.neighbours)?;
        let celsius = number("temperature_c", self.temperature_c.unwrap_or(20.0), -100.0, 100.0)?;
        let c = SpeedOfSound::at_celsius_tenths((10.0 * celsius).round() as i16);
        let metres = |name, metres: f64| -> Result<Micros, String> {
            let mm = (1000.0 * number(name, metres, 0.0, 1000.0)?).round();
            Ok(c.echo_time(mm as u32))
        };
        let (t_delta, speed_mm_s) = match (self.t_delta_us, self.jitter_us, self.speed_m_s) {
            (Some(t_delta), None, None) => (t_delta, None),
            (None, Some(jitter), None) => (jitter, None),
            (None, Some(jitter), Some(speed)) => {
                (jitter, Some((1000.0 * number("speed_m_s", speed, 0.0, 100.0)?).round() as u32))
            }
            _ => return Err("expected either t_delta_us, or jitter_us with or without speed_m_s".to_owned()),
        };
        let min_interval = match (self.min_interval_us, self.crosstalk_range_m) {
            (Some(us), None) => Micros::new(us),
            (None, Some(range)) => metres("crosstalk_range_m", range)?,
            _ => return Err("expected either min_interval_us or crosstalk_range_m".to_owned()),
        };
        let window = match (self.window_us, self.max_range_m, self.retrigger_us) {
            (Some(us), None, None) => Micros::new(us),
            (None, Some(range), retrigger) => {
                metres("max_range_m", range)?.max(Micros::new(retrigger.unwrap_or_default()))
            }
            _ => return Err("expected either window_us, or max_range_m with or without retrigger_us".to_owned()),
        };
        if window == Micros::ZERO {
            return Err("a listening window of 0 us; expected window_us or max_range_m above zero".to_owned());
        }
        Ok(RingSpec {
            sensors: self.sensors,
            tick: Micros::new(self.tick_us),
            layout: self.layout.owned(self.neighbours, self.sensors)?,
            min_interval,
            window,
            stale_echo: self.stale_echo,
            c,
            t_delta: Micros::new(t_delta),
            speed_mm_s,
        })
    }
}
