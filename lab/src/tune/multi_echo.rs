//! Settings by which several echoes are compared in Set I: the best of a grid, on alcoves below 2,000.

use eeruf_core::Micros;
use eeruf_sim::experiments::ExperimentError;
use eeruf_sim::experiments::set_one::{MultiEcho, SetOneOptions, set_one};
use eeruf_sim::{Entry, Method, Physics};

/// Number of alcoves, from 0 on.
const ALCOVES: u64 = 100;
const CONSECUTIVE: [u8; 3] = [2, 3, 4];
const T_DELTA_US: [u32; 4] = [100, 200, 300, 500];

/// Returns the line of the source.
pub(crate) fn line() -> Result<String, ExperimentError> {
    let mut best = None;
    for consecutive in CONSECUTIVE {
        for t_delta in T_DELTA_US.map(Micros::new) {
            let setting = MultiEcho { consecutive, t_delta };
            let cost = cost(setting, ALCOVES)?;
            eprintln!("{consecutive} within {t_delta}: {:.2}", 100.0 * cost);
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, setting));
            }
        }
    }
    Ok(best.map_or_else(String::new, |(_, setting)| printed(setting)))
}

/// Returns errors plus losses as shares, of the median alcove and of the 90th percentile.
fn cost(multi_echo: MultiEcho, seeds: u64) -> Result<f64, ExperimentError> {
    let methods = Entry::all([Method::MultiEcho]);
    let asked = SetOneOptions {
        seeds,
        first: 0,
        steps: 0,
        methods,
        multi_echo,
        physics: Physics::PLAIN,
        ..SetOneOptions::default()
    };
    let table = set_one(&asked, &|_| true)?;
    let both = |figures: &eeruf_sim::experiments::set_one::Figures| {
        [figures.wrong_of_all, figures.good_lost].into_iter().flatten().map(|spread| spread.median + spread.p90).sum()
    };
    Ok(table.methods.iter().map(|(_, figures)| -> f64 { both(figures) }).sum())
}

fn printed(MultiEcho { consecutive, t_delta }: MultiEcho) -> String {
    let t_delta = t_delta.as_micros();
    format!(
        "    pub const TUNED: Self = \
         Self {{ consecutive: {consecutive}, t_delta: Micros::new({t_delta}) }};"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    // The constant in the source is as this prints it and in the grid.
    #[test]
    fn source_constant_is_as_printed_and_in_the_grid() {
        let source = include_str!("../../../crates/eeruf-sim/src/experiments/set_one/multi_echo.rs");
        let MultiEcho { consecutive, t_delta } = MultiEcho::TUNED;
        assert!(source.lines().any(|line| line == printed(MultiEcho::TUNED)), "{}", printed(MultiEcho::TUNED));
        assert!(CONSECUTIVE.contains(&consecutive) && T_DELTA_US.contains(&t_delta.as_micros()));
    }

    #[test]
    fn pairs_within_500_us_cost_more_than_the_tuned_ones() {
        let loose = MultiEcho { consecutive: 2, t_delta: Micros::new(500) };
        let [loose, tuned] = [loose, MultiEcho::TUNED].map(|setting| cost(setting, 20).unwrap());
        assert!(tuned < loose, "{tuned} {loose}");
    }
}
