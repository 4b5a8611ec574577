//! `eeruf experiment set-one`: eight sensors before three walls at right angles, over many alcoves.

use std::fs;

use eeruf_sim::experiments::set_one::{
    Alcove, Figures, MULTI_ECHO_CONSECUTIVE, MULTI_ECHO_PATIENCE, MULTI_ECHO_T_DELTA, READINGS, SetOne, set_one,
};
use eeruf_sim::{BestSchedule, Method, best_schedule_for};

use super::{Common, bad, median, percents, table, watched};
use crate::draw;
use crate::input::{InputError, to_json};
use crate::watch::Watch;

/// Set I: eight sensors before three perpendicular walls, each reading compared with what the sensor reads alone.
///
/// Every alcove is simulated by each method for as long as 8000 readings of the conventional one take. Figures are given as
/// 10 % / median / 90 % of the alcoves.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    common: Common,
    /// Simulate only these methods
    #[arg(long = "method", value_name = "NAME", num_args = 1.., value_delimiter = ',')]
    methods: Vec<Method>,
}

const SEEDS: u64 = 200;
/// How many nodes the search for `eeruf_best` may cost; it is proven shortest long before.
const BUDGET: u64 = 300_000;

pub(crate) fn run(args: &Args) -> Result<(), InputError> {
    let bad = bad("set-one");
    let asked: Vec<Method> = Method::ALL.into_iter().filter(|method| args.methods.contains(method)).collect();
    let methods = if asked.is_empty() { Method::ALL.to_vec() } else { asked };
    let seeds = args.common.seeds.unwrap_or(SEEDS);
    let mut watch = Watch::new();
    let designing = |nodes: u64| format!("designing eeruf_best, {nodes} nodes");
    let best =
        best_schedule_for(&Alcove::random(0).robot(), BUDGET, |progress| watch.go_on(|| designing(progress.nodes)))
            .map_err(|error| bad(&error))?;
    drop(watch);
    let watched = watched(format!("{seeds} alcoves by {} methods", methods.len()));
    let found = set_one(seeds, READINGS, &methods, Some(&best), &watched).map_err(|error| bad(&error))?;
    drop(watched);
    for (folder, ending) in [(&args.common.svg, "svg"), (&args.common.png, "png")] {
        if let Some(folder) = folder {
            fs::create_dir_all(folder).map_err(|error| InputError::new(folder, None, error))?;
            draw::set_one(&found).save(&folder.join("set-one").with_extension(ending))?;
        }
    }
    if args.common.json {
        println!("{}", to_json(&found));
    } else {
        print!("{}", describe(&found, &best));
    }
    Ok(())
}

/// What the paper reports of a method in Set I: how many of the readings were wrong.
fn paper(method: Method) -> &'static str {
    match method {
        Method::Conventional => "over 30, mostly 40-80",
        Method::EerufImmediate | Method::Eeruf => "under 3, mostly 1-2",
        _ => "",
    }
}

fn describe(found: &SetOne, best: &BestSchedule) -> String {
    let header = [
        "method",
        "paper: wrong %",
        "wrong, % of all",
        "by crosstalk",
        "wrong, % of accepted",
        "rejected %",
        "good lost %",
        "age ms",
        "age 99 %",
        "accepted/s",
        "starved",
    ];
    let rows = found.methods.iter().map(|(method, figures)| row(*method, figures));
    let mut text = format!(
        "Set I: {} alcoves, {} periods of 60 ms each; 10 % / median / 90 % of the alcoves, or the median alone.\n\
         multi_echo compares {} readings within {} and has a patience of {}, all others two within 500 us and none;\n\
         eeruf_best has a period of {} ({}).\n\n",
        found.seeds,
        found.periods,
        MULTI_ECHO_CONSECUTIVE,
        MULTI_ECHO_T_DELTA,
        MULTI_ECHO_PATIENCE,
        best.schedule.period(),
        if best.proven { "proven shortest" } else { "not proven shortest" },
    );
    text += &table(&header, rows);
    text
}

fn row(method: Method, figures: &Figures) -> Vec<String> {
    vec![
        method.to_string(),
        paper(method).to_owned(),
        percents(figures.wrong_of_all),
        percents(figures.crosstalk_of_all),
        percents(figures.wrong_of_accepted),
        percents(figures.rejected),
        percents(figures.good_lost),
        median(figures.age_ms, 0),
        median(figures.age_p99_ms, 0),
        median(figures.readings_per_s, 1),
        format!("{:.2}", figures.starved),
    ]
}
