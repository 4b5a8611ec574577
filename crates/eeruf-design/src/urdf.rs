//! Places of sensors from a robot's URDF: along the fixed joints between its base and the sensors' links, each of which
//! looks along its x axis, as in `sensor_msgs/Range`.

use std::path::Path;

use eeruf_files::{FileError, Pose, meant};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node};

use crate::limits::number;
use crate::places::Places;

/// Name of the link that is the robot's base, if there is one (REP 105).
const BASE: &str = "base_link";
/// Name of the base's place on the floor (REP 120).
const FLOOR: &str = "base_footprint";
/// The steepest angle at which a sensor may look up or down, in degrees; a choice. Its range is 3.4 % longer than seen
/// from above.
const STEEPEST_DEG: f64 = 15.0;
/// Largest number of links that an error lists.
const NAMED: usize = 20;

/// Links and joints of a robot, and the file that describes it.
struct Urdf<'a> {
    links: Vec<String>,
    joints: Vec<Joint>,
    file: &'a Path,
}

/// A joint, with the place of its child's frame in its parent's.
struct Joint {
    name: String,
    kind: String,
    parent: String,
    child: String,
    origin: Isometry3<f64>,
}

/// Reads the places of these links.
pub(crate) fn places(file: &Path, links: &[String]) -> Result<Places, String> {
    let urdf = Urdf::read(file)?;
    let name = file.display();
    let base = urdf.base()?;
    let mut places = Places { base_link: Some(base.to_owned()), urdf_links: urdf.links.clone(), ..Places::default() };
    match urdf.place(base, FLOOR) {
        Ok(floor) => places.base_height_m = -floor.translation.z,
        Err(_) => places.assumed.push(format!(
            "{base} on the floor, as {name} has no {FLOOR} fixed to it and the ring file no base_height_m"
        )),
    }
    for link in links {
        if !urdf.links.contains(link) {
            return Err(urdf.unknown(link));
        }
        let place = urdf.place(base, link)?;
        for m in place.translation.vector.iter() {
            number(&format!("links: a coordinate of `{link}` from `{base}` in {name}"), *m, -1000.0, 1000.0)?;
        }
        let ahead = place.rotation * Vector3::x();
        let up_deg = libm::asin(ahead.z.clamp(-1.0, 1.0)).to_degrees();
        if !(up_deg.abs() <= STEEPEST_DEG) {
            return Err(format!(
                "links: `{link}` in {name} looks {up_deg:.0} degrees up; expected {STEEPEST_DEG} at most, up or down: \
                 a sensor looks along its link's x axis"
            ));
        }
        let (x_m, y_m) = (place.translation.x, place.translation.y);
        places.poses.push(Pose { x_m, y_m, heading_rad: libm::atan2(ahead.y, ahead.x) });
        places.z_m.push(place.translation.z);
    }
    Ok(places)
}

impl Joint {
    fn of(joint: Node<'_, '_>) -> Result<Self, String> {
        let link = |tag| attribute(within(joint, tag).unwrap_or(joint), "link");
        let numbers = |key| {
            let said = within(joint, "origin").and_then(|origin| origin.attribute(key)).unwrap_or("0 0 0");
            let each: Vec<f64> = said.split_whitespace().map_while(|number| number.parse().ok()).collect();
            <[f64; 3]>::try_from(each).map_err(|_| format!("{key} = \"{said}\"; expected three numbers"))
        };
        let [roll, pitch, yaw] = numbers("rpy")?;
        let turned = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let origin = Isometry3::from_parts(Translation3::from(numbers("xyz")?), turned);
        let (name, kind) = (attribute(joint, "name")?, attribute(joint, "type")?);
        Ok(Self { name, kind, parent: link("parent")?, child: link("child")?, origin })
    }
}

fn within<'a, 'i>(node: Node<'a, 'i>, tag: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.has_tag_name(tag))
}

fn attribute(node: Node<'_, '_>, key: &str) -> Result<String, String> {
    node.attribute(key).map(str::to_owned).ok_or_else(|| format!("<{}> without {key}", node.tag_name().name()))
}

impl<'a> Urdf<'a> {
    fn read(file: &'a Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(file);
        let text = text.map_err(|error| format!("urdf: {}", FileError::reading(file, &error)))?;
        let name = file.display();
        if text.contains("<xacro:") || text.contains("${") {
            return Err(format!(
                "urdf: {name} is a xacro file; expected a URDF: run xacro first, `xacro {name}` prints one"
            ));
        }
        Self::of(file, &text).map_err(|error| format!("urdf: {name}: {error}; expected a URDF"))
    }

    fn of(file: &'a Path, text: &str) -> Result<Self, String> {
        let document = Document::parse(text).map_err(|error| error.to_string())?;
        let robot = within(document.root(), "robot").ok_or("no <robot>")?;
        let each = |tag| robot.children().filter(move |node| node.has_tag_name(tag));
        let links = each("link").map(|link| attribute(link, "name")).collect::<Result<_, _>>()?;
        Ok(Self { links, joints: each("joint").map(Joint::of).collect::<Result<_, _>>()?, file })
    }

    /// The link relative to which places are given: `base_link`, or else the root.
    fn base(&self) -> Result<&str, String> {
        if self.links.iter().any(|known| known == BASE) {
            return Ok(BASE);
        }
        let is_root = |name: &str| self.joints.iter().all(|joint| joint.child != name);
        let root = self.links.iter().map(String::as_str).find(|name| is_root(name));
        root.ok_or_else(|| format!("urdf: {}: no {BASE} and no root; expected one of them", self.file.display()))
    }

    fn unknown(&self, link: &str) -> String {
        let links = || self.links.iter().map(String::as_str);
        let names: Vec<_> = links().take(NAMED).map(|name| format!("`{name}`")).collect();
        let more = links().count().saturating_sub(NAMED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let meant = meant(link, links()).map_or(String::new(), |known| format!("; did you mean `{known}`?"));
        format!("links: no `{link}` in {}; expected one of {}{more}{meant}", self.file.display(), names.join(", "))
    }

    /// The joints from a link up to the top of the robot.
    fn joints_above<'l>(&'l self, link: &'l str) -> (Vec<&'l Joint>, &'l str) {
        let (mut joints, mut at) = (vec![], link);
        while let Some(joint) = self.joints.iter().find(|joint| joint.child == at) {
            // A robot that closes a circle.
            if joints.len() == self.joints.len() {
                break;
            }
            joints.push(joint);
            at = &joint.parent;
        }
        (joints, at)
    }

    /// The place of a link relative to another one, if no joint between them moves.
    fn place(&self, from: &str, link: &str) -> Result<Isometry3<f64>, String> {
        let ((mut up, from_top), (mut down, top)) = (self.joints_above(from), self.joints_above(link));
        let name = self.file.display();
        if from_top != top {
            return Err(format!("links: `{link}` in {name} is not joined to `{from}`; expected joints between them"));
        }
        // Joints above both may move.
        while let (Some(one), Some(other)) = (up.last(), down.last())
            && core::ptr::eq(*one, *other)
        {
            up.pop();
            down.pop();
        }
        if let Some(joint) = down.iter().chain(&up).find(|joint| joint.kind != "fixed") {
            return Err(format!(
                "links: `{link}` in {name} moves against `{from}`: joint `{}` is {}; expected fixed joints",
                joint.name, joint.kind
            ));
        }
        let along =
            |joints: &[&Joint]| joints.iter().rev().fold(Isometry3::identity(), |place, joint| place * joint.origin);
        Ok(along(&up).inverse() * along(&down))
    }
}

#[cfg(feature = "rooms")]
#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::{RingSpec, RoomsAsked};
    use eeruf_files::emit::Emit as _;

    /// A robot with a mast that turns; its front sensors hang on a bracket, and the left one is upside down.
    const ROBOT: &str = r#"<?xml version="1.0"?>
<robot name="r2">
  <!-- Colours and what only a simulator needs. -->
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="world"/>
  <joint name="drives" type="planar"><parent link="world"/><child link="base_footprint"/></joint>
  <link name="base_footprint"/>
  <joint name="lift" type="fixed">
    <parent link="base_footprint"/><child link="base_link"/><origin xyz="0 0 0.08"/>
  </joint>
  <link name="base_link">
    <visual><geometry><cylinder radius="0.2" length="0.1"/></geometry><material name="grey"/></visual>
    <inertial><mass value="4"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  </link>
  <joint name="wheel" type="continuous"><parent link="base_link"/><child link="wheel"/><axis xyz="0 1 0"/></joint>
  <link name="wheel"/>
  <joint name="bracket" type="fixed">
    <parent link="base_link"/><child link="bracket"/><origin xyz="0.1 0 0.02" rpy="0 0 1.5707963267948966"/>
  </joint>
  <link name="bracket"/>
  <joint name="left" type="fixed">
    <parent link="bracket"/><child link="sonar_left"/><origin xyz="0.12 -0.03 0" rpy="3.141592653589793 0 -1.0"/>
  </joint>
  <link name="sonar_left"/>
  <joint name="right" type="fixed">
    <parent link="bracket"/><child link="sonar_right"/><origin xyz="-0.12 -0.03 0" rpy="0 0 -2.1415926535897931"/>
  </joint>
  <link name="sonar_right"/>
  <joint name="rear" type="fixed">
    <parent link="base_footprint"/><child link="sonar_rear"/><origin xyz="-0.2 0 0.1" rpy="0 -0.1 3.141592653589793"/>
  </joint>
  <link name="sonar_rear"/>
  <joint name="turns" type="revolute">
    <parent link="base_link"/><child link="mast"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <link name="mast"/>
  <joint name="head" type="fixed"><parent link="mast"/><child link="sonar_head"/></joint>
  <link name="sonar_head"/>
  <joint name="down" type="fixed">
    <parent link="base_link"/><child link="sonar_down"/><origin rpy="0 1.0 0"/>
  </joint>
  <link name="sonar_down"/>
  <link name="loose"/>
  <gazebo reference="sonar_left"><sensor type="ray" name="s"/></gazebo>
  <gazebo><plugin name="p" filename="f.so"/></gazebo>
</robot>"#;

    const RING: &str = "sensors = 3\nmodule = \"hc-sr04\"\nlayout = \"line\"\n";
    const LINKS: &str = "urdf = \"robot.urdf\"\nlinks = [\"sonar_left\", \"sonar_right\", \"sonar_rear\"]\n";

    /// A ring file in a folder of its own, beside a robot's URDF.
    fn ring(name: &str, ring: &str, robot: &str) -> Result<RingSpec, String> {
        let folder = std::env::temp_dir().join(format!("eeruf-urdf-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("robot.urdf"), robot).unwrap();
        let spec = RingSpec::in_file(&folder.join("ring.toml"), ring);
        std::fs::remove_dir_all(&folder).unwrap();
        spec.map_err(|error| error.to_string().replace(&format!("{}/", folder.display()), ""))
    }

    #[test]
    fn poses_follow_the_fixed_joints_from_the_base() {
        let places = ring("poses", &format!("{RING}{LINKS}"), ROBOT).unwrap().places;
        let left_deg = 90.0 - 1f64.to_degrees();
        let right_deg = 90.0 - 2.141_592_653_589_793_f64.to_degrees();
        let expected = [(0.13, 0.12, 0.02, left_deg), (0.13, -0.12, 0.02, right_deg), (-0.2, 0.0, 0.1 - 0.08, 180.0)];
        for ((pose, z_m), (x, y, z, deg)) in places.poses.iter().zip(&places.z_m).zip(expected) {
            let heading = pose.heading_rad.to_degrees();
            let off = [pose.x_m - x, pose.y_m - y, z_m - z, (heading.abs() - deg.abs())];
            assert!(off.iter().all(|off| off.abs() < 1e-12), "{places:?}");
        }
        assert!((places.base_height_m - 0.08).abs() < 1e-15 && places.assumed.is_empty(), "{places:?}");
        assert_eq!((places.base_link.as_deref(), places.urdf_links.len()), (Some("base_link"), 12));
    }

    #[test]
    fn ring_with_a_urdf_is_judged_as_with_its_poses() {
        let linked = ring("linked", &format!("{RING}{LINKS}"), ROBOT).unwrap();
        let places = "base_height_m = 0.08\nposes = [\
                      { x_m = 0.13, y_m = 0.12, z_m = 0.02, heading_deg = 32.704220486917 }, \
                      { x_m = 0.13, y_m = -0.12, z_m = 0.02, heading_deg = -32.704220486917 }, \
                      { x_m = -0.2, y_m = 0, z_m = 0.02, heading_deg = 180 }]";
        let listed = RingSpec::from_text(&format!("{RING}{places}")).unwrap();
        assert_eq!(listed.robot_ring().heights_m.len(), 3);
        let answer = |spec: &RingSpec| {
            let design = spec.shortest_to_study().unwrap().unwrap();
            let asked = RoomsAsked { places: 1, ..RoomsAsked::default() };
            let judged = spec.judge_in_rooms(Some(&design), &asked, &|_| true).unwrap();
            assert!(judged.assumed.is_empty(), "{:?}", judged.assumed);
            (design.schedule.to_toml(), judged.kinds)
        };
        assert_eq!(answer(&linked), answer(&listed));
        // The heights of the sensors count.
        let higher = RingSpec::from_text(&format!("{RING}{}", places.replace("0.08", "1.0"))).unwrap();
        assert_ne!(answer(&linked).1, answer(&higher).1);
    }

    #[test]
    fn floor_and_base_that_a_urdf_lacks_are_said() {
        let no_floor = ROBOT.replace("base_footprint", "bottom");
        let text = format!("{RING}{LINKS}");
        let places = ring("floor", &text, &no_floor).unwrap().places;
        assert_eq!(places.base_height_m, 0.0);
        assert!(places.assumed[0].starts_with("base_link on the floor, as "), "{:?}", places.assumed);
        let places = ring("height", &format!("{text}base_height_m = 0.3"), &no_floor).unwrap().places;
        assert!(places.assumed.is_empty() && (places.heights_m()[0] - 0.32).abs() < 1e-12, "{places:?}");
        let low = ring("low", &text, &no_floor.replace("0.1 0 0.02", "0.1 0 -0.02")).unwrap_err();
        assert_eq!(
            low,
            "ring.toml, line 5: links: sensor 0 is -0.02 m above the floor; expected above 0 to 100: base_height_m \
             says how high the base is, where z is 0"
        );
        let root = ROBOT.replace("base_link", "chassis").replace("<link name=\"world\"/>", "");
        let root = root.replace(
            "<joint name=\"drives\" type=\"planar\"><parent link=\"world\"/><child link=\"base_footprint\"/></joint>",
            "",
        );
        let places = ring("root", &text, &root).unwrap().places;
        assert_eq!(places.base_link.as_deref(), Some("base_footprint"));
        assert!((places.heights_m()[0] - 0.1).abs() < 1e-12, "{places:?}");
    }

    #[test]
    fn errors_name_link_joint_and_cause() {
        let refused = |links: &str, robot: &str| {
            ring("error", &format!("{RING}{}", LINKS.replace("sonar_rear", links)), robot).unwrap_err()
        };
        let error = refused("sonar_raer", ROBOT);
        assert!(
            error.starts_with("ring.toml, line 5: links: no `sonar_raer` in robot.urdf; expected one of `world`, ")
        );
        assert!(error.ends_with("`loose`; did you mean `sonar_rear`?"), "{error}");
        assert_eq!(
            refused("sonar_head", ROBOT),
            "ring.toml, line 5: links: `sonar_head` in robot.urdf moves against `base_link`: joint `turns` is \
             revolute; expected fixed joints"
        );
        assert_eq!(
            refused("loose", ROBOT),
            "ring.toml, line 5: links: `loose` in robot.urdf is not joined to `base_link`; expected joints between them"
        );
        let error = refused("sonar_down", ROBOT);
        assert!(error.contains("`sonar_down` in robot.urdf looks -57 degrees up; expected 15 at most"), "{error}");
        assert!(refused("sonar_left", ROBOT).contains("links: `sonar_left` twice"));
        let error = refused("sonar_rear", &ROBOT.replace("0.12 -0.03 0\"", "nan 0 0\""));
        assert!(
            error.contains("a coordinate of `sonar_left` from `base_link` in robot.urdf = NaN; expected"),
            "{error}"
        );
        let xacro = "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\"><xacro:include filename=\"a\"/></robot>";
        assert_eq!(
            refused("sonar_rear", xacro),
            "ring.toml, line 4: urdf: robot.urdf is a xacro file; expected a URDF: run xacro first, `xacro robot.urdf` \
             prints one"
        );
        let error = refused("sonar_rear", "<robot name=\"a\"><link/></robot>");
        assert!(error.starts_with("ring.toml, line 4: urdf: robot.urdf: ") && error.ends_with("; expected a URDF"));
        let of = |more: &str| ring("keys", &format!("{RING}{more}"), ROBOT).unwrap_err();
        assert!(of(&LINKS.replace("robot.urdf", "no.urdf")).contains("line 4: urdf: no.urdf: No such file"));
        assert!(of("urdf = \"robot.urdf\"").contains("line 4: urdf = \"robot.urdf\" without links; expected"));
        assert!(of("links = [\"sonar_left\"]").contains("expected either poses, or spacing_deg and radius_m, or urdf"));
        assert!(of(&LINKS.replace(", \"sonar_rear\"", "")).contains("line 5: links has 2 names; expected 3"));
        let error = RingSpec::from_text(&format!("{RING}{LINKS}")).unwrap_err().to_string();
        assert!(error.starts_with("line 4: urdf = \"robot.urdf\" is looked for beside the ring file"), "{error}");
    }

    // A joint whose parent is below it does not cause an endless loop.
    #[test]
    fn robot_that_closes_a_circle_ends() {
        let circle = r#"<robot name="c"><link name="base_link"/><link name="a"/><link name="b"/>
            <joint name="1" type="fixed"><parent link="a"/><child link="b"/></joint>
            <joint name="2" type="fixed"><parent link="b"/><child link="a"/></joint></robot>"#;
        let file = PathBuf::new();
        let urdf = Urdf::of(&file, circle).unwrap();
        assert!(urdf.place(BASE, "a").unwrap_err().contains("not joined"));
    }
}
