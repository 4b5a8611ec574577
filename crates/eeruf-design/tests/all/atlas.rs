//! The atlas of this crate.

use crate::common::{Random, accepted, claim_of, from_environment, small};
use eeruf_core::Micros;
use eeruf_design::atlas::{ATLAS, Neighbourhood, Ring, Row, all_rings, answer, rows};
use eeruf_design::atlas_making::{certificate_of, hash_of, header};

#[test]
fn atlas_has_a_row_for_each_ring_in_order() {
    let all: Vec<Row> = rows(ATLAS).collect();
    let text: String = all.iter().map(|row| format!("{row}\n")).collect();
    assert_eq!(format!("{}{text}", header()), ATLAS);
    assert_eq!(all.iter().map(|row| row.ring).collect::<Vec<Ring>>(), all_rings());
    assert!(ATLAS.len() < 1_000_000, "{} bytes", ATLAS.len());
}

// Each schedule keeps what its ring requires in its period and not one tick less.
#[test]
fn atlas_schedules_keep_needs_in_their_periods() {
    for row in rows(ATLAS) {
        let problem = row.ring.problem();
        let schedule = row.schedule(problem.tick).unwrap();
        let report = schedule.verify(&problem.requirements);
        assert!(report.ok(), "{row}");
        assert!(1 <= row.certified && row.certified <= row.bound && row.bound <= row.period, "{row}");
        let shorter = Row { period: row.period - 1, ..row.clone() };
        let keeps = shorter.schedule(problem.tick).is_some_and(|schedule| schedule.verify(&problem.requirements).ok());
        assert!(!keeps, "{row}");
    }
}

#[test]
fn no_row_is_longer_than_its_construction() {
    for row in rows(ATLAS) {
        let Ring { sensors, neighbourhood, separation, interval, window } = row.ring;
        let (sensors, colours) = match neighbourhood {
            Neighbourhood::All => (u32::from(sensors), u32::from(sensors)),
            Neighbourhood::Line(n) => (u32::from(sensors), u32::from(n)),
            // As many blocks as there is room for; a colour is a place in a block.
            Neighbourhood::Ring(n) => (u32::from(sensors), u32::from(sensors.div_ceil(sensors / n))),
        };
        let simple = (colours * interval).max(window) + (sensors - 1) * separation;
        assert!(row.period <= simple, "{row}: {simple}");
    }
}

// A proven row is the answer for its ring, and an open one is not.
#[test]
fn proven_row_answers_and_open_one_does_not() {
    for row in rows(ATLAS) {
        let found = answer(ATLAS, &row.ring.problem());
        assert_eq!(found.map(|(row, _)| row), (row.period == row.bound).then(|| row.clone()), "{row}");
    }
}

// The bound by counting is below every known schedule of a ring.
#[test]
fn no_schedule_is_shorter_than_counted_bounds() {
    for row in rows(ATLAS) {
        let counted = row.ring.problem().shortest(0, &mut ()).unwrap().bound;
        assert!(counted <= Micros::from_millis(row.bound), "{row}: {counted}");
    }
}

// A sample is proven again by the search and its certificates are those of the hashes.
#[test]
fn sample_of_atlas_is_proven_again() {
    let cases = from_environment("EERUF_CASES", 12);
    let all: Vec<Row> = rows(ATLAS).collect();
    let (mut random, mut proven, mut certificates) = (Random(20_001), 0, Vec::new());
    for _ in 0..cases {
        let row = &all[random.below(all.len() as u32) as usize];
        let text = certificate_of(row).unwrap_or_else(|error| panic!("{row}: {error}"));
        let claim = claim_of(&text);
        assert_eq!((claim.period, claim.bound), (row.period, row.certified), "{row}");
        assert_eq!(hash_of(&text), row.hash, "{row}");
        certificates.push(text);
        let problem = row.ring.problem();
        let found = problem.shortest(200_000, &mut ()).unwrap().found();
        if row.bound == row.period {
            assert_eq!((found.value, found.proven), (Some(Micros::from_millis(row.period)), true), "{row}");
            proven += 1;
        } else {
            // The result of another search does not contradict the row.
            assert!(found.bound <= Some(Micros::from_millis(row.period)), "{row}");
            assert!(found.value >= Some(Micros::from_millis(row.bound)), "{row}");
        }
    }
    assert!(2 * proven > cases, "{proven} of {cases} were proven");
    accepted("atlas", &small(certificates));
}
