//! Set III over many placings: every way's figures, and how they spread.

use serde::{Serialize, Serializer, ser::SerializeMap};

use super::figures::{Brief, Figures, Run};
use super::placing::{Arrangement, Place, Placing};
use super::way::Way;
use crate::experiments::conditions::Conditions;
use crate::experiments::error::{ExperimentError, numbers};
use crate::experiments::progress::Progress;
use crate::{
    acoustics::{GainProfile, Physics},
    experiments::FIRST,
    scene::Room,
    simulation::{Options, simulate_while},
    threads::sweep,
    world::{Noise, World, WorldError},
};

/// Options of Set III.
#[derive(Clone, Debug, PartialEq)]
pub struct SetThreeOptions {
    /// Number of placings. The default is 200.
    pub seeds: u64,
    /// The first placing's number. The default is [`FIRST`]: parameters were tuned on numbers below 2,000.
    pub first: u64,
    /// For how many periods each placing is simulated. The default is 40, 4 s: robots that meet are then side by side.
    pub periods: u32,
    /// The ways of firing. The default is [`Way::USUAL`].
    pub ways: Vec<Way>,
    /// Which effects the rooms have. The default is [`Physics::DEFAULT`].
    pub physics: Physics,
    /// Floor and ceiling. The default is none: the rooms are flat.
    pub room: Option<Room>,
    /// The growth of the receivers' gain. The default is constant.
    pub gain: GainProfile,
}

impl Default for SetThreeOptions {
    fn default() -> Self {
        Self {
            seeds: 200,
            first: FIRST,
            periods: 40,
            ways: Way::USUAL.to_vec(),
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
    /// Which effects the rooms had.
    pub physics: Physics,
    /// Their height and the rings' gain.
    #[serde(flatten)]
    pub conditions: Conditions,
    /// Periods that each was simulated for.
    pub periods: u32,
    /// The ways in the order asked for, with their figures over all placings.
    #[serde(serialize_with = "by_way")]
    pub methods: Vec<(Way, Figures)>,
    /// The placings by place and arrangement, and by the number of robots.
    pub groups: Vec<Group>,
}

/// Some of the placings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Group {
    /// Where they are; none for anywhere.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub place: Option<Place>,
    /// Their arrangement; none for any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arrangement: Option<Arrangement>,
    /// Number of robots; none for any number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub robots: Option<usize>,
    /// Number of these placings.
    pub placings: usize,
    /// The ways in the order asked for, with their figures over these placings.
    #[serde(serialize_with = "by_way")]
    pub methods: Vec<(Way, Brief)>,
}

fn by_way<S: Serializer, T: Serialize>(entries: &[(Way, T)], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(entries.len()))?;
    for (way, entry) in entries {
        map.serialize_entry(way, entry)?;
    }
    map.end()
}

/// Runs Set III: every placing under each way, on all cores.
///
/// `keep_going` is called now and then, by several threads, with the share that is done, 0 to 1; when its answer is
/// `false` the run stops. The result does not depend on the number of threads.
///
/// # Errors
/// [`ExperimentError`] for no placings, more than there are numbers for, or no ways, and if it was stopped.
///
/// ```
/// use eeruf_sim::experiments::set_three::{SetThreeOptions, Way, set_three};
/// let ways = vec!["conventional".parse()?, Way::Driving];
/// let asked = SetThreeOptions { seeds: 2, periods: 20, ways, ..SetThreeOptions::default() };
/// let table = set_three(&asked, &|_| true)?;
/// assert_eq!(table.methods[1].0, Way::Driving);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn set_three(
    asked: &SetThreeOptions,
    keep_going: &(dyn Fn(f64) -> bool + Sync),
) -> Result<SetThree, ExperimentError> {
    let &SetThreeOptions { first, seeds, periods, ref ways, physics, .. } = asked;
    let placings: Vec<u64> = numbers(first, seeds)?.collect();
    if ways.is_empty() {
        return Err(ExperimentError::NoMethods);
    }
    let progress = Progress::new(seeds.saturating_mul(ways.len() as u64), keep_going);
    let runs = sweep(&placings, |&number| {
        let mut runs = Vec::with_capacity(ways.len());
        if !progress.go_on() {
            return Err(ExperimentError::Stopped);
        }
        let world = world_of(asked, &Placing::random(number))?.with_seed(number);
        for way in ways {
            let options = Options { hopping: way.hopping(), ..Options::periods(periods) };
            let readings = simulate_while(&world, way.method(), &options, |_| progress.go_on())?;
            runs.push(Run::of(&readings, world.robots().len()));
            progress.one_done();
        }
        Ok(runs)
    });
    let runs: Vec<Vec<Run>> = runs.into_iter().collect::<Result<_, ExperimentError>>()?;
    if progress.stopped() {
        return Err(ExperimentError::Stopped);
    }
    let of = |column: usize| Figures::of(&runs.iter().map(|run| run[column]).collect::<Vec<_>>());
    let methods = ways.iter().enumerate().map(|(column, &way)| (way, of(column))).collect();
    let conditions = Conditions::of(asked.room.as_ref(), asked.gain);
    Ok(SetThree { first, seeds, physics, conditions, periods, methods, groups: groups(&placings, ways, &runs) })
}

/// The placings by place and arrangement, and by the number of robots.
fn groups(placings: &[u64], ways: &[Way], runs: &[Vec<Run>]) -> Vec<Group> {
    let kinds: Vec<_> = placings
        .iter()
        .map(|&number| Placing::random(number))
        .map(|Placing { place, arrangement, robots, .. }| (place, arrangement, robots.len()))
        .collect();
    let group = |place: Option<Place>, arrangement: Option<Arrangement>, robots: Option<usize>| {
        let of = |kind: &(Place, Arrangement, usize)| {
            place.is_none_or(|place| place == kind.0)
                && arrangement.is_none_or(|arrangement| arrangement == kind.1)
                && robots.is_none_or(|robots| robots == kind.2)
        };
        let members: Vec<_> = runs.iter().zip(&kinds).filter(|(_, kind)| of(kind)).map(|(run, _)| run).collect();
        let brief = |column: usize| Brief::of(members.iter().map(|run| &run[column]));
        let methods = ways.iter().enumerate().map(|(column, &way)| (way, brief(column))).collect();
        Group { place, arrangement, robots, placings: members.len(), methods }
    };
    let arrangements = [Arrangement::Standing, Arrangement::Meeting, Arrangement::Following];
    let places = [Place::Corridor, Place::Hall].into_iter();
    let kinds = places.flat_map(|place| arrangements.map(|arrangement| (place, arrangement)));
    let by_kind = kinds.map(|(place, arrangement)| group(Some(place), Some(arrangement), None));
    let all = by_kind.chain((2..=6).map(|robots| group(None, None, Some(robots))));
    all.filter(|group| group.placings > 0).collect()
}

/// A placing as a world.
///
/// # Errors
/// [`WorldError`] for a placing that cannot be.
pub fn world_of(asked: &SetThreeOptions, placing: &Placing) -> Result<World, WorldError> {
    let robots = placing.robots.iter().map(|robot| robot.clone().with_pattern(Some(asked.gain), None)).collect();
    World::new(placing.scene()?.with_room(asked.room)?, robots, Noise::default())?.with_physics(asked.physics)
}
