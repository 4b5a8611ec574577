//! Makes a row of the atlas: the search, and its certificate.

use eeruf_core::search::SearchError;
use eeruf_core::{Micros, Phase};
use eeruf_period::engine::prove::NoProof;
use sha2::{Digest, Sha256};

use crate::atlas::{Ring, Row};
use crate::certificate::{Stated, certify};

/// Budget of nodes for the search of a ring, the choice among its shortest schedules, and the proof of its certificate;
/// with more than 16 sensors fewer, since each costs more.
const BUDGET: u64 = 20_000;
const PREFERENCE_BUDGET: u64 = 20_000;
const CERTIFICATE_BUDGET: u64 = 4_000;

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
/// Why a ring is invalid, in words.
pub fn make(ring: &Ring) -> Result<Row, String> {
    let problem = ring.problem();
    let words = |error: SearchError| error.to_string();
    let found = problem.shortest(scaled(BUDGET, ring), &mut ()).map_err(words)?;
    let (mut schedule, mut preferred) = (found.schedule, [false; 3]);
    if found.proven() {
        let best = problem.prefer(&schedule, scaled(PREFERENCE_BUDGET, ring), &mut ()).map_err(words)?;
        (schedule, preferred) = (best.0, best.1.proven);
    }
    let ticks = |time: Micros| time.as_micros() / problem.tick.as_micros();
    let fire = [Phase::A, Phase::B].map(|phase| {
        (0..problem.sensors).map(|sensor| ticks(schedule.t_fire(phase, sensor).unwrap_or_default())).collect()
    });
    let row = Row {
        ring: *ring,
        period: ticks(schedule.period()),
        bound: ticks(found.bound),
        certified: 0,
        hash: String::new(),
        preferred,
        fire,
    };
    let text = certificate_of(&row).map_err(|error| error.to_string())?;
    let certified = Stated::read(&text).ok_or("a certificate without a claim")?.bound;
    Ok(Row { certified, hash: hash_of(&text), ..row })
}

/// The certificate of a row's schedule and bound.
///
/// # Errors
/// If what the row says is wrong.
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
