//! Effects of a world: the presets `plain` and `default`, and the individual effects.

use core::fmt;
use core::str::FromStr;

use serde::ser::{Serialize, SerializeStruct as _, Serializer};

/// Effects that a world computes. `docs/explanation/physics.md` explains each, and the source of its default.
///
/// ```
/// use eeruf_sim::Physics;
/// assert_eq!("plain".parse(), Ok(Physics::PLAIN));
/// assert_eq!(Physics { shadows: true, ..Physics::PLAIN }.name(), None);
/// assert_eq!("full".parse::<Physics>().unwrap_err().to_string(), "physics is \"full\"; expected plain or default");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Physics {
    /// True if a pole shades the space behind it when sound cannot bend around it: when its radius exceeds that of the
    /// first Fresnel zone, `sqrt(lambda d1 d2 / (d1 + d2))`. Sensors inside a pole or a wall are then refused too.
    /// Robots' bodies always shade.
    pub shadows: bool,
    /// True if the free ends of walls and the corners that jut out diffract sound, once per path and only if visible.
    pub edges: bool,
    /// True if a wall that is narrow compared with the first Fresnel zone, `sqrt(lambda r)` wide at distance r,
    /// reflects according to its width instead of like an endless wall.
    pub narrow_panels: bool,
    /// True if a threshold detector hears faint echoes later. An echo just at the threshold is heard a whole burst
    /// late.
    pub range_walk: bool,
    /// True if sounds of one firing that reach a receiver within a burst of each other add as phasors, by the phases of
    /// the carrier, and are heard when the envelope of the sum crosses the threshold; this includes `range_walk`. If
    /// false, each sound is heard on its own. False in all presets.
    pub interference: bool,
    /// Time for which a path fades in the same way, in seconds: after it, the correlation has fallen to 1/e. At 0 each
    /// firing fades independently, by its number among the firings of its sensor.
    pub fading_time_s: f64,
}

impl Physics {
    /// The simplest physics, under which methods were tuned: poles of any thickness are transparent, edges are silent,
    /// narrow walls reflect like wide ones, faint echoes are heard at their onset, and each arrival fades
    /// independently.
    pub const PLAIN: Self = Self {
        shadows: false,
        edges: false,
        narrow_panels: false,
        range_walk: false,
        interference: false,
        fading_time_s: 0.0,
    };

    /// The default of worlds: all effects except `interference`, with the numbers explained in
    /// `docs/explanation/physics.md`.
    pub const DEFAULT: Self = Self {
        shadows: true,
        edges: true,
        narrow_panels: true,
        range_walk: true,
        interference: false,
        fading_time_s: 1.0,
    };

    /// The presets by their names.
    pub const PRESETS: [(&'static str, Self); 2] = [("plain", Self::PLAIN), ("default", Self::DEFAULT)];

    /// Returns the name of this preset; `None` for other physics.
    pub fn name(&self) -> Option<&'static str> {
        Self::PRESETS.iter().find(|(_, preset)| preset == self).map(|(name, _)| *name)
    }

    /// Returns true if paths fade in the same way for a time.
    pub(crate) fn fades_slowly(&self) -> bool {
        self.fading_time_s > 0.0
    }

    /// Returns true if an echo is heard only when its envelope has risen to the threshold.
    pub(crate) fn rises(&self) -> bool {
        self.range_walk || self.interference
    }
}

/// The preset's name, or a list of the effects.
impl fmt::Display for Physics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.name(), self) {
            (Some(name), _) => f.write_str(name),
            (None, Self { shadows, edges, narrow_panels, range_walk, interference, fading_time_s }) => write!(
                f,
                "shadows {shadows}, edges {edges}, narrow_panels {narrow_panels}, range_walk {range_walk}, \
                 interference {interference}, fading_time_s {fading_time_s}"
            ),
        }
    }
}

/// The preset's name, or all effects by their names.
impl Serialize for Physics {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if let Some(name) = self.name() {
            return serializer.serialize_str(name);
        }
        let mut effects = serializer.serialize_struct("Physics", 6)?;
        effects.serialize_field("shadows", &self.shadows)?;
        effects.serialize_field("edges", &self.edges)?;
        effects.serialize_field("narrow_panels", &self.narrow_panels)?;
        effects.serialize_field("range_walk", &self.range_walk)?;
        effects.serialize_field("interference", &self.interference)?;
        effects.serialize_field("fading_time_s", &self.fading_time_s)?;
        effects.end()
    }
}

/// An unknown name of a preset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownPhysics(String);

impl fmt::Display for UnknownPhysics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "physics is {:?}; expected plain or default", self.0)
    }
}

impl core::error::Error for UnknownPhysics {}

impl FromStr for Physics {
    type Err = UnknownPhysics;

    fn from_str(name: &str) -> Result<Self, UnknownPhysics> {
        let preset = Self::PRESETS.iter().find(|(known, _)| *known == name).map(|(_, preset)| *preset);
        preset.ok_or_else(|| UnknownPhysics(name.to_owned()))
    }
}
