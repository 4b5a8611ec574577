// flow: one after the other, each with as much quiet as it has needed, 6.0 to 33.2 ms. An echo is believed if it
// fits the last one believed, or if two in a row agree and no other firing explains them.
// Sensors 0 to 7: hc-sr04, pulse_width, trigger 10 us, rest 60000 us, held 38000 us without an echo
use eeruf_core::flow::{BeliefSettings, TurnSettings};
use eeruf_core::{Micros, RingConfig};

// 8 sensors that fire one after the other, with 6.028 ms to 33.159 ms of quiet, listening for 24.31 ms.
// For `FlowRing::<SENSORS>::flow(SENSORS, turns(seed), BELIEF, CONFIG, now)`.
pub const SENSORS: usize = 8;

/// When sensors fire. The seed is the chip's number or another that each robot has of its own, not 0.
pub const fn turns(seed: u32) -> TurnSettings {
    let mut turns = TurnSettings::new(seed);
    turns.least = Micros::new(6_028);
    turns.most = Micros::new(33_159);
    turns.rest = Micros::new(60_000);
    turns.dice = Micros::new(2_000);
    turns
}

pub const BELIEF: BeliefSettings = {
    let mut belief = BeliefSettings::DEFAULT;
    belief.t_delta = Micros::new(80);
    belief.near = Micros::new(150);
    belief.path_change = Micros::new(150);
    belief.top_speed_mm_s = 500;
    belief.alone = false;
    belief
};

pub const CONFIG: RingConfig = RingConfig::new().with_window(Micros::new(24_310)).with_blanking(Micros::new(117));
