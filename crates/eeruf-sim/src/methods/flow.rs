//! A ring that fires by flow: core's own, for a robot.

use eeruf_core::{MAX_SENSORS, flow::FlowRing, hopping::HoppingListening};

use super::method::MAX_ECHOES;
use super::ring_runner::{RingStart, SEVERAL_TRACKS, Started, TRACKS, trusting};
use crate::world::Robot;

/// A flow ring, no larger than needed.
pub(super) fn flow<'s>(start: &RingStart<'s>) -> Started<'s> {
    match start.robot.sensors.len() {
        ..=8 => ring::<8, TRACKS, 1>(start),
        9..=24 => ring::<24, TRACKS, 1>(start),
        _ => ring::<MAX_SENSORS, TRACKS, 1>(start),
    }
}

/// The same of sensors that report several echoes.
pub(super) fn several<'s>(start: &RingStart<'s>) -> Started<'s> {
    ring::<MAX_SENSORS, SEVERAL_TRACKS, MAX_ECHOES>(start)
}

fn ring<'s, const K: usize, const H: usize, const E: usize>(start: &RingStart<'s>) -> Started<'s> {
    let Robot { ref sensors, window, blanking, fleet_number, .. } = *start.robot;
    let mut settings = start.flow.with_fleet_number(fleet_number);
    settings.shortest_cycle = start.robot.period;
    let listening = HoppingListening::new(window).with_blanking(blanking);
    Ok(Box::new(trusting(FlowRing::<K, H, E>::flow(sensors.len(), settings, listening, start.now)?)))
}
