//! The node's side in ROS 2: its publishers and subscriptions, over DDS.

pub(crate) mod cloud;
pub(crate) mod messages;
mod participant;
mod scene;

use std::env;
use std::fmt::Display;
use std::time::Duration;

use futures_executor::block_on;
use serde::Serialize;
use serde::de::DeserializeOwned;

use ros2_client::dds::rustdds::Topic;
use ros2_client::qos::{Durability, History, WhenFull};
use ros2_client::ros2::LogLevel;
use ros2_client::{Context, MessageTypeName, Name, Node, NodeName, NodeOptions, Publisher, QosProfile, Subscription};

use crate::board_line::nanoseconds;
use crate::cli::Setup;
use crate::diagnosis::Status;
use crate::gpio::Speeds;
use crate::parameters::{Parameters, Source};
use crate::placing::{Place, Placing};
use crate::range::Scale;
use crate::ros_args::RosArgs;
use crate::simulated::Course;
use crate::view::View;
use messages::{
    DiagnosticArray, DiagnosticStatus, Header, KeyValue, LaserScan, Odometry, PointCloud2, Quaternion, Range,
    TfMessage, Time, Transform, TransformStamped, Twist, ULTRASOUND, Vector3,
};

use scene::Scene;

/// Publishers that need the poses of the sensors.
struct Placed {
    places: Vec<Place>,
    base_frame: String,
    cloud: Publisher<PointCloud2>,
    scan: Publisher<LaserScan>,
    /// Publisher of transforms, kept so that later subscribers receive them.
    _transforms: Publisher<TfMessage>,
}

pub(crate) struct Ros {
    /// The node, which leaves the domain when it is dropped.
    node: Node,
    ranges: Vec<Publisher<Range>>,
    frame_ids: Vec<String>,
    diagnostics: Publisher<DiagnosticArray>,
    /// `None` without poses of the sensors.
    placed: Option<Placed>,
    /// `None` with hardware.
    scene: Option<Scene>,
    /// The robot's motion, for a ring on pins.
    odometry: Option<Subscription<Odometry>>,
    parameters: Parameters,
    name: String,
    hardware: String,
}

/// Quality of service for publishing: reliable for subscribers that ask for it. A subscriber that does not acknowledge
/// delays the node by at most this long.
const PUBLISHING: QosProfile = QosProfile::publisher_default()
    .reliability_reliable(WhenFull::Wait(Duration::from_millis(10)))
    .history(History::KeepLast { depth: 10 });
/// Quality of service for transforms that never change: later subscribers receive them, too.
const LATCHED: QosProfile =
    QosProfile { durability: Durability::TransientLocal, history: History::KeepLast { depth: 1 }, ..PUBLISHING };
/// Quality of service named sensor data in ROS 2: lost messages are not sent again.
const LISTENING: QosProfile = QosProfile::subscription_default().history(History::KeepLast { depth: 64 });

impl Ros {
    /// Joins the domain `ROS_DOMAIN_ID`.
    pub(crate) fn open(setup: &Setup, args: &RosArgs) -> Result<Self, String> {
        let parameters = &setup.parameters;
        let participant = participant::join(domain()?)?;
        let context = Context::from_domain_participant(participant).map_err(wrong("DDS"))?;
        let node_name = NodeName::new(args.namespace(), &args.node).map_err(wrong(&args.full_name()))?;
        let mut node = context.new_node(node_name, options(parameters)).map_err(wrong("node"))?;
        // Answers requests for parameters until the node is dropped.
        let spinner = node.spinner().map_err(wrong("parameters"))?;
        std::thread::spawn(|| {
            block_on(spinner.spin()).inspect_err(|error| eprintln!("eeruf-ros2: parameters: {error}"))
        });
        let mut node = Topics { node, args };
        let mut ranges = Vec::new();
        for sensor in 0..parameters.sensors {
            let name = Parameters::name_of(&parameters.topics, "~/sonar_", sensor);
            ranges.push(node.publisher(&name, ["sensor_msgs", "Range"], &PUBLISHING)?);
        }
        let diagnostics = node.publisher("/diagnostics", ["diagnostic_msgs", "DiagnosticArray"], &PUBLISHING)?;
        let hears = parameters.source == Source::Gpio && !parameters.odometry_topic.is_empty();
        let odometry = hears.then(|| node.subscription(&parameters.odometry_topic, ["nav_msgs", "Odometry"]));
        let odometry = odometry.transpose()?;
        let frame_id = |sensor| Parameters::name_of(&parameters.frame_ids, "sonar_", sensor);
        let frame_ids: Vec<String> = (0..parameters.sensors).map(frame_id).collect();
        let is_placed = !setup.placing.places.is_empty();
        let placed = is_placed.then(|| node.placed(&setup.placing, &parameters.base_frame, &frame_ids));
        let placed = placed.transpose()?;
        let scene = setup.world.as_ref().map(|_| Scene::open(&mut node, parameters)).transpose()?;
        Ok(Self {
            node: node.node,
            ranges,
            frame_ids,
            diagnostics,
            placed,
            scene,
            odometry,
            parameters: parameters.clone(),
            name: args.node.clone(),
            hardware: if parameters.source == Source::Serial { parameters.port.clone() } else { String::new() },
        })
    }

    /// Publishes a message of the node on `/rosout`.
    pub(crate) fn log(&self, what: &str) {
        ros2_client::rosout!(self.node, LogLevel::Info, "{what}");
    }

    /// Publishes a sensor's range, for a firing at this time; false if sending failed.
    pub(crate) fn publish_range(&self, sensor: u8, fired_ns: i64, range: f32) -> bool {
        let at = usize::from(sensor);
        let (Some(publisher), Some(frame_id)) = (self.ranges.get(at), self.frame_ids.get(at)) else { return false };
        let header = Header { stamp: Time::from_nanoseconds(fired_ns), frame_id: frame_id.clone() };
        let message = Range {
            header,
            radiation_type: ULTRASOUND,
            field_of_view: self.parameters.field_of_view_rad,
            min_range: self.parameters.min_range_m,
            max_range: self.parameters.max_range_m,
            range,
            variance: 0.0,
        };
        publisher.publish(message).is_ok()
    }

    /// Publishes the views of all sensors, with their ages in seconds, and the scan; false if sending failed.
    pub(crate) fn publish_ring(&self, now_ns: i64, views: &[(View, f32)], scale: &Scale) -> bool {
        let Some(placed) = &self.placed else { return true };
        let header = Header { stamp: Time::from_nanoseconds(now_ns), frame_id: placed.base_frame.clone() };
        let scan = cloud::scan(header.clone(), &placed.places, views, self.parameters.field_of_view_rad, scale);
        let cloud = cloud::cloud(header, &placed.places, views, self.parameters.min_range_m);
        placed.scan.publish(scan).is_ok() & placed.cloud.publish(cloud).is_ok()
    }

    /// Returns the latest commanded velocity of a simulated robot: ahead, and turning.
    pub(crate) fn velocity(&self) -> Option<Result<(f64, f64), String>> {
        self.scene.as_ref()?.velocity()
    }

    /// Publishes a simulated robot's pose and what its sensors would see alone; false if sending failed.
    pub(crate) fn publish_truth(&self, now_ns: i64, course: Course, views: &[(View, f32)]) -> bool {
        let (Some(scene), Some(placed)) = (&self.scene, &self.placed) else { return true };
        scene.publish(Time::from_nanoseconds(now_ns), course, &placed.places, views, self.parameters.min_range_m)
    }

    /// Publishes the diagnostics; false if sending failed.
    pub(crate) fn publish_diagnostics(&self, now_ns: i64, report: &[Status]) -> bool {
        let status = report.iter().map(|status| DiagnosticStatus {
            level: status.level as u8,
            name: format!("{}: {}", self.name, status.about),
            message: status.message.clone(),
            hardware_id: self.hardware.clone(),
            values: status
                .values
                .iter()
                .map(|(key, value)| KeyValue { key: (*key).to_owned(), value: value.clone() })
                .collect(),
        });
        let header = Header { stamp: Time::from_nanoseconds(now_ns), frame_id: String::new() };
        self.diagnostics.publish(DiagnosticArray { header, status: status.collect() }).is_ok()
    }

    /// Yields the robot's speeds reported since the last call; an error for an invalid message.
    pub(crate) fn take(&self) -> impl Iterator<Item = Result<Speeds, String>> {
        self.odometry
            .iter()
            .flat_map(|odometry| std::iter::from_fn(|| odometry.take().transpose()))
            .map(|message| message.map_err(|error| error.to_string()).and_then(|(message, _)| speeds(&message.twist.0)))
    }
}

/// Options that let parameters be read but not set, since they take effect only at the start.
fn options(parameters: &Parameters) -> NodeOptions {
    let values = parameters.values();
    let none = NodeOptions::new();
    let options = values.iter().fold(none, |options, (name, value)| options.declare_parameter(name, value.clone()));
    options.parameter_validator(Box::new(move |name, value| {
        let is_read = values.contains(&(name, value.clone()));
        is_read.then_some(()).ok_or_else(|| format!("{name}: read at the start; restart the node with -p {name}:=.."))
    }))
}

/// The node, and the names of its topics.
struct Topics<'a> {
    node: Node,
    args: &'a RosArgs,
}

impl Topics<'_> {
    fn topic(&mut self, name: &str, [package, kind]: [&str; 2], qos: &QosProfile) -> Result<Topic, String> {
        let full = self.args.topic(name);
        let parsed = Name::parse(&full).map_err(|error| format!("topic {full}: {error:?}"))?;
        self.node.create_topic(&parsed, MessageTypeName::new(package, kind), qos).map_err(wrong(&full))
    }

    fn publisher<M: Serialize>(
        &mut self,
        name: &str,
        kind: [&str; 2],
        qos: &QosProfile,
    ) -> Result<Publisher<M>, String> {
        let topic = self.topic(name, kind, qos)?;
        self.node.create_publisher(&topic, None).map_err(wrong(name))
    }

    fn subscription<M: DeserializeOwned + 'static>(
        &mut self,
        name: &str,
        kind: [&str; 2],
    ) -> Result<Subscription<M>, String> {
        let topic = self.topic(name, kind, &LISTENING)?;
        self.node.create_subscription(&topic, None).map_err(wrong(name))
    }

    /// Publishes the poses of the sensors, once.
    fn placed(&mut self, placing: &Placing, base_frame: &str, frame_ids: &[String]) -> Result<Placed, String> {
        let cloud = self.publisher("~/points", ["sensor_msgs", "PointCloud2"], &PUBLISHING)?;
        let scan = self.publisher("~/scan", ["sensor_msgs", "LaserScan"], &PUBLISHING)?;
        let transforms = self.publisher("/tf_static", ["tf2_msgs", "TFMessage"], &LATCHED)?;
        let stamp = Time::from_nanoseconds(nanoseconds());
        let transform = |(place, frame_id): (&Place, &String)| TransformStamped {
            header: Header { stamp, frame_id: base_frame.to_owned() },
            child_frame_id: frame_id.clone(),
            transform: Transform {
                translation: Vector3 { x: place.x_m, y: place.y_m, z: place.z_m },
                rotation: Quaternion::from_yaw(place.yaw_rad),
            },
        };
        let message = TfMessage { transforms: placing.frames(frame_ids).map(transform).collect() };
        transforms.publish(message).map_err(|error| format!("/tf_static: {error}"))?;
        let places = placing.places.clone();
        Ok(Placed { places, base_frame: base_frame.to_owned(), cloud, scan, _transforms: transforms })
    }
}

/// Returns the robot's speeds, rounded up; `None` if they are not numbers.
fn speeds(twist: &Twist) -> Result<Speeds, String> {
    let speeds = [twist.linear.x.hypot(twist.linear.y), twist.angular.z.abs()];
    match speeds.iter().all(|speed| speed.is_finite()) {
        true => Ok(speeds.map(|speed| (1e3 * speed).ceil() as u32)),
        false => Err(format!("odometry: {} m/s, {} rad/s; expected numbers", speeds[0], speeds[1])),
    }
}

/// `ROS_DOMAIN_ID`, 0 if it is not set.
fn domain() -> Result<u16, String> {
    let Ok(set) = env::var("ROS_DOMAIN_ID") else { return Ok(0) };
    let id = set.parse().ok().filter(|id| *id <= 232);
    id.ok_or_else(|| format!("ROS_DOMAIN_ID: {set}; expected 0 to 232"))
}

fn wrong<E: Display>(what: &str) -> impl Fn(E) -> String + '_ {
    move |error| format!("{what}: {error}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_of_odometry_are_rounded_up() {
        let twist = |x, y, z| {
            let [linear, angular] = [Vector3 { x, y, z: 0.0 }, Vector3 { z, ..Vector3::default() }];
            speeds(&Twist { linear, angular })
        };
        assert_eq!(twist(-0.3, 0.4, -0.0101), Ok([500, 11]));
        assert_eq!(twist(1e30, 0.0, 0.0), Ok([u32::MAX, 0]));
        let error = twist(0.1, 0.0, f64::NAN).unwrap_err();
        assert_eq!(error, "odometry: 0.1 m/s, NaN rad/s; expected numbers");
    }
}
