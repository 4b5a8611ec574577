//! Set III over many placings: every method's figures and their spread.

use serde::Serialize;

use super::figures::{Brief, Figures, Run};
use super::placing::{Arrangement, Placing, Site};
use crate::experiments::by_name::{by_name, named, transposed};
use crate::experiments::conditions::Conditions;
use crate::experiments::error::{ExperimentError, distinct, numbers};
use crate::experiments::progress::Progress;
use crate::{
    acoustics::{GainProfile, Physics},
    experiments::FIRST,
    methods::Method,
    scene::Room,
    simulation::{Entry, Options},
    threads::{Stop, sweep},
    world::{Noise, Robot, World, WorldError},
};

/// Options of Set III.
#[derive(Clone, Debug, PartialEq)]
pub struct SetThreeOptions {
    /// Number of placings. The default is 200.
    pub seeds: u64,
    /// The first placing's number. The default is [`FIRST`]: parameters were tuned on numbers below 2,000.
    pub first: u64,
    /// Number of periods for which each placing is simulated. The default is 40 (4 s), after which meeting robots are
    /// side by side.
    pub periods: u32,
    /// The methods. The default is [`usual`].
    pub methods: Vec<Entry>,
    /// Effects in the rooms. The default is [`Physics::DEFAULT`].
    pub physics: Physics,
    /// Floor and ceiling. The default is none: the rooms are flat.
    pub room: Option<Room>,
    /// The growth of the receivers' gain. The default is constant.
    pub gain: GainProfile,
}

/// Returns the methods that Set III compares by default.
pub fn usual() -> Vec<Entry> {
    use Method::{Dither, Eeruf, Flow, Sequential, SequentialVotes, Simultaneous};
    Entry::all([Simultaneous, Sequential, SequentialVotes, Dither, Eeruf, Flow])
}

impl Default for SetThreeOptions {
    fn default() -> Self {
        Self {
            seeds: 200,
            first: FIRST,
            periods: 40,
            methods: usual(),
            physics: Physics::DEFAULT,
            room: None,
            gain: GainProfile::Constant,
        }
    }
}

/// Set III over many placings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SetThree {
    /// The first placing's number.
    pub first: u64,
    /// Number of placings.
    pub seeds: u64,
    /// Effects in the rooms.
    pub physics: Physics,
    /// The rooms' height and the rings' gain.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// Number of periods for which each placing was simulated.
    pub periods: u32,
    /// The methods in the order asked for, with their figures over all placings.
    #[serde(serialize_with = "by_name")]
    pub methods: Vec<(String, Figures)>,
    /// The placings by place and arrangement, and by the number of robots.
    pub groups: Vec<Group>,
    /// For each method, the result in each placing.
    #[serde(skip)]
    pub runs: Vec<Vec<Run>>,
}

/// A group of placings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// Surroundings of the robots; `None` for any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub place: Option<Site>,
    /// The robots' arrangement; `None` for any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arrangement: Option<Arrangement>,
    /// Number of robots; `None` for any number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robots: Option<usize>,
    /// Number of placings in the group.
    pub placings: usize,
    /// The methods in the order asked for, with their figures over these placings.
    #[serde(serialize_with = "by_name")]
    pub methods: Vec<(String, Brief)>,
}

/// Runs Set III: every placing under each method, on all cores.
///
/// Several threads sometimes call `keep_going` with the finished share, 0 to 1; if it returns `false`, the run stops.
/// The result does not depend on the number of threads.
///
/// # Errors
/// [`ExperimentError`] for no placings, more than there are numbers for, no methods or two of one name, and if
/// `keep_going` stopped it.
///
/// ```
/// use eeruf_sim::{Entry, experiments::set_three::{SetThreeOptions, set_three}};
/// let methods = vec!["conventional".parse()?, "flow".parse()?];
/// let asked = SetThreeOptions { seeds: 2, periods: 20, methods, ..SetThreeOptions::default() };
/// let table = set_three(&asked, &|_| true)?;
/// assert_eq!(table.methods[1].0, "flow");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn set_three(
    asked: &SetThreeOptions,
    keep_going: &(dyn Fn(f64) -> bool + Sync),
) -> Result<SetThree, ExperimentError> {
    let placings: Vec<u64> = numbers(asked.first, asked.seeds)?.collect();
    distinct(&asked.methods)?;
    let progress = Progress::new(asked.seeds.saturating_mul(asked.methods.len() as u64), keep_going);
    let runs = sweep(&placings, |&number| {
        let mut runs = Vec::with_capacity(asked.methods.len());
        if !progress.go_on() {
            return Err(ExperimentError::Stopped);
        }
        let placing = Placing::random(number);
        for entry in &asked.methods {
            let world = world_of(asked, &placing, entry)?.with_seed(number);
            let options = Options::periods(asked.periods);
            let readings = entry.simulate(&world, &options, &Stop::default(), |_| progress.go_on())?;
            runs.push(Run::of(number, &readings, world.robots().len()));
            progress.one_done();
        }
        Ok(runs)
    });
    let runs: Vec<Vec<Run>> = runs.into_iter().collect::<Result<_, ExperimentError>>()?;
    if progress.stopped() {
        return Err(ExperimentError::Stopped);
    }
    Ok(SetThree::of(asked, transposed(asked.methods.len(), runs)))
}

impl SetThree {
    /// Makes the table from finished runs: for each method one run for each placing.
    pub fn of(asked: &SetThreeOptions, runs: Vec<Vec<Run>>) -> Self {
        let &SetThreeOptions { first, seeds, periods, physics, .. } = asked;
        let methods = named(&asked.methods, runs.iter().map(|runs| Figures::of(runs)));
        let conditions = Conditions::of(asked.room.as_ref(), asked.gain);
        let names: Vec<_> = asked.methods.iter().map(Entry::name).collect();
        let groups = group(&names, &runs);
        Self { first, seeds, physics, conditions, periods, methods, groups, runs }
    }
}

/// Groups the placings by place and arrangement, and by number of robots; `runs` has a list for each name.
pub fn group(names: &[&str], runs: &[Vec<Run>]) -> Vec<Group> {
    let placing = |run: &Run| {
        let Placing { place, arrangement, robots, .. } = Placing::random(run.seed);
        (place, arrangement, robots.len())
    };
    let kinds: Vec<_> = runs.first().into_iter().flatten().map(placing).collect();
    let group = |place: Option<Site>, arrangement: Option<Arrangement>, robots: Option<usize>| {
        let of = |kind: &(Site, Arrangement, usize)| {
            place.is_none_or(|place| place == kind.0)
                && arrangement.is_none_or(|arrangement| arrangement == kind.1)
                && robots.is_none_or(|robots| robots == kind.2)
        };
        let members = |runs: &'_ [Run]| -> Vec<Run> {
            runs.iter().zip(&kinds).filter(|(_, kind)| of(kind)).map(|(run, _)| *run).collect()
        };
        let briefs = runs.iter().map(|runs| Brief::of(members(runs).iter()));
        let methods = names.iter().map(|&name| name.to_owned()).zip(briefs).collect();
        Group { place, arrangement, robots, placings: kinds.iter().filter(|kind| of(kind)).count(), methods }
    };
    let arrangements = [Arrangement::Standing, Arrangement::Meeting, Arrangement::Following];
    let places = [Site::Corridor, Site::Hall].into_iter();
    let kinds_of = places.flat_map(|place| arrangements.map(|arrangement| (place, arrangement)));
    let by_kind = kinds_of.map(|(place, arrangement)| group(Some(place), Some(arrangement), None));
    let all = by_kind.chain((2..=6).map(|robots| group(None, None, Some(robots))));
    all.filter(|group| group.placings > 0).collect()
}

/// Makes a placing as a world of rings that fire by a method.
///
/// # Errors
/// [`WorldError`] for an invalid placing.
pub fn world_of(asked: &SetThreeOptions, placing: &Placing, entry: &Entry) -> Result<World, WorldError> {
    let robot = |robot: &Robot| entry.robot(robot.clone().with_pattern(Some(asked.gain), None));
    let robots = placing.robots.iter().map(robot).collect();
    World::new(placing.scene()?.with_room(asked.room)?, robots, Noise::default())?.with_physics(asked.physics)
}
