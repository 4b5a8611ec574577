//! Numbers that a ring file may hold.

use eeruf_core::MAX_SENSORS;

/// The default of `neighbours`.
pub const fn four() -> u8 {
    4
}

/// Checks that a ring may have this many sensors.
///
/// # Errors
/// The number and what is expected.
pub fn sensors_in_range(sensors: usize) -> Result<(), String> {
    let fits = (1..=MAX_SENSORS).contains(&sensors);
    fits.then_some(()).ok_or_else(|| format!("{sensors} sensors; expected 1 to {MAX_SENSORS}"))
}

/// Checks that this many adjacent sensors may be neighbours.
///
/// # Errors
/// The number and what is expected.
pub fn neighbours_in_range(neighbours: u8) -> Result<(), String> {
    let fits = (1..=MAX_SENSORS).contains(&usize::from(neighbours));
    fits.then_some(()).ok_or_else(|| format!("neighbours = {neighbours}; expected 1 to {MAX_SENSORS}"))
}

pub(crate) fn number(name: &str, value: f64, least: f64, most: f64) -> Result<f64, String> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        // The likely cause is the one for which a value is implausible.
        let why = eeruf_files::doubt(name, value).and_then(|doubt| Some(format!("; {}", doubt.rsplit_once("; ")?.1)));
        Err(format!("{name} = {value}; expected {least} to {most}{}", why.unwrap_or_default()))
    }
}
