//! Arguments of Set I.

use eeruf_core::Micros;
use eeruf_period::ShortestPeriod;

use super::alcove::SENSORS;
use super::multi_echo::MultiEcho;
use crate::{
    acoustics::{Physics, Transducer},
    experiments::FIRST,
    methods::Method,
    scene::Room,
    simulation::Entry,
    world::Noise,
};

/// Number of readings that the conventional method takes in the paper's experiment (Sec. 4). All other methods run for
/// the same time.
pub const READINGS: u32 = 8000;

/// Arguments of Set I.
#[derive(Clone, Debug, PartialEq)]
pub struct SetOneOptions {
    /// Number of geometries. The default is 200.
    pub seeds: u64,
    /// The first geometry's number. The default is [`FIRST`]: parameters were tuned on geometries below 2,000.
    pub first: u64,
    /// Duration of each geometry's simulation, as the number of readings that the conventional method takes in it. The
    /// default is [`READINGS`], as in the paper.
    pub readings: u32,
    /// Number of steps of the back wall, which measure latency; 0 for none. The default is 22: back and forth in each
    /// phase of a cycle of 11.
    pub steps: u32,
    /// The methods. The default is [`Method::usual`].
    pub methods: Vec<Entry>,
    /// Schedule of [`Method::EerufBest`], see [`best_schedule_for`](crate::best_schedule_for).
    pub best: Option<ShortestPeriod>,
    /// Effects in the alcoves. The default is [`Physics::DEFAULT`].
    pub physics: Physics,
    /// Floor and ceiling of the alcoves. The default is none: they are flat.
    pub room: Option<Room>,
    /// Number of sensors in the ring, 1 to 24. The default is 8.
    pub sensors: usize,
    /// The period. The default is 60 ms.
    pub period: Micros,
    /// The transducers. The default is [`Transducer::POLAROID_6500`].
    pub transducer: Transducer,
    /// Noise in the alcoves; the number of each alcove is its seed.
    pub noise: Noise,
    /// Settings of [`Method::MultiEcho`].
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
