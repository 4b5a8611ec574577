//! The ranges of a log, block by block. `python/eeruf/logs.py` is its public form.

use std::path::{Path, PathBuf};

use eeruf_core::Micros;
use eeruf_files::FileError;
use eeruf_logs::{
    Counted, Doctor, Examination, FieldChoice, Judging, LogReading, McapWriter, Options, RangeJudge, RangeUnit, Report,
    Table, TimeUnit, read_from, read_log, read_stream,
};
use numpy::PyReadonlyArray1;
use pyo3::{exceptions::PyTypeError, prelude::*, types::PyDict};

use crate::{
    arguments::{above_zero, choice, flag, items, shown, text, whole, wrong},
    columns::{Codes, of_vec, room},
    errors::Raise,
    exclusive::Exclusive,
    file_object::{Results, Work},
    logs::{Source, out_file, raise, warn_of_each},
};

/// Readings of a log, and what is known about the log after them.
#[derive(Default)]
struct Block {
    sensor: Vec<i64>,
    at_ns: Vec<i64>,
    range_m: Vec<f64>,
    min_range_m: Vec<f64>,
    max_range_m: Vec<f64>,
    variance: Vec<f64>,
    kind: Vec<i8>,
    report: Report,
    counted: Vec<Counted>,
    /// The examination after the last reading.
    examination: Option<Examination>,
}

/// The readings of a log block by block, as dictionaries of columns. The last block has the findings of the whole log.
#[pyclass(frozen, name = "_LogBlocks", module = "eeruf._eeruf")]
pub(crate) struct LogBlocks {
    work: Exclusive<Option<Work<Result<Block, FileError>>>>,
    is_judged: bool,
}

#[pymethods]
impl LogBlocks {
    #[new]
    fn new<'py>(
        source: &Bound<'py, PyAny>,
        options: &Bound<'py, PyDict>,
        judge: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
        rows: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let (py, source, options) = (source.py(), Source::of(source)?, read_options(options)?);
        let rows = rows.map_or(Ok(usize::MAX), |rows| whole("rows", rows, 1..=usize::MAX >> 1))?;
        let judge = judge.map(range_judge).transpose()?;
        let out: Option<PathBuf> = out.map(out_file).transpose()?;
        let name = source.name().to_owned();
        let judging = judge.map(|judge| Judging::new(judge, options.speed_of_sound, &name));
        let judging = judging.transpose().map_err(Raise::raise)?;
        let judging = match (judging, out) {
            (Some(judging), Some(out)) => Some(judging.writing(McapWriter::create(&out).map_err(raise)?)),
            (Some(judging), None) => Some(judging),
            (None, Some(out)) => return Err(wrong("out", out.display(), "a judge too, or None")),
            (None, None) => None,
        };
        let is_judged = judging.is_some();
        let object = match &source {
            Source::Path(_) => None,
            Source::Object(object, _) => Some(object),
        };
        let is_sought = match object {
            Some(object) if object.hasattr("seekable")? => object.call_method0("seekable")?.is_truthy()?,
            _ => false,
        };
        let work = Work::begin(py, object, move |file, results| {
            let mut reader = Blocks::new(&options, judging, rows, results);
            let each = |report: &Report, reading: &LogReading| reader.take(report, reading);
            let report = match file {
                None => read_log(&name, &options, each),
                Some(file) if is_sought => read_from(file, &name, &options, each),
                Some(file) => read_stream(file, &name, &options, each),
            };
            reader.end(&name, report);
        })?;
        Ok(Self { work: Exclusive::new("reader of a log", Some(work)), is_judged })
    }

    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let mut under_way = self.work.get()?;
        let Some(mut work) = under_way.take() else { return Ok(None) };
        let block = work.next(py)?.map_err(raise)?;
        if block.examination.is_none() {
            *under_way = Some(work);
        } else {
            warn_of_each(py, block.report.warnings.clone())?;
        }
        drop(under_way);
        block.columns(py, self.is_judged).map(Some)
    }
}

/// Makes blocks of readings.
struct Blocks {
    block: Block,
    rows: usize,
    doctor: Doctor,
    judging: Option<Judging>,
    results: Results<Result<Block, FileError>>,
    /// True if an error was passed on, or no thread waits.
    is_over: bool,
}

impl Blocks {
    fn new(
        options: &Options,
        judging: Option<Judging>,
        rows: usize,
        results: Results<Result<Block, FileError>>,
    ) -> Self {
        let doctor = Doctor::new(options.speed_of_sound);
        Self { block: Block::default(), rows, doctor, judging, results, is_over: false }
    }

    fn take(&mut self, report: &Report, reading: &LogReading) {
        if self.is_over {
            return;
        }
        if self.block.sensor.len() == self.rows {
            let full = std::mem::take(&mut self.block);
            let full = Block { report: report.clone(), counted: counted(self.judging.as_ref()), ..full };
            self.is_over = !self.results.hand_in(Ok(full));
        }
        self.doctor.push(reading);
        if let Some(judging) = &mut self.judging {
            match judging.push(&report.sensors, reading) {
                Ok(kind) => self.block.kind.push(kind.map_or(-1, |kind| kind as i8)),
                Err(error) => {
                    self.results.hand_in(Err(error));
                    self.is_over = true;
                }
            }
        }
        self.block.push(reading);
    }

    fn end(self, name: &Path, report: Result<Report, FileError>) {
        if self.is_over {
            return;
        }
        let last = report.and_then(|report| {
            if report.sensors.is_empty() {
                let found: Vec<_> =
                    report.skipped.iter().map(|topic| format!("{}: {}", topic.topic, topic.why)).collect();
                let message = format!("{}: no sensors; expected ranges; found {}", report.form, found.join("; "));
                return Err(FileError::new(name, message));
            }
            let examination = Some(self.doctor.examine(&report.firing, &report.names()));
            let counted = counted(self.judging.as_ref());
            self.judging.map_or(Ok(()), Judging::finish)?;
            Ok(Block { examination, counted, report, ..self.block })
        });
        self.results.hand_in(last);
    }
}

fn counted(judging: Option<&Judging>) -> Vec<Counted> {
    judging.map_or_else(Vec::new, Judging::counted)
}

impl Block {
    fn push(&mut self, reading: &LogReading) {
        self.sensor.push(reading.sensor as i64);
        self.at_ns.push(reading.at_ns.map_or(-1, u64::cast_signed));
        self.range_m.push(reading.range_m);
        self.min_range_m.push(reading.min_range_m);
        self.max_range_m.push(reading.max_range_m);
        self.variance.push(reading.variance.map_or(f64::NAN, f64::from));
    }

    /// The fields of `Ranges`, or of `Judged`.
    fn columns(self, py: Python<'_>, is_judged: bool) -> PyResult<Bound<'_, PyDict>> {
        let (out, report) = (PyDict::new(py), self.report);
        out.set_item("sensor", of_vec(py, self.sensor))?;
        out.set_item("at_ns", of_vec(py, self.at_ns))?;
        out.set_item("range_m", of_vec(py, self.range_m))?;
        out.set_item("min_range_m", of_vec(py, self.min_range_m))?;
        out.set_item("max_range_m", of_vec(py, self.max_range_m))?;
        out.set_item("variance", of_vec(py, self.variance))?;
        if is_judged {
            judged(&out, self.kind, &self.counted)?;
        }
        out.set_item("names", report.names())?;
        out.set_item("topics", report.sensors.iter().map(|sensor| sensor.topic.clone()).collect::<Vec<_>>())?;
        out.set_item("frames", report.sensors.iter().map(|sensor| sensor.frame.clone()).collect::<Vec<_>>())?;
        out.set_item("damage", report.damage.iter().map(ToString::to_string).collect::<Vec<_>>())?;
        let skipped = report.skipped.iter().map(|topic| (topic.topic.clone(), topic.why.clone()));
        out.set_item("skipped", skipped.collect::<Vec<_>>())?;
        out.set_item("form", &report.form)?;
        let guess = |guess: &eeruf_logs::Guess| (guess.what.clone(), guess.value.clone(), guess.option.clone());
        out.set_item("guesses", report.guesses.iter().map(guess).collect::<Vec<_>>())?;
        let not_yet = "the log is not read to its end";
        let is_last = self.examination.is_some();
        out.set_item("firing", report.firing.pattern.as_str())?;
        out.set_item("proves", if is_last { report.firing.proves(None) } else { not_yet.to_owned() })?;
        let answer = self.examination.as_ref().map(|found| found.answer(&report.firing, &report.names()));
        out.set_item("warnings", report.warnings)?;
        let unexamined = || Examination { reasons: vec![not_yet.to_owned()], ..Examination::default() };
        let Examination { verdict, fooled, pairs, reasons, record, suspects, notes, .. } =
            self.examination.unwrap_or_else(unexamined);
        let crosstalk = PyDict::new(py);
        crosstalk.set_item("verdict", verdict.as_str())?;
        crosstalk.set_item("fooled", fooled)?;
        crosstalk.set_item("pairs", pairs)?;
        crosstalk.set_item("reasons", reasons)?;
        crosstalk.set_item("record", record)?;
        crosstalk.set_item("suspects", suspects.iter().map(|of| (of.sensor, of.by)).collect::<Vec<_>>())?;
        crosstalk.set_item("answer", answer.unwrap_or_else(|| not_yet.to_owned()))?;
        crosstalk.set_item("notes", notes)?;
        out.set_item("crosstalk", crosstalk)?;
        Ok(out)
    }
}

/// The judge of ranges from an `Agree`.
fn range_judge(judge: &Bound<'_, PyAny>) -> PyResult<RangeJudge> {
    let t_delta = Micros::new(whole("t_delta_us", &judge.getattr("t_delta_us")?, 0..=u32::MAX)?);
    Ok(RangeJudge { t_delta, consecutive: whole("consecutive", &judge.getattr("consecutive")?, 2..=8)? })
}

/// Columns of `eeruf.logs.Ranges`.
#[derive(FromPyObject)]
struct Columns<'py> {
    sensor: PyReadonlyArray1<'py, i64>,
    at_ns: PyReadonlyArray1<'py, i64>,
    range_m: PyReadonlyArray1<'py, f64>,
    min_range_m: PyReadonlyArray1<'py, f64>,
    max_range_m: PyReadonlyArray1<'py, f64>,
}

/// Judges ranges that were read before: returns the additional fields of `Judged`.
#[pyfunction]
#[pyo3(name = "_judge")]
pub(crate) fn judge<'py>(
    ranges: &Bound<'py, PyAny>,
    judge: Option<&Bound<'py, PyAny>>,
    speed_of_sound: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let py = ranges.py();
    let speed_of_sound = above_zero("speed_of_sound", speed_of_sound)?;
    let expected = || wrong("judge", "None", "an eeruf.logs.Agree");
    let judge = range_judge(judge.ok_or_else(expected)?)?;
    let mut judging = Judging::new(judge, speed_of_sound, "the log".as_ref()).map_err(Raise::raise)?;
    let expected = "an eeruf.logs.Ranges of arrays with one dimension, as read_log gives it";
    let columns: Columns<'_> = ranges.extract().map_err(|_| wrong("log", shown(ranges), expected))?;
    let (sensor, at_ns, range_m) = (columns.sensor.as_array(), columns.at_ns.as_array(), columns.range_m.as_array());
    let (least, most) = (columns.min_range_m.as_array(), columns.max_range_m.as_array());
    let rows = sensor.len();
    if [at_ns.len(), range_m.len(), least.len(), most.len()] != [rows; 4] {
        return Err(wrong("log", shown(ranges), "columns of equal lengths"));
    }
    let mut kinds = room(rows)?;
    for row in 0..rows {
        let known = usize::try_from(sensor[row]).ok().filter(|&sensor| sensor < MOST_SENSORS);
        let reading = LogReading {
            sensor: known.ok_or_else(|| wrong(&format!("sensor[{row}]"), sensor[row], "0 to 65535"))?,
            at_ns: u64::try_from(at_ns[row]).ok(),
            radiation: 0,
            field_of_view_rad: 0.0,
            min_range_m: least[row],
            max_range_m: most[row],
            range_m: range_m[row],
            variance: None,
        };
        kinds.push(judging.push(&[], &reading).map_err(raise)?.map_or(-1, |kind| kind as i8));
    }
    let out = PyDict::new(py);
    judged(&out, kinds, &judging.counted())?;
    Ok(out)
}

/// Largest plausible number of sensors.
const MOST_SENSORS: usize = 1 << 16;

/// Sets the judge's results.
fn judged(out: &Bound<'_, PyDict>, kinds: Vec<i8>, counted: &[Counted]) -> PyResult<()> {
    out.set_item("kind", Codes::Kinds.name(&of_vec(out.py(), kinds))?)?;
    out.set_item("gaps", counted.iter().map(|counted| counted.gaps).collect::<Vec<_>>())?;
    out.set_item("backwards", counted.iter().map(|counted| counted.backwards).collect::<Vec<_>>())
}

/// The options for reading, by name.
fn read_options(given: &Bound<'_, PyDict>) -> PyResult<Options> {
    const NAMES: [&str; 12] = [
        "time",
        "time_unit",
        "ranges",
        "range_unit",
        "sensor",
        "speed_of_sound",
        "no_echo_m",
        "no_echo",
        "columns",
        "topics",
        "fields",
        "judged",
    ];
    for name in given.keys() {
        if !NAMES.contains(&name.extract::<String>()?.as_str()) {
            let message = format!("unexpected keyword argument {}; expected {}", shown(&name), NAMES.join(", "));
            return Err(PyTypeError::new_err(message));
        }
    }
    // `None` means not given.
    let get = |name: &str| given.get_item(name).map(|value| value.filter(|value| !value.is_none()));
    let texts = |name: &str, expected: &'static str| match get(name)? {
        None => Ok(Vec::new()),
        Some(values) => items(name, &values, expected)?.iter().map(|value| text(name, value, expected)).collect(),
    };
    let column = |name: &str| get(name)?.map(|value| text(name, &value, "the name of a column, or None")).transpose();
    let number = |name: &str, default: f64| get(name)?.map_or(Ok(default), |value| above_zero(name, &value));
    let standard = Options::default();
    Ok(Options {
        table: Table {
            columns: texts("columns", "the names of columns")?,
            ranges: texts("ranges", "the names of columns")?,
            range_unit: get("range_unit")?
                .map(|unit| choice("range_unit", Some(&unit), &RangeUnit::NAMES))
                .transpose()?,
            time: column("time")?,
            time_unit: get("time_unit")?.map(|unit| choice("time_unit", Some(&unit), &TimeUnit::NAMES)).transpose()?,
            sensor: column("sensor")?,
        },
        speed_of_sound: number("speed_of_sound", standard.speed_of_sound)?,
        no_echo_m: number("no_echo_m", standard.no_echo_m)?,
        no_echo: texts("no_echo", "values that mean no echo, as texts")?,
        topics: texts("topics", "the names of topics")?,
        fields: get("fields")?.map_or_else(|| Ok(Vec::new()), |fields| field_choices(&fields))?,
        judged: flag("judged", get("judged")?.as_ref(), false)?,
    })
}

/// Triples of topic, path and unit.
fn field_choices(fields: &Bound<'_, PyAny>) -> PyResult<Vec<FieldChoice>> {
    let expected = "triples of topic, field and unit, as (\"/sonars\", \"distance_mm[]\", \"mm\")";
    let field = |field: &Bound<'_, PyAny>| {
        let found: Option<(String, String, String)> = field.extract().ok();
        let (topic, path, unit) = found.ok_or_else(|| wrong("fields", shown(field), expected))?;
        let known = RangeUnit::NAMES.iter().find(|known| known.0 == unit);
        let unit = known.ok_or_else(|| wrong("fields", shown(field), expected))?.1;
        Ok(FieldChoice { topic, path, unit })
    };
    items("fields", fields, expected)?.iter().map(field).collect()
}
