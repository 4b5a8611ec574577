//! What is asked of Set I.

use eeruf_core::{Micros, hopping::HoppingSettings};

use super::alcove::SENSORS;
use super::multi_echo::MultiEcho;
use crate::{
    acoustics::{Physics, Transducer},
    experiments::FIRST,
    methods::{BestSchedule, Method},
    scene::Room,
    simulation::Entry,
    world::Noise,
};

/// How many readings the paper has of one set-up (Sec. 4): of the conventional method, and of all others in that time.
pub const READINGS: u32 = 8000;

/// What is asked of Set I.
#[derive(Clone, Debug, PartialEq)]
pub struct SetOneOptions {
    /// How many geometries. The default is 200.
    pub seeds: u64,
    /// The first geometry's number. The default is [`FIRST`]: parameters were tuned on geometries below 2,000.
    pub first: u64,
    /// For how long each geometry is simulated: as long as so many readings of the conventional method take. The
    /// default is [`READINGS`], as in the paper.
    pub readings: u32,
    /// How often the back wall steps to and fro, for the figures of how soon that is seen; 0: never. The default is
    /// 22: to and fro in each phase of a cycle of 11.
    pub steps: u32,
    /// The methods. The default is [`Method::usual`].
    pub methods: Vec<Entry>,
    /// What [`Method::EerufBest`] fires by, see [`best_schedule_for`](crate::best_schedule_for).
    pub best: Option<BestSchedule>,
    /// How [`Method::EerufHopping`] fires and believes, unless its entry says.
    pub hopping: HoppingSettings,
    /// Which effects the alcoves have. The default is [`Physics::DEFAULT`].
    pub physics: Physics,
    /// Floor and ceiling of the alcoves. The default is none: they are flat.
    pub room: Option<Room>,
    /// How many sensors the ring has, 1 to 24. The default is 8.
    pub sensors: usize,
    /// Its period. The default is 60 ms.
    pub period: Micros,
    /// Its transducers. The default is [`Transducer::POLAROID_6500`].
    pub transducer: Transducer,
    /// How noisy the alcoves are; each has its own number as seed.
    pub noise: Noise,
    /// What [`Method::MultiEcho`] fires and believes by.
    pub multi_echo: MultiEcho,
}

impl Default for SetOneOptions {
    fn default() -> Self {
        Self {
            seeds: 200,
            first: FIRST,
            readings: READINGS,
            steps: 22,
            methods: Entry::all(Method::usual()),
            best: None,
            hopping: HoppingSettings::BALANCED,
            physics: Physics::DEFAULT,
            room: None,
            sensors: SENSORS,
            period: Micros::from_millis(60),
            transducer: Transducer::POLAROID_6500,
            noise: Noise::default(),
            multi_echo: MultiEcho::TUNED,
        }
    }
}
