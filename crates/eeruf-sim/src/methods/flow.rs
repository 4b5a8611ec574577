//! A ring that fires by flow: core's own, for a robot.

use eeruf_core::{MAX_SENSORS, flow::FlowRing, hopping::HoppingListening};

use super::ring_runner::{RingStart, Started};
use crate::world::Robot;

/// Tracks of each sensor where it reports one echo of a firing.
const TRACKS: usize = 4;

/// A flow ring, no larger than needed.
pub(super) fn flow<'s>(start: &RingStart<'s>) -> Started<'s> {
    match start.robot.sensors.len() {
        ..=8 => ring::<8>(start),
        9..=24 => ring::<24>(start),
        _ => ring::<MAX_SENSORS>(start),
    }
}

fn ring<'s, const K: usize>(start: &RingStart<'s>) -> Started<'s> {
    let Robot { ref sensors, window, blanking, fleet_number, .. } = *start.robot;
    let mut settings = start.flow.with_fleet_number(fleet_number);
    settings.shortest_cycle = start.robot.period;
    let listening = HoppingListening::new(window).with_blanking(blanking);
    Ok(Box::new(FlowRing::<K, TRACKS>::flow(sensors.len(), settings, listening, start.now)?))
}
