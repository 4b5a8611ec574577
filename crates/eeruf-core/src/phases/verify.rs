//! [`PhaseVerification`]: whether firing times of many phases keep what is asked of them, and what they do not.

use core::fmt;

use super::{Audible, PhaseInterval, PhaseSeparation, PhaseTable};
use crate::layout::Layout;
use crate::time::Micros;

/// The shift of crosstalk that is required from phase to phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum PhaseCriterion {
    /// `2 T_delta + 1 us`, as in (13a) and (13b).
    Exact,
    /// `T_delta` and this margin: it is all that jitter and lateness may use. A
    /// [`HoppingRing`](crate::hopping::HoppingRing) lets a reading whose firing was later by more than half of it
    /// support nothing.
    Margin(Micros),
}

/// Requirements on firing times of many phases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhaseRequirements<'a> {
    /// `T_delta`: a reading supports a track that it differs from by no more.
    pub t_delta: Micros,
    /// The shift that crosstalk must have.
    pub criterion: PhaseCriterion,
    /// The audible part of a path. No sensor may fire again within its window.
    pub audible: Audible,
    /// The least time between the firings of two neighbours (Sec. 3.1 c).
    pub min_interval: Micros,
    /// Pairs of neighbours.
    pub layout: Layout<'a>,
    /// True if a sensor's own sound from earlier periods must move too.
    pub stale_echo: bool,
}

impl PhaseRequirements<'_> {
    /// The exact criterion; four neighbours of a line, which keep no interval; sound that is heard for as long as the
    /// window.
    pub const fn new(t_delta: Micros, window: Micros) -> Self {
        Self {
            t_delta,
            criterion: PhaseCriterion::Exact,
            audible: Audible::new(window),
            min_interval: Micros::ZERO,
            layout: Layout::Line(4),
            stale_echo: false,
        }
    }

    /// `D`: by how much crosstalk must move from phase to phase.
    pub const fn separation(&self) -> Micros {
        match self.criterion {
            PhaseCriterion::Exact => self.t_delta.saturating_add(self.t_delta).saturating_add(Micros::new(1)),
            // Crosstalk that moves by no more than `T_delta` is supported.
            PhaseCriterion::Margin(Micros::ZERO) => self.t_delta.saturating_add(Micros::new(1)),
            PhaseCriterion::Margin(margin) => self.t_delta.saturating_add(margin),
        }
    }
}

impl<const K: usize> PhaseTable<'_, K> {
    /// Checks the table, in `25 (K M)^2` steps.
    pub const fn verify<'r>(&self, requirements: &'r PhaseRequirements<'r>) -> PhaseVerification<'r> {
        let audible = &requirements.audible;
        let stale = if requirements.stale_echo { self.stale_separation(audible) } else { None };
        PhaseVerification::new(requirements, self.separation(audible), stale, self)
    }
}

/// Findings on firing times of many phases, against the requirements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhaseVerification<'r> {
    requirements: &'r PhaseRequirements<'r>,
    separation: Option<PhaseSeparation>,
    stale: Option<PhaseSeparation>,
    min_interval: Option<PhaseInterval>,
    min_refire: Option<PhaseInterval>,
}

impl<'r> PhaseVerification<'r> {
    pub(crate) const fn new<const K: usize>(
        requirements: &'r PhaseRequirements<'r>,
        separation: Option<PhaseSeparation>,
        stale: Option<PhaseSeparation>,
        table: &PhaseTable<'_, K>,
    ) -> Self {
        let min_interval = table.min_interval(requirements.layout);
        Self { requirements, separation, stale, min_interval, min_refire: table.min_refire() }
    }

    /// Returns true if every requirement holds.
    pub const fn ok(&self) -> bool {
        self.violation(0).is_none()
            && self.violation(1).is_none()
            && self.violation(2).is_none()
            && self.violation(3).is_none()
    }

    /// The least shift of crosstalk, and where it occurs; `None` if no path can be heard in two phases.
    pub const fn separation(&self) -> Option<PhaseSeparation> {
        self.separation
    }

    /// The least shift of a stale echo; `None` if none can be heard, or if it was not asked for.
    pub const fn stale_separation(&self) -> Option<PhaseSeparation> {
        self.stale
    }

    /// The smallest interval between neighbours; `None` without neighbours.
    pub const fn min_interval(&self) -> Option<PhaseInterval> {
        self.min_interval
    }

    /// The shortest time between two firings of one sensor; `None` without sensors.
    pub const fn min_refire(&self) -> Option<PhaseInterval> {
        self.min_refire
    }

    /// The largest `t_delta` at which crosstalk - and stale echoes, if asked for - move far enough by the criterion;
    /// `None` if none is, or if nothing limits it.
    pub const fn max_t_delta(&self) -> Option<Micros> {
        let least = match (self.separation, self.stale) {
            (Some(one), Some(other)) if other.value.as_micros() < one.value.as_micros() => other.value,
            (Some(one), _) | (None, Some(one)) => one.value,
            (None, None) => return None,
        };
        let most = match self.requirements.criterion {
            PhaseCriterion::Exact => match least.as_micros().checked_sub(1) {
                Some(twice) => Some(twice / 2),
                None => None,
            },
            PhaseCriterion::Margin(Micros::ZERO) => least.as_micros().checked_sub(1),
            PhaseCriterion::Margin(margin) => least.as_micros().checked_sub(margin.as_micros()),
        };
        match most {
            Some(most) => Some(Micros::new(most)),
            None => None,
        }
    }

    /// Violations, the worst of each kind.
    pub const fn violations(&self) -> PhaseViolations<'r> {
        PhaseViolations { verification: *self, next: 0 }
    }

    const fn violation(&self, check: u8) -> Option<PhaseViolation> {
        let requirements = self.requirements;
        let separation = requirements.separation();
        match check {
            0 => match self.separation {
                Some(found) if found.value.as_micros() < separation.as_micros() => {
                    Some(PhaseViolation::Crosstalk { found, required: separation })
                }
                _ => None,
            },
            1 => match self.stale {
                Some(found) if found.value.as_micros() < separation.as_micros() => {
                    Some(PhaseViolation::StaleEcho { found, required: separation })
                }
                _ => None,
            },
            2 => match self.min_interval {
                Some(found) if found.value.as_micros() < requirements.min_interval.as_micros() => {
                    Some(PhaseViolation::Interval { found, required: requirements.min_interval })
                }
                _ => None,
            },
            _ => match self.min_refire {
                Some(found) if found.value.as_micros() < requirements.audible.window.as_micros() => {
                    Some(PhaseViolation::Window { found, required: requirements.audible.window })
                }
                _ => None,
            },
        }
    }
}

/// One requirement that firing times of many phases do not keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PhaseViolation {
    /// Crosstalk would be believed.
    Crosstalk {
        /// The least by which it moves.
        found: PhaseSeparation,
        /// The shift required.
        required: Micros,
    },
    /// A sensor's own echo from an earlier period would be believed.
    StaleEcho {
        /// The least by which it moves.
        found: PhaseSeparation,
        /// The shift required.
        required: Micros,
    },
    /// Two neighbours fire too close together: Sec. 3.1 c.
    Interval {
        /// The smallest interval.
        found: PhaseInterval,
        /// The least that would do.
        required: Micros,
    },
    /// A sensor fires again while it still listens.
    Window {
        /// The shortest time between two firings of a sensor.
        found: PhaseInterval,
        /// The window.
        required: Micros,
    },
}

impl PhaseViolation {
    /// A short name, as `--json` and Python spell it.
    pub const fn as_str(&self) -> &'static str {
        match self {
            Self::Crosstalk { .. } => "crosstalk",
            Self::StaleEcho { .. } => "stale_echo",
            Self::Interval { .. } => "interval",
            Self::Window { .. } => "window",
        }
    }

    /// Where the requirement comes from.
    pub const fn source(&self) -> &'static str {
        match self {
            Self::Crosstalk { .. } => "Eqs. (13a), (13b) for many phases",
            Self::StaleEcho { .. } => "Eq. (13b) with x = y",
            Self::Interval { .. } => "Sec. 3.1 c",
            Self::Window { .. } => "T_wind",
        }
    }
}

impl fmt::Display for PhaseViolation {
    /// Sensors from 1; from 0 with `{:#}`. Phases from 0.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = u8::from(!f.alternate());
        match self {
            Self::Crosstalk { found, required } | Self::StaleEcho { found, required } => {
                let PhaseSeparation { value, sensors: (x, y), phases: (m, n), ages: (i, j) } = found;
                write!(
                    f,
                    "sound of sensor {} moves by {value} for sensor {} from phase {} ({i} periods old) to phase {} \
                     ({j} periods old); expected {required}",
                    x + first,
                    y + first,
                    m.0,
                    n.0
                )
            }
            Self::Interval { found, required } => {
                let PhaseInterval { value, sensors: (x, y), phases: (m, n) } = found;
                write!(
                    f,
                    "neighbours {} in phase {} and {} in phase {} fire {value} apart; expected {required}",
                    x + first,
                    m.0,
                    y + first,
                    n.0
                )
            }
            Self::Window { found, required } => {
                let PhaseInterval { value, sensors: (x, _), phases: (m, n) } = found;
                write!(
                    f,
                    "sensor {} fires {value} after itself from phase {} to phase {}; expected its window of {required}",
                    x + first,
                    m.0,
                    n.0
                )
            }
        }
    }
}

/// Violations: see [`PhaseVerification::violations`].
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhaseViolations<'r> {
    verification: PhaseVerification<'r>,
    next: u8,
}

impl PhaseViolations<'_> {
    /// The next one; `Iterator::next` for constants.
    pub const fn advance(&mut self) -> Option<PhaseViolation> {
        while self.next < 4 {
            let found = self.verification.violation(self.next);
            self.next += 1;
            if found.is_some() {
                return found;
            }
        }
        None
    }
}

impl Iterator for PhaseViolations<'_> {
    type Item = PhaseViolation;

    fn next(&mut self) -> Option<PhaseViolation> {
        self.advance()
    }
}
