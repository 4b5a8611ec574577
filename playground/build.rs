//! Picks from the atlas the rings that the page can ask for and whose search would keep its reader waiting.

use std::env;
use std::fs;
use std::path::Path;

const ATLAS: &str = "../crates/eeruf-design/src/atlas/atlas.txt";
/// Number of sensors up to which a search takes no more than a few tenths of a second.
const QUICK: u64 = 12;
/// Number of adjacent sensors that are neighbours on the page.
const NEIGHBOURS: u64 = 4;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={ATLAS}");
    let atlas = fs::read_to_string(ATLAS).expect("it is in the repository");
    let part: String = atlas.lines().filter_map(slow).collect();
    assert!(!part.is_empty(), "{ATLAS}: no row as the page reads them");
    let folder = env::var("OUT_DIR").expect("cargo sets it");
    fs::write(Path::new(&folder).join("atlas.txt"), part).expect("cargo made the folder");
}

/// Returns a proven row that the page needs, without its certificate's hash, which the page does not show.
fn slow(row: &str) -> Option<String> {
    let words: Vec<&str> = row.split(' ').collect();
    let [sensors, _, neighbours, separation, interval, window, period, bound, certified, preferred, _, times] =
        words[..]
    else {
        return None;
    };
    let is_asked = neighbours.parse() == Ok(NEIGHBOURS) && sensors.parse::<u64>().is_ok_and(|sensors| sensors > QUICK);
    let needs = [&words[..3], &[separation, interval, window]].concat().join(" ");
    (is_asked && period == bound).then(|| format!("{needs} {period} {bound} {certified} {preferred} - {times}\n"))
}
