//! [`Way`]: a way of firing that a program for a board can use.

use eeruf_core::flow::{InTurn, TurnSettings, Votes};
use eeruf_core::plan::Plan as _;
use eeruf_core::{EachSensor, Instant, MAX_SENSORS, SensorLimits};
use eeruf_sim::Robot;
use eeruf_sim::experiments::measure::RoomWay;
use eeruf_sim::methods::Method;
use eeruf_sim::world::FiringTable;
use serde::Serialize;

use crate::flow::FlowDesign;
use crate::ring::RingSpec;

/// A way of firing that a program for a board can use. All except two phases are settings of one ring,
/// [`FlowRing`](eeruf_core::flow::FlowRing).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// One sensor after the other, each when the previous sound has died away; every echo is believed.
    Sequential,
    /// Groups of sensors that are not neighbours, group after group; every echo is believed.
    Groups,
    /// The paper's way: a table whose waits alternate between two values.
    TwoPhases,
    /// One sensor after the other, each with only as much quiet as it needs.
    Flow,
}

impl Way {
    /// All ways, the simplest first.
    pub const ALL: [Self; 4] = [Self::Sequential, Self::Groups, Self::TwoPhases, Self::Flow];

    /// The name in options and in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sequential => "sequential",
            Self::Groups => "groups",
            Self::TwoPhases => "two-phases",
            Self::Flow => "flow",
        }
    }

    /// The name in sentences.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Sequential => "one by one",
            Self::Groups => "in groups",
            Self::TwoPhases => "in two phases",
            Self::Flow => "by flow",
        }
    }

    /// The order and the gaps of a ring's firings, in words.
    pub fn in_words(self, turns: &TurnSettings) -> String {
        let [least, most] = [turns.least, turns.most].map(|time| format!("{:.1}", f64::from(time.as_micros()) / 1e3));
        match self {
            Self::Sequential => format!("one by one, one each {most} ms; every echo is believed."),
            Self::Groups => format!("group after group, one each {most} ms; every echo is believed."),
            Self::TwoPhases => {
                "two phases, by a table whose waits alternate; what agrees twice is believed.".to_owned()
            }
            Self::Flow => format!(
                "flow: one after the other, each with as much quiet as it has needed, {least} to {most} ms. An echo is \
                 believed if it fits the last one believed, or if two in a row agree and no other firing explains them."
            ),
        }
    }

    /// Returns true if the way is recommended where it costs least. Two phases need firings on time, and among sensors
    /// that fire together only distance keeps foreign sound out.
    pub const fn is_recommended(self) -> bool {
        matches!(self, Self::Sequential | Self::Flow)
    }

    /// The way of a program that corresponds to one judged in rooms; `None` if there is none. One by one believes every
    /// echo, so each sensor has the air for itself while it listens.
    pub fn of(way: &RoomWay) -> Option<Self> {
        match way.method {
            Method::Sequential => Some(Self::Sequential),
            Method::Table => {
                let gap = way.robot.firing.table.as_ref()?.gap();
                (gap >= way.robot.window).then_some(Self::Sequential)
            }
            Method::FarGroups => Some(Self::Groups),
            Method::Eeruf => Some(Self::TwoPhases),
            Method::Flow => Some(Self::Flow),
            _ => None,
        }
    }
}

/// A way of firing with its figures. Sensors count from 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct How {
    /// The way's name.
    pub way: &'static str,
    /// Description of the way in words.
    pub in_words: String,
    /// Sensors in the order in which they fire while nothing is heard; `None` for a table.
    pub order: Vec<u8>,
    /// The least and the greatest time from a firing to the next, in microseconds; `None` for a table.
    pub gaps_us: Option<[u32; 2]>,
    /// Sensors that fire together.
    pub groups: Vec<Vec<u8>>,
    /// The echoes that are believed: `every_echo`, `by_motion` (flow's judge), or `two_in_a_row`.
    pub votes: &'static str,
}

impl RingSpec {
    /// Returns the description of a way judged in rooms; `None` for one that no program can use.
    ///
    /// # Errors
    /// See [`fired`](Self::fired).
    pub fn how(&self, judged: &RoomWay) -> Result<Option<How>, String> {
        let Some(way) = Way::of(judged) else { return Ok(None) };
        if way == Way::TwoPhases {
            let in_words = way.in_words(&TurnSettings::new(1));
            let (order, groups) = (vec![], vec![]);
            return Ok(Some(How { way: way.name(), in_words, order, gaps_us: None, groups, votes: "two_in_a_row" }));
        }
        let FlowDesign { turns, belief, window, limits, .. } = self.fired(way, &judged.robot, 1)?;
        let now = Instant::from_micros(0);
        let plan = InTurn::<MAX_SENSORS, _>::with_limits(self.sensors, limits, turns, window, now);
        let mut plan = plan.map_err(|error| error.to_string())?;
        let mut order = vec![];
        while let Some((sensor, _)) = plan.next_firing().filter(|_| order.len() < self.sensors) {
            let due = plan.deadline();
            plan.fire(due);
            plan.ended(sensor, due);
            order.push(sensor);
        }
        let together = |group: u8| -> Vec<u8> {
            (0..self.sensors as u8).filter(|&x| limits.groups()[usize::from(x)] == group).collect()
        };
        let groups = (1..=self.sensors as u8).map(together).filter(|group| group.len() > 1).collect();
        Ok(Some(How {
            way: way.name(),
            in_words: way.in_words(&turns),
            order,
            gaps_us: Some([turns.least.as_micros(), turns.most.as_micros()]),
            groups,
            votes: if belief.votes == Votes::EveryEcho { "every_echo" } else { "by_motion" },
        }))
    }

    /// The settings for firing the robot one by one, in groups or by flow, as judged in rooms, with this seed of the
    /// random gaps.
    ///
    /// # Errors
    /// Groups of sensors that are neighbours, or that have groups of their own already, in words.
    pub fn fired(&self, way: Way, robot: &Robot, seed: u32) -> Result<FlowDesign, String> {
        let mut flow = match way {
            Way::Flow => self.flow_of(&robot.clone().by_flow(), seed),
            _ => self.flow_of(robot, seed),
        };
        if let (Way::Sequential, Some(gap)) = (way, robot.firing.table.as_ref().map(FiringTable::gap)) {
            flow.turns.most = gap.max(flow.window);
        }
        if matches!(way, Way::Sequential | Way::Groups) {
            flow.turns = flow.turns.one_by_one();
            flow.belief.votes = Votes::EveryEcho;
        }
        if way == Way::Groups {
            let together = self.groups_far_apart(!robot.together.is_empty())?;
            let t_delta = flow.belief.t_delta;
            let own = |sensor| flow.limits.of(sensor).unwrap_or(SensorLimits { window: flow.window, t_delta });
            flow.limits = EachSensor::for_flow(std::array::from_fn(|sensor| own(sensor as u8)), &together);
        }
        Ok(flow)
    }

    /// Sets of sensors that lie as far apart as neighbours reach, bit x for sensor x.
    fn groups_far_apart(&self, has_own: bool) -> Result<Vec<u64>, String> {
        if has_own {
            return Err(
                "groups: the ring file has `together`; expected none, as groups are made of single sensors".into()
            );
        }
        let (sensors, layout) = (self.sensors, self.layout.layout());
        let apart = usize::from(self.neighbours).clamp(1, sensors);
        let set = |first: usize| (first..sensors).step_by(apart);
        for first in 0..apart {
            let near = |x: usize| set(first).find(|&y| y > x && layout.neighbours(sensors, x, y)).map(|y| (x, y));
            if let Some((x, y)) = set(first).find_map(near) {
                return Err(format!(
                    "groups: sensors {x} and {y} are neighbours; expected a line, or a ring whose {sensors} sensors \
                     are a multiple of {apart}"
                ));
            }
        }
        Ok((0..apart).map(|first| set(first).fold(0, |set, x| set | 1 << x)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fired(ring: &str, way: Way) -> Result<FlowDesign, String> {
        let spec = RingSpec::from_text(ring).unwrap();
        let robot = spec.room_robot().unwrap().robot;
        spec.fired(way, &robot, 1)
    }

    #[test]
    fn order_and_groups_are_those_of_the_plan() {
        let spec = RingSpec::from_text("sensors = 8\nmodule = \"hc-sr04\"\nlayout = \"ring\"").unwrap();
        let ways = RoomWay::all(&spec.room_robot().unwrap().robot, None);
        let how = |name| spec.how(ways.iter().find(|way| way.name == name).unwrap()).unwrap();
        let flow = how("flow").unwrap();
        assert_eq!((flow.order, flow.votes, flow.groups.len()), (vec![0, 3, 6, 1, 4, 7, 2, 5], "by_motion", 0));
        assert!(flow.gaps_us.is_some_and(|[least, most]| least < most));
        let groups = how("far_groups").unwrap();
        assert_eq!(groups.groups, [[0, 4], [1, 5], [2, 6], [3, 7]]);
        assert_eq!((groups.order.len(), groups.votes), (8, "every_echo"));
        assert_eq!(how("blocking"), None);
        // Gaps are those that were measured; none is shorter than a sensor listens.
        assert_eq!(how("one_by_one_33ms").and_then(|how| how.gaps_us), Some([33_000; 2]));
        assert_eq!(how("one_by_one_20ms"), None);
    }

    #[test]
    fn one_by_one_keeps_all_its_quiet_and_groups_are_no_neighbours() {
        let ring = "sensors = 8\nmodule = \"hc-sr04\"\nlayout = \"ring\"\nneighbours = 4";
        let flow = fired(ring, Way::Flow).unwrap();
        assert!(flow.turns.least < flow.turns.most && flow.belief.votes == Votes::ByMotion);
        let one = fired(ring, Way::Sequential).unwrap();
        assert_eq!((one.turns.least, one.turns.most), (flow.turns.most, flow.turns.most));
        assert_eq!((one.belief.votes, one.limits.most().is_none()), (Votes::EveryEcho, true));
        let groups = fired(ring, Way::Groups).unwrap().limits;
        assert_eq!(groups.groups()[..8], [1, 2, 3, 4, 1, 2, 3, 4]);
        let ten = fired(&ring.replace("= 8", "= 10"), Way::Groups).unwrap_err();
        assert!(ten.contains("sensors 0 and 8 are neighbours; expected"), "{ten}");
    }
}
