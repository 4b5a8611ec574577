//! CSV with any columns.

use eeruf_logs::{Echo, Options, RangeUnit, Table, TimeUnit};

use crate::read;

fn echoes(text: &str, table: Table) -> Result<Vec<(String, Option<u64>, Echo)>, String> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.csv");
    std::fs::write(&file, text).unwrap();
    let options = Options { table, speed_of_sound: 340.0, ..Options::default() };
    let (report, readings) = read(&file, &options).map_err(|error| error.message().to_owned())?;
    let of = |sensor: usize| report.names()[sensor].clone();
    Ok(readings.iter().map(|reading| (of(reading.sensor), reading.at_ns, reading.echo())).collect())
}

#[test]
fn columns_are_found_by_name_in_the_units_given() {
    let text = "stamp,mode,left_us,right_us,battery\n1700000000000,x,10000,,12.1\n1700000000060,y,,20000,12.0\n";
    let table = Table {
        ranges: vec!["left_us".to_owned(), "right_us".to_owned()],
        range_unit: Some(RangeUnit::Us),
        time: Some("stamp".to_owned()),
        time_unit: Some(TimeUnit::Ms),
        columns: vec![],
        sensor: None,
    };
    let at = |ms: u64| Some(1_700_000_000_000_000_000 + ms * 1_000_000);
    let (left, right) = ("left_us".to_owned(), "right_us".to_owned());
    let read = echoes(text, table).unwrap();
    let expected = [
        (left.clone(), at(0), Echo::At(1.7)),
        (right.clone(), at(0), Echo::Nothing),
        (left, at(60), Echo::Nothing),
        (right, at(60), Echo::At(3.4)),
    ];
    assert_eq!(read, expected);
}

#[test]
fn a_column_may_say_whose_reading_a_row_is() {
    let text = "t,id,mm\n0.1,a,1000\n0.2,b,2000\n0.3,a,9000\n";
    let column = |name: &str| Some(name.to_owned());
    let table = Table {
        ranges: vec!["mm".to_owned()],
        range_unit: Some(RangeUnit::Mm),
        time: column("t"),
        sensor: column("id"),
        ..Table::default()
    };
    let read = echoes(text, table.clone()).unwrap();
    let expected = [("a", 100, Echo::At(1.0)), ("b", 200, Echo::At(2.0)), ("a", 300, Echo::Nothing)];
    assert_eq!(read, expected.map(|(name, ms, echo)| (name.to_owned(), Some(ms * 1_000_000), echo)));
    let error = echoes(text, Table { time: column("time"), ..table.clone() }).unwrap_err();
    assert_eq!(error, "no column `time`; expected one of: t, id, mm");
    assert_eq!(echoes(text, Table { ranges: vec![], ..table.clone() }).unwrap(), read);
    let two = Table { ranges: vec!["mm".to_owned(), "t".to_owned()], time: None, ..table };
    assert_eq!(echoes(text, two).unwrap_err(), "2 columns with ranges; with a column of sensors expected is one");
}

// A sensor requested by name is listed even if it never hears anything.
#[test]
fn sensor_asked_for_by_name_is_listed_without_echoes() {
    let text = "left,deaf,right\n1.0,,\n1.1,,2.0\n";
    let deaf = |ranges: &[&str]| {
        let ranges = ranges.iter().map(|&name| name.to_owned()).collect();
        let read = echoes(text, Table { ranges, ..Table::default() }).unwrap();
        read.into_iter().filter(|(name, ..)| name == "deaf").map(|(.., echo)| echo).collect::<Vec<_>>()
    };
    assert_eq!(deaf(&["left", "deaf", "right"]), [Echo::Nothing; 2]);
    // Nothing says that it is a sensor.
    assert_eq!(deaf(&[]), []);
}
