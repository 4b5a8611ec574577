//! Input that is legal but implausible: milliseconds for microseconds, centimetres for metres.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::FileError;
use crate::parse::line_at;

/// The plausible values of a key. Zero is always plausible: it means that nothing is asked for.
struct Plausible {
    key: &'static str,
    from: f64,
    to: f64,
    /// The likely cause of a value outside the range, and the expected values.
    why: &'static str,
}

const fn plausible(key: &'static str, from: f64, to: f64, why: &'static str) -> Plausible {
    Plausible { key, from, to, why }
}

const MICROSECONDS: &str = "likely milliseconds: times are microseconds";
const BOUNCES: &str = "each bounce multiplies the paths; 4 to 6 suffice in most rooms";
const METRES: &str = "likely centimetres or millimetres: lengths are metres";

/// Plausible values of keys in files and of command-line options: a key means the same everywhere.
const PLAUSIBLE: [Plausible; 39] = [
    plausible("heading_rad", 0.0, 6.3, "likely degrees: with this key headings are radians"),
    plausible("spacing_rad", 0.0, 3.2, "radians from one sensor to the next, not degrees or the whole circle"),
    plausible("w_rad_s", 0.0, 20.0, "likely degrees: rates of turn are radians per second"),
    plausible("resolution", 0.001, 1.0, METRES),
    plausible("period_us", 2_000.0, 60e6, MICROSECONDS),
    plausible("period", 2_000.0, 60e6, MICROSECONDS),
    plausible("reach_us", 1_000.0, 10e6, MICROSECONDS),
    plausible("until_us", 1_000.0, 1e6, MICROSECONDS),
    plausible("no_echo_m", 0.05, 60.0, METRES),
    plausible("tolerance_m", 0.0, 2.0, METRES),
    plausible("height_m", 0.0, 20.0, METRES),
    plausible("length_m", 0.01, 200.0, METRES),
    plausible("speed_of_sound", 250.0, 450.0, "speeds are metres per second: sound in air has 343 at 20 degrees"),
    plausible("window_us", 1_000.0, 1e6, MICROSECONDS),
    plausible("retrigger_us", 1_000.0, 10e6, MICROSECONDS),
    plausible("min_interval_us", 200.0, 5e9, MICROSECONDS),
    plausible("t_delta_us", 20.0, 20_000.0, "T_delta is in microseconds, a few hundred for most modules"),
    plausible("jitter_us", 2.0, 5_000.0, "jitter is in microseconds, 50 to 400 for most modules"),
    plausible("wait_max_us", 200.0, 10e6, MICROSECONDS),
    plausible("blanking_us", 10.0, 50_000.0, MICROSECONDS),
    plausible("tick_us", 1.0, 100_000.0, "firing times are multiples of the tick, 100 to 1000 us for most rings"),
    plausible("max_range_m", 0.05, 30.0, METRES),
    plausible("crosstalk_range_m", 0.05, 60.0, METRES),
    plausible("radius_m", 0.001, 20.0, METRES),
    plausible("points_m", 0.0, 200.0, METRES),
    plausible("at_m", 0.0, 200.0, METRES),
    plausible("waypoints_m", 0.0, 200.0, METRES),
    plausible("x_m", 0.0, 200.0, METRES),
    plausible("y_m", 0.0, 200.0, METRES),
    plausible("speed_m_s", 0.01, 20.0, "likely mm/s or km/h: speeds are metres per second"),
    plausible("velocity_m_s", 0.0, 20.0, "likely mm/s or km/h: speeds are metres per second"),
    plausible("temperature_c", 0.0, 60.0, "likely kelvin or Fahrenheit: temperatures are degrees Celsius"),
    plausible("heading_deg", 0.0, 360.0, "expected -360 to 360 degrees"),
    plausible("drift_ppm", 0.0, 10_000.0, "drift is in millionths; crystals drift by 10 to 100"),
    plausible("turn_deg_s", 0.0, 720.0, "expected degrees per second"),
    plausible("fading_db_rms", 0.0, 20.0, "fading is in dB, 1 to 3 in most rooms"),
    plausible("jitter_us_rms", 0.0, 5_000.0, MICROSECONDS),
    plausible("max_order", 0.0, 12.0, BOUNCES),
    plausible("order", 0.0, 12.0, BOUNCES),
];

/// Lists of firing times and waits.
const LISTS: [&str; 6] = ["t_lag_us", "t_wait_a_us", "t_wait_b_us", "t_fire_a_us", "t_fire_b_us", "t_fire_us"];

/// Keys that name a module.
const MODULES: [&str; 2] = ["module", "like"];

/// Returns the keys that may have implausible values, which are also names of options and arguments.
pub fn doubted_keys() -> impl Iterator<Item = &'static str> {
    PLAUSIBLE.iter().map(|plausible| plausible.key)
}

/// Returns one warning for each key that has implausible values in a TOML text: the first such value, and the number of
/// others. Empty for text that is not TOML.
///
/// ```
/// let warnings = eeruf_files::doubts_in("# a ring\nwindow_us = 30");
/// let expected = "line 2: window_us: 30; expected 1000 to 1000000; likely milliseconds: times are microseconds";
/// assert_eq!(warnings[0].to_string(), expected);
/// let poles = eeruf_files::doubts_in(&"[[poles]]\nradius_m = 30\n".repeat(50_000));
/// assert_eq!(poles.len(), 1);
/// assert!(poles[0].to_string().ends_with("lengths are metres; so are 49999 more of this key"));
/// ```
pub fn doubts_in(text: &str) -> Vec<FileError> {
    let mut found = vec![];
    if let Ok(table) = DeTable::parse(text) {
        in_table(table.get_ref(), &mut found);
    }
    let mut of_keys: Vec<(usize, String, usize)> = vec![];
    for (at, message) in found {
        let key = |message: &str| message.split(':').next().map(str::to_owned);
        match of_keys.iter_mut().find(|(_, first, _)| key(first) == key(&message)) {
            Some((.., more)) => *more += 1,
            None => of_keys.push((at, message, 0)),
        }
    }
    let warning = |(at, message, more): (usize, String, usize)| {
        let error = FileError::in_text(message).at_line(Some(line_at(text, at)));
        if more > 0 { error.and(format!("so are {more} more of this key")) } else { error }
    };
    of_keys.into_iter().map(warning).collect()
}

/// Collects the implausible values of a table and its subtables, with their places.
fn in_table(table: &DeTable<'_>, found: &mut Vec<(usize, String)>) {
    for (key, value) in table {
        let (key, at) = (key.get_ref().as_ref(), key.span().start);
        in_value(key, at, value, found);
        if key == "spacing_deg" {
            spacing(table, at, found);
        }
    }
}

fn in_value(key: &str, at: usize, value: &Spanned<DeValue<'_>>, found: &mut Vec<(usize, String)>) {
    match value.get_ref() {
        DeValue::Table(table) => in_table(table, found),
        DeValue::String(name) if MODULES.contains(&key) => {
            let taken = |module: &eeruf_modules::Module| (at, format!("{key}: {name}; taken as {}", module.name));
            found.extend(eeruf_modules::like(name).map(taken));
        }
        DeValue::Array(array) if MODULES.contains(&key) => {
            array.iter().for_each(|value| in_value(key, at, value, found));
        }
        DeValue::Array(array) => {
            array.iter().filter_map(|value| value.get_ref().as_table()).for_each(|table| in_table(table, found));
            let mut numbers = vec![];
            numbers_of(value.get_ref(), &mut numbers);
            found.extend(doubt_list(key, &numbers).map(|message| (at, format!("{key}: {message}"))));
        }
        other => {
            let message = number(other).and_then(|number| doubt(key, number));
            found.extend(message.map(|message| (at, format!("{key}: {message}"))));
        }
    }
}

/// Warns of a spacing that puts several sensors in one place, or that is probably in radians.
fn spacing(table: &DeTable<'_>, at: usize, found: &mut Vec<(usize, String)>) {
    let of = |key: &str| table.get(key).and_then(|value| number(value.get_ref()));
    let (Some(spacing), Some(sensors)) = (of("spacing_deg"), of("sensors")) else { return };
    if sensors < 2.0 {
        return;
    }
    if spacing != 0.0 && spacing.abs() < 1.0 {
        let why = "likely radians: the spacing is in degrees";
        found.push((at, format!("spacing_deg: {spacing}; expected 1 to {:.1}; {why}", 360.0 / sensors)));
    } else if spacing.abs() * (sensors - 1.0) >= 360.0 {
        let most = 360.0 / sensors;
        let why =
            format!("{sensors} sensors go around more than once; likely the whole circle: a full ring has {most}");
        found.push((at, format!("spacing_deg: {spacing}; expected at most {most:.1}; {why}")));
    }
}

/// Returns a message if the value of a key is implausible: the value, the plausible range and the likely cause.
///
/// ```
/// assert_eq!(eeruf_files::doubt("t_delta_us", 500.0), None);
/// assert!(eeruf_files::doubt("radius_m", 30.0).unwrap().starts_with("30; expected 0.001 to 20; likely centi"));
/// ```
pub fn doubt(key: &str, number: f64) -> Option<String> {
    if key == "heading_deg" && is_likely_rad(number) {
        return Some(format!("{number}; likely radians: headings are degrees, and this is {:.0}", number.to_degrees()));
    }
    let plausible = PLAUSIBLE.iter().find(|plausible| plausible.key == key)?;
    let size = number.abs();
    let is_plausible = size == 0.0 || (plausible.from..=plausible.to).contains(&size);
    let Plausible { from, to, why, .. } = plausible;
    // A number of 300 digits says no more than its power of ten.
    let shown = if size < 1e12 { number.to_string() } else { format!("{number:e}") };
    (!is_plausible).then(|| format!("{shown}; expected {from} to {to}; {why}"))
}

/// Returns true if an angle is likely in radians: converted to degrees it is a multiple of 15, up to a full circle.
///
/// ```
/// use eeruf_files::is_likely_rad;
/// assert!([0.785, -1.57, 3.14, 1.05].into_iter().all(is_likely_rad));
/// assert!(![0.0, 1.0, 2.0, 5.0, 15.0, 45.0, -90.0].into_iter().any(is_likely_rad));
/// ```
pub fn is_likely_rad(angle: f64) -> bool {
    let of_15_degrees = angle.to_degrees().abs() / 15.0;
    (0.5..24.5).contains(&of_15_degrees) && (of_15_degrees - libm::round(of_15_degrees)).abs() < 0.02
}

/// Applies [`doubt`] to a list: firing times and waits are implausible only if all of them are small.
///
/// ```
/// assert_eq!(eeruf_files::doubt_list("t_lag_us", &[0.0, 15_000.0]), None);
/// assert!(eeruf_files::doubt_list("t_lag_us", &[0.0, 15.0]).unwrap().starts_with("15 us at most; expected 200 us"));
/// ```
pub fn doubt_list(key: &str, numbers: &[f64]) -> Option<String> {
    if !LISTS.contains(&key) {
        return numbers.iter().find_map(|&number| doubt(key, number));
    }
    let largest = numbers.iter().copied().fold(0.0, f64::max);
    let is_small = largest > 0.0 && largest < 200.0;
    is_small.then(|| format!("{largest} us at most; expected 200 us or more; {MICROSECONDS}"))
}

fn numbers_of(value: &DeValue<'_>, numbers: &mut Vec<f64>) {
    match value.as_array() {
        Some(array) => array.iter().for_each(|value| numbers_of(value.get_ref(), numbers)),
        None => numbers.extend(number(value)),
    }
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    let text = match value {
        DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
        DeValue::Float(float) => float.as_str(),
        _ => return None,
    };
    text.parse().ok().filter(|number: &f64| number.is_finite())
}
