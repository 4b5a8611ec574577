//! Counts the doctor's verdicts on logs of known truth, and fails if too many are wrong:
//! `cargo run --release --example verdicts [FIRST [LOGS]]`.

#[path = "../tests/all/random.rs"]
mod random;
#[path = "../tests/all/verdicts.rs"]
mod verdicts;
#[path = "../tests/all/worlds.rs"]
mod worlds;

fn main() -> Result<(), std::num::ParseIntError> {
    let mut arguments = std::env::args().skip(1);
    let mut next = |default: u64| arguments.next().map_or(Ok(default), |text| text.parse());
    let (first, logs) = (next(20_000)?, next(200)?);
    let counts = verdicts::Counts::of(first, logs);
    println!("{counts}");
    counts.hold();
    Ok(())
}
