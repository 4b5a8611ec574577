//! Rooms: a robot that stands, drives, and turns, alone and beside another one of its make.

use eeruf_sim::experiments::Difference;
use eeruf_sim::experiments::measure::{Condition as Moves, Moving};
use eeruf_sim::experiments::rooms::{RoomKind, RoomPlan};
use eeruf_sim::{Entry, Motion, Noise, Options, Physics, Robot, Room, Stop, Vector, World, sweep};

use super::{Asked, Cell, Table, usual};

type Error = Box<dyn std::error::Error + Send + Sync>;

/// Simulated seconds of a room: standing, and moving.
const STANDING_S: f64 = 20.0;
const MOVING_S: f64 = 8.0;

struct Condition {
    name: &'static str,
    speed_m_s: f64,
    turn_deg_s: f64,
}

const CONDITIONS: [Condition; 5] = [
    Condition { name: "standing", speed_m_s: 0.0, turn_deg_s: 0.0 },
    Condition { name: "0.5 m/s", speed_m_s: 0.5, turn_deg_s: 0.0 },
    Condition { name: "1 m/s", speed_m_s: 1.0, turn_deg_s: 0.0 },
    Condition { name: "45 degrees/s", speed_m_s: 0.0, turn_deg_s: 45.0 },
    Condition { name: "90 degrees/s", speed_m_s: 0.0, turn_deg_s: 90.0 },
];

/// Share of time in which the first robot is right, right echoes a second, and share of foreign sound believed.
type Run = [f64; 3];

fn run(of: &Condition, robot: &Robot, kind: RoomKind, number: u64, entry: &Entry) -> Result<Run, Error> {
    let plan = RoomPlan::random(kind, number, robot.radius_m());
    let robot = entry.robot(Robot { others: kind == RoomKind::Meeting, ..robot.clone() });
    let (sensors, period) = (robot.sensors.len(), robot.period);
    let mut robots = plan.world(&robot, of.speed_m_s)?.robots().to_vec();
    if of.turn_deg_s > 0.0 {
        let turn_rad_s = of.turn_deg_s.to_radians();
        robots[0] = Robot {
            motion: Motion::Constant { velocity: Vector::zeros(), turn_rad_s },
            odometry: true,
            ..robots[0].clone()
        };
    }
    let seconds = if of.speed_m_s + of.turn_deg_s > 0.0 { MOVING_S } else { STANDING_S };
    let world = World::new(plan.scene()?.with_room(Some(Room::DEFAULT))?, robots, Noise::default())?;
    let world = world.with_physics(Physics::DEFAULT)?.with_seed(number);
    let periods = (1e6 * seconds / f64::from(period.as_micros())).ceil() as u32;
    let all = entry.simulate(&world, &Options::periods(periods), &Stop::default(), |_| true)?;
    let own: Vec<usize> = (0..all.len()).filter(|&k| all.robot[k] == 0).collect();
    let mut own = all.select(&own);
    own.sensors = sensors;
    let found = own.summary();
    Ok([100.0 * found.belief.right, found.right_echoes_per_s, 100.0 * found.belief.phantom])
}

pub(super) fn table(asked: &Asked) -> Result<Table, Box<dyn std::error::Error>> {
    let robot = asked.robot()?;
    let entries = usual();
    let head = &["right %", "against one by one", "right echoes/s", "phantom %"];
    let mut table = Table::new("rooms", 1, head);
    for others in [false, true] {
        for condition in &CONDITIONS {
            let kinds = Moves { moving: Moving::Standing, others };
            let rooms = kinds.rooms(asked.first, asked.count);
            let mut base: Vec<Run> = vec![];
            for entry in &entries {
                let runs = sweep(&rooms, |&(kind, number)| run(condition, &robot, kind, number, entry));
                let runs = runs.into_iter().collect::<Result<Vec<_>, _>>().map_err(|error| error.to_string())?;
                let column = |of: usize| Cell::mean(runs.iter().map(|run| run[of]));
                let more = Difference::of(runs.iter().zip(&base).map(|(run, base)| run[0] - base[0]));
                let more = more.map_or(Cell([f64::NAN; 3]), |more| Cell::new(more.mean, more.mean_95));
                let name = format!("{}{}", condition.name, if others { ", meeting" } else { "" });
                table.row(name, entry.name(), vec![column(0), more, column(1), column(2)]);
                if base.is_empty() {
                    base = runs;
                }
            }
        }
    }
    Ok(table)
}
