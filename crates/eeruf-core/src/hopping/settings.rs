//! Settings by which a hopping ring fires, believes and listens.

use crate::time::Micros;
use crate::tracker::{LATEST_ECHO, TrackerSettings};

/// Settings by which a [`HoppingRing`](super::HoppingRing) fires and believes. Begin with one of
/// [`BALANCED`](Self::BALANCED), [`QUICK`](Self::QUICK), [`DRIVING`](Self::DRIVING) and [`MAPS`](Self::MAPS);
/// `docs/explanation/hopping.md` says which is for whom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct HoppingSettings {
    /// Settings by which readings are weighed.
    pub tracker: TrackerSettings,
    /// Credit per period towards a solo period, in 1/256; 0: none is ever held.
    pub solo_rate: u8,
    /// A sensor with nothing accepted for this many firings asks for a solo period.
    pub solo_after: u8,
    /// At least this many periods from one solo period to the next; 0 counts as 1.
    pub solo_spacing: u8,
    /// After this many readings running that do not fit what is confirmed a sensor draws a new lag; 0: lags stay.
    pub shift_after: u8,
    /// At least this many periods from one change of lags to the next. All sensors that ask for a new lag get it
    /// together, since whatever is not yet confirmed then loses its support.
    pub shift_spacing: u8,
    /// Least interval between firings of neighbours when a new lag is drawn; [`Micros::ZERO`]: none. The more, the
    /// fewer lags are free.
    pub shift_interval: Micros,
    /// Number of adjacent sensors of a line that are neighbours.
    pub neighbours: u8,
}

impl HoppingSettings {
    /// For most robots.
    pub const BALANCED: Self = Self {
        tracker: TrackerSettings::BALANCED,
        solo_rate: 84,
        solo_after: 5,
        solo_spacing: 3,
        shift_after: 0,
        shift_spacing: 8,
        shift_interval: Micros::from_millis(8),
        neighbours: 4,
    };
    /// For robots that must stop early: a little more is wrong.
    pub const QUICK: Self =
        Self { tracker: TrackerSettings::QUICK, solo_rate: 100, solo_after: 4, solo_spacing: 2, ..Self::BALANCED };
    /// For robots that drive: the code and the tracker alone. What moves is not blind for long, solo periods silence
    /// all others and believe at once what another robot sends, and a new lag costs all support so far.
    pub const DRIVING: Self = Self { solo_rate: 0, shift_after: 0, ..Self::BALANCED };
    /// For maps: confirmed echoes alone, and few solo periods.
    pub const MAPS: Self = Self {
        tracker: TrackerSettings::MAPS,
        solo_rate: 28,
        solo_after: 8,
        solo_spacing: 6,
        shift_spacing: 24,
        ..Self::BALANCED
    };

    /// Weighing readings so.
    #[must_use]
    pub const fn with_tracker(self, tracker: TrackerSettings) -> Self {
        Self { tracker, ..self }
    }

    /// Earning so much of a solo period with each period, in 1/256; 0: none is ever held.
    #[must_use]
    pub const fn with_solo_rate(self, solo_rate: u8) -> Self {
        Self { solo_rate, ..self }
    }

    /// Asking for a solo period after this many firings with nothing accepted.
    #[must_use]
    pub const fn with_solo_after(self, solo_after: u8) -> Self {
        Self { solo_after, ..self }
    }

    /// With this many periods at least from one solo period to the next.
    #[must_use]
    pub const fn with_solo_spacing(self, solo_spacing: u8) -> Self {
        Self { solo_spacing, ..self }
    }

    /// Drawing a new lag after this many readings that do not fit; 0: lags stay.
    #[must_use]
    pub const fn with_shift_after(self, shift_after: u8) -> Self {
        Self { shift_after, ..self }
    }

    /// With this many periods at least from one change of lags to the next.
    #[must_use]
    pub const fn with_shift_spacing(self, shift_spacing: u8) -> Self {
        Self { shift_spacing, ..self }
    }

    /// Keeping this much between neighbours where lags are redrawn.
    #[must_use]
    pub const fn with_shift_interval(self, shift_interval: Micros) -> Self {
        Self { shift_interval, ..self }
    }

    /// With this many adjacent sensors of a line as neighbours.
    #[must_use]
    pub const fn with_neighbours(self, neighbours: u8) -> Self {
        Self { neighbours, ..self }
    }
}

impl Default for HoppingSettings {
    fn default() -> Self {
        Self::BALANCED
    }
}

/// The settings of a ring that are about firing: the tracker has the others.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Pace {
    pub(super) solo_rate: u8,
    pub(super) solo_after: u8,
    pub(super) solo_spacing: u8,
    pub(super) shift_after: u8,
    pub(super) shift_spacing: u8,
    pub(super) neighbours: u8,
    pub(super) shift_interval: Micros,
}

impl Pace {
    pub(super) const fn of(settings: &HoppingSettings) -> Self {
        let &HoppingSettings { solo_rate, solo_after, solo_spacing, shift_after, shift_spacing, .. } = settings;
        let &HoppingSettings { neighbours, shift_interval, .. } = settings;
        Self { solo_rate, solo_after, solo_spacing, shift_after, shift_spacing, neighbours, shift_interval }
    }
}

/// Settings by which a [`HoppingRing`](super::HoppingRing) listens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct HoppingListening {
    /// `T_wind`: how long a sensor listens after it has fired, at most [`MAX_WINDOW`](Self::MAX_WINDOW).
    pub window: Micros,
    /// Edges sooner than this after firing are ringing of the transducer, not echoes.
    pub blanking: Micros,
    /// After how long no sound is heard any more. A sensor fires alone once all else is silent, and no other until
    /// its own sound is.
    pub reach: Micros,
}

impl HoppingListening {
    /// The longest window, 16,711,679 us: the tracker keeps echo times in 24 bits, and later echoes would all read
    /// alike, whatever the phase.
    pub const MAX_WINDOW: Micros = LATEST_ECHO;

    /// This window, no blanking, and sound that is heard for as long as the window.
    pub const fn new(window: Micros) -> Self {
        Self { window, blanking: Micros::ZERO, reach: window }
    }

    /// Deaf for this long after firing; shorter than the window.
    #[must_use]
    pub const fn with_blanking(self, blanking: Micros) -> Self {
        Self { blanking, ..self }
    }

    /// From a firing until its sensor no longer listens, and nothing of it is heard in a window that opens then.
    pub(crate) const fn dies(&self) -> Micros {
        let dies = self.reach.saturating_sub(self.blanking);
        let dies = if dies.as_micros() > self.window.as_micros() { dies } else { self.window };
        dies.saturating_add(Micros::new(1))
    }

    /// With sound that is heard for this long.
    #[must_use]
    pub const fn with_reach(self, reach: Micros) -> Self {
        Self { reach, ..self }
    }
}
