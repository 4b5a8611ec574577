//! The shortest period for a ring: the answer of `eeruf design`, and its certificate.

use std::cell::RefCell;
use std::ops::ControlFlow;

use eeruf_core::search::Progress;
use eeruf_core::{Micros, Phase};
use eeruf_design::certificate::Stated;
use eeruf_design::{Effort, FoundJson, RingDesign, RingSpec, WhatIf};
use eeruf_files::emit::Emit as _;
use serde::Serialize;

use crate::progress::progress;

/// Search budget on the page in nodes, and a smaller one for more than [`FEW`] sensors, whose nodes take many times as
/// long: about a minute in either case.
const BUDGET: u64 = 2_000_000;
const BUDGET_OF_MANY: u64 = 50_000;
const FEW: usize = 24;
/// The rings of the atlas whose search takes long: see `build.rs`.
const ATLAS: &str = include_str!(concat!(env!("OUT_DIR"), "/atlas.txt"));
/// Budget of nodes for the certificate's proof, as by default in `eeruf design`.
const CERTIFICATE_BUDGET: usize = 1_000_000;
/// Number of a proof's nodes between two reports to the page.
const SAID_EVERY: usize = 256;

/// A designed ring. Times in microseconds.
#[derive(Serialize)]
pub(crate) struct DesignAnswer {
    /// The output of `eeruf design --json`; `seconds` is 0, because the page measures no time.
    found: FoundJson,
    /// The change that `t_delta` must cover, and the largest change that the schedule allows.
    t_delta_us: u32,
    max_t_delta_us: Option<u32>,
    /// The required and the actual smallest interval between two neighbours.
    min_interval_us: u32,
    kept_interval_us: Option<u32>,
    window_us: u32,
    /// Range of the window.
    range_m: f64,
    /// Least time until a sensor fires again.
    min_refire_us: u32,
    /// Speed of the robot above which good readings differ by more than `t_delta`.
    speed_m_s: f64,
    fire_us: [Vec<u32>; 2],
    /// True if the verifier, which shares no code with the search, accepts the schedule.
    verified: bool,
    rust: String,
    c: String,
    arduino: String,
    toml: String,
}

/// The gain from relaxing one need.
#[derive(Serialize)]
pub(crate) struct What {
    need: String,
    period_us: Option<u32>,
    proven: bool,
}

/// A certificate, its claim, and the checker, which the page does not run.
#[derive(Serialize)]
pub(crate) struct Certificate {
    says: String,
    nodes: usize,
    text: String,
    checker: &'static str,
}

/// Returns the shortest period for a ring file.
pub(crate) fn design(ring: &str) -> Result<DesignAnswer, String> {
    let design = shortest(ring)?;
    let spec = &design.spec;
    let requirements = design.spec.problem().requirements;
    let schedule = &design.schedule;
    let report = schedule.verify(&requirements);
    let max_t_delta = report.max_t_delta();
    let speed = schedule.max_speed_mm_s(max_t_delta.unwrap_or(Micros::ZERO), spec.c.mm_per_s());
    let fire =
        |phase| (0..spec.sensors).filter_map(move |sensor| schedule.t_fire(phase, sensor)).map(Micros::as_micros);
    Ok(DesignAnswer {
        found: design.json(0.0),
        t_delta_us: design.t_delta.as_micros(),
        max_t_delta_us: max_t_delta.map(Micros::as_micros),
        min_interval_us: requirements.min_interval.as_micros(),
        kept_interval_us: report.min_interval().map(|interval| interval.value.as_micros()),
        window_us: requirements.window.as_micros(),
        range_m: f64::from(spec.c.distance_mm(requirements.window)) / 1000.0,
        min_refire_us: report.min_refire().as_micros(),
        speed_m_s: f64::from(speed) / 1000.0,
        fire_us: [Phase::A, Phase::B].map(|phase| fire(phase).collect()),
        verified: report.ok(),
        rust: schedule.to_rust(&requirements),
        c: schedule.to_c(&requirements),
        arduino: schedule.to_arduino(&requirements, "RING"),
        toml: schedule.to_toml(),
    })
}

/// Returns the changes that would shorten the period of this ring.
pub(crate) fn faster(ring: &str) -> Result<Vec<What>, String> {
    let relaxed = shortest(ring)?.what_if(&mut say).map_err(|error| error.to_string())?;
    let what = |WhatIf { need, period, proven }| What { need, period_us: period.map(Micros::as_micros), proven };
    Ok(relaxed.into_iter().map(what).collect())
}

/// Returns the certificate that the period of this ring is the shortest.
pub(crate) fn certificate(ring: &str) -> Result<Certificate, String> {
    let design = shortest(ring)?;
    let mut calls = 0;
    let keep_going = |nodes: usize| {
        calls += 1;
        if calls % SAID_EVERY == 0 {
            progress(f64::NAN, nodes as f64);
        }
        true
    };
    let proof = design.prove(CERTIFICATE_BUDGET, keep_going);
    let text = proof.map_err(|error| error.to_string())?;
    let stated = Stated::read(&text).ok_or("a certificate without a claim")?;
    let checker = include_str!("../../checker/check_period.py");
    Ok(Certificate { says: stated.to_string(), nodes: stated.nodes, text, checker })
}

thread_local! {
    /// The last answer, kept for later questions about the same ring.
    static LAST: RefCell<Option<(String, RingDesign)>> = const { RefCell::new(None) };
}

fn shortest(ring: &str) -> Result<RingDesign, String> {
    let known =
        LAST.with_borrow(|last| last.as_ref().filter(|(text, _)| text == ring).map(|(_, design)| design.clone()));
    if let Some(design) = known {
        return Ok(design);
    }
    let spec = RingSpec::from_text(ring).map_err(|error| error.to_string())?;
    let budget = if spec.sensors > FEW { BUDGET_OF_MANY } else { BUDGET };
    let found = spec.shortest(&Effort { budget, what_if: false, atlas: ATLAS }, &mut say);
    let design = found.map_err(|none| none.to_string())?;
    LAST.set(Some((ring.to_owned(), design.clone())));
    Ok(design)
}

/// Reports the search's progress to the page.
fn say(at: &Progress) -> ControlFlow<()> {
    progress(f64::NAN, at.nodes as f64);
    ControlFlow::Continue(())
}
