//! Limits of hearing between two kinds of transducers: the faintest sound and the longest path.

use crate::{
    acoustics::{LOUDEST_PANEL, Transducer},
    scene::Air,
    world::{FARTHEST, World},
};

/// Level in dB below the threshold at which sound is still considered if arrivals add. A choice.
const HEARD_TOGETHER_DB: f64 = 10.0;

/// Limits of the sound that one kind of transducer hears from another in this world.
#[derive(Clone, Copy, Debug)]
pub(super) struct HearingRange {
    sending: Transducer,
    hearing: Transducer,
    /// The least amplitude that is heard.
    pub(super) floor: f64,
    /// The faintest level that is heard if the strongest fading, or other arrivals within a burst, raise it.
    pub(super) faintest: f64,
    /// The longest path that is heard at that level, in metres.
    pub(super) longest_m: f64,
}

impl HearingRange {
    pub(super) fn new(sending: &Transducer, hearing: &Transducer, world: &World) -> Self {
        let air = world.scene().air();
        let floor = hearing.detection_floor(air);
        let fading_db = world.noise().fading_db_rms * f64::from(FARTHEST);
        let below_db = if world.physics().interference { fading_db.max(HEARD_TOGETHER_DB) } else { fading_db };
        let faintest = floor / libm::exp10(below_db / 20.0);
        let loudest = if world.physics().narrow_panels { LOUDEST_PANEL } else { 1.0 };
        let longest_m = longest_audible_m(sending, air, faintest / loudest);
        Self { sending: *sending, hearing: *hearing, floor, faintest, longest_m }
    }

    /// Returns the frequency of the sending transducer, in Hz.
    pub(super) fn frequency_hz(&self) -> f64 {
        self.sending.frequency_hz
    }

    pub(super) fn is_of(&self, sending: &Transducer, hearing: &Transducer) -> bool {
        self.sending == *sending && self.hearing == *hearing
    }
}

/// Returns the longest path, in metres, on which sound could be heard: a millimetre more than the length at which
/// spreading and the air alone reduce it to `floor`.
fn longest_audible_m(transducer: &Transducer, air: Air, floor: f64) -> f64 {
    let loss_db_per_m = air.absorption_db_per_m(transducer.frequency_hz);
    let (mut near, mut far) = (0.0, 1.0 / floor);
    while far - near > 1e-3 {
        let middle = 0.5 * (near + far);
        let heard = libm::exp10(-loss_db_per_m * middle / 20.0) / middle >= floor;
        *(if heard { &mut near } else { &mut far }) = middle;
    }
    far + 1e-3
}
