//! A ring without hardware: the first robot of a scene, simulated in real time.

use std::path::Path;
use std::sync::Arc;

use eeruf_core::{Instant, Micros, ReadingKind};
use eeruf_serial::FiringMessage;
use eeruf_sim::{Fault, FaultKind, Method, Options, Simulation, Stop, World};

use crate::board_line::nanoseconds;
use crate::placing::Placing;

/// The longest time simulated in one step, in seconds, so that messages come at even intervals.
const PIECE_S: f64 = 0.02;
/// Delay, in seconds, beyond which a slow simulation no longer catches up with real time.
const BEHIND_S: f64 = 1.0;

/// Reads a scene file.
pub(crate) fn world(file: &Path) -> Result<Arc<World>, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("simulate: {}: {error}", file.display()))?;
    let world = World::from_text_with(file, &text, eeruf_design::robot_ring);
    world.map(Arc::new).map_err(|error| format!("simulate: {error}"))
}

/// Returns the poses of the first robot's sensors.
pub(crate) fn placing(world: &World, height_m: f64) -> Placing {
    Placing::of(world.robots().first().map_or(&[], |robot| &robot.sensors), height_m)
}

/// A reading of the simulation.
pub(crate) struct Simulated {
    pub(crate) firing: FiringMessage,
    /// Time of the firing, by the host's clock.
    pub(crate) fired_ns: i64,
    /// The echo time that the sensor would have alone; `None` if nothing is in range.
    pub(crate) truth: Option<Micros>,
}

/// The reading that a driver would report for a line silenced by a fault; the simulator itself reports silence.
fn broken(faults: &[Fault], sensor: u8, time_s: f64) -> Option<ReadingKind> {
    let mut there = faults.iter().filter(|fault| fault.is_of(0, sensor) && fault.is_at(time_s));
    there.find_map(|fault| match fault.kind {
        FaultKind::Missing | FaultKind::Cut => Some(ReadingKind::Unanswered),
        FaultKind::Stuck => Some(ReadingKind::Stuck),
        _ => None,
    })
}

/// The robot's position and motion in the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Course {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) yaw_rad: f64,
    /// Speed ahead, in the robot's frame.
    pub(crate) v_m_s: f64,
    pub(crate) w_rad_s: f64,
}

pub(crate) struct Simulator {
    simulation: Simulation,
    began_ns: i64,
    /// Real time that was skipped because the simulation is slower.
    skipped_s: f64,
}

impl Simulator {
    pub(crate) fn new(world: Arc<World>, method: &str) -> Result<Self, String> {
        let method: Method = method.parse().map_err(|error| format!("method: {error}"))?;
        let simulation = Simulation::new(world, method, &Options::default(), Stop::default());
        let simulation = simulation.map_err(|error| format!("simulate: {error}"))?;
        Ok(Self { simulation, began_ns: nanoseconds(), skipped_s: 0.0 })
    }

    /// Simulates the real time that has passed. Returns the readings, and true if the simulation falls behind.
    pub(crate) fn go_on(&mut self) -> Result<(Vec<Simulated>, bool), String> {
        let passed_s = (nanoseconds() - self.began_ns) as f64 * 1e-9 - self.skipped_s;
        let behind_s = passed_s - self.simulation.time_s();
        let is_slow = behind_s > BEHIND_S;
        if is_slow {
            self.skipped_s += behind_s - PIECE_S;
        }
        Ok((self.step(behind_s.clamp(0.0, PIECE_S))?, is_slow))
    }

    /// Simulates this time, in seconds.
    pub(crate) fn step(&mut self, step_s: f64) -> Result<Vec<Simulated>, String> {
        let mut read = Vec::new();
        let readings = self.simulation.step(step_s, |_| true).map_err(|error| format!("simulate: {error}"))?;
        for n in (0..readings.len()).filter(|&n| readings.robot[n] == 0) {
            let micros = |us: f64| (us.is_finite() && us >= 0.0).then(|| Micros::new(us.round() as u32));
            let fired_s = readings.fired_s[n];
            let t_echo = micros(readings.t_echo_us[n]);
            let broken = broken(self.simulation.world().faults(), readings.sensor[n], fired_s);
            let firing = FiringMessage {
                sensor: readings.sensor[n],
                phase: readings.phase[n],
                kind: broken.filter(|_| t_echo.is_none()).unwrap_or(readings.kind[n]),
                fired: Instant::from_micros((fired_s * 1e6) as u64 as u32),
                period: readings.period[n],
                t_echo,
                late: Micros::ZERO,
                age: Micros::ZERO,
                explained_by: None,
            };
            let fired_ns = self.began_ns + ((fired_s + self.skipped_s) * 1e9) as i64;
            read.push(Simulated { firing, fired_ns, truth: micros(readings.reference_us[n]) });
        }
        Ok(read)
    }

    /// Sets the robot's velocity from now on.
    pub(crate) fn drive(&mut self, v_m_s: f64, w_rad_s: f64) -> Result<(), String> {
        self.simulation.set_velocity(0, v_m_s, w_rad_s).map_err(|error| format!("cmd_vel: {error}"))
    }

    pub(crate) fn course(&self) -> Result<Course, String> {
        let moment = self.simulation.moment(0).map_err(|error| format!("simulate: {error}"))?;
        let yaw_rad = moment.pose.rotation.angle();
        let ahead = moment.velocity.x * yaw_rad.cos() + moment.velocity.y * yaw_rad.sin();
        let place = moment.pose.translation;
        Ok(Course { x_m: place.x, y_m: place.y, yaw_rad, v_m_s: ahead, w_rad_s: moment.turn_rad_s })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "seed = 1\nmax_order = 2\n[[wall]]\npoints_m = [[2.0, -3.0], [2.0, 3.0]]\nfaces = \"both\"\n\
                         [[robot]]\npose = { x_m = 0.0, y_m = 0.0, heading_deg = 0.0 }\n\
                         ring = { sensors = 4, spacing_deg = 20.0, radius_m = 0.2 }\nmodule = \"hc-sr04\"\n";

    #[test]
    fn robot_of_a_scene_reads_and_drives_at_the_walls_pace() {
        let world = Arc::new(World::from_text("scene.toml".as_ref(), SCENE).unwrap());
        assert_eq!(placing(&world, 0.1).places.len(), 4);
        let mut simulator = Simulator::new(Arc::clone(&world), "eeruf").unwrap();
        simulator.drive(0.5, 0.0).unwrap();
        let mut read = Vec::new();
        let began = nanoseconds();
        while read.len() < 40 {
            assert!(nanoseconds() - began < 20_000_000_000, "{} readings in 20 s", read.len());
            read.extend(simulator.go_on().unwrap().0);
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let sensors: std::collections::BTreeSet<u8> = read.iter().map(|read| read.firing.sensor).collect();
        assert_eq!(sensors, [0, 1, 2, 3].into());
        assert!(read.iter().all(|read| read.fired_ns >= began && read.fired_ns <= nanoseconds()));
        let course = simulator.course().unwrap();
        assert!(course.x_m > 0.01 && (course.v_m_s - 0.5).abs() < 1e-9, "{course:?}");
        // The wall, seen by the two sensors that face it best.
        let near = read.iter().filter_map(|read| read.truth).map(Micros::as_micros).min().unwrap();
        assert!((8_000..11_000).contains(&near), "{near} us");
        assert!(Simulator::new(world, "eruf").is_err_and(|error| error.starts_with("method: ")));
    }
}
