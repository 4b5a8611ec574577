//! Makes a row of the atlas: the search, and its certificate.

use eeruf_core::search::SearchError;
use eeruf_core::{Micros, Phase};
use eeruf_period::engine::prove::NoProof;
use eeruf_sim::AnySchedule;
use sha2::{Digest, Sha256};

use crate::atlas::{Ring, Row};
use crate::certificate::{Stated, certify};

/// Budget of nodes for the search of a ring, the choice among its shortest schedules, and the proof of its certificate;
/// fewer with more than 16 sensors, since nodes cost more.
const BUDGET: u64 = 20_000;
const PREFERENCE_BUDGET: u64 = 20_000;
const CERTIFICATE_BUDGET: u64 = 40_000;

/// The first lines of the file.
#[must_use]
pub fn header() -> &'static str {
    "# Shortest periods of rings of 2 to 32 sensors, made by `eeruf atlas FILE`. In ticks:\n\
     # sensors, layout, neighbours, separation, interval, window: period, bound, certified bound, proven best of its\n\
     # period in t_delta, interval, refire time; the certificate's SHA-256 to 32 digits; firing times in phases a and\n\
     # b, two digits of base 64 for each (0-9 A-Z a-z - _).\n"
}

/// Searches a ring. The row depends on nothing but the ring.
///
/// # Errors
/// The reason why the ring is invalid, in words.
pub fn make(ring: &Ring) -> Result<Row, String> {
    searched(ring, scaled(BUDGET, ring)).and_then(|row| again(&row, 0))
}

/// Makes the row from one search of at most `nodes` nodes.
fn searched(ring: &Ring, nodes: u64) -> Result<Row, String> {
    let found = ring.problem().shortest(nodes, &mut ()).map_err(|error: SearchError| error.to_string())?;
    let [period, bound] = [found.period(), found.bound].map(in_ticks);
    let (fire, preferred) = (fire_of(ring, &found.schedule), [false; 3]);
    Ok(Row { ring: *ring, period, bound, certified: 0, hash: String::new(), preferred, fire })
}

/// Converts a time to a row's ticks of a millisecond.
fn in_ticks(time: Micros) -> u32 {
    time.as_micros() / 1000
}

/// Returns the firing times of each sensor, in ticks.
fn fire_of(ring: &Ring, schedule: &AnySchedule) -> [Vec<u32>; 2] {
    [Phase::A, Phase::B].map(|phase| {
        (0..usize::from(ring.sensors)).map(|x| in_ticks(schedule.t_fire(phase, x).unwrap_or_default())).collect()
    })
}

/// The row after a search of `nodes` more nodes, if it is open: with the preferred schedule if the row is newly proven,
/// and with its certificate.
///
/// # Errors
/// As for [`make`].
pub fn again(row: &Row, nodes: u64) -> Result<Row, String> {
    let (mut row, ring, problem) = (row.clone(), &row.ring, row.ring.problem());
    if row.bound < row.period {
        // Without nodes, the bound comes from counting.
        let found = searched(ring, scaled(nodes, ring))?;
        row.bound = row.bound.max(found.bound);
        if found.period < row.period {
            (row.period, row.fire) = (found.period, found.fire);
        }
    }
    if row.bound == row.period && row.preferred == [false; 3] {
        let schedule = row.schedule(problem.tick).ok_or("no schedule")?;
        let best = problem.prefer(&schedule, scaled(PREFERENCE_BUDGET, ring), &mut ());
        let (schedule, spare) = best.map_err(|error| error.to_string())?;
        (row.fire, row.preferred) = (fire_of(ring, &schedule), spare.proven);
    }
    let text = certificate_of(&row).map_err(|error| error.to_string())?;
    let certified = Stated::read(&text).ok_or("a certificate without a claim")?.bound;
    Ok(Row { certified, hash: hash_of(&text), ..row })
}

/// The certificate of a row's schedule and bound.
///
/// # Errors
/// The row's claim is wrong.
pub fn certificate_of(row: &Row) -> Result<String, NoProof> {
    let problem = row.ring.problem();
    let schedule = row.schedule(problem.tick).ok_or_else(|| NoProof::Claim("no schedule".to_owned()))?;
    let bound = Some(Micros::from_millis(row.bound));
    certify(&problem, &schedule, bound, scaled(CERTIFICATE_BUDGET, &row.ring) as usize, |_| true)
}

/// The first 32 digits of a text's SHA-256, as `sha256sum` prints them.
#[must_use]
pub fn hash_of(text: &str) -> String {
    Sha256::digest(text.as_bytes()).iter().take(16).map(|byte| format!("{byte:02x}")).collect()
}

fn scaled(nodes: u64, ring: &Ring) -> u64 {
    nodes * 16 * 16 / u64::from(ring.sensors.max(16)).pow(2)
}
