//! The parameters of the node: their defaults, their YAML file, and checks.

use std::fmt::{self, Write as _};
use std::path::PathBuf;

use eeruf_core::MAX_SENSORS;
use ros2_client::ParameterValue;
use serde::de::{DeserializeSeed, IgnoredAny, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// The source of readings.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Source {
    /// A board on a serial line, which filters by itself.
    #[default]
    Serial,
    /// HC-SR04 modules on this machine's own pins.
    Gpio,
    /// No hardware: the first robot of a scene file.
    Simulation,
}

/// Distances to send while a sensor does not answer.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum UnansweredAs {
    /// No distances until the vehicle is armed, so that its proximity check fails; then unknown.
    #[default]
    Hold,
    /// An obstacle at the minimum range: a copter flies away from it.
    Obstacle,
    /// Unknown, which `ArduPilot` takes for free space.
    Unknown,
}

macro_rules! parameters {
    ($($(#[doc = $doc:literal])+ $name:ident: $kind:ty = $default:expr, $shown:literal;)+) => {
        /// All parameters.
        #[derive(Clone, Debug, PartialEq)]
        #[expect(clippy::doc_markdown, reason = "they are comments of a YAML file as well")]
        pub(crate) struct Parameters {
            $($(#[doc = $doc])+ pub(crate) $name: $kind,)+
        }

        impl Default for Parameters {
            fn default() -> Self {
                Self { $($name: $default,)+ }
            }
        }

        /// Name, comment and default of each parameter.
        const DESCRIBED: &[(&str, &[&str], &str)] = &[$((stringify!($name), &[$($doc),+], $shown),)+];

        impl Parameters {
            /// Names and values, for the parameter services.
            pub(crate) fn values(&self) -> Vec<(&'static str, ParameterValue)> {
                vec![$((stringify!($name), self.$name.value()),)+]
            }

            /// Sets the parameter with this name.
            fn set<'de, D: Deserializer<'de>>(&mut self, name: &str, value: D) -> Result<(), D::Error> {
                const NAMES: &[&str] = &[$(stringify!($name)),+];
                match name {
                    $(stringify!($name) => self.$name = Deserialize::deserialize(value)?,)+
                    unknown => return Err(serde::de::Error::unknown_field(unknown, NAMES)),
                }
                Ok(())
            }
        }
    };
}

parameters! {
    /// The source of readings: serial (a board), gpio or simulation.
    source: Source = Source::Serial, "serial";
    /// The board's serial line.
    port: String = "/dev/ttyACM0".to_owned(), "/dev/ttyACM0";
    /// The baud rate; it has no effect over USB.
    baud: u32 = 115_200, "115200";
    /// For gpio: the chip, and its trigger and echo line for each sensor; all else is in the ring file.
    gpio_chip: String = "/dev/gpiochip0".to_owned(), "/dev/gpiochip0";
    /// On a Raspberry Pi: GPIO numbers, not pins of the header.
    trigger_lines: Vec<u32> = Vec::new(), "[]";
    /// An HC-SR04 answers with 5 V: a Raspberry Pi needs a divider to 3.3 V on each.
    echo_lines: Vec<u32> = Vec::new(), "[]";
    /// For gpio by flow: the robot's speeds (nav_msgs/Odometry); without messages, the ring file's.
    odometry_topic: String = "odom".to_owned(), "odom";
    /// For simulation: a scene file whose first robot carries the ring, and how that ring fires and filters.
    scene: PathBuf = PathBuf::new(), "\"\"";
    /// A method of `eeruf study`: flow, eeruf (a table), ..; gpio knows these two.
    method: String = "flow".to_owned(), "flow";
    /// The scene's frame in the simulation.
    map_frame: String = "map".to_owned(), "map";
    /// A ring file with poses or a URDF: number and places of the sensors, for /tf_static, the cloud, MAVLink.
    ring: PathBuf = PathBuf::new(), "\"\"";
    /// The number of sensors, unless a ring file gives it.
    sensors: u8 = 8, "8";
    /// One topic for each sensor; none: ~/sonar_1, ~/sonar_2, ..
    topics: Vec<String> = Vec::new(), "[]";
    /// One frame for each sensor; none: sonar_1, sonar_2, ..
    frame_ids: Vec<String> = Vec::new(), "[]";
    /// The robot's frame, in which the ring file has the poses.
    base_frame: String = "base_link".to_owned(), "base_link";
    /// The height of the sensors above it, if the ring file has none.
    height_m: f64 = 0.0, "0.0";
    /// The full width of a sensor's beam.
    field_of_view_rad: f32 = 0.52, "0.52";
    /// The minimum range of a sensor.
    min_range_m: f32 = 0.02, "0.02";
    /// The maximum range; echoes from beyond it do not count.
    max_range_m: f32 = 4.0, "4.0";
    /// The temperature of the air.
    temperature_c: f32 = 20.0, "20.0";
    /// Diagnostics: a firing that comes later than this is a fault.
    late_us: u32 = 2_000, "2000";
    /// A sensor is blind after this many echoes without an accepted one.
    blind_after: u32 = 20, "20";
    /// A sensor is silent after this time without a firing.
    silent_after_s: f64 = 1.0, "1.0";
    /// A file for the log that `eeruf diagnose` reads; empty for none.
    log: PathBuf = PathBuf::new(), "\"\"";
    /// MAVLink: udp:HOST:PORT; empty for none.
    mavlink: String = String::new(), "\"\"";
    /// The number of the vehicle.
    mavlink_system: u8 = 1, "1";
    /// 196 is MAV_COMP_ID_OBSTACLE_AVOIDANCE.
    mavlink_component: u8 = 196, "196";
    /// A sensor that does not answer: hold (no distances before arming, then unknown), unknown, or obstacle (at
    /// min_range_m; for ground vehicles, since copters back away from it).
    mavlink_unanswered_as: UnansweredAs = UnansweredAs::Hold, "hold";
    /// The heading of each sensor, counter-clockwise from ahead, unless a ring file gives it; none: evenly around.
    yaws_deg: Vec<f32> = Vec::new(), "[]";
    /// Time stamps always use the host's clock: true is an error.
    use_sim_time: bool = false, "false";
}

trait Value {
    /// The value as written in the file: 0.52, not 0.5199999809.
    fn value(&self) -> ParameterValue;
}

macro_rules! values {
    ($($kind:ty: $it:ident => $of:ident($value:expr);)+) => {
        $(impl Value for $kind {
            fn value(&self) -> ParameterValue {
                let $it = self;
                ParameterValue::$of($value)
            }
        })+
    };
}

values! {
    bool: it => Boolean(*it);
    u8: it => Integer((*it).into());
    u32: it => Integer((*it).into());
    f32: it => Double(it.to_string().parse().unwrap_or_default());
    f64: it => Double(*it);
    String: it => String(it.clone());
    PathBuf: it => String(it.display().to_string());
    Source: it => String(format!("{it:?}").to_lowercase());
    UnansweredAs: it => String(format!("{it:?}").to_lowercase());
    Vec<u32>: it => IntegerArray(it.iter().map(|&number| number.into()).collect());
    Vec<f32>: it => DoubleArray(it.iter().map(|number| f64::from(*number)).collect());
    Vec<String>: it => StringArray(it.clone());
}

/// Sets one parameter.
struct One<'p>(&'p mut Parameters, &'p str);

impl<'de> DeserializeSeed<'de> for One<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, value: D) -> Result<(), D::Error> {
        self.0.set(self.1, value)
    }
}

/// Sets the parameters of one node.
struct All<'p>(&'p mut Parameters);

impl<'de> DeserializeSeed<'de> for All<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, parameters: D) -> Result<(), D::Error> {
        parameters.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for All<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("parameters, `name: value`")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut parameters: A) -> Result<(), A::Error> {
        while let Some(name) = parameters.next_key::<String>()? {
            parameters.next_value_seed(One(self.0, &name))?;
        }
        Ok(())
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }
}

/// A part of a file, for nodes, namespaces, or patterns of them. Sets the parameters for this node and skips all
/// others, whatever they contain.
struct Nodes<'p> {
    /// Path of the part: empty at the top, otherwise like `/robot_1/eeruf`.
    path: String,
    /// The node's full name.
    node: &'p str,
    parameters: &'p mut Parameters,
    /// True once parameters for this node were found.
    found: &'p mut bool,
    others: &'p mut Vec<String>,
}

impl<'de> DeserializeSeed<'de> for Nodes<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, part: D) -> Result<(), D::Error> {
        part.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Nodes<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the parameters of nodes, `{}: ros__parameters: ..`", self.node)
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut nodes: A) -> Result<(), A::Error> {
        while let Some(name) = nodes.next_key::<String>()? {
            if name == "ros__parameters" {
                if matches(&self.path, self.node) {
                    *self.found = true;
                    nodes.next_value_seed(All(self.parameters))?;
                } else {
                    nodes.next_value::<IgnoredAny>()?;
                    self.others.push(self.path.trim_start_matches('/').to_owned());
                }
                continue;
            }
            nodes.next_value_seed(Nodes {
                path: format!("{}/{}", self.path, name.trim_matches('/')),
                node: self.node,
                parameters: &mut *self.parameters,
                found: &mut *self.found,
                others: &mut *self.others,
            })?;
        }
        Ok(())
    }
}

/// Returns true if a pattern matches the full name: `*` matches one part of it, `**` any number of parts.
fn matches(pattern: &str, name: &str) -> bool {
    fn parts<'p>(pattern: &[&'p str], name: &[&'p str]) -> bool {
        match (pattern, name) {
            ([], []) => true,
            (["**", rest @ ..], name) => (0..=name.len()).any(|skipped| parts(rest, &name[skipped..])),
            ([part, rest @ ..], [first, more @ ..]) => (*part == "*" || part == first) && parts(rest, more),
            _ => false,
        }
    }
    let split = |text: &'_ str| text.split('/').filter(|part| !part.is_empty()).map(str::to_owned).collect::<Vec<_>>();
    let (pattern, name) = (split(pattern), split(name));
    parts(&pattern.iter().map(String::as_str).collect::<Vec<_>>(), &name.iter().map(String::as_str).collect::<Vec<_>>())
}

impl Parameters {
    /// All parameters with their defaults, as a YAML file.
    pub(crate) fn file() -> String {
        let mut file = "/**:\n  ros__parameters:\n".to_owned();
        for (name, comment, default) in DESCRIBED {
            for line in *comment {
                _ = writeln!(file, "    #{line}");
            }
            _ = writeln!(file, "    {name}: {default}");
        }
        file
    }

    /// Sets the parameters that a file gives for the node with this full name, such as `/eeruf`; later parts prevail.
    pub(crate) fn read_yaml(&mut self, text: &str, node: &str) -> Result<(), String> {
        let (mut found, mut others) = (false, Vec::new());
        let nodes = Nodes { path: String::new(), node, parameters: self, found: &mut found, others: &mut others };
        serde_saphyr::with_deserializer_from_str(text, |yaml| nodes.deserialize(yaml))
            .map_err(|error| error.to_string())?;
        if found {
            return Ok(());
        }
        let others = if others.is_empty() { "none".to_owned() } else { format!("parameters of {}", others.join(", ")) };
        Err(format!("{others}; expected those of {node} or /**"))
    }

    /// Sets one parameter from a piece of YAML.
    pub(crate) fn read_one(&mut self, name: &str, value: &str) -> Result<(), String> {
        serde_saphyr::with_deserializer_from_str(value, |yaml| One(self, name).deserialize(yaml))
            .map_err(|error| format!("{name}:={value}: {error}"))
    }

    /// Checks that the parameters are valid, alone and together.
    pub(crate) fn check(&self) -> Result<(), String> {
        let must = |holds: bool, wrong: String| if holds { Ok(()) } else { Err(wrong) };
        let sensors = usize::from(self.sensors);
        must((1..=MAX_SENSORS).contains(&sensors), format!("sensors: {sensors}; expected 1 to {MAX_SENSORS}"))?;
        let lists =
            [("topics", self.topics.len()), ("frame_ids", self.frame_ids.len()), ("yaws_deg", self.yaws_deg.len())];
        for (list, length) in lists {
            let whole = length == 0 || length == sensors;
            must(whole, format!("{list}: {length} entries; expected one for each of {sensors} sensors, or none"))?;
        }
        if self.source == Source::Gpio {
            for (list, lines) in [("trigger_lines", &self.trigger_lines), ("echo_lines", &self.echo_lines)] {
                let length = lines.len();
                must(length == sensors, format!("{list}: {length} lines; expected one for each of {sensors} sensors"))?;
            }
            let mut lines = [&self.trigger_lines[..], &self.echo_lines[..]].concat();
            lines.sort_unstable();
            let twice = lines.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0]);
            let line = twice.unwrap_or_default();
            must(twice.is_none(), format!("trigger_lines and echo_lines: {line} twice; expected a line for each pin"))?;
        }
        let (least, most) = (self.min_range_m, self.max_range_m);
        must(least >= 0.0 && least.is_finite(), format!("min_range_m: {least}; expected 0 or more"))?;
        must(most > least && most <= 100.0, format!("max_range_m: {most}; expected more than {least}, up to 100"))?;
        let view = self.field_of_view_rad;
        must(view > 0.0 && view <= 6.3, format!("field_of_view_rad: {view}; expected more than 0, up to 6.3"))?;
        let celsius = self.temperature_c;
        must((-60.0..=80.0).contains(&celsius), format!("temperature_c: {celsius}; expected -60 to 80"))?;
        let silent = self.silent_after_s;
        must(silent > 0.0 && silent.is_finite(), format!("silent_after_s: {silent}; expected more than 0"))?;
        must(self.blind_after > 0, "blind_after: 0; expected 1 or more".to_owned())?;
        let yaw = self.yaws_deg.iter().find(|yaw| !yaw.is_finite());
        must(yaw.is_none(), format!("yaws_deg: {}; expected degrees", yaw.unwrap_or(&0.0)))?;
        must(self.height_m.is_finite(), format!("height_m: {}; expected metres", self.height_m))?;
        let sim_time = "use_sim_time: true; expected false: stamps are by this machine's clock".to_owned();
        must(!self.use_sim_time, sim_time)
    }

    /// Name for each sensor: the list's entry, or one made of the prefix.
    pub(crate) fn name_of(list: &[String], prefix: &str, sensor: u8) -> String {
        list.get(usize::from(sensor)).cloned().unwrap_or_else(|| format!("{prefix}{}", sensor + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, node: &str) -> Result<Parameters, String> {
        let mut parameters = Parameters::default();
        parameters.read_yaml(text, node).map(|()| parameters)
    }

    fn wrong(parameters: &str) -> String {
        let text = format!("eeruf:\n  ros__parameters:\n    {parameters}\n");
        read(&text, "/eeruf").and_then(|read| read.check()).unwrap_err()
    }

    #[test]
    fn file_in_config_holds_all_parameters_and_defaults() {
        let file = include_str!("../config/eeruf.yaml");
        assert_eq!(file, Parameters::file(), "eeruf-ros2 --print-params > crates/eeruf-ros2/config/eeruf.yaml");
        let read = read(file, "/eeruf").unwrap();
        read.check().unwrap();
        assert_eq!(read, Parameters::default());
    }

    #[test]
    fn node_finds_its_parameters_among_others() {
        let text = "nav2:\n  ros__parameters: {rate: [1, {a: b}]}\n/**:\n  ros__parameters: {sensors: 3, baud: 9600}\n\
                    /eeruf:\n  ros__parameters: {sensors: 12, late_us: 300}\n\
                    robot_1:\n  eeruf:\n    ros__parameters: {sensors: 24}\nrobot_2: {bare: }\n\
                    /*/left:\n  ros__parameters: {sensors: 5}\n";
        let said = |node| read(text, node).map(|read| (read.sensors, read.baud, read.late_us)).unwrap();
        assert_eq!(said("/eeruf"), (12, 9600, 300));
        assert_eq!(said("/other"), (3, 9600, 2000));
        assert_eq!(said("/robot_1/eeruf"), (24, 9600, 2000));
        assert_eq!(said("/robot_2/eeruf"), (3, 9600, 2000));
        assert_eq!((said("/robot_2/left").0, said("/left").0, said("/a/b/left").0), (5, 3, 3));
        assert_eq!(read("eeruf:\n  ros__parameters:\n", "/eeruf").unwrap(), Parameters::default());
        let none = read("nav2:\n  ros__parameters: {}\n", "/eeruf").unwrap_err();
        assert!(none.contains("parameters of nav2; expected those of /eeruf or /**"), "{none}");
    }

    #[test]
    fn one_parameter_is_read_as_yaml() {
        let mut parameters = Parameters::default();
        for (name, value) in
            [("sensors", "3"), ("topics", "[a, b, 'c d']"), ("port", "/dev/ttyUSB0"), ("max_range_m", "5")]
        {
            parameters.read_one(name, value).unwrap();
        }
        assert_eq!((parameters.sensors, parameters.topics.len(), parameters.max_range_m), (3, 3, 5.0));
        assert_eq!(parameters.port, "/dev/ttyUSB0");
        let wrong = parameters.read_one("sensors", "many").unwrap_err();
        assert!(wrong.starts_with("sensors:=many: "), "{wrong}");
        let unknown = parameters.read_one("senors", "3").unwrap_err();
        assert!(unknown.contains("unknown field") && unknown.contains(" sensors,"), "{unknown}");
    }

    #[test]
    fn wrong_value_is_named_with_what_is_expected() {
        for (parameters, expected) in [
            ("senors: 8", "senors"),
            ("sensors: eight", "eight"),
            ("sensors: 65", "sensors: 65; expected 1 to 64"),
            ("method: [flow]", "method"),
            ("topics: [a, b]", "topics: 2 entries; expected one for each of 8 sensors, or none"),
            ("source: ranges", "unknown variant"),
            ("max_range_m: 0.01", "max_range_m: 0.01; expected more than 0.02, up to 100"),
            ("field_of_view_rad: 0", "field_of_view_rad: 0; expected more than 0"),
            ("temperature_c: 293", "temperature_c: 293; expected -60 to 80"),
            ("blind_after: 0", "blind_after: 0; expected 1 or more"),
            ("source: gpio", "trigger_lines: 0 lines; expected one for each of 8 sensors"),
            (
                "{source: gpio, sensors: 2, trigger_lines: [17, 27], echo_lines: [22, 17]}",
                "trigger_lines and echo_lines: 17 twice; expected a line for each pin",
            ),
            ("use_sim_time: true", "use_sim_time: true; expected false"),
            ("silent_after_s: .nan", "silent_after_s: NaN; expected more than 0"),
        ] {
            let said = wrong(parameters);
            assert!(said.contains(expected), "{parameters}: {said}");
        }
    }
}
