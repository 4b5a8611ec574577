//! Robots that stand or drive in alcoves of Set I and in other rooms.

use std::error::Error;

use eeruf_sim::experiments::rooms::RoomKind::{Aisle, Clutter, Corridor, Garage, Hall, Office};
use eeruf_sim::experiments::rooms::{RoomKind, RoomPlan};
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::{Motion, Physics, Vector, World};

/// Rooms with one robot in them.
const ROOMS: [RoomKind; 6] = [Corridor, Office, Hall, Clutter, Garage, Aisle];
const SPEED_M_S: f64 = 0.5;

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Place {
    Alcove,
    Room,
}

/// Makes the world of a robot that drives and knows its motion.
pub(crate) fn world(number: u64, place: Place, physics: Physics) -> Result<World, Box<dyn Error>> {
    let alcove = Alcove::random(number);
    let mut robot = alcove.robot();
    robot.odometry = true;
    let world = match place {
        Place::Alcove => {
            let turn_rad_s = if number.is_multiple_of(2) { 0.04 } else { -0.04 };
            robot.motion = Motion::Constant { velocity: Vector::new(0.0, -0.015), turn_rad_s };
            World::new(alcove.scene()?, vec![robot], eeruf_sim::Noise::default())?.with_seed(number)
        }
        Place::Room => {
            let kind = ROOMS[(number % ROOMS.len() as u64) as usize];
            RoomPlan::random(kind, number, robot.radius_m()).world(&robot, SPEED_M_S)?
        }
    };
    Ok(world.with_physics(physics)?)
}
