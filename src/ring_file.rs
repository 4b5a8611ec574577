//! Ring files: what a designer knows of a ring, turned into what a schedule must meet.

use std::path::Path;

use eeruf_core::search::{PeriodProblem, WaitProblem};
use eeruf_core::{Criterion, Layout, MAX_SENSORS, Micros, Requirements, SpeedOfSound};
use serde::Deserialize;

use crate::input::{InputError, read_toml};

/// How the sensors stand, as files spell it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(
    untagged,
    expecting = "expected \"line\", \"ring\", \"blocks\", or pairs of neighbours such as [[0, 1], [1, 2]]"
)]
pub(crate) enum LayoutKey {
    #[default]
    #[serde(skip)]
    Unsaid,
    Named(LayoutName),
    Pairs(Vec<(usize, usize)>),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum LayoutName {
    Line,
    Ring,
    Blocks,
}

/// A layout with the rows of a graph that it may need.
#[derive(Clone, Debug)]
pub(crate) struct OwnedLayout {
    name: Option<LayoutName>,
    neighbours: u8,
    rows: Vec<u64>,
}

impl OwnedLayout {
    pub(crate) fn layout(&self) -> Layout<'_> {
        match self.name {
            Some(LayoutName::Line) => Layout::Line(self.neighbours),
            Some(LayoutName::Ring) => Layout::Ring(self.neighbours),
            Some(LayoutName::Blocks) => Layout::Blocks(self.neighbours),
            None => Layout::Graph(&self.rows),
        }
    }
}

impl LayoutKey {
    fn owned(&self, neighbours: u8, sensors: usize) -> Result<OwnedLayout, String> {
        let pairs = match self {
            Self::Unsaid => return Ok(OwnedLayout { name: Some(LayoutName::Line), neighbours, rows: vec![] }),
            &Self::Named(name) => return Ok(OwnedLayout { name: Some(name), neighbours, rows: vec![] }),
            Self::Pairs(pairs) => pairs,
        };
        let mut rows = vec![0; sensors];
        for &(x, y) in pairs {
            if x >= sensors || y >= sensors || x == y {
                return Err(format!(
                    "layout: neighbours [{x}, {y}]; expected two different sensors from 0 to {}",
                    sensors - 1
                ));
            }
            rows[x] |= 1_u64 << y;
            rows[y] |= 1_u64 << x;
        }
        Ok(OwnedLayout { name: None, neighbours, rows })
    }
}

const fn four() -> u8 {
    4
}

const fn one_millisecond() -> u32 {
    1000
}

/// A ring file for `design`: times in microseconds, or what a designer knows instead of them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RingFile {
    sensors: usize,
    #[serde(default = "four")]
    neighbours: u8,
    #[serde(default)]
    layout: LayoutKey,
    #[serde(default = "one_millisecond")]
    tick_us: u32,
    #[serde(default)]
    stale_echo: bool,
    /// T_delta itself, or the sensor's repeatability with jitter, and how fast the robot moves.
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
pub(crate) struct RingSpec {
    pub(crate) sensors: usize,
    pub(crate) tick: Micros,
    pub(crate) layout: OwnedLayout,
    pub(crate) min_interval: Micros,
    pub(crate) window: Micros,
    pub(crate) stale_echo: bool,
    pub(crate) c: SpeedOfSound,
    /// What `t_delta` must cover on a robot that stands.
    pub(crate) t_delta: Micros,
    /// How fast the robot moves, in mm/s, if `t_delta` must cover that too.
    pub(crate) speed_mm_s: Option<u32>,
}

impl RingSpec {
    /// What a schedule must meet if `t_delta` must cover this much.
    pub(crate) fn needs(&self, t_delta: Micros) -> PeriodProblem<'_> {
        let requirements = Requirements {
            t_delta,
            criterion: Criterion::Exact,
            min_interval: self.min_interval,
            layout: self.layout.layout(),
            window: self.window,
            stale_echo: self.stale_echo,
        };
        PeriodProblem { sensors: self.sensors, requirements, tick: self.tick }
    }
}

/// Reads a ring file.
pub(crate) fn read_ring(file: &Path) -> Result<RingSpec, InputError> {
    read_toml::<RingFile>(file)?.spec().map_err(|message| InputError::new(file, None, message))
}

impl RingFile {
    fn spec(&self) -> Result<RingSpec, String> {
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

/// A ring file for `search`: the paper's problem.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WaitFile {
    sensors: usize,
    period_us: u32,
    wait_max_us: u32,
    tick_us: u32,
    t_lag_us: Option<Vec<u32>>,
    t_delta_us: u32,
    #[serde(default)]
    min_interval_us: u32,
    #[serde(default = "four")]
    neighbours: u8,
    #[serde(default)]
    layout: LayoutKey,
    #[serde(default)]
    criterion: CriterionKey,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum CriterionKey {
    #[default]
    Paper,
    Exact,
}

/// What such a file asks for.
pub(crate) struct WaitSpec {
    file: WaitFile,
    layout: OwnedLayout,
    t_lag: Option<Vec<Micros>>,
}

/// Reads a ring file for `search`.
pub(crate) fn read_waits(file: &Path) -> Result<WaitSpec, InputError> {
    let waits = read_toml::<WaitFile>(file)?;
    let layout = sensors_in_range(waits.sensors)
        .and_then(|()| neighbours_in_range(waits.neighbours))
        .and_then(|()| waits.layout.owned(waits.neighbours, waits.sensors))
        .map_err(|message| InputError::new(file, None, message))?;
    let t_lag = waits.t_lag_us.as_ref().map(|lags| lags.iter().copied().map(Micros::new).collect());
    Ok(WaitSpec { file: waits, layout, t_lag })
}

impl WaitSpec {
    pub(crate) fn needs(&self) -> WaitProblem<'_> {
        let WaitFile { sensors, period_us, wait_max_us, tick_us, t_delta_us, min_interval_us, neighbours, .. } =
            self.file;
        WaitProblem {
            sensors,
            period: Micros::new(period_us),
            wait_max: Micros::new(wait_max_us),
            tick: Micros::new(tick_us),
            t_lag: self.t_lag.as_deref(),
            t_delta: Micros::new(t_delta_us),
            min_interval: Micros::new(min_interval_us),
            neighbours,
            layout: self.layout.layout(),
            criterion: match self.file.criterion {
                CriterionKey::Paper => Criterion::Paper,
                CriterionKey::Exact => Criterion::Exact,
            },
        }
    }
}

fn sensors_in_range(sensors: usize) -> Result<(), String> {
    if (1..=MAX_SENSORS).contains(&sensors) {
        Ok(())
    } else {
        Err(format!("{sensors} sensors; expected 1 to {MAX_SENSORS}"))
    }
}

fn neighbours_in_range(neighbours: u8) -> Result<(), String> {
    if (1..=MAX_SENSORS).contains(&usize::from(neighbours)) {
        Ok(())
    } else {
        Err(format!("neighbours = {neighbours}; expected 1 to {MAX_SENSORS}"))
    }
}

fn number(name: &str, value: f64, least: f64, most: f64) -> Result<f64, String> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(format!("{name} = {value}; expected {least} to {most}"))
    }
}
