//! Cost of the table of `docs/explanation/search.md`, and where one limit of one sensor or pair is a tick more or less:
//! `cargo lab twins [SECONDS]`, for each ring at most. Times are those of a core.

use eeruf_core::Layout;
use eeruf_period::engine::Problem;
use eeruf_period::engine::shortest::shortest;

use crate::clock::core_seconds;

const KINDS: [&str; 7] = ["even", "window +", "window -", "gap +", "gap -", "separation +", "separation -"];

fn twin(even: &Problem, kind: &str) -> Problem {
    let mut twin = even.clone();
    let (middle, pair) = (even.sensors() / 2, even.gaps.len() / 2);
    match kind {
        "window +" => twin.window[0] += 1,
        "window -" => twin.window[middle] -= 1,
        "gap +" => (twin.gaps[0].2, twin.gaps[0].3) = (16, 16),
        "gap -" => (twin.gaps[pair].2, twin.gaps[pair].3) = (14, 14),
        "separation +" => twin.separation[0] += 1,
        "separation -" => twin.separation[middle] -= 1,
        _ => {}
    }
    twin
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let seconds: f64 = arguments.first().map_or(Ok(10.0), |text| text.parse())?;
    println!("layout sensors window | {}: period[bound] nodes ms", KINDS.join(", "));
    // Of each kind: seconds, open rings, and the logarithms of the ratios to the even ring's time, 20 ms at least.
    let mut sums = [(0.0, 0, 0.0); KINDS.len()];
    let (mut rings, mut worst) = (0, [0.0_f64; KINDS.len()]);
    for layout in ["line", "ring"] {
        for (sensors, window) in [8, 12, 16, 24].iter().flat_map(|&k| [15, 30, 45, 60].map(|window| (k, window))) {
            let rows = if layout == "ring" { Layout::Ring(4) } else { Layout::Line(4) }.rows(sensors);
            let even = Problem::alike(&rows[..sensors], 2, 15, window);
            print!("{layout} {sensors} {window}");
            let mut of_even = 0.0;
            rings += 1;
            for (kind, (sum, worst)) in KINDS.iter().zip(sums.iter_mut().zip(&mut worst)) {
                let begin = core_seconds();
                let mut go_on = |_: &_| core_seconds() - begin < seconds;
                let found = shortest(&twin(&even, kind), u64::MAX, &mut go_on).expect("there is a schedule");
                let own = (core_seconds() - begin) * 1e3;
                let open = if found.bound < found.period { format!("[{}]", found.bound) } else { String::new() };
                print!(" | {}{open} {} {own:.1}", found.period, found.nodes);
                if *kind == "even" {
                    of_even = own;
                }
                let floored = own.max(20.0) / of_even.max(20.0);
                let (all, left_open, ratios) = *sum;
                let left_open = left_open + u32::from(!open.is_empty());
                *sum = (all + own / 1e3, left_open, ratios + floored.ln());
                *worst = worst.max(floored);
            }
            println!();
        }
    }
    for (kind, ((all, open, ratios), worst)) in KINDS.iter().zip(sums.into_iter().zip(worst)) {
        println!(
            "# {kind}: {all:.2} s, {open} open; times the even ring's, less than 20 ms counts as 20: geometric mean \
             {:.2}, at most {worst:.1}",
            (ratios / f64::from(rings)).exp()
        );
    }
    Ok(())
}
