//! The verifier: checks a [`Schedule`] against its [`Requirements`] and names every violation.
//!
//! Everything the search returns is checked here, by code that shares nothing with the search. Nothing is stored: a
//! [`Verification`] borrows the schedule, and its violations are computed as they are read.

use core::fmt;

use crate::requirements::{Least, Requirements, shorter};
use crate::schedule::{Phase, Schedule};
use crate::time::Micros;

impl<const K: usize> Schedule<K> {
    /// Checks the schedule against `requirements`: see [`Verification`].
    pub const fn verify<'r>(&'r self, requirements: &'r Requirements<'r>) -> Verification<'r, K> {
        Verification(TwoPhases { schedule: self, requirements })
    }
}

/// The findings of [`Schedule::verify`]: firing times checked against requirements. Findings are computed on demand,
/// not stored.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Verification<'r, const K: usize>(TwoPhases<'r, K>);

impl<'r, const K: usize> Verification<'r, K> {
    /// Returns true if every requirement holds.
    pub const fn ok(&self) -> bool {
        self.first_violation().is_none()
    }

    /// The least shift of crosstalk by (13a), (13b), with the two sensors where it occurs. Sensors that must fire
    /// together need no separation and do not count. `None` for a single sensor.
    pub const fn separation(&self) -> Option<Least> {
        self.0.separation()
    }

    /// The least shift of a stale echo; `None` if stale echoes need not be rejected.
    pub const fn stale_separation(&self) -> Option<Least> {
        self.0.stale_separation()
    }

    /// The largest common `t_delta` for which crosstalk (and stale echoes, if asked for) moves far enough by the
    /// criterion; `None` if none does.
    #[doc(alias = "T_delta")]
    pub const fn max_t_delta(&self) -> Option<Micros> {
        let least = match closer(self.separation(), self.stale_separation()) {
            Some(least) => least.value,
            None => Micros::MAX,
        };
        self.0.requirements.criterion.max_t_delta(least)
    }

    /// The smallest interval between neighbours or, if pairs have intervals of their own, between two sensors that need
    /// one; `None` if there are none.
    pub const fn min_interval(&self) -> Option<Least> {
        self.0.min_interval()
    }

    /// The shortest time between two firings of one sensor; [`Micros::MAX`] without sensors.
    pub const fn min_refire(&self) -> Micros {
        self.0.schedule.min_refire()
    }

    /// All violations: first crosstalk by (13a), then by (13b), then stale echoes, intervals, windows, shared echo
    /// lines, sensors triggered too soon, and sensors that must fire together.
    pub const fn violations(&self) -> impl Iterator<Item = Violation> + Clone + use<'r, K> {
        self.one_by_one()
    }

    const fn one_by_one(&self) -> Violations<'r, K> {
        Violations { of: self.0, check: 0, x: 0, y: 0, phase: 0 }
    }

    /// The first violation.
    pub const fn first_violation(&self) -> Option<Violation> {
        self.one_by_one().advance()
    }
}

/// A schedule of two phases, and the requirements.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct TwoPhases<'r, const K: usize> {
    schedule: &'r Schedule<K>,
    requirements: &'r Requirements<'r>,
}

impl<const K: usize> TwoPhases<'_, K> {
    const fn separation(&self) -> Option<Least> {
        if self.requirements.uneven.is_none() {
            return self.schedule.separation(self.requirements.criterion);
        }
        let mut least: Option<Least> = None;
        let mut x = 0;
        while x < self.schedule.sensors() {
            let mut y = x + 1;
            while y < self.schedule.sensors() {
                let (even, odd) = self.schedule.left_sides(self.requirements.criterion, x, y);
                let value = if even.as_micros() < odd.as_micros() { even } else { odd };
                let is_less = match least {
                    Some(least) => value.as_micros() < least.value.as_micros(),
                    None => true,
                };
                if is_less && !self.requirements.fire_together(x, y) {
                    least = Some(Least::of_two_phases(value, x, y));
                }
                y += 1;
            }
            x += 1;
        }
        least
    }

    const fn stale_separation(&self) -> Option<Least> {
        let (mut least, mut x) = (None, 0);
        while self.requirements.stale_echo && x < self.schedule.sensors() {
            let value = stale_separation(self.schedule, x);
            least = closer(least, Some(Least::of_two_phases(value, x, x)));
            x += 1;
        }
        least
    }

    const fn min_interval(&self) -> Option<Least> {
        let sensors = self.schedule.sensors();
        if self.requirements.uneven.is_none() {
            return self.schedule.min_interval(self.requirements.layout);
        }
        let mut least: Option<Least> = None;
        let mut x = 0;
        while x < sensors {
            let mut y = 0;
            while y < sensors {
                if self.requirements.interval_of(sensors, x, y).is_some() {
                    let mut phase = 0;
                    while phase < 2 {
                        if x < y {
                            least = shorter(least, self.schedule.interval_within(x, y, phase));
                        }
                        least = shorter(least, self.schedule.interval_across(x, y, phase));
                        phase += 1;
                    }
                }
                y += 1;
            }
            x += 1;
        }
        least
    }
}

/// The lesser of two; the first if they are equal.
const fn closer(least: Option<Least>, next: Option<Least>) -> Option<Least> {
    match (least, next) {
        (Some(one), Some(other)) if one.value.as_micros() <= other.value.as_micros() => least,
        (_, None) => least,
        _ => next,
    }
}

pub(crate) const fn stale_separation<const K: usize>(schedule: &Schedule<K>, sensor: usize) -> Micros {
    Micros::new(2 * schedule.shift_us(sensor).unsigned_abs())
}

/// The requirement that is violated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ViolationKind {
    /// Crosstalk an even number of periods old would pass: Eq. (13a).
    CrosstalkA,
    /// Crosstalk an odd number of periods old would pass: Eq. (13b).
    CrosstalkB,
    /// A sensor's own echo from the previous period would pass.
    StaleEcho,
    /// Two neighbours fire too close together: Sec. 3.1 c.
    Interval,
    /// A sensor fires again while it still listens.
    Window,
    /// A sensor fires while another one listens on the same echo line.
    SharedLine,
    /// A sensor fires again sooner than it may be triggered.
    Refire,
    /// Two sensors that must fire together do not.
    Together,
}

impl ViolationKind {
    /// A short name, as `--json` and Python spell it.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::CrosstalkA => "crosstalk_a",
            Self::CrosstalkB => "crosstalk_b",
            Self::StaleEcho => "stale_echo",
            Self::Interval => "interval",
            Self::Window => "window",
            Self::SharedLine => "shared_line",
            Self::Refire => "refire",
            Self::Together => "together",
        }
    }

    /// Returns the source of the requirement.
    pub const fn source(self) -> &'static str {
        match self {
            Self::CrosstalkA => "Eq. (13a)",
            Self::CrosstalkB | Self::StaleEcho => "Eq. (13b)",
            Self::Interval => "Sec. 3.1 c",
            Self::Window | Self::SharedLine => "T_wind",
            Self::Refire => "refire",
            Self::Together => "together",
        }
    }
}

/// One requirement that does not hold. `{}` counts sensors from 1, `{:#}` from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Violation {
    /// The requirement.
    pub kind: ViolationKind,
    /// The sensors concerned, from 0; the same twice if there is only one.
    pub sensors: (u8, u8),
    /// The phases of the firings; for crosstalk and stale echoes both `a`.
    pub phases: (Phase, Phase),
    /// The time found.
    pub value: Micros,
    /// The least time that would suffice; 0, and only 0, for two sensors that must fire together.
    pub required: Micros,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = u8::from(!f.alternate());
        let (x, y) = (self.sensors.0 + first, self.sensors.1 + first);
        let (value, required, source) = (self.value, self.required, self.kind.source());
        match self.kind {
            ViolationKind::CrosstalkA | ViolationKind::CrosstalkB => write!(
                f,
                "crosstalk between sensors {x} and {y} moves by {value} from one reading to the next; \
                 to be rejected it needs at least {required} ({source})"
            ),
            ViolationKind::StaleEcho => write!(
                f,
                "an echo of sensor {x} from the period before moves by {value} from one reading to the next; \
                 to be rejected it needs at least {required} ({source} with x = y)"
            ),
            ViolationKind::Interval if self.phases.0 == self.phases.1 => write!(
                f,
                "sensors {x} and {y} fire {value} apart in phase {}; neighbours need at least {required} ({source})",
                self.phases.0
            ),
            ViolationKind::Interval => write!(
                f,
                "sensors {x} and {y} fire {value} apart between phases {} and {}; neighbours need at least {required} \
                 ({source})",
                self.phases.0, self.phases.1
            ),
            ViolationKind::Window => write!(
                f,
                "sensor {x} fires again {value} after phase {}; it listens for {required} ({source})",
                self.phases.0
            ),
            ViolationKind::SharedLine => write!(
                f,
                "sensor {y} fires {value} after sensor {x} fired in phase {}; on the echo line that they share sensor \
                 {x} listens for {required} ({source})",
                self.phases.0
            ),
            ViolationKind::Refire => write!(
                f,
                "sensor {x} fires again {value} after phase {}; it must not be triggered within {required}",
                self.phases.0
            ),
            ViolationKind::Together => {
                write!(f, "sensors {x} and {y} fire {value} apart in phase {}; they must fire together", self.phases.0)
            }
        }
    }
}

/// The violations of a [`Verification`], one after the other.
#[derive(Clone)]
struct Violations<'r, const K: usize> {
    of: TwoPhases<'r, K>,
    check: u8,
    x: usize,
    y: usize,
    phase: usize,
}

impl<const K: usize> Violations<'_, K> {
    /// `Iterator::next` as a `const fn`, so that a table can be checked when it is compiled.
    const fn advance(&mut self) -> Option<Violation> {
        while self.check < 10 {
            let found = self.examine();
            self.step();
            if found.is_some() {
                return found;
            }
        }
        None
    }

    /// Advances to the next sensor `y`, then the next `x`, phase and check.
    const fn step(&mut self) {
        let sensors = self.of.schedule.sensors();
        self.y += 1;
        if self.y == sensors {
            self.y = 0;
            self.x += 1;
        }
        if self.x == sensors {
            self.x = 0;
            self.phase += 1;
        }
        if self.phase == 2 {
            self.phase = 0;
            self.check += 1;
        }
    }

    const fn examine(&self) -> Option<Violation> {
        let (schedule, requirements) = (self.of.schedule, self.of.requirements);
        let (x, y, phase) = (self.x, self.y, self.phase);
        let pair = x < y && phase == 0;
        let phases = (Phase(phase as u8), Phase(phase as u8));
        let sensors = (x as u8, y as u8);
        let (kind, phases, value, required) = match self.check {
            0 | 1 if pair => {
                let Some(separation) = requirements.separation_of(x, y) else { return None };
                let (even, odd) = schedule.left_sides(requirements.criterion, x, y);
                if self.check == 0 {
                    (ViolationKind::CrosstalkA, phases, even, separation)
                } else {
                    (ViolationKind::CrosstalkB, phases, odd, separation)
                }
            }
            2 if requirements.stale_echo && x == y && phase == 0 => {
                let Some(separation) = requirements.separation_of(x, x) else { return None };
                (ViolationKind::StaleEcho, phases, stale_separation(schedule, x), separation)
            }
            3 | 4 if x < y || self.check == 4 => {
                let Some(required) = requirements.interval_of(schedule.sensors(), x, y) else { return None };
                let within = self.check == 3;
                let interval =
                    if within { schedule.interval_within(x, y, phase) } else { schedule.interval_across(x, y, phase) };
                (ViolationKind::Interval, interval.phases, interval.value, required)
            }
            5 if x == y => (ViolationKind::Window, phases, schedule.refire(phase, x), requirements.window_of(x)),
            6 | 7 if requirements.share_a_line(x, y) => {
                let (first, second) = (schedule.fire_at(phase, x), schedule.fire_at(phase, y));
                let interval = if self.check == 7 {
                    schedule.interval_across(x, y, phase)
                } else if first.as_micros() <= second.as_micros() {
                    schedule.interval_within(x, y, phase)
                } else {
                    return None;
                };
                (ViolationKind::SharedLine, interval.phases, interval.value, requirements.window_of(x))
            }
            8 if x == y => (ViolationKind::Refire, phases, schedule.refire(phase, x), requirements.refire_of(x)),
            9 if x < y && requirements.fire_together(x, y) => {
                let apart = schedule.interval_within(x, y, phase).value;
                if apart.as_micros() == 0 {
                    return None;
                }
                return Some(Violation {
                    kind: ViolationKind::Together,
                    sensors,
                    phases,
                    value: apart,
                    required: Micros::ZERO,
                });
            }
            _ => return None,
        };
        if value.as_micros() >= required.as_micros() {
            return None;
        }
        Some(Violation { kind, sensors, phases, value, required })
    }
}

impl<const K: usize> Iterator for Violations<'_, K> {
    type Item = Violation;

    fn next(&mut self) -> Option<Violation> {
        self.advance()
    }
}
