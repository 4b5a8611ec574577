//! What can be set, as ROS 2 writes parameters into YAML files.

use std::fmt;
use std::path::PathBuf;

use eeruf_core::MAX_SENSORS;
use serde::de::{DeserializeSeed, IgnoredAny, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// Where readings come from.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Source {
    /// A board on a serial line, which filters.
    #[default]
    Serial,
    /// Raw echo times on a topic, to be filtered here.
    EchoTimes,
    /// Ranges on a topic for each sensor, to be filtered here.
    Ranges,
}

/// What a `Range` says where nothing is in range.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ClearAs {
    /// `+Inf`, as REP 117 wants it.
    #[default]
    Inf,
    /// The maximum range, by which Nav2's range layer clears.
    MaxRange,
}

/// What `OBSTACLE_DISTANCE` says where a sensor does not answer.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum UnansweredAs {
    /// An obstacle at the minimum range, which no autopilot takes for free space.
    #[default]
    Obstacle,
    /// Unknown, which `ArduPilot` takes for free space.
    Unknown,
}

/// All parameters; `docs/how-to/ros2.md` says what each is for.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Parameters {
    /// Not a parameter: the node's name.
    #[serde(skip)]
    pub(crate) name: String,
    /// Not a parameter: whether to speak ROS at all.
    #[serde(skip)]
    pub(crate) ros: bool,
    pub(crate) source: Source,
    pub(crate) port: String,
    pub(crate) baud: u32,
    pub(crate) sensors: u8,
    pub(crate) topics: Vec<String>,
    pub(crate) frame_ids: Vec<String>,
    pub(crate) echo_times_topic: String,
    pub(crate) range_topics: Vec<String>,
    pub(crate) clear_as: ClearAs,
    pub(crate) field_of_view_rad: f32,
    pub(crate) min_range_m: f32,
    pub(crate) max_range_m: f32,
    pub(crate) temperature_c: f32,
    pub(crate) t_delta_us: u32,
    pub(crate) late_us: u32,
    pub(crate) blind_after: u32,
    pub(crate) silent_after_s: f64,
    pub(crate) log: PathBuf,
    pub(crate) mavlink: String,
    pub(crate) mavlink_system: u8,
    pub(crate) mavlink_component: u8,
    pub(crate) mavlink_unanswered_as: UnansweredAs,
    pub(crate) yaws_deg: Vec<f32>,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            name: "eeruf".to_owned(),
            ros: true,
            source: Source::Serial,
            port: "/dev/ttyACM0".to_owned(),
            baud: 115_200,
            sensors: 8,
            topics: Vec::new(),
            frame_ids: Vec::new(),
            echo_times_topic: "echo_times".to_owned(),
            range_topics: Vec::new(),
            clear_as: ClearAs::Inf,
            field_of_view_rad: 0.52,
            min_range_m: 0.02,
            max_range_m: 4.0,
            temperature_c: 20.0,
            t_delta_us: 500,
            late_us: 2_000,
            blind_after: 20,
            silent_after_s: 1.0,
            log: PathBuf::new(),
            mavlink: String::new(),
            mavlink_system: 1,
            // MAV_COMP_ID_OBSTACLE_AVOIDANCE.
            mavlink_component: 196,
            mavlink_unanswered_as: UnansweredAs::Obstacle,
            yaws_deg: Vec::new(),
        }
    }
}

/// A node's part of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Node {
    #[serde(rename = "ros__parameters")]
    parameters: Option<Parameters>,
}

/// Finds a node's part by its name; what is for other nodes is skipped, whatever it holds.
struct OfNode<'n>(&'n str);

impl<'de> DeserializeSeed<'de> for OfNode<'_> {
    type Value = Parameters;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Parameters, D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for OfNode<'_> {
    type Value = Parameters;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the parameters of nodes, `{}: ros__parameters: ..`", self.0)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut nodes: A) -> Result<Parameters, A::Error> {
        let (mut own, mut of_all, mut others) = (None, None, Vec::new());
        while let Some(name) = nodes.next_key::<String>()? {
            if name.trim_start_matches('/') == self.0 {
                own = Some(nodes.next_value::<Node>()?.parameters.unwrap_or_default());
            } else if name == "/**" {
                of_all = Some(nodes.next_value::<Node>()?.parameters.unwrap_or_default());
            } else {
                nodes.next_value::<IgnoredAny>()?;
                others.push(name);
            }
        }
        own.or(of_all).ok_or_else(|| {
            let there = others.join(", ");
            serde::de::Error::custom(format!("parameters of {there}; expected those of {} or /**", self.0))
        })
    }
}

impl Parameters {
    /// The parameters of the node with this name, or else those of all nodes (`/**`).
    pub(crate) fn from_yaml(text: &str, name: &str) -> Result<Self, String> {
        let read = serde_saphyr::with_deserializer_from_str(text, |yaml| OfNode(name).deserialize(yaml));
        let mut read = read.map_err(|error| error.to_string())?;
        name.clone_into(&mut read.name);
        Ok(read)
    }

    /// Whether they can be used, and together.
    pub(crate) fn check(&self) -> Result<(), String> {
        let must = |holds: bool, wrong: String| if holds { Ok(()) } else { Err(wrong) };
        let sensors = usize::from(self.sensors);
        must((1..=MAX_SENSORS).contains(&sensors), format!("sensors: {sensors}; expected 1 to {MAX_SENSORS}"))?;
        let lists = [
            ("topics", self.topics.len()),
            ("frame_ids", self.frame_ids.len()),
            ("range_topics", self.range_topics.len()),
            ("yaws_deg", self.yaws_deg.len()),
        ];
        for (list, length) in lists {
            let whole = length == 0 || length == sensors;
            must(whole, format!("{list}: {length} entries; expected one for each of {sensors} sensors, or none"))?;
        }
        let ranges_named = self.source != Source::Ranges || !self.range_topics.is_empty();
        must(ranges_named, "range_topics: none; source: ranges needs one for each sensor".to_owned())?;
        let (least, most) = (self.min_range_m, self.max_range_m);
        must(least >= 0.0 && least.is_finite(), format!("min_range_m: {least}; expected 0 or more"))?;
        must(most > least && most <= 100.0, format!("max_range_m: {most}; expected more than {least}, up to 100"))?;
        let view = self.field_of_view_rad;
        must(view > 0.0 && view <= 6.3, format!("field_of_view_rad: {view}; expected more than 0, up to 6.3"))?;
        let celsius = self.temperature_c;
        must((-60.0..=80.0).contains(&celsius), format!("temperature_c: {celsius}; expected -60 to 80"))?;
        let most_t_delta = 65_535;
        let t_delta = self.t_delta_us;
        must(t_delta <= most_t_delta, format!("t_delta_us: {t_delta}; expected 0 to {most_t_delta}"))?;
        let silent = self.silent_after_s;
        must(silent > 0.0 && silent.is_finite(), format!("silent_after_s: {silent}; expected more than 0"))?;
        must(self.blind_after > 0, "blind_after: 0; expected 1 or more".to_owned())?;
        let yaw = self.yaws_deg.iter().find(|yaw| !yaw.is_finite());
        must(yaw.is_none(), format!("yaws_deg: {}; expected degrees", yaw.unwrap_or(&0.0)))?;
        let logged = self.log.as_os_str().is_empty() || self.source != Source::Ranges;
        must(logged, "log: ranges come without the instants of their firings, of which a log is made".to_owned())?;
        let heard = self.ros || self.source == Source::Serial;
        must(heard, "without ROS only source: serial can be listened to; give --port".to_owned())
    }

    /// What is called so for each sensor: the list's entry, or one made of the prefix.
    pub(crate) fn name_of(list: &[String], prefix: &str, sensor: u8) -> String {
        list.get(usize::from(sensor)).cloned().unwrap_or_else(|| format!("{prefix}{}", sensor + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wrong(parameters: &str) -> String {
        let text = format!("eeruf:\n  ros__parameters:\n    {parameters}\n");
        Parameters::from_yaml(&text, "eeruf").and_then(|read| read.check()).unwrap_err()
    }

    #[test]
    fn the_file_in_config_says_what_the_defaults_are() {
        let read = Parameters::from_yaml(include_str!("../config/eeruf.yaml"), "eeruf").unwrap();
        read.check().unwrap();
        assert_eq!(read, Parameters::default());
    }

    #[test]
    fn a_node_finds_its_own_parameters_among_those_of_others() {
        let text = "nav2:\n  ros__parameters: {rate: [1, {a: b}]}\n/**:\n  ros__parameters: {sensors: 3}\n\
                    /eeruf:\n  ros__parameters: {sensors: 12, clear_as: max_range}\n";
        let read = |name| Parameters::from_yaml(text, name).unwrap();
        assert_eq!((read("eeruf").sensors, read("eeruf").clear_as), (12, ClearAs::MaxRange));
        assert_eq!((read("other").sensors, read("other").clear_as), (3, ClearAs::Inf));
        let empty = Parameters::from_yaml("eeruf:\n  ros__parameters:\n", "eeruf").unwrap();
        assert_eq!(empty, Parameters::default());
        let none = Parameters::from_yaml("nav2:\n  ros__parameters: {}\n", "eeruf").unwrap_err();
        assert!(none.contains("parameters of nav2; expected those of eeruf or /**"), "{none}");
    }

    #[test]
    fn what_is_wrong_is_named_with_its_value_and_what_is_expected() {
        for (parameters, expected) in [
            ("senors: 8", "senors"),
            ("sensors: eight", "eight"),
            ("sensors: 65", "sensors: 65; expected 1 to 64"),
            ("clear_as: infinity", "infinity"),
            ("topics: [a, b]", "topics: 2 entries; expected one for each of 8 sensors, or none"),
            ("source: ranges", "range_topics: none"),
            ("max_range_m: 0.01", "max_range_m: 0.01; expected more than 0.02, up to 100"),
            ("field_of_view_rad: 0", "field_of_view_rad: 0; expected more than 0"),
            ("temperature_c: 293", "temperature_c: 293; expected -60 to 80"),
            ("t_delta_us: 70000", "t_delta_us: 70000; expected 0 to 65535"),
            ("blind_after: 0", "blind_after: 0; expected 1 or more"),
            ("silent_after_s: .nan", "silent_after_s: NaN; expected more than 0"),
        ] {
            let said = wrong(parameters);
            assert!(said.contains(expected), "{parameters}: {said}");
        }
    }
}
