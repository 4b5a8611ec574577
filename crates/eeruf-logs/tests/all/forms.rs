//! Logs in the forms that users have, each with its correct answer from `tests/data`.

use std::io::Write as _;
use std::path::Path;

use eeruf_logs::{Echo, FieldChoice, Options, Pattern, RangeUnit, Report, Table, read_log, read_stream};

/// A log's contents: each sensor's name and ranges in metres, `-` for no echo, `<` for too close, `!` for a non-number;
/// and the seconds between its first two readings.
pub(crate) fn said(bytes: &[u8], options: &Options) -> (String, Option<f64>, Report) {
    let mut readings = vec![];
    let report = read_stream(bytes, Path::new("log"), options, |_, reading| readings.push(*reading)).unwrap();
    let text = |sensor: usize| {
        let own = readings.iter().filter(|reading| reading.sensor == sensor).map(|reading| match reading.echo() {
            Echo::At(range_m) => format!(" {}", (range_m * 1000.0).round() / 1000.0),
            Echo::Nothing => " -".to_owned(),
            Echo::TooClose => " <".to_owned(),
            Echo::Invalid => " !".to_owned(),
        });
        report.names()[sensor].clone() + ":" + &own.collect::<String>()
    };
    let sensors: Vec<_> = (0..report.sensors.len()).map(text).collect();
    let mut first = readings.iter().filter(|reading| reading.sensor == 0).filter_map(|reading| reading.at_ns);
    let step = first.next().zip(first.next()).map(|(one, two)| (two as f64 - one as f64) * 1e-9);
    (sensors.join("; "), step, report)
}

/// A form: name, text, sensors, and seconds between the first two readings.
type Form = (String, String, String, Option<f64>);

/// The forms of a file: `== NAME == SENSORS == SECONDS`, and the lines of the log up to the next one. `\t`, `\r` and
/// `\u{HEX}` are escapes; a final `\` means a text without a last line break.
fn forms(file: &str) -> Vec<Form> {
    let blocks = file.strip_prefix("== ").unwrap().split("\n== ");
    let plain = |text: &str| {
        let (mut out, mut rest) = (String::new(), text);
        while let Some((before, after)) = rest.split_once('\\') {
            out += before;
            let (letter, left) = after.split_at(1);
            rest = left;
            match letter {
                "t" => out.push('\t'),
                "r" => out.push('\r'),
                "\\" => out.push('\\'),
                _ => {
                    let (hex, left) = left[1..].split_once('}').unwrap();
                    out.extend(char::from_u32(u32::from_str_radix(hex, 16).unwrap()));
                    rest = left;
                }
            }
        }
        out + rest
    };
    let form = |block: &str| {
        let (head, text) = block.split_once('\n').unwrap();
        let [name, sensors, step] = head.split(" ==").map(str::trim).collect::<Vec<_>>()[..] else { panic!("{head}") };
        let text = text.strip_suffix('\n').unwrap_or(text);
        let text = text.strip_suffix('\\').map_or_else(|| plain(text) + "\n", plain);
        (name.to_owned(), text, plain(sensors), step.parse().ok())
    };
    blocks.map(form).collect()
}

#[test]
fn each_form_gives_its_right_answer() {
    let mut wrong = vec![];
    for (name, text, sensors, step) in forms(include_str!("../data/forms.txt")) {
        let (found, seconds, report) = said(text.as_bytes(), &Options::default());
        let is_near = step.zip(seconds).is_none_or(|(step, seconds)| (step - seconds).abs() < 1e-4);
        let has_options = report.guesses.iter().all(|guess| guess.option.starts_with("--"));
        let is_right = found == sensors && report.damage.is_empty() && is_near && step.is_some() == seconds.is_some();
        if !is_right || !has_options {
            let damage: Vec<_> = report.damage.iter().map(ToString::to_string).collect();
            wrong.push(format!("{name}\n  expected {sensors} {step:?}\n  found    {found} {seconds:?} {damage:?}"));
        }
    }
    assert!(wrong.is_empty(), "{} wrong\n{}", wrong.len(), wrong.join("\n"));
}

// A message without an end may be cut in the middle of a number.
#[test]
fn message_that_is_not_ended_gives_no_reading() {
    let text = "range: 0.40\n---\nrange: 0.41\n---\nrange: 0.4";
    let (said, _, report) = said(text.as_bytes(), &Options::default());
    assert_eq!(said, "range: 0.4 0.41");
    assert_eq!(report.damage.len(), 1);
}

#[test]
fn lines_and_rows_of_one_sensor_each_show_the_firing_pattern() {
    let line = |n: u32| format!("12:00:{:02}.{:03} -> Sensor {}: 40 cm\n", n / 20, n % 20 * 50, n % 4 + 1);
    let row = |n: u32| {
        format!("{},{}40{}\n", f64::from(n) * 0.05, ",".repeat(n as usize % 4), ",".repeat(3 - n as usize % 4))
    };
    let lines: String = (0..400).map(line).collect();
    let rows = "t,a,b,c,d\n".to_owned() + &(0..400).map(row).collect::<String>();
    let at_once = "t,a,b,c,d\n".to_owned()
        + &(0..100).map(|n| format!("{},40,40,40,40\n", f64::from(n) * 0.2)).collect::<String>();
    for (text, expected) in [(lines, Pattern::InTurn), (rows, Pattern::InTurn), (at_once, Pattern::Unknown)] {
        assert_eq!(said(text.as_bytes(), &Options::default()).2.firing.pattern, expected, "{}", &text[..40]);
    }
}

#[test]
fn more_json_documents_give_the_same_records() {
    let expected = "left: 0.4 0.41; right: 0.8 -";
    for text in [
        "[{\"left\":40,\"right\":80},{\"left\":41,\"right\":null}]",
        "{\n\"ring\": \"a {[\",\n\"readings\": [{\"left\":40,\"right\":80},\n{\"left\":41,\"right\":null}]}",
        "{\"left\":40,\n\"right\":80}\n{\"left\":41,\n\"right\":null}\n",
        "{\"left\":40,\"right\":80}\n{\"left\":41,\"right\":null}\n",
    ] {
        assert_eq!(said(text.as_bytes(), &Options::default()).0, expected, "{text}");
    }
    let arrays = "column 1: 0.4 0.41; column 2: 0.8 -";
    for text in ["[[40,80],[41,null]]", "[40,80]\n[41,None]\n"] {
        assert_eq!(said(text.as_bytes(), &Options::default()).0, arrays, "{text}");
    }
}

#[test]
fn utf_16_and_packed_text_read_as_plain() {
    let text = "t,left,right\n0.0,40,80\n0.1,41,81\n";
    let expected = "left: 0.4 0.41; right: 0.8 0.81";
    for (bom, order) in [(true, true), (false, true), (true, false), (false, false)] {
        let start = if bom { "\u{feff}" } else { "" };
        let units = format!("{start}{text}").encode_utf16().collect::<Vec<_>>();
        let bytes: Vec<u8> =
            units.iter().flat_map(|unit| if order { unit.to_le_bytes() } else { unit.to_be_bytes() }).collect();
        assert_eq!(said(&bytes, &Options::default()).0, expected, "{bom} {order}");
    }
    let folder = tempfile::tempdir().unwrap();
    let mut gzip = flate2::write::GzEncoder::new(vec![], flate2::Compression::default());
    gzip.write_all(text.as_bytes()).unwrap();
    let mut bzip2 = bzip2::write::BzEncoder::new(vec![], bzip2::Compression::default());
    bzip2.write_all(text.as_bytes()).unwrap();
    let zstd = zstd::encode_all(text.as_bytes(), 1).unwrap();
    for (name, bytes) in [("a.csv.gz", gzip.finish().unwrap()), ("b.bz2", bzip2.finish().unwrap()), ("c.zst", zstd)] {
        let file = folder.path().join(name);
        std::fs::write(&file, &bytes).unwrap();
        let mut readings = 0;
        let report = read_log(&file, &Options::default(), |_, _| readings += 1).unwrap();
        assert_eq!((readings, report.names().join(" ").as_str(), report.damage.len()), (4, "left right", 0), "{name}");
        assert!(report.form.contains("packed by"), "{}", report.form);
        // The damage of a cut file is reported.
        std::fs::write(&file, &bytes[..bytes.len() - 6]).unwrap();
        let report = read_log(&file, &Options::default(), |_, _| {}).unwrap();
        assert!(!report.damage.is_empty(), "{name}");
    }
    let bag = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bags/ros1-none.bag")).unwrap();
    let file = folder.path().join("drive.bag.zst");
    std::fs::write(&file, zstd::encode_all(&*bag, 1).unwrap()).unwrap();
    assert_eq!(read_log(&file, &Options::default(), |_, _| {}).unwrap().sensors.len(), 6);
}

#[test]
fn options_override_guesses() {
    let text = "a,b,c\n0,40,7\n1,41,7\n";
    let with = |change: &dyn Fn(&mut Options)| {
        let mut options = Options::default();
        change(&mut options);
        said(text.as_bytes(), &options).0
    };
    assert_eq!(with(&|options| options.table.ranges = vec!["b".to_owned()]), "b: 0.4 0.41");
    assert_eq!(
        with(&|options| options.table.columns = ["t", "near", "-"].map(str::to_owned).to_vec()),
        "near: 0.4 0.41"
    );
    let only = |options: &mut Options| options.table.ranges = vec!["a".to_owned()];
    let no_echo = |options: &mut Options| {
        only(options);
        options.no_echo = vec!["1".to_owned()];
        options.table.range_unit = Some(RangeUnit::M);
    };
    assert_eq!(with(&no_echo), "a: 0 -");
    let table = Table { columns: vec!["t".to_owned()], ..Table::default() };
    let refused = read_stream(text.as_bytes(), Path::new("log"), &Options { table, ..Options::default() }, |_, _| {});
    assert_eq!(refused.unwrap_err().message(), "--columns: 1 names; expected 3, as many as the rows have columns");
}

#[test]
fn log_without_sensors_says_what_it_holds() {
    for (text, expected) in [
        ("hello\nworld\n", "none of them a range"),
        ("t,battery\n1,12.1\n2,12.0\n", "columns t, battery, none of them a range"),
        ("{\"event\":\"start\"}\n", "columns event, none of them a range"),
        ("Time [s],Channel 0\n0.0000,0\n0.0012,1\n0.0052,0\n", "Channel 0, none of them a range"),
        ("can0 201 [4] 01 90 03 20\ncan0 201 [4] 01 91 03 21\ncan0 202 [4] 02 91 03 21\n", "none of them a range"),
        ("FMT, 128, 89, FMT, BBnNZ, Type,Length,Name\nATT, 100, 0.1, 0.2\n", "no records with ranges"),
    ] {
        let (_, _, report) = said(text.as_bytes(), &Options::default());
        assert!(report.sensors.is_empty());
        let said = report.skipped.last().unwrap().why.clone();
        assert!(said.contains(expected), "{text}: {said}");
    }
}

#[test]
fn foreign_forms_are_named_with_their_way_out() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes, form, way) in [
        ("a.csv.xz", &b"\xfd7zXZ\0\0\x04"[..], "packed by xz", "xz --decompress"),
        ("a.xlsx", b"PK\x03\x04", "spreadsheet", "read_excel"),
        ("a.dat", b"\x01\x02\x03\0\0\0\x07\x08", "binary", "MCAP"),
    ] {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        let error = read_log(&file, &Options::default(), |_, _| {}).unwrap_err().to_string();
        assert!(error.contains(form) && error.contains(way) && !error.contains('\n'), "{error}");
        let error = eeruf_logs::FiringLog::read(&file).unwrap_err().to_string();
        assert!(error.contains(form), "{error}");
    }
}

/// A bag of the field cases.
fn bag(name: &str, options: &Options) -> (Report, Vec<Echo>) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/field-cases").join(name);
    let mut echoes = vec![];
    let report = read_log(&file, options, |_, reading| echoes.push(reading.echo())).unwrap();
    (report, echoes)
}

#[test]
fn points_arrays_and_long_scans_are_read_where_asked() {
    let topic = |topic: &str| Options { topics: vec![topic.to_owned()], ..Options::default() };
    let field = |topic: &str, path: &str, unit| Options {
        fields: vec![FieldChoice { topic: topic.to_owned(), path: path.to_owned(), unit }],
        ..Options::default()
    };
    let (points, _) = bag("pointcloud.bag", &Options::default());
    assert!(points.sensors.is_empty() && points.skipped[0].why.contains("--topic /RosAria/sonar"), "{points:?}");
    let (points, echoes) = bag("pointcloud.bag", &topic("/RosAria/sonar"));
    assert!(points.sensors.len() > 1 && !echoes.is_empty() && points.damage.is_empty(), "{points:?}");
    let (array, echoes) = bag("multiarray.bag", &Options::default());
    assert_eq!((array.sensors.len(), array.firing.pattern), (6, Pattern::Unknown));
    let mm = field("/ultrasonic", "data[]", RangeUnit::Mm);
    let (other, smaller) = bag("multiarray.bag", &mm);
    let range = |echo: &Echo| if let Echo::At(range_m) = echo { *range_m } else { f64::NAN };
    assert!((range(&smaller[0]) - range(&echoes[0]) * 1e-3).abs() < 1e-9 && other.sensors.len() == 6);
    let (wrong, _) = bag("multiarray.bag", &field("/ultrasonic", "ranges[]", RangeUnit::M));
    assert!(wrong.skipped[0].why.contains("no field `ranges[]`") && wrong.skipped[0].why.contains("data[]"));
    assert_eq!(bag("scan73.bag", &Options::default()).0.sensors.len(), 73);
    let (far, _) = bag("cmranges.bag", &Options::default());
    assert!(far.warnings[0].contains("--field /us range cm"), "{:?}", far.warnings);
    let (near, echoes) = bag("cmranges.bag", &field("/us", "range", RangeUnit::Cm));
    assert!(near.warnings.is_empty() && (range(&echoes[0]) - 0.8).abs() < 1e-6, "{:?}", echoes[0]);
}

#[test]
fn damaged_line_among_messages_of_a_board_is_damage() {
    let start = "ets Jul 29 2019 12:21:46\nrst:0x1 (POWERON_RESET),boot:0x13 (SPI_FAST_FLASH_BOOT)\nentry 0x400805f0\n";
    let lines = "front: 40 cm\nfront: 4ets Jul 29 2019 12:21:46\nfr\u{fffd}nt: 41 cm\nfront: 42 cm\n";
    let more = "front: 43 cm\nload: 7 cm\nfront: 4\u{0} cm\nfr\u{fffd}nt: 41 cm\nfront: 42 cm\n";
    let (found, _, report) = said(format!("{start}{lines}{start}{more}").as_bytes(), &Options::default());
    assert_eq!((found.as_str(), report.damage.len()), ("front: 0.4 0.42 0.43 0.42", 5), "{:?}", report.damage);
    assert!(report.skipped.iter().any(|skipped| skipped.why.starts_with("6 of its lines: a board")), "{report:?}");
}

#[test]
fn extremes_of_readings_are_not_sensors_beside_them() {
    for (header, kept, left) in [
        ("front_min,front_mean,front_max,left_min,left_mean,left_max", ["front_mean", "left_mean"], 4),
        ("front_cm,front_max_cm,front_std_cm,left_cm,left_max_cm,left_std_cm", ["front_cm", "left_cm"], 2),
        ("max_front,min_front,upper_front,max_left,min_left,upper_left", ["min_front", "min_left"], 4),
    ] {
        let row = |n: u32| format!("{}.{n},{n}1.5,{n}3.7,2{n}.1,3{n}.5,4{n}.9\n", n + 40);
        let text = format!("{header}\n{}", (2..9).map(row).collect::<String>());
        let (found, _, report) = said(text.as_bytes(), &Options::default());
        let names: Vec<_> = found.split("; ").filter_map(|sensor| Some(sensor.split_once(':')?.0)).collect();
        assert_eq!(names, kept, "{text}");
        let guess = report.guesses.iter().find(|guess| guess.what == "no sensors").unwrap();
        assert_eq!(guess.value.matches("the least or the greatest").count(), left, "{}", guess.value);
    }
}

#[test]
fn repetition_is_said_and_overridden() {
    let text = "front_cm,front_in\n40,15.7\n51,20.1\n69,27.2\n";
    let (found, _, report) = said(text.as_bytes(), &Options::default());
    assert_eq!(found, "front_cm: 0.4 0.51 0.69");
    let guess = report.guesses.iter().find(|guess| guess.what == "no sensors").unwrap();
    assert_eq!(guess.value, "`front_in` repeats `front_cm`");
    let mut options = Options::default();
    options.table.ranges = vec!["front_in".to_owned()];
    assert_eq!(said(text.as_bytes(), &options).0, "front_in: 0.399 0.511 0.691");
    options.table.ranges.push("front_cm".to_owned());
    assert!(said(text.as_bytes(), &options).0.contains("; "), "{text}");
    let columns = ["a_cm", "b_in"].map(str::to_owned).to_vec();
    let options = Options { table: Table { columns, ..Table::default() }, ..Options::default() };
    assert_eq!(said(text.as_bytes(), &options).0, "a_cm: 0.4 0.51 0.69; b_in: 0.399 0.511 0.691");
}

// Sensors side by side in front of a wall, one nearer by a constant factor, and one that falls silent.
#[test]
fn sensors_that_read_alike_stay_sensors() {
    let rows = |other: &dyn Fn(usize) -> String| {
        let row = |row: usize| format!("{},{}\n", 40 + row * 37 % 90, other(40 + row * 37 % 90));
        "left,right\n".to_owned() + &(0..60).map(row).collect::<String>()
    };
    let short: String = rows(&|cm| cm.to_string()).lines().take(12).map(|line| format!("{line}\n")).collect();
    let others: [&dyn Fn(usize) -> String; 4] = [
        &|cm| (cm + 1).to_string(),
        &|cm| (2 * cm).to_string(),
        &|cm| if cm == 54 { "0".to_owned() } else { cm.to_string() },
        &|cm| if cm % 10 == 4 { "153".to_owned() } else { (cm * 10).to_string() },
    ];
    for text in others.map(rows).into_iter().chain([short]) {
        assert_eq!(said(text.as_bytes(), &Options::default()).2.sensors.len(), 2, "{text}");
    }
    assert_eq!(said(rows(&|cm| cm.to_string()).as_bytes(), &Options::default()).2.sensors.len(), 1);
    assert_eq!(said(rows(&|cm| (cm * 10).to_string()).as_bytes(), &Options::default()).2.sensors.len(), 1);
}

/// Checks results on forms whose answers were written down before the reader saw them: correct, refused or reported as
/// damaged, and silently wrong.
fn tried(file: &str) -> (usize, Vec<String>, Vec<String>) {
    let (mut right, mut open, mut wrong) = (0, vec![], vec![]);
    for (name, text, sensors, step) in forms(file) {
        if let Err(error) = read_stream(text.as_bytes(), Path::new("log"), &Options::default(), |_, _| {}) {
            right += usize::from(sensors == "refused");
            open.extend((sensors != "refused").then(|| format!("{name}: {error}")));
            continue;
        }
        let (found, seconds, report) = said(text.as_bytes(), &Options::default());
        let value = |of: &str| of.rsplit_once(':').map_or(of, |of| of.1).trim().to_owned();
        let [of, expected] = [&found, &sensors].map(|text| text.split("; ").map(value).collect::<Vec<_>>());
        let is_refused = report.sensors.is_empty() || !report.damage.is_empty();
        let is_near = step.is_none_or(|step| seconds.is_some_and(|seconds| (step - seconds).abs() < 0.02 * step));
        let line = format!("{name}: {found} {seconds:?}; expected {sensors} {step:?}");
        match (of == expected && is_near && report.damage.is_empty(), is_refused) {
            (true, _) => right += 1,
            (false, true) if sensors == "refused" => right += 1,
            (false, true) => open.push(line),
            (false, false) => wrong.push(line),
        }
    }
    (right, open, wrong)
}

// At first sight, 30 of the second forty were right and 8 silently wrong; of the third forty, 28 and 10; of the 202 of
// trial 4 by forties, 25 and 10, 36 and 5, 31 and 4, 34 and 6, 34 and 4. The reader was improved each time. Left out:
// four unnamed columns of whole numbers, two of them not ranges, and a ceiling of 255 that occurs twice.
#[test]
fn forms_of_trials_are_mostly_right() {
    let trials = [
        (include_str!("../data/trial-1.txt"), 39),
        (include_str!("../data/trial-2.txt"), 37),
        (include_str!("../data/trial-3.txt"), 40),
        (include_str!("../data/trial-4.txt"), 200),
    ];
    for (file, least) in trials {
        let (right, open, wrong) = tried(file);
        println!("right {right}, refused {}, silently wrong {}", open.len(), wrong.len());
        open.iter().chain(&wrong).for_each(|line| println!("  {line}"));
        assert!(right >= least && wrong.is_empty(), "{right}: {open:#?} {wrong:#?}");
    }
}
