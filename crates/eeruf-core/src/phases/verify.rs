//! [`PhaseVerification`]: whether firing times of many phases keep what is asked of them, and what they do not.

use super::{PhaseTable, closer};
use crate::requirements::{Least, Requirements};
use crate::time::Micros;
use crate::verify::{Violation, ViolationKind};

impl<const K: usize> PhaseTable<'_, K> {
    /// Checks the table, in `25 (K M)^2` steps: every limit, pair, phase and age.
    pub const fn verify<'r>(&self, requirements: &'r Requirements<'r>) -> PhaseVerification<'r> {
        self.verify_with(None, requirements)
    }

    /// The same where it is proven that crosstalk of all pairs moves by at least so much.
    pub(crate) const fn verify_with<'r>(
        &self,
        proven: Option<Least>,
        requirements: &'r Requirements<'r>,
    ) -> PhaseVerification<'r> {
        let (mut worst, mut separation, mut stale) = ([None; KINDS], None, None);
        let mut x = 0;
        while x < self.sensors() {
            let mut y = 0;
            while y < self.sensors() {
                let stale_echo = x == y;
                if let (Some(required), true) =
                    (requirements.separation_of(x, y), !stale_echo || requirements.stale_echo)
                {
                    let found = match proven {
                        Some(proven) if !stale_echo => Some(Least { sensors: (x as u8, y as u8), ..proven }),
                        _ => self.separation_of(x, y, requirements),
                    };
                    if stale_echo {
                        stale = closer(stale, found);
                        worst[1] = worse(worst[1], moves(ViolationKind::StaleEcho, found, required));
                    } else {
                        separation = closer(separation, found);
                        worst[0] = worse(worst[0], moves(ViolationKind::Crosstalk, found, required));
                    }
                }
                y += 1;
            }
            x += 1;
        }
        let (min_interval, min_refire) = (self.min_interval(requirements), self.min_refire());
        let worst = self.times(requirements, worst);
        PhaseVerification { requirements, separation, stale, min_interval, min_refire, worst }
    }

    /// The worst violations of what does not depend on crosstalk.
    const fn times(&self, requirements: &Requirements<'_>, mut worst: Worst) -> Worst {
        let sensors = self.sensors();
        let mut x = 0;
        while x < sensors {
            let mut phase = 0;
            while phase < self.phases() {
                let refire = self.between(x, phase, x, phase + 1);
                worst[3] = worse(worst[3], lasts(ViolationKind::Window, refire, requirements.window_of(x)));
                worst[5] = worse(worst[5], lasts(ViolationKind::Refire, refire, requirements.refire_of(x)));
                let mut y = 0;
                while y < sensors {
                    let (within, next) = (self.between(x, phase, y, phase), self.between(x, phase, y, phase + 1));
                    if let Some(required) = requirements.interval_of(sensors, x, y) {
                        worst[2] = worse(worst[2], lasts(ViolationKind::Interval, within, required));
                        worst[2] = worse(worst[2], lasts(ViolationKind::Interval, next, required));
                    }
                    if requirements.share_a_line(x, y) {
                        // The first firing of y that is no sooner than that of x.
                        let follows = if self.after(x, phase, y, phase) >= 0 { within } else { next };
                        let window = requirements.window_of(x);
                        worst[4] = worse(worst[4], lasts(ViolationKind::SharedLine, follows, window));
                    }
                    if requirements.fire_together(x, y) && within.value.as_micros() > 0 {
                        worst[6] = worse(worst[6], Some(violation(ViolationKind::Together, within, Micros::ZERO)));
                    }
                    y += 1;
                }
                phase += 1;
            }
            x += 1;
        }
        worst
    }
}

/// Crosstalk, stale echoes, intervals, windows, shared lines, refire times, sensors that fire together.
const KINDS: usize = 7;

/// The worst violation of each kind.
type Worst = [Option<Violation>; KINDS];

/// Sound that does not move as far as it must.
const fn moves(kind: ViolationKind, found: Option<Least>, required: Micros) -> Option<Violation> {
    match found {
        Some(found) => lasts(kind, found, required),
        None => None,
    }
}

/// Firings that are closer than they may be, or sound that moves less than it must.
const fn lasts(kind: ViolationKind, found: Least, required: Micros) -> Option<Violation> {
    if found.value.as_micros() < required.as_micros() { Some(violation(kind, found, required)) } else { None }
}

const fn violation(kind: ViolationKind, found: Least, required: Micros) -> Violation {
    let Least { value, sensors, phases, ages } = found;
    Violation { kind, sensors, phases, ages, value, required }
}

/// The violation that is further from what is required; the first of equal ones.
const fn worse(worst: Option<Violation>, next: Option<Violation>) -> Option<Violation> {
    match (worst, next) {
        (Some(one), Some(other)) if short_by(one) >= short_by(other) => worst,
        (_, None) => worst,
        _ => next,
    }
}

const fn short_by(violation: Violation) -> u32 {
    violation.value.as_micros().abs_diff(violation.required.as_micros())
}

/// Findings on firing times of many phases, against the requirements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhaseVerification<'r> {
    requirements: &'r Requirements<'r>,
    separation: Option<Least>,
    stale: Option<Least>,
    min_interval: Option<Least>,
    min_refire: Option<Least>,
    worst: Worst,
}

impl PhaseVerification<'_> {
    /// Returns true if every requirement holds.
    pub const fn ok(&self) -> bool {
        self.first_violation().is_none()
    }

    /// The least shift of crosstalk, and where it occurs; `None` if no path can be heard in two phases.
    pub const fn separation(&self) -> Option<Least> {
        self.separation
    }

    /// The least shift of a stale echo; `None` if none can be heard, or if it was not asked for.
    pub const fn stale_separation(&self) -> Option<Least> {
        self.stale
    }

    /// The smallest interval between neighbours, or between pairs that need one of their own; `None` without any.
    pub const fn min_interval(&self) -> Option<Least> {
        self.min_interval
    }

    /// The shortest time between two firings of one sensor; `None` without sensors.
    pub const fn min_refire(&self) -> Option<Least> {
        self.min_refire
    }

    /// The largest `t_delta` at which crosstalk - and stale echoes, if asked for - move far enough by the criterion, if
    /// all sensors have the same; `None` if none is, or if nothing limits it.
    pub const fn max_t_delta(&self) -> Option<Micros> {
        match closer(self.separation, self.stale) {
            Some(least) => self.requirements.criterion.max_t_delta(least.value),
            None => None,
        }
    }

    /// Violations, the worst of each kind.
    pub fn violations(&self) -> impl Iterator<Item = Violation> {
        self.worst.into_iter().flatten()
    }

    /// The first of them.
    pub const fn first_violation(&self) -> Option<Violation> {
        let mut kind = 0;
        while kind < KINDS {
            if self.worst[kind].is_some() {
                return self.worst[kind];
            }
            kind += 1;
        }
        None
    }
}
