//! Names that are like others.

/// The least likeness, out of 1, of a name that was meant.
const ALIKE: f64 = 0.85;

/// The name that an unknown one was meant to be, if one is like it.
///
/// ```
/// assert_eq!(eeruf_files::meant("sensor", ["layout", "sensors"].into_iter()), Some("sensors"));
/// ```
pub fn meant<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let likeness = known.map(|known| (known, strsim::jaro_winkler(known, name)));
    let likely = likeness.filter(|(_, alike)| *alike >= ALIKE);
    likely.max_by(|one, other| one.1.total_cmp(&other.1)).map(|(known, _)| known)
}
