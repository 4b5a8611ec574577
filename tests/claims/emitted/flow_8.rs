// Sensors 0 to 7: hc-sr04, pulse_width, trigger 10 us, rest 60000 us, held 38000 us without an echo
use eeruf_core::{Micros, flow::FlowSettings, hopping::HoppingListening};

// 8 sensors that fire by flow, in cycles of at least 60.001 ms, listening for 23.31 ms.
// For `FlowRing::<SENSORS>::flow(SENSORS, SETTINGS, LISTENING, now)`.
pub const SENSORS: usize = 8;

pub const SETTINGS: FlowSettings = {
    let mut settings = FlowSettings::DEFAULT;
    settings.shortest_cycle = Micros::new(60_001);
    settings.rest = Micros::new(60_000);
    settings
};

pub const LISTENING: HoppingListening =
    HoppingListening::new(Micros::new(23_310)).with_blanking(Micros::new(117)).with_reach(Micros::new(23_310));
