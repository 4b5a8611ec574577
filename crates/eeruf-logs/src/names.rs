//! The meaning of a column by its name.

use crate::options::{RangeUnit, TimeUnit};

use crate::value;

/// Meaning of a column by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    Range,
    Time,
    /// The sensor to which the row belongs.
    Sensor,
    /// A limit of the sensor's range.
    Least,
    Most,
    /// A quantity other than a range.
    Other,
    /// An unknown meaning.
    Vague,
}

const TIMES: &str = "\
    time timestamp stamp millis micros nanos clock date datetime elapsed uptime epoch utc zeit uhrzeit datum \
    seconds secs nsecs nanosec nsec";
const WHOLE_TIMES: &str = "t ts ms us ns s sec msec usec milliseconds microseconds nanoseconds";
const ECHOES: &str = "echo flight pulse duration travel";
const RANGES: &str = "\
    range ranges distance distances dist sonar sonars ultrasonic ultrasound ultrasonics hcsr ping abstand \
    entfernung value values payload";
const SENSORS: &str = "\
    sensor id name channel ch frame topic sonar _field sensor_id sensorid frame_id entity_id source instance device \
    device_id key addr address port";
const OTHERS: &str = "\
    battery bat voltage volt volts current temp temperature humidity hum pressure seq sequence index entry idx \
    count counter row line mode state status flag flags ir infrared laser lidar speed velocity vel accel acc gyro \
    yaw pitch roll heading angle theta odom odometry x y z lat lon alt altitude encoder pwm motor rssi snr \
    variance covariance std intensity intensities radiation fov period phase reading rate size stride offset \
    checksum crc gain strength quality confidence amplitude threshold event error err message msg rpm light ldr \
    pir button led setpoint target desired goal color colour qos type orientation unit units given solo steady batt \
    vbat vcc watt percent soc enc encoders tick \
    ticks tof sharp acceleration accelerometer gyroscope mag magnetometer imu gps sat ax ay az gx gy gz mx my mz \
    vx vy vz q servo cmd linear angular valid ok enabled bump bumper touch contact estop hz fps deg degc lux feed \
    stat orient elevation adc analog analogue ttl changes expected sends";

/// Words for directions and places of sensors, in several languages.
const PLACES: &str = "\
    left right front back rear center centre middle mid top bottom upper lower side corner bow stern port starboard \
    north south east west fl fr bl br rl rr fc lf rf lb rb lr links rechts vorne vorn hinten mitte oben unten \
    gauche droite avant arriere izquierda derecha frente atras delante sinistra destra sx dx lus rus";
/// Words for lengths that are computed from a range.
const DERIVED: &str = "depth level height tcdt";
/// Words for constant lines that fix the axis of a plotter.
const LIMITS: &str = "min max minimum maximum lower upper lower_limit upper_limit";
/// Units that are names by themselves.
const UNITS: &str = "cm mm inch inches meters metres centimeters centimetres millimeters millimetres";
const FILTERS: &str = "filtered filter smoothed smooth avg average averaged mean median kalman ema sma lowpass lpf";

/// Units that no range here has, at the end of a name.
const UNREAD_UNITS: &str = "v mv yd yds dm km nm pct percent px";
/// Ends of names of source files, which loggers write before a line's number.
const SOURCES: &str = "py ino c cc cpp h hpp rs js ts java go";

/// Returns true if a list, separated by spaces, has this word.
fn is_in(list: &str, word: &str) -> bool {
    list.split(' ').any(|own| own == word)
}

/// The words of a name in lower case: `frontLeft_cm2` is `front`, `left`, `cm`, `2`.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for letter in name.chars() {
        let is_border = (letter.is_uppercase() && before.is_lowercase())
            || (letter.is_ascii_digit() != before.is_ascii_digit() && before != ' ');
        if is_border && words.last().is_some_and(|word| !word.is_empty()) {
            words.push(String::new());
        }
        if letter.is_alphanumeric() {
            words.last_mut().expect("there is one").extend(letter.to_lowercase());
        } else if words.last().is_some_and(|word| !word.is_empty()) {
            words.push(String::new());
        }
        before = letter;
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The meaning of the last part of a path or, if that is vague, of the whole path.
pub(crate) fn meaning(name: &str) -> Meaning {
    // QGroundControl names distances by the sensor's direction: `distanceSensor.rotationPitch270`.
    if let Some((sensor, _)) = name.rsplit_once(".rotation")
        && meaning_of(sensor) == Meaning::Range
    {
        return Meaning::Range;
    }
    if name.rsplit_once('.').is_some_and(|(_, end)| is_in(SOURCES, end)) {
        return Meaning::Other;
    }
    let last = name.rsplit_once('.').map_or(Meaning::Vague, |(_, last)| meaning_of(last));
    if last == Meaning::Vague { meaning_of(name) } else { last }
}

fn meaning_of(name: &str) -> Meaning {
    let words = words(name);
    let has = |of: &str| words.iter().any(|word| is_in(of, word));
    let whole = name.trim().trim_start_matches('%').to_lowercase();
    // An address on a bus.
    if whole.starts_with("0x") {
        return Meaning::Vague;
    }
    if words.len() > 1 && is_in(UNREAD_UNITS, &words[words.len() - 1]) {
        return Meaning::Other;
    }
    let is_echo = has(ECHOES) || whole == "time_of_flight";
    if has("field") && has("view") || has("angle increment") {
        return Meaning::Other;
    }
    if has(RANGES) && has("min minimum") {
        return Meaning::Least;
    }
    if has(RANGES) && has("max maximum") {
        return Meaning::Most;
    }
    let without_units: Vec<_> = words.iter().filter(|word| !is_unit(word)).map(String::as_str).collect();
    let is_time = has(TIMES) || is_in(WHOLE_TIMES, &whole) || matches!(without_units[..], ["t" | "ts" | "tv"]);
    if has("fired") || (is_time && !is_echo) {
        return Meaning::Time;
    }
    // The distance now, beside its limits.
    let is_distance_now = has(RANGES) && has("current");
    if has(OTHERS) && !is_distance_now || is_in(LIMITS, &whole) {
        return Meaning::Other;
    }
    if is_in(SENSORS, &whole) || has("frame") && has("id") {
        return Meaning::Sensor;
    }
    if has(RANGES) || is_echo {
        return Meaning::Range;
    }
    Meaning::Vague
}

fn is_unit(word: &str) -> bool {
    value::unit(word).is_some() || TimeUnit::of_word(word).is_some()
}

/// The unit of ranges in a name, and whether the name says it without doubt: `us` also means ultrasound.
pub(crate) fn range_unit(name: &str) -> Option<(RangeUnit, bool)> {
    let words = words(name);
    let last = words.last()?;
    let is_echo = words.iter().any(|word| is_in(ECHOES, word));
    if is_echo && TimeUnit::of_word(last) == Some(TimeUnit::Ms) {
        return Some((RangeUnit::Ms, true));
    }
    if let Some(unit) = value::unit(last).filter(|_| words.len() > 1 || is_in(UNITS, last)) {
        return Some((unit, unit != RangeUnit::Us || is_echo));
    }
    // A number after it, as in `cm2`.
    let unit = words.iter().rev().nth(1).and_then(|word| value::unit(word));
    if let Some(unit @ (RangeUnit::Cm | RangeUnit::Mm)) = unit {
        return Some((unit, true));
    }
    is_echo.then_some((RangeUnit::Us, false))
}

/// A name without words for ranges, units, filters and copies, which identifies the sensor.
pub(crate) fn stem(name: &str) -> Vec<String> {
    let mut words = words(name);
    words.retain(|word| ![RANGES, FILTERS, ECHOES, "raw copy"].iter().any(|list| is_in(list, word)) && !is_unit(word));
    words
}

/// The stem of a name for the least or the greatest of several readings, without that word, and whether it is the
/// least; `None` for other names.
pub(crate) fn extreme(name: &str) -> Option<(Vec<String>, bool)> {
    let mut stem = stem(name);
    let is_least = stem.iter().any(|word| is_in("min minimum", word));
    let count = stem.len();
    stem.retain(|word| !is_in(LIMITS, word));
    (stem.len() < count).then_some((stem, is_least))
}

/// Returns true for the first letter of a place's name.
pub(crate) fn is_letter_of_place(name: &str) -> bool {
    is_in("l r c m f b", &name.to_lowercase())
}

/// A name without words that do not describe the quantity: places, filters, units, numbers, and words for any value.
pub(crate) fn quantity(name: &str) -> String {
    const ANY: &str = "field data reading sensor ch channel column s us u d dt tcdt val state copy raw a b c e";
    let mut words = stem(name);
    words.retain(|word| !is_in(ANY, word) && !is_in(PLACES, word) && !word.bytes().all(|byte| byte.is_ascii_digit()));
    words.concat()
}

/// Returns true for the name of a place on a robot.
pub(crate) fn is_place(name: &str) -> bool {
    words(name).iter().any(|word| is_in(PLACES, word))
}

/// Returns true for a remark beside a value that says whose it is: `sensor 3`, `#3`, `front left`.
pub(crate) fn is_owner(remark: &str) -> bool {
    let words = words(remark);
    let is_numbered = words.last().is_some_and(|word| word.bytes().all(|byte| byte.is_ascii_digit()));
    let is_called = remark.starts_with('#') || is_in(SENSORS, &words[0]) || is_in("us hc sr nr no", &words[0]);
    is_numbered && is_called || !words.is_empty() && words.iter().all(|word| is_in(PLACES, word))
}

/// Returns true for the name of filtered readings.
pub(crate) fn is_filtered(name: &str) -> bool {
    words(name).iter().any(|word| is_in(FILTERS, word))
}

/// Returns true for the name of a length that a program computes from a range.
pub(crate) fn is_derived(name: &str) -> bool {
    words(name).iter().any(|word| is_in(DERIVED, word))
}

/// Returns true for the name of an analogue input pin, such as `A0`.
pub(crate) fn is_analogue_pin(name: &str) -> bool {
    let pin = name.trim().strip_prefix(['A', 'a']).and_then(|pin| pin.parse::<u8>().ok());
    pin.is_some_and(|pin| pin < 16)
}

/// Returns true for a unit of anything but a length or a time.
pub(crate) fn is_foreign_unit(text: &str) -> bool {
    const UNITS: &str = "% c f v mv a ma w g kg hpa pa db dba dbm lux lx rpm hz deg \u{b0} \u{b0}c \u{b0}f km/h m/s";
    is_in(UNITS, &text.to_lowercase().trim_matches([',', ';', '.', ')']).replace('(', ""))
}

/// The unit of times in a name.
pub(crate) fn time_unit(name: &str) -> Option<TimeUnit> {
    words(name).iter().rev().find_map(|word| TimeUnit::of_word(word))
}

/// Preference for a time column: the stamp of a message's header first.
pub(crate) fn preference(name: &str) -> u8 {
    let words = words(name);
    let has = |word: &str| words.iter().any(|own| own == word);
    u8::from(has("header")) * 2 + u8::from(has("stamp"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meaning_follows_the_words_of_a_name() {
        for (name, expected) in [
            ("t", Meaning::Time),
            ("t_ms", Meaning::Time),
            ("millis", Meaning::Time),
            ("%time", Meaning::Time),
            ("field.header.stamp", Meaning::Time),
            ("fired_us", Meaning::Time),
            ("echo_time_us", Meaning::Range),
            ("t_echo_us", Meaning::Range),
            ("left", Meaning::Vague),
            ("frontLeft", Meaning::Vague),
            ("US1", Meaning::Vague),
            ("field.range", Meaning::Range),
            ("field.min_range", Meaning::Least),
            ("field.max_range", Meaning::Most),
            ("field.field_of_view", Meaning::Other),
            ("field.header.seq", Meaning::Other),
            ("field.header.frame_id", Meaning::Sensor),
            ("battery_v", Meaning::Other),
            ("ir_distance", Meaning::Other),
            ("sensor", Meaning::Sensor),
            ("Sensor 1", Meaning::Vague),
            ("distance_cm", Meaning::Range),
            ("DISTANCE_SENSOR.current_distance", Meaning::Range),
            ("DISTANCE_SENSOR.min_distance", Meaning::Least),
            ("DISTANCE_SENSOR.id", Meaning::Sensor),
            ("DISTANCE_SENSOR.type", Meaning::Other),
            ("distance.value", Meaning::Range),
            ("us.left", Meaning::Vague),
            ("entity_id", Meaning::Sensor),
            ("entry_id", Meaning::Other),
        ] {
            assert_eq!(meaning(name), expected, "{name}");
        }
        let others = ["front_V", "range_yd", "distance [dm]", "sonar.py"];
        assert_eq!(others.map(meaning), [Meaning::Other; 4]);
    }

    #[test]
    fn unit_stands_at_the_end_of_a_name() {
        let unit = |name| range_unit(name).map(|unit| unit.0);
        assert_eq!(unit("left_cm"), Some(RangeUnit::Cm));
        assert_eq!(unit("Left [mm]"), Some(RangeUnit::Mm));
        assert_eq!(unit("distanceCm"), Some(RangeUnit::Cm));
        assert_eq!(unit("pulse"), Some(RangeUnit::Us));
        assert_eq!(unit("echo_left_ms"), Some(RangeUnit::Ms));
        assert_eq!(range_unit("left_us"), Some((RangeUnit::Us, false)));
        assert_eq!(unit("US1"), None);
        assert_eq!(unit("left"), None);
        assert_eq!(time_unit("time_ms"), Some(TimeUnit::Ms));
    }
}
