//! Runs of all ways in all rooms under all conditions, and the results as CSV.

use core::fmt::Write as _;
use core::ops::Range;

use super::cost::Point;
use super::heard::{Control, Heard};
use super::sight::Sight;
use super::things::{Draws, ThingKind};
use super::trial::{Condition, Moving, Speeds, Trial};
use super::votes::Setting;
use super::ways::{Family, RoomWay};
use crate::{
    experiments::error::ExperimentError,
    experiments::progress::Progress,
    experiments::rooms::{RoomGroup, RoomPlan},
    methods::Method,
    simulation::Options,
    threads::sweep,
    world::World,
};

/// Rooms and conditions in which ways are measured.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureAsked {
    /// The conditions.
    pub conditions: Vec<Condition>,
    /// The caller's own rooms; empty for rooms of the set.
    pub own: Vec<RoomGroup>,
    /// The number of the first room of each kind. Settings are chosen on numbers below 2,000, and reported from
    /// [`FIRST`](crate::experiments::FIRST) on.
    pub first: u64,
    /// Number of rooms of each of the seven kinds without another robot; seven times as many have one.
    pub places: u64,
    /// The robot's speeds.
    pub speeds: Speeds,
}

/// A trial's room, and the thing that appeared.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The room's kind, or the name of its group, and its number.
    pub room: (String, u64),
    /// The thing's kind, its sensor and distance in metres; `None` if no thing fitted that its sensor could read.
    pub thing: Option<(ThingKind, usize, f64)>,
    /// Counts of the things drawn.
    pub draws: Draws,
    /// The driving or turning robot's speed in m/s.
    pub speed_m_s: f64,
}

/// Figures of one way by setting, in the order of [`Setting::ALL`], and room; or the reason why the way cannot fire.
pub type BySetting = Result<Vec<Vec<Sight>>, String>;

/// Results of all ways under one condition.
#[derive(Clone, Debug)]
pub struct Under {
    /// The condition.
    pub condition: Condition,
    /// The rooms.
    pub places: Vec<Place>,
    /// Figures of each way.
    pub sights: Vec<BySetting>,
}

/// Ways with their figures under all conditions.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The ways.
    pub ways: Vec<RoomWay>,
    /// The conditions.
    pub under: Vec<Under>,
}

impl MeasureAsked {
    /// The rooms under a condition for a robot of this radius, each with its group's name and its random key.
    fn rooms(&self, condition: Condition, radius_m: f64) -> Vec<(String, u64, RoomPlan)> {
        /// The key of the caller's rooms, next to the keys of the kinds.
        const OWN: u64 = 20;
        if self.own.is_empty() {
            let of_set = condition.rooms(self.first, self.places).into_iter();
            let plan = |(kind, number)| RoomPlan::random(kind, number, radius_m);
            return of_set.map(|room| (room.0.to_string(), room.0 as u64, plan(room))).collect();
        }
        let of_group = |group: &RoomGroup| {
            group.rooms.iter().map(|plan| (group.name.clone(), OWN, plan.clone())).collect::<Vec<_>>()
        };
        self.own.iter().flat_map(of_group).collect()
    }
}

impl Under {
    /// The mean share of time with an echo in which the belief is right, by the groups of rooms; none without an echo.
    pub fn right_by_room(&self, sights: &[Sight]) -> Vec<(String, Option<f64>)> {
        let mut names: Vec<&String> = self.places.iter().map(|place| &place.room.0).collect();
        names.dedup();
        let mean = |name: &String| {
            let of = self.places.iter().zip(sights).filter(|(place, _)| place.room.0 == *name);
            let shares: Vec<f64> = of.map(|(_, sight)| sight.right).filter(|right| !right.is_nan()).collect();
            let mean = shares.iter().sum::<f64>() / shares.len() as f64;
            (name.clone(), (!shares.is_empty()).then_some(mean))
        };
        names.into_iter().map(mean).collect()
    }

    /// The share of fitting things that the sensor facing them does not read: the module's blindness.
    pub fn unread(&self) -> f64 {
        let sum = |of: fn(&Draws) -> u32| self.places.iter().map(|place| f64::from(of(&place.draws))).sum::<f64>();
        sum(|draws| draws.unread) / sum(|draws| draws.fitted).max(1.0)
    }
}

/// Measures ways, each of them or its control, on all cores. Several threads call `keep_going` with the finished share,
/// 0 to 1; if it returns `false`, the measurement stops. The result does not depend on the number of threads.
///
/// # Errors
/// [`ExperimentError`] for no ways, rooms or conditions, for a room too small for the robot, and if
/// `keep_going` stopped it.
pub fn measure(
    ways: &[(RoomWay, Option<Control>)],
    asked: &MeasureAsked,
    keep_going: &(dyn Fn(f64) -> bool + Sync),
) -> Result<Measured, ExperimentError> {
    let Some((first, _)) = ways.first() else { return Err(ExperimentError::NoMethods) };
    let robot = &first.robot;
    let rooms = |&condition: &Condition| {
        asked.rooms(condition, robot.radius_m()).into_iter().map(move |room| (condition, room))
    };
    let jobs: Vec<_> = asked.conditions.iter().flat_map(rooms).collect();
    if jobs.is_empty() {
        return Err(ExperimentError::NoSeeds);
    }
    let progress = Progress::new(jobs.len() as u64, keep_going);
    // A control may need what comes after the thing is seen.
    let until_seen = ways.iter().all(|(_, control)| control.is_none());
    let runs = sweep(&jobs, |(condition, (name, key, plan))| {
        let trial = Trial::new((*key, plan.clone()), robot, *condition, asked.speeds)?;
        // Controls of one way share its readings.
        let mut last: Option<(&RoomWay, Vec<Heard>)> = None;
        let mut sights = Vec::with_capacity(ways.len());
        for (way, control) in ways {
            let mut heard = match last.take().filter(|(before, _)| *before == way) {
                Some((_, heard)) => heard,
                None => match trial.heard(way, until_seen, &|| progress.go_on()) {
                    Err(ExperimentError::Simulation(error)) => {
                        sights.push(Err(error.to_string()));
                        continue;
                    }
                    heard => heard?,
                },
            };
            last = Some((way, heard.clone()));
            if let Some(control) = control {
                control.apply(&mut heard, plan.number, trial.c);
            }
            sights.push(Ok(Setting::ALL.map(|setting| trial.sight(&way.robot, &heard, setting, *control))));
        }
        progress.one_done();
        Ok((*condition, (trial.place(name.clone()), sights)))
    });
    let runs = runs.into_iter().collect::<Result<Vec<_>, ExperimentError>>()?;
    if progress.stopped() {
        return Err(ExperimentError::Stopped);
    }
    let mut runs = runs.into_iter().peekable();
    let under = asked.conditions.iter().map(|&condition| {
        let of_condition = core::iter::from_fn(|| runs.next_if(|(of, _)| *of == condition));
        let (places, by_room): (Vec<_>, Vec<_>) = of_condition.map(|(_, run)| run).unzip();
        Under { condition, places, sights: by_setting(by_room, ways.len()) }
    });
    let under = under.collect();
    Ok(Measured { ways: ways.iter().map(|(way, _)| way.clone()).collect(), under })
}

/// Regroups the figures of each room by way and setting.
fn by_setting(mut by_room: Vec<Vec<Result<[Sight; Setting::ALL.len()], String>>>, ways: usize) -> Vec<BySetting> {
    let of_way = |way: usize| -> BySetting {
        let of_rooms: Vec<_> =
            by_room.iter_mut().map(|sights| core::mem::replace(&mut sights[way], Err(String::new()))).collect();
        let of_rooms = of_rooms.into_iter().collect::<Result<Vec<_>, _>>()?;
        Ok((0..Setting::ALL.len()).map(|setting| of_rooms.iter().map(|sights| sights[setting]).collect()).collect())
    };
    (0..ways).map(of_way).collect()
}

impl Trial {
    fn place(&self, name: String) -> Place {
        let thing = self.thing.as_ref().map(|thing| (thing.kind, thing.sensor, thing.distance_m));
        let room = (name, self.plan.number);
        Place { room, thing, draws: self.draws, speed_m_s: self.speeds.speed_m_s }
    }
}

/// Measures methods of the first robot of a scene like [`measure`], one by one first, in trials with these numbers, on
/// all cores.
///
/// # Errors
/// [`ExperimentError`] for no robot or trials, for a scene without room for the robots, and if `keep_going` stopped it.
pub fn measure_in_scene(
    world: &World,
    methods: &[(Family, Method)],
    trials: Range<u64>,
    keep_going: &(dyn Fn(f64) -> bool + Sync),
) -> Result<Measured, ExperimentError> {
    let robot = world.robots().first().ok_or(ExperimentError::NoSeeds)?;
    let way = |&(family, method): &(Family, Method)| {
        let name = method.as_str();
        RoomWay { family, name, method, robot: robot.clone(), options: Options::default() }
    };
    let progress = Progress::new(trials.end.saturating_sub(trials.start), keep_going);
    let runs = sweep(&trials.collect::<Vec<_>>(), |&number| {
        let trial = Trial::in_scene(world, number).ok_or(ExperimentError::NoSeeds)?;
        let sights =
            methods.iter().map(|&(_, method)| match trial.heard_in_scene(world, method, &|| progress.go_on()) {
                Err(ExperimentError::Simulation(error)) if !progress.stopped() => Ok(Err(error.to_string())),
                heard => heard.map(|heard| Ok(Setting::ALL.map(|setting| trial.sight(robot, &heard, setting, None)))),
            });
        let sights = sights.collect::<Result<Vec<_>, _>>()?;
        progress.one_done();
        Ok((trial.place(String::new()), sights))
    });
    if progress.stopped() {
        return Err(ExperimentError::Stopped);
    }
    let (places, by_room) = runs.into_iter().collect::<Result<Vec<_>, ExperimentError>>()?.into_iter().unzip();
    let condition = Condition { moving: Moving::Standing, others: false };
    let under = vec![Under { condition, places, sights: by_setting(by_room, methods.len()) }];
    Ok(Measured { ways: methods.iter().map(way).collect(), under })
}

impl Measured {
    /// The points of some of the ways.
    pub fn points(&self, ways: impl Fn(usize) -> bool) -> Vec<Point> {
        let of_way = |way| Setting::ALL.map(|setting| Point { way, setting });
        (0..self.ways.len()).filter(|&way| ways(way)).flat_map(of_way).collect()
    }

    /// The points of each family, for [`costs`](Self::costs).
    pub fn families(&self) -> Vec<Vec<Point>> {
        Family::ALL.into_iter().map(|family| self.points(|way| self.ways[way].family == family)).collect()
    }

    /// Adds rooms in which the ways were measured under the same conditions.
    pub fn add(&mut self, more: Self) {
        for (under, more) in self.under.iter_mut().zip(more.under) {
            under.places.extend(more.places);
            for (sights, more) in under.sights.iter_mut().zip(more.sights) {
                match (&mut *sights, more) {
                    (Ok(sights), Ok(more)) => sights.iter_mut().zip(more).for_each(|(all, more)| all.extend(more)),
                    (Ok(_), Err(why)) => *sights = Err(why),
                    (Err(_), _) => {}
                }
            }
        }
    }

    /// The measurement under some of the conditions, of some of the ways.
    pub fn only(&self, conditions: impl Fn(Condition) -> bool, ways: impl Fn(usize) -> bool) -> Self {
        let kept: Vec<usize> = (0..self.ways.len()).filter(|&way| ways(way)).collect();
        let under = self.under.iter().filter(|under| conditions(under.condition)).map(|under| Under {
            condition: under.condition,
            places: under.places.clone(),
            sights: kept.iter().map(|&way| under.sights[way].clone()).collect(),
        });
        Self { ways: kept.iter().map(|&way| self.ways[way].clone()).collect(), under: under.collect() }
    }

    /// The head of [`csv`](Self::csv).
    pub const CSV_HEAD: &'static str = "condition,room,number,way,setting,thing,sensor,distance_m,drawn,unread,\
                                        speed_m_s,latency_ms,false_stops,watched_s,foreign,right,blind";

    /// Returns one row for each room, way, condition and setting, without a head. An infinite latency is `inf`, a
    /// missing value is empty.
    pub fn csv(&self) -> String {
        let mut out = String::new();
        for under in &self.under {
            for (way, by_setting) in self.ways.iter().zip(&under.sights) {
                for (setting, sights) in Setting::ALL.iter().zip(by_setting.iter().flatten()) {
                    for (place, sight) in under.places.iter().zip(sights) {
                        let Place { room: (kind, number), thing, draws: Draws { fitted, unread }, speed_m_s } = place;
                        let &Sight { ref latency_ms, false_stops, watched_s, foreign, ref right, blind, .. } = sight;
                        let thing =
                            thing.map_or(",,".to_owned(), |(kind, sensor, m)| format!("{kind:?},{sensor},{m:.3}"));
                        let known = |value: &f64| if value.is_nan() { String::new() } else { format!("{value:.4}") };
                        _ = writeln!(
                            out,
                            "{},{kind},{number},{},{setting},{thing},{fitted},{unread},{speed_m_s:.3},{},{false_stops},\
                             {watched_s:.3},{foreign:.5},{},{blind}",
                            under.condition.as_str(),
                            way.name,
                            known(latency_ms),
                            known(right),
                        );
                    }
                }
            }
        }
        out
    }
}
