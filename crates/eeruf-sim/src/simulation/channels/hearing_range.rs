//! Limits of hearing: how faint the sound of one kind of transducer may be, and how far it may come, to be heard by
//! another.

use crate::{
    acoustics::{LOUDEST_PANEL, Transducer},
    scene::Air,
    world::{FARTHEST, World},
};

/// Sound that is farther below the threshold is not counted where arrivals add. A choice.
const HEARD_TOGETHER_DB: f64 = 10.0;

/// Sound that a kind of transducer hears of a kind in this world.
#[derive(Clone, Copy, Debug)]
pub(super) struct HearingRange {
    sending: Transducer,
    hearing: Transducer,
    /// The amplitude that is just heard.
    pub(super) floor: f64,
    /// The faintest level that is heard if the strongest fading lifts it, or others that come within a burst.
    pub(super) faintest: f64,
    /// The longest path that is heard then, in metres.
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

    /// Frequency of what is sent, in Hz.
    pub(super) fn frequency_hz(&self) -> f64 {
        self.sending.frequency_hz
    }

    pub(super) fn is_of(&self, sending: &Transducer, hearing: &Transducer) -> bool {
        self.sending == *sending && self.hearing == *hearing
    }
}

/// The longest path that sound could be heard after, in metres: a millimetre more than where it has fallen to `floor`
/// without any loss but spreading and the air's.
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
