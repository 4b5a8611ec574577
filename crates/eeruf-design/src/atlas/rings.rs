//! Rings of the atlas.

use core::fmt;
use core::str::FromStr;

use eeruf_core::{Layout, MAX_SENSORS, Micros, Requirements};
use eeruf_period::PeriodProblem;

/// The sensors that are neighbours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Neighbourhood {
    /// All sensors are neighbours, as in any short line or ring.
    All,
    /// Any n adjacent sensors of a line.
    Line(u8),
    /// Any n adjacent sensors of a ring.
    Ring(u8),
}

/// A ring of sensors that are all alike, in whole ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ring {
    /// Number of sensors.
    pub sensors: u8,
    /// The sensors that are neighbours.
    pub neighbourhood: Neighbourhood,
    /// Least difference of the refire times of any two: the smallest number of ticks above `2 t_delta`.
    pub separation: u32,
    /// Interval between firings of neighbours.
    pub interval: u32,
    /// Listening time of each sensor.
    pub window: u32,
}

/// Largest number of sensors of a ring in the atlas.
const MOST_SENSORS: u8 = 32;
/// Number of adjacent sensors that are neighbours.
const NEIGHBOURS: core::ops::RangeInclusive<u8> = 2..=6;
/// Separations for readings near-identical below 0.5 ms, and below the paper's 1 ms, in ticks of 1 ms.
const SEPARATIONS: [u32; 2] = [1, 2];
/// The paper's 15 ms.
const INTERVAL: u32 = 15;
/// Windows, in order: an HC-SR04 up to 4 m; the paper's; an HC-SR04 until it releases its line; modules that fire 20
/// times a second; Polaroid's and others that see 11 m.
const WINDOWS: [u32; 5] = [25, 30, 40, 50, 65];

/// All rings of the atlas in order, of 2 to 32 sensors.
#[must_use]
pub fn all_rings() -> Vec<Ring> {
    let mut rings = Vec::new();
    for sensors in 2..=MOST_SENSORS {
        let layouts = NEIGHBOURS.flat_map(|n| [Layout::Line(n), Layout::Ring(n)]);
        let mut neighbourhoods: Vec<Neighbourhood> =
            layouts.filter_map(|layout| Neighbourhood::of(&layout, sensors)).collect();
        neighbourhoods.sort_unstable();
        neighbourhoods.dedup();
        for neighbourhood in neighbourhoods {
            for separation in SEPARATIONS {
                rings.extend(WINDOWS.map(|window| Ring {
                    sensors,
                    neighbourhood,
                    separation,
                    interval: INTERVAL,
                    window,
                }));
            }
        }
    }
    rings
}

/// Returns true if the ring with this number belongs to shard `shard` of `shards`; numbers and shards count from 0.
#[must_use]
pub fn is_in_shard(number: usize, shard: usize, shards: usize) -> bool {
    number % shards.max(1) == shard
}

impl Neighbourhood {
    /// Neighbourhood of a layout, whatever its name; `None` if the atlas has no such neighbourhood.
    #[must_use]
    pub fn of(layout: &Layout<'_>, sensors: u8) -> Option<Self> {
        let count = usize::from(sensors);
        let named = NEIGHBOURS.flat_map(|n| [Self::Line(n), Self::Ring(n)]);
        let rows = layout.rows(count);
        core::iter::once(Self::All).chain(named).find(|candidate| candidate.layout(sensors).rows(count) == rows)
    }

    /// Returns the layout of a ring with this many sensors.
    #[must_use]
    pub fn layout(self, sensors: u8) -> Layout<'static> {
        match self {
            Self::All => Layout::Line(sensors),
            Self::Line(n) => Layout::Line(n),
            Self::Ring(n) => Layout::Ring(n),
        }
    }
}

impl Ring {
    /// The ring of a problem; `None` if its sensors differ, or if no ring of the atlas has its needs.
    #[must_use]
    pub fn of(problem: &PeriodProblem<'_>) -> Option<Self> {
        let PeriodProblem { sensors, requirements, tick } = *problem;
        let sensors = u8::try_from(sensors).ok().filter(|&sensors| sensors <= MOST_SENSORS)?;
        if requirements.uneven.is_some() || requirements.stale_echo || tick == Micros::ZERO {
            return None;
        }
        requirements.layout.check(usize::from(sensors)).ok()?;
        let ticks = |time: Micros| time.as_micros().div_ceil(tick.as_micros());
        let separation = 2 * u64::from(requirements.t_delta.as_micros()) / u64::from(tick.as_micros()) + 1;
        let separation = u32::try_from(separation).ok().filter(|ticks| SEPARATIONS.contains(ticks))?;
        let (interval, window) = (ticks(requirements.min_interval), ticks(requirements.window));
        if interval != INTERVAL || !WINDOWS.contains(&window) {
            return None;
        }
        let neighbourhood = Neighbourhood::of(&requirements.layout, sensors)?;
        Some(Self { sensors, neighbourhood, separation, interval, window })
    }

    /// Requirements on a schedule, in ticks of 1 ms.
    #[must_use]
    pub fn problem(&self) -> PeriodProblem<'static> {
        let requirements = Requirements {
            min_interval: Micros::from_millis(self.interval),
            window: Micros::from_millis(self.window),
            layout: self.neighbourhood.layout(self.sensors),
            ..Requirements::new(Micros::new((1000 * self.separation - 1) / 2))
        };
        PeriodProblem { sensors: usize::from(self.sensors), requirements, tick: Micros::from_millis(1) }
    }
}

impl fmt::Display for Ring {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { sensors, neighbourhood, separation, interval, window } = self;
        let (layout, neighbours) = match neighbourhood {
            Neighbourhood::All => ("all", sensors),
            Neighbourhood::Line(n) => ("line", n),
            Neighbourhood::Ring(n) => ("ring", n),
        };
        write!(f, "{sensors} {layout} {neighbours} {separation} {interval} {window}")
    }
}

impl FromStr for Ring {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let bad = || format!("{text:?}; expected a ring such as 12 line 4 2 15 30");
        let words: Vec<&str> = text.split(' ').collect();
        let [sensors, layout, neighbours, separation, interval, window] = words[..] else { return Err(bad()) };
        let number = |word: &str| word.parse::<u32>().map_err(|_| bad());
        let small = |word: &str| word.parse::<u8>().ok().filter(|&n| usize::from(n) <= MAX_SENSORS).ok_or_else(bad);
        let neighbourhood = match layout {
            "all" => Neighbourhood::All,
            "line" => Neighbourhood::Line(small(neighbours)?),
            "ring" => Neighbourhood::Ring(small(neighbours)?),
            _ => return Err(bad()),
        };
        Ok(Self {
            sensors: small(sensors)?,
            neighbourhood,
            separation: number(separation)?,
            interval: number(interval)?,
            window: number(window)?,
        })
    }
}
