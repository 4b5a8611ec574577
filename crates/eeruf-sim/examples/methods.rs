//! The results of three ways of firing in a scene file: `cargo run --release -p eeruf-sim --example methods --
//! scenes/alcove.toml`

use std::{error::Error, path::PathBuf};

use eeruf_sim::{Method, Options, Summary, World, simulate};

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("scenes/alcove.toml"), PathBuf::from);
    let world = World::from_toml(&file)?;
    println!("{:<14} {:>9} {:>12} {:>15}", "method", "wrong, %", "accepted/s", "age 99 %, ms");
    for method in [Method::Sequential, Method::Simultaneous, Method::Eeruf] {
        let readings = simulate(&world, method, &Options::periods(500))?;
        let Summary { wrong_of_all, readings_per_s, age_ms, .. } = readings.summary();
        println!("{method:<14} {:>9.2} {readings_per_s:>12.1} {:>15.0}", 100.0 * wrong_of_all, age_ms.p99);
    }
    Ok(())
}
