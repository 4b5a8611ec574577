//! A log of ranges, examined: how its sensors fired, whether they read each other's sound, and why that is said.
//! `cargo run -p eeruf-logs --example examine -- LOG`

use std::{error::Error, path::Path};

use eeruf_logs::{Doctor, Options, read_log};

/// Of air at 20 °C, in m/s.
const SPEED_OF_SOUND: f64 = 343.2;

fn main() -> Result<(), Box<dyn Error>> {
    let log = std::env::args().nth(1).ok_or("usage: examine LOG")?;
    let mut doctor = Doctor::new(SPEED_OF_SOUND);
    let report = read_log(Path::new(&log), &Options::default(), |_, reading| doctor.push(reading))?;
    let names = report.names();
    let found = doctor.examine(&report.firing, &names);
    println!("{} sensors, fired {}: {}", names.len(), report.firing.pattern.as_str(), found.verdict.as_str());
    for &sensor in &found.fooled {
        println!("{} reads foreign sound", names[sensor]);
    }
    for reason in &found.reasons {
        println!("{reason}");
    }
    Ok(())
}
