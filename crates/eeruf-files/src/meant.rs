//! Suggestions for misspelt names.

/// Smallest similarity, out of 1, for a suggestion.
const ALIKE: f64 = 0.85;

/// Returns the known name that is most similar to an unknown one, if any is similar enough.
///
/// ```
/// assert_eq!(eeruf_files::meant("sensor", ["layout", "sensors"].into_iter()), Some("sensors"));
/// ```
pub fn meant<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let likeness = known.map(|known| (known, strsim::jaro_winkler(known, name)));
    let likely = likeness.filter(|(_, alike)| *alike >= ALIKE);
    likely.max_by(|one, other| one.1.total_cmp(&other.1)).map(|(known, _)| known)
}
