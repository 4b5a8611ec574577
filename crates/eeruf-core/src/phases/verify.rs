//! Verifies firing times of many phases: the worst violation of each kind.

use super::PhaseTable;
use crate::requirements::{Least, Requirements};
use crate::time::Micros;
use crate::verify::{KINDS, ManyPhases, Verification, Violation, ViolationKind, closer};

impl<const K: usize> PhaseTable<'_, K> {
    /// Checks the table, in `25 (K M)^2` steps: every limit, pair, phase and age.
    pub const fn verify<'r>(&self, requirements: &'r Requirements<'r>) -> Verification<'r, K> {
        self.verify_with(None, requirements)
    }

    /// The same where it is proven that crosstalk of all pairs moves by at least so much.
    pub(crate) const fn verify_with<'r>(
        &self,
        proven: Option<Least>,
        requirements: &'r Requirements<'r>,
    ) -> Verification<'r, K> {
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
        Verification::of_many(ManyPhases { requirements, separation, stale, min_interval, min_refire, worst })
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
