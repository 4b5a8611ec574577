//! The text of a cell: a number with a unit, a word for no echo, or a time.

use crate::options::{RangeUnit, TimeUnit};

/// A cell of a column of ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value {
    Number(f64),
    NoEcho,
    TooClose,
}

/// Words for no echo, separated by bars; the first is the empty text.
const NO_ECHO: &str = "\
    |none|null|nil|nan|-nan|na|n/a|inf|+inf|infinity|+infinity|no echo|noecho|no_echo|timeout|time out|\
    out of range|out_of_range|oor|err|error|undefined|invalid|nothing|.inf|.nan|<na>|unknown|#n/a";

/// Returns true for a word that logs write for no echo.
pub(crate) fn is_no_echo(text: &str) -> bool {
    // Dashes in the places of digits.
    let is_blank = text.len() <= 12 && text.contains('-') && text.trim_matches(['-', '.']).is_empty();
    is_blank || text.len() <= 12 && NO_ECHO.split('|').any(|word| text.eq_ignore_ascii_case(word))
}

/// A finite decimal number, and nothing else: `0x10`, `1_000` and `1e999` are refused.
pub(crate) fn number(text: &str, decimal_comma: bool) -> Option<f64> {
    let bytes = text.as_bytes();
    if !bytes.iter().any(u8::is_ascii_digit) {
        return None;
    }
    let is_part = |byte: &u8| byte.is_ascii_digit() || b"+-.eE".contains(byte) || (decimal_comma && *byte == b',');
    if !bytes.iter().all(is_part) {
        return None;
    }
    let parsed: f64 = if decimal_comma { text.replace(',', ".").parse() } else { text.parse() }.ok()?;
    parsed.is_finite().then_some(parsed)
}

/// The number before a unit, as in `40cm` or `40 cm`, and the unit if there is one.
pub(crate) fn with_unit(text: &str, decimal_comma: bool) -> Option<(f64, Option<RangeUnit>)> {
    if let Some(number) = number(text, decimal_comma) {
        return Some((number, None));
    }
    let end = text.rfind(|letter: char| letter.is_ascii_digit() || letter == '.')? + 1;
    let unit = unit(text[end..].trim())?;
    number(text[..end].trim_end(), decimal_comma).map(|number| (number, Some(unit)))
}

/// The unit of ranges with this name.
pub(crate) fn unit(word: &str) -> Option<RangeUnit> {
    RangeUnit::of_word(&word.trim_matches(['(', ')', '[', ']', '.']).to_lowercase())
}

/// The range in a cell; `None` if it is neither a number nor a word for no echo.
pub(crate) fn range(text: &str, decimal_comma: bool) -> Option<(Value, Option<RangeUnit>)> {
    // No word for no echo begins so.
    if text.starts_with(|letter: char| letter.is_ascii_digit()) {
        return with_unit(text, decimal_comma).map(|(number, unit)| (Value::Number(number), unit));
    }
    if is_no_echo(text) {
        return Some((Value::NoEcho, None));
    }
    // A word before a unit, as formatted output has it: `nan cm`, `infm`.
    let glued = text.get(..3).filter(|word| ["inf", "nan"].contains(word)).map(|word| (word, &text[3..]));
    let dashes = text.rfind('-').map(|at| text.split_at(at + 1)).filter(|(word, _)| is_no_echo(word));
    let spaced = text.rsplit_once(' ').filter(|(word, _)| !word.is_empty() && is_no_echo(word)).or(dashes);
    if let Some(own) = spaced.or(glued).and_then(|(_, own)| unit(own)) {
        return Some((Value::NoEcho, Some(own)));
    }
    // Beyond what the sensor measures: `>400 cm`, `<2`.
    for (sign, value) in [('>', Value::NoEcho), ('<', Value::TooClose)] {
        if let Some((_, own)) = text.strip_prefix(sign).and_then(|rest| with_unit(rest.trim_start(), decimal_comma)) {
            return Some((value, own));
        }
    }
    if ["-inf", "-infinity", "-.inf"].iter().any(|word| text.eq_ignore_ascii_case(word)) {
        return Some((Value::TooClose, None));
    }
    with_unit(text, decimal_comma).map(|(number, unit)| (Value::Number(number), unit))
}

const HOUR_NS: u64 = 3_600_000_000_000;
const DAY_NS: u64 = 24 * HOUR_NS;
const MONTHS: [&str; 12] = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];

/// Nanoseconds of a date, a time of day, or both, also with a 12-hour clock.
pub(crate) fn calendar_ns(text: &str) -> Option<u64> {
    let text = text.trim();
    let text = text.strip_suffix(" UTC").unwrap_or(text);
    let halves = [(" AM", 0), (" PM", 12), (" am", 0), (" pm", 12)];
    if let Some((text, noon)) = halves.iter().find_map(|(end, noon)| Some((text.strip_suffix(end)?, *noon))) {
        let ns = calendar_ns(text)?;
        let hour = ns % DAY_NS / HOUR_NS;
        return (1..=12).contains(&hour).then(|| ns - hour * HOUR_NS + (hour % 12 + noon) * HOUR_NS);
    }
    // As `date` and C print it: `Tue Jan  2 12:00:01 2024`.
    if text.starts_with(char::is_alphabetic) {
        let words: Vec<_> = text.split_whitespace().collect();
        let [_, month, day, time, .., year] = words[..] else { return None };
        let month = 1 + MONTHS.iter().position(|name| *name == month)?;
        let day = u64::try_from(days(&format!("{year}-{month}-{day}"))?).ok()?;
        return day.checked_mul(DAY_NS)?.checked_add(time_of_day_ns(time)?);
    }
    if let Some(ns) = time_of_day_ns(text) {
        return Some(ns);
    }
    let (date, time) = match text.find(['T', ' ', '_']) {
        Some(at) => (&text[..at], text[at + 1..].trim()),
        None => (text, ""),
    };
    let days = days(date)?;
    let (time, zone_s) = zone(time)?;
    // After a date two numbers are hours and minutes.
    let minutes = || time_of_day_ns(&format!("{time}:00")).filter(|_| time.matches(':').count() == 1);
    let ns = if time.is_empty() { 0 } else { time_of_day_ns(time).or_else(minutes)? };
    let s = days.checked_mul(86_400)?.checked_sub(zone_s)?;
    u64::try_from(s).ok()?.checked_mul(1_000_000_000)?.checked_add(ns)
}

/// A time without its zone, and the zone's distance from UTC in seconds.
fn zone(time: &str) -> Option<(&str, i64)> {
    if let Some(time) = time.strip_suffix(['Z', 'z']) {
        return Some((time, 0));
    }
    let Some(at) = time.rfind(['+', '-']) else { return Some((time, 0)) };
    let digits: String = time[at + 1..].chars().filter(|&letter| letter != ':').collect();
    let number: i64 = digits.parse().ok()?;
    let seconds = match digits.len() {
        2 => number * 3600,
        4 => (number / 100) * 3600 + (number % 100) * 60,
        _ => return None,
    };
    Some((&time[..at], if time.as_bytes()[at] == b'-' { -seconds } else { seconds }))
}

/// Days from 1970 to `2024-01-31`, `2024/01/31`, `31.01.2024` or `1/31/2024`. If two numbers can be the month, it is
/// the first one with slashes, and otherwise the second.
fn days(date: &str) -> Option<i64> {
    let parts = |by: char| -> Option<[u32; 3]> {
        let mut parts = date.split(by).map(|part| part.parse::<u32>().ok());
        let three = [parts.next()??, parts.next()??, parts.next()??];
        parts.next().is_none().then_some(three)
    };
    let (by, three) = ['-', '/', '.'].into_iter().find_map(|by| Some((by, parts(by)?)))?;
    let [year, month, day] = match three {
        [year, month, day] if year > 31 => [year, month, day],
        [month, day, year] if day > 12 || (by == '/' && month <= 12) => [year, month, day],
        [day, month, year] => [year, month, day],
    };
    let year = if by == '/' && (20..100).contains(&year) { 2000 + year } else { year };
    if !(1970..=2200).contains(&year) || !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    // Years that begin in March, so that a leap day is the last.
    let (y, m) = (i64::from(year) - i64::from(month <= 2), i64::from((month + 9) % 12));
    let of_year = (153 * m + 2) / 5 + i64::from(day) - 1;
    Some(365 * y + y / 4 - y / 100 + y / 400 + of_year - 719_468)
}

/// Nanoseconds of `12:00:01.100`, `12:00:01,100`, `12:00:01`, or `00:01.1`, as spreadsheets write a short time.
fn time_of_day_ns(text: &str) -> Option<u64> {
    let mut parts = text.split(':');
    let (hours, minutes, seconds) = match (parts.next()?, parts.next()?, parts.next()) {
        (hours, minutes, Some(seconds)) => (hours, minutes, seconds),
        (minutes, seconds, None) => ("0", minutes, Some(seconds).filter(|text| text.contains('.'))?),
    };
    let whole = |part: &str, below: u64| {
        let is_whole = (1..=2).contains(&part.len()) && part.bytes().all(|byte| byte.is_ascii_digit());
        part.parse::<u64>().ok().filter(|&number| is_whole && number < below)
    };
    let (seconds, fraction) = seconds.split_once(['.', ',']).unwrap_or((seconds, ""));
    if parts.next().is_some() || fraction.len() > 9 || !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let ns = format!("{fraction:0<9}").parse::<u64>().ok()?;
    let s = whole(hours, 24)? * 3600 + whole(minutes, 60)? * 60 + whole(seconds, 61)?;
    Some(s * 1_000_000_000 + ns)
}

/// The time of `Jan 31 12:00:01 robot node[7]: `, the prefix of syslog, or of the time alone, without a year.
fn syslog(line: &str) -> Option<(u64, &str)> {
    let word = |text: &'_ str| text.find(' ').map(|end| (end, text[end..].trim_start().len()));
    let month = 1 + MONTHS.iter().position(|name| line.starts_with(name))?;
    let rest = line.get(3..)?.strip_prefix(' ')?.trim_start();
    let (end, left) = word(rest)?;
    let day = days(&format!("1970-{month}-{}", &rest[..end]))?;
    let rest = &rest[rest.len() - left..];
    let (end, left) = word(rest)?;
    let at = time_of_day_ns(&rest[..end])?;
    let rest = &rest[rest.len() - left..];
    Some((u64::try_from(day).ok()? * DAY_NS + at, after_program(rest).unwrap_or(rest)))
}

/// The rest of a line after `robot node[7]: `, a host and a program.
fn after_program(line: &str) -> Option<&str> {
    let (before, said) = line.split_once(": ")?;
    let mut words = before.split_whitespace();
    let (_, program) = (words.next()?, words.next()?);
    (program.starts_with(char::is_alphabetic) && words.next().is_none()).then_some(said.trim_start())
}

/// The time of `I (1234) tag: `, the prefix of ESP-IDF: milliseconds since the start.
fn esp_idf(line: &str) -> Option<(u64, &str)> {
    let (ms, rest) = line.strip_prefix(['E', 'W', 'I', 'D', 'V'])?.strip_prefix(" (")?.split_once(") ")?;
    let (_, said) = rest.split_once(": ")?;
    Some((ms.parse::<u64>().ok()?.checked_mul(1_000_000)?, said.trim_start()))
}

const LEVELS: [&str; 7] = ["DEBUG", "INFO", "WARN", "WARNING", "ERROR", "CRITICAL", "FATAL"];

/// A line without the level and the name before it, as Python's logging prints them: `INFO:sonar:left: 40`.
pub(crate) fn without_level(line: &str) -> &str {
    // Most lines begin with a number.
    if !line.starts_with(|letter: char| letter.is_ascii_uppercase()) {
        return line;
    }
    let rest = LEVELS.iter().find_map(|level| line.strip_prefix(level)?.strip_prefix(':'));
    rest.and_then(|rest| rest.split_once(':')).map_or(line, |(_, said)| said.trim_start())
}

/// Nanoseconds of a time with its unit: `1.5 s`, `1500ms`.
pub(crate) fn elapsed_ns(text: &str) -> Option<u64> {
    let (time, unit) = text.split_at(text.find(char::is_alphabetic)?);
    let ns = TimeUnit::of_word(unit)?.said().1 * number(time.trim_end(), false)?;
    (0.0..1e19).contains(&ns).then(|| ns.round() as u64)
}

/// Nanoseconds of a time in brackets: a date, seconds, seconds and those since the last line, or a time with a unit.
fn bracketed_ns(inner: &str) -> Option<u64> {
    let seconds = |text: &str| number(text, false).filter(|&s| text.contains('.') && (0.0..1e10).contains(&s));
    // A level and the name of a program may follow.
    let is_level = |rest: &str| rest.split(' ').next().is_some_and(|word| LEVELS.contains(&word));
    let leveled = inner.split_once(' ').filter(|(_, rest)| is_level(rest)).and_then(|(time, _)| calendar_ns(time));
    // Zephyr separates microseconds from milliseconds.
    let parted = inner.rsplit_once(',').filter(|(time, us)| us.len() == 3 && time.contains('.'));
    let parted = parted.and_then(|(time, us)| calendar_ns(&format!("{time}{us}")));
    calendar_ns(inner).or(leveled).or(parted).or_else(|| elapsed_ns(inner)).or_else(|| {
        let words: Vec<_> = inner.split_whitespace().map(seconds).collect::<Option<_>>()?;
        (words.len() <= 2).then(|| words.first().map(|s| (s * 1e9).round() as u64))?
    })
}

/// A time at the beginning of a line, without brackets, and the rest of the line.
fn plain_time(line: &str) -> Option<(u64, &str)> {
    let is_end = |letter: char| letter.is_whitespace() || letter == '>';
    let first = line.find(is_end)?;
    let second = line[first..].trim_start();
    let second = line.len() - second.len() + second.find(is_end).unwrap_or(second.len());
    // A time with a unit ends with a colon.
    let until_colon = |text: &str| text.strip_suffix(':').and_then(elapsed_ns);
    let time = |text: &str| calendar_ns(text.trim_end_matches(':')).or_else(|| until_colon(text));
    let both = line.get(..second).and_then(|text| Some((time(text)?, &line[second..])));
    if both.is_some() {
        return both;
    }
    if let Some(ns) = until_colon(&line[..first]) {
        return Some((ns, &line[first..]));
    }
    let (own, rest) = (line[..first].trim_end_matches([':', '-']), &line[first..]);
    // A date whose time is a part of the next cell.
    let is_half = !own.contains(':') && rest.trim_start().get(..3).is_some_and(|next| next.contains(':'));
    // Seconds since 1970, if the values after them are not cells separated by spaces.
    let seconds = number(own, false).filter(|&s| own.contains('.') && (1e9..1e10).contains(&s));
    let seconds = seconds.filter(|_| rest.contains([',', ';', ':', '=']));
    let ns = calendar_ns(own).filter(|_| !is_half).or(seconds.map(|s| (s * 1e9).round() as u64))?;
    Some((ns, rest))
}

/// A time before the readings of a line, as serial monitors, loggers and `dmesg` write it, and the rest of the line.
pub(crate) fn prefix(line: &str) -> Option<(u64, &str)> {
    let line = line.trim_start();
    if let Some(found) = esp_idf(line).or_else(|| syslog(line)) {
        return Some(found);
    }
    let (mut time, mut rest) = (None, line);
    // The form of bus tools: `(1700000000.123456) can0 ..`.
    let in_parentheses = line.strip_prefix('(').and_then(|inner| inner.split_once(") "));
    let since_1970 = |text: &str| number(text, false).filter(|&s| text.contains('.') && (1e9..1e10).contains(&s));
    if let Some((s, after)) = in_parentheses.and_then(|(inner, after)| Some((since_1970(inner)?, after))) {
        return Some(((s * 1e9).round() as u64, after.trim_start()));
    }
    // A level or the name of a node may stand in brackets before the time, and after it.
    while let Some((inner, after)) = rest.strip_prefix('[').and_then(|inner| inner.split_once(']')) {
        let (inner, after) = (inner.trim(), after.trim_start());
        let is_name = inner.starts_with(char::is_alphabetic)
            && (time.is_none() || LEVELS.contains(&inner) || after.starts_with([':', '[']));
        // Arduino's log of an ESP32: `[  1234][I][main.cpp:42]`, in milliseconds.
        let is_level = matches!(after.as_bytes(), [b'[', b'E' | b'W' | b'I' | b'D' | b'V', b']', ..]);
        // A number alone is a time too if the numbers of the lines rise, which `strip` checks.
        let is_ms = is_level || after.contains([':', '=']);
        let ms = inner.parse::<u64>().ok().filter(|_| is_ms).and_then(|ms| ms.checked_mul(1_000_000));
        match ms.or_else(|| bracketed_ns(inner)).filter(|_| time.is_none()) {
            Some(ns) => time = Some(ns),
            None if is_name => {}
            None => break,
        }
        rest = after;
    }
    if time.is_none() {
        let (ns, after) = plain_time(rest)?;
        (time, rest) = (Some(ns), after.trim_start());
    }
    let rest = rest.strip_prefix("UTC").unwrap_or(rest);
    // The first cell of a table.
    if rest.starts_with([',', ';']) {
        return None;
    }
    let rest =
        ["->", ">", ":", "- ", "# "].iter().find_map(|arrow| rest.strip_prefix(arrow)).unwrap_or(rest).trim_start();
    let after_level = |level: &&str| rest.strip_prefix(*level)?.strip_prefix(' ');
    let after_name = LEVELS.iter().find_map(|level| Some(rest.split_once(&format!(" - {level} - "))?.1));
    let rest = LEVELS.iter().find_map(after_level).or(after_name).unwrap_or(rest).trim_start();
    let program = after_program(rest).filter(|said| rest[..rest.len() - said.len()].trim_end().ends_with("]:"));
    Some((time?, program.unwrap_or(rest)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_every_spelling_are_nanoseconds() {
        let s = 1_704_196_801_000_000_000;
        for text in [
            "2024-01-02T12:00:01Z",
            "2024-01-02 12:00:01",
            "2024/01/02 12:00:01.000",
            "02.01.2024 12:00:01",
            "2024-01-02T13:00:01+01:00",
            "2024-01-02 12:00:01,000",
            "2024-01-02 12:00:01 UTC",
        ] {
            assert_eq!(calendar_ns(text), Some(s), "{text}");
        }
        assert_eq!(calendar_ns("12:00:01.1"), Some(43_201_100_000_000));
        for text in ["40", "40.5", "12:00", "2024-13-02", "25:00:00", "left", "", "1-2-3"] {
            assert_eq!(calendar_ns(text), None, "{text}");
        }
    }

    #[test]
    fn prefix_ends_where_readings_begin() {
        for line in [
            "12:00:01.100 -> 40,80",
            "[12:00:01.100] 40,80",
            "12:00:01.100: 40,80",
            "12:00:01.100 > 40,80",
            "12:00:01.100\t40,80",
        ] {
            assert_eq!(prefix(line), Some((43_201_100_000_000, "40,80")), "{line}");
        }
        assert_eq!(prefix("[  12.5] left: 4"), Some((12_500_000_000, "left: 4")));
        assert_eq!(prefix("2024-01-02 12:00:01,000 INFO a=1"), Some((1_704_196_801_000_000_000, "a=1")));
        assert_eq!(prefix("I (1250) sonar: left: 40"), Some((1_250_000_000, "left: 40")));
        let first = 43_201_100_000_000;
        assert_eq!(prefix("Jan 01 12:00:01.100 robot sonar[7]: a=1"), Some((first, "a=1")));
        assert_eq!(prefix("Jan  2 12:00:01.1 robot sonar: a=1"), Some((first + 86_400_000_000_000, "a=1")));
        assert_eq!(prefix("2024-01-02 12:00:01 UTC,40,80"), None);
        assert_eq!(prefix("January,left,right"), None);
        assert_eq!(prefix("left: 40 right: 80"), None);
        assert_eq!(prefix("12:00:01.100,40,80"), None);
    }

    #[test]
    fn number_is_plain_and_finite() {
        assert_eq!(number("40,5", true), Some(40.5));
        assert_eq!(with_unit("40 cm", false), Some((40.0, Some(RangeUnit::Cm))));
        for text in ["4x", "0x10", "1e999", "1.2.3", "40,5", "--", "", "4\u{fffd}", "+-4"] {
            assert_eq!(number(text, false), None, "{text}");
        }
    }
}
