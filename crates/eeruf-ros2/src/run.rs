//! The main loop, which turns frames from the board into ranges, diagnostics, `MAVLink` messages and a log.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

use eeruf_core::{Micros, ReadingKind};
use eeruf_serial::{FiringMessage, Message, Received};

use crate::board_clock::BoardClock;
use crate::board_line::{FromLine, listen, nanoseconds};
use crate::cli::Setup;
use crate::diagnosis::{Diagnosis, Level};
use crate::firing_log::FiringLog;
use crate::gpio::{GpioRing, Speeds};
use crate::mavlink::Mavlink;
use crate::parameters::{Parameters, Source};
use crate::range::Scale;
use crate::ros::Ros;
use crate::simulated::Simulator;
use crate::view::View;

/// Interval at which topics are polled; a ring of 64 sensors has a reading every millisecond or two.
const LOOK: Duration = Duration::from_millis(5);
/// The shortest time between two messages about the whole ring.
const PICTURE: Duration = Duration::from_millis(100);
/// Interval at which faults are reported.
const REPORT: Duration = Duration::from_secs(1);

/// Runs until Ctrl-C.
pub(crate) fn run(mut setup: Setup) -> Result<(), String> {
    let stop = Arc::new(AtomicBool::new(false));
    let stopped = Arc::clone(&stop);
    ctrlc::set_handler(move || stopped.store(true, Ordering::Relaxed)).map_err(|error| format!("Ctrl-C: {error}"))?;
    let mut node = EerufNode::open(&setup)?;
    let parameters = &setup.parameters;
    let line = match (parameters.source, setup.gpio.take()) {
        (Source::Serial, _) => {
            let (to, from) = channel();
            listen(parameters.port.clone(), parameters.baud, to);
            Some(from)
        }
        (_, Some(ring)) => {
            let (speeds, of_robot) = channel();
            node.speeds = Some(speeds);
            Some(pins(ring, parameters, of_robot)?)
        }
        _ => None,
    };
    node.say_once(&format!("{} sensors, from {}", parameters.sensors, source(parameters)));
    let mut reported = Instant::now();
    while !stop.load(Ordering::Relaxed) {
        node.look(line.as_ref())?;
        node.picture();
        if reported.elapsed() >= REPORT {
            reported += REPORT;
            node.report()?;
        }
    }
    node.flush()?;
    eprintln!("eeruf-ros2: ended");
    Ok(())
}

#[cfg(target_os = "linux")]
fn pins(ring: GpioRing, parameters: &Parameters, speeds: Receiver<Speeds>) -> Result<Receiver<FromLine>, String> {
    let (to, from) = channel();
    let lines = [&parameters.trigger_lines[..], &parameters.echo_lines[..]];
    crate::gpio::listen(ring, &parameters.gpio_chip, lines, speeds, to)?;
    Ok(from)
}

#[cfg(not(target_os = "linux"))]
fn pins(_: GpioRing, _: &Parameters, _: Receiver<Speeds>) -> Result<Receiver<FromLine>, String> {
    Err("source: gpio; expected Linux, whose kernel has GPIO character devices".to_owned())
}

fn source(parameters: &Parameters) -> String {
    match parameters.source {
        Source::Serial => format!("{} at {} baud", parameters.port, parameters.baud),
        Source::Gpio => format!("the lines of {}", parameters.gpio_chip),
        Source::Simulation => format!("the simulation of {}", parameters.scene.display()),
    }
}

struct EerufNode {
    ros: Option<Ros>,
    simulator: Option<Simulator>,
    /// The reading that each simulated sensor would have had alone at its last firing.
    truth: Vec<(View, f32)>,
    mavlink: Option<Mavlink>,
    log: Option<FiringLog>,
    /// Source of the robot's motion, for a ring on pins.
    speeds: Option<Sender<Speeds>>,
    diagnosis: Diagnosis,
    scale: Scale,
    clock: BoardClock,
    clock_name: String,
    /// The number of the last frame.
    sequence: Option<u16>,
    /// True if a reading came since the state of the ring was last sent.
    has_news: bool,
    pictured: Option<Instant>,
    began: Instant,
    /// The last message about the line, to print each message once.
    said: String,
}

impl EerufNode {
    fn open(setup: &Setup) -> Result<Self, String> {
        let parameters = &setup.parameters;
        Ok(Self {
            ros: setup.ros.as_ref().map(|args| Ros::open(setup, args)).transpose()?,
            simulator: setup.world.clone().map(|world| Simulator::new(world, &parameters.method)).transpose()?,
            truth: vec![(View::Unknown, 0.0); usize::from(parameters.sensors)],
            mavlink: (!parameters.mavlink.is_empty()).then(|| Mavlink::open(parameters)).transpose()?,
            log: (!parameters.log.as_os_str().is_empty()).then(|| FiringLog::create(&parameters.log)).transpose()?,
            speeds: None,
            diagnosis: Diagnosis::new(parameters, 0.0),
            scale: Scale::new(parameters),
            clock: BoardClock::default(),
            clock_name: "board".to_owned(),
            sequence: None,
            has_news: false,
            pictured: None,
            began: Instant::now(),
            said: String::new(),
        })
    }

    fn now_s(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    /// Reads new input, or waits a little if there is none.
    fn look(&mut self, line: Option<&Receiver<FromLine>>) -> Result<(), String> {
        let Some(line) = line else {
            std::thread::sleep(LOOK);
            return self.simulate();
        };
        self.hear_motion();
        match line.recv_timeout(10 * LOOK) {
            Ok(FromLine::Opened) => {
                self.diagnosis.line_lost = None;
                self.say_once("the line is open");
                self.sequence = None;
                Ok(())
            }
            Ok(FromLine::Lost(why)) => {
                self.say_once(&format!("{why}; trying again"));
                self.diagnosis.line_lost = Some(why);
                Ok(())
            }
            Ok(FromLine::Frame(Ok(received), at_ns)) => self.frame(received, at_ns),
            Ok(FromLine::Frame(Err(eeruf_serial::FrameError::Damaged), _)) => {
                self.diagnosis.damaged();
                Ok(())
            }
            Ok(FromLine::Frame(Err(error), _)) => {
                self.say_once(&error.to_string());
                self.diagnosis.foreign = Some(error.to_string());
                Ok(())
            }
            Err(RecvTimeoutError::Timeout) => Ok(()),
            Err(RecvTimeoutError::Disconnected) => Err("the thread that reads the line has ended".to_owned()),
        }
    }

    fn frame(&mut self, received: Received, at_ns: i64) -> Result<(), String> {
        let Received { sequence, message, of_hopping } = received;
        if of_hopping {
            self.say_once("the board's ring hops in time, of an earlier version; how it weighs readings is ignored");
        }
        if let Some(last) = self.sequence.replace(sequence) {
            // A board that restarted begins with 0.
            let missing = sequence.wrapping_sub(last).wrapping_sub(1);
            self.diagnosis.lost(if sequence == 0 { 0 } else { missing });
        }
        match message {
            Message::Hello { sensors, clock } => {
                self.clock_name = clock;
                self.diagnosis.board_sensors = Some(sensors);
                Ok(())
            }
            Message::Period { period, max_late, edges_lost, health } => {
                self.diagnosis.period(period, max_late, edges_lost, &health);
                Ok(())
            }
            Message::Firing(firing) => {
                let fired_ns = self.clock.fired_ns(firing.fired, firing.age, at_ns);
                self.firing(&firing, fired_ns)
            }
        }
    }

    /// Simulates up to the current time.
    fn simulate(&mut self) -> Result<(), String> {
        let Some(simulator) = &mut self.simulator else { return Ok(()) };
        match self.ros.as_ref().and_then(Ros::velocity) {
            // An invalid velocity does not end the simulation.
            Some(Ok((v_m_s, w_rad_s))) => {
                if let Err(error) = simulator.drive(v_m_s, w_rad_s) {
                    self.say_once(&error);
                }
            }
            Some(Err(error)) => self.say_once(&error),
            None => {}
        }
        let Some(simulator) = &mut self.simulator else { return Ok(()) };
        let (read, is_slow) = simulator.go_on()?;
        if is_slow {
            self.say_once("the simulation is slower than the clock on the wall");
        }
        for simulated in read {
            let at = simulated.firing.sensor;
            let kind = if simulated.truth.is_some() { ReadingKind::Accepted } else { ReadingKind::Clear };
            let seen = self.scale.distance(kind, simulated.truth).map_or(View::Unknown, View::Sees);
            if let Some(place) = self.truth.get_mut(usize::from(at)) {
                *place = (seen, 0.0);
            }
            self.firing(&simulated.firing, simulated.fired_ns)?;
        }
        Ok(())
    }

    fn hear_motion(&mut self) {
        let heard: Vec<_> = self.ros.iter().flat_map(Ros::take).collect();
        for speeds in heard {
            match speeds {
                // A thread that has ended reports the reason.
                Ok(speeds) => _ = self.speeds.as_ref().map(|to| to.send(speeds)),
                Err(why) => self.say_once(&why),
            }
        }
    }

    fn firing(&mut self, firing: &FiringMessage, fired_ns: i64) -> Result<(), String> {
        if let Some(log) = &mut self.log {
            log.write(&self.clock_name, firing).map_err(|error| format!("log: {error}"))?;
        }
        let FiringMessage { sensor, kind, t_echo, late, explained_by, .. } = *firing;
        self.diagnosis.reading(self.now_s(), sensor, kind, t_echo, late, explained_by);
        self.has_news = true;
        let Some(distance) = self.scale.distance(kind, t_echo) else { return Ok(()) };
        let range = distance.number();
        let published = self.ros.as_ref().is_none_or(|ros| ros.publish_range(sensor, fired_ns, range));
        let sent = self.mavlink.as_mut().is_none_or(|mavlink| mavlink.distance(sensor, distance).is_ok());
        if !(published && sent) {
            self.diagnosis.unsent();
        }
        Ok(())
    }

    /// Sends the state of the whole ring, at most ten times a second and only after new readings: subscribers must
    /// notice when readings stop.
    fn picture(&mut self) {
        if !self.has_news || self.pictured.is_some_and(|last| last.elapsed() < PICTURE) {
            return;
        }
        (self.has_news, self.pictured) = (false, Some(Instant::now()));
        let seconds = |age: Micros| (f64::from(age.as_micros()) / 1e6) as f32;
        let views = self.diagnosis.views(self.now_s(), &self.scale);
        let views: Vec<(View, f32)> = views.map(|(view, age)| (view, seconds(age))).collect();
        let published = self.ros.as_ref().is_none_or(|ros| ros.publish_ring(nanoseconds(), &views, &self.scale));
        let sent = self.mavlink.as_mut().is_none_or(|mavlink| mavlink.picture(&views).is_ok());
        let course = self.simulator.as_ref().and_then(|simulator| simulator.course().ok());
        let shown = self.ros.as_ref().zip(course);
        let shown = shown.is_none_or(|(ros, course)| ros.publish_truth(nanoseconds(), course, &self.truth));
        if !(published && sent && shown) {
            self.diagnosis.unsent();
        }
    }

    fn report(&mut self) -> Result<(), String> {
        let report = self.diagnosis.report(self.now_s());
        if let Some(ros) = &self.ros {
            if !ros.publish_diagnostics(nanoseconds(), &report) {
                self.diagnosis.unsent();
            }
        } else {
            // Without ROS nothing else reports it.
            let wrong = report.iter().filter(|status| status.level != Level::Ok);
            let wrong: Vec<_> = wrong.map(|status| format!("{}: {}", status.about, status.message)).collect();
            self.say_once(&if wrong.is_empty() { "all is well".to_owned() } else { wrong.join("; ") });
        }
        if self.mavlink.as_mut().is_some_and(|mavlink| mavlink.heartbeat().is_err()) {
            self.diagnosis.unsent();
        }
        self.flush()
    }

    fn say_once(&mut self, what: &str) {
        if self.said != what {
            eprintln!("eeruf-ros2: {what}");
            self.ros.as_ref().inspect(|ros| ros.log(what));
            what.clone_into(&mut self.said);
        }
    }

    fn flush(&mut self) -> Result<(), String> {
        self.log.as_mut().map_or(Ok(()), FiringLog::flush).map_err(|error| format!("log: {error}"))
    }
}
