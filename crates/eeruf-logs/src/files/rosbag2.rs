//! Reads ROS 2 bags: folders with `metadata.yaml` and the files that it names, in `SQLite` or MCAP.

use std::fs::File;
use std::path::{Path, PathBuf};

use rusqlite::{Connection, OpenFlags};
use saphyr::{LoadableYamlNode, Yaml};

use super::bag;
use super::form::{Form, Opened};
use super::mcap::Mcap;
use super::schema::Encoding;
use super::topics::Topic;
use super::unzstd::{LARGEST_MESSAGE, Unzstd};
use crate::sink::Sink;
use eeruf_files::FileError;

/// Contents of `metadata.yaml`.
#[derive(Default)]
struct Metadata {
    files: Vec<PathBuf>,
    /// Number of messages on these topics.
    messages: u64,
    /// True if each message is compressed by itself.
    packed: bool,
}

/// Reads all files of a bag.
pub(crate) fn read(folder: &Path, sink: &mut Sink<'_>) -> Result<(), FileError> {
    let metadata = folder.join("metadata.yaml");
    let found = match std::fs::read_to_string(&metadata) {
        Ok(text) => match Metadata::of(&text) {
            Ok(found) => found,
            Err(why) => {
                sink.damage(&metadata, None, format!("{why}; all bag files of the folder are read"));
                Metadata::default()
            }
        },
        Err(error) => {
            sink.damage(&metadata, None, format!("{error}; all bag files of the folder are read"));
            Metadata::default()
        }
    };
    let mut files: Vec<_> = found.files.iter().map(|file| folder.join(file)).collect();
    if files.is_empty() {
        files = bag_files(folder)?;
    }
    let (damage, found_before) = (sink.report.damage.len(), sink.of_topics.found);
    for file in files {
        // A file that cannot be opened does not affect the others.
        let read = match file.extension().and_then(|ending| ending.to_str()) {
            Some("mcap") => match File::open(&file) {
                Ok(mut opened) => bag::read(Mcap::new(found.packed), &mut opened, &file, sink),
                Err(error) => Err(FileError::reading(&file, &error)),
            },
            Some("db3") => read_sqlite(&file, &file, found.packed, sink),
            _ => read_packed(&file, sink),
        };
        if let Err(error) = read {
            sink.note(error);
        }
    }
    if sink.report.damage.len() == damage {
        sink.counted(&metadata, found.messages, found_before);
    }
    Ok(())
}

/// Reads a file of a bag that is compressed as a whole.
fn read_packed(file: &Path, sink: &mut Sink<'_>) -> Result<(), FileError> {
    let opened = File::open(file).and_then(|opened| Opened::new(opened, file));
    let mut opened = opened.map_err(|error| FileError::reading(file, &error))?;
    match (opened.packing, opened.form) {
        (None, _) => Err(FileError::new(file, "a file of unknown kind; expected .mcap or .db3, also packed by zstd")),
        (_, Form::Mcap | Form::Sqlite) => {
            super::read_copy(&mut opened, file, sink)?;
            opened.tell(file, sink);
            Ok(())
        }
        (_, other) => Err(FileError::new(file, format!("{} within; expected MCAP or SQLite", other.name()))),
    }
}

impl Metadata {
    fn of(text: &str) -> Result<Self, String> {
        let documents = Yaml::load_from_str(text).map_err(|error| format!("no YAML: {error}"))?;
        let bag = documents.first().and_then(|document| document.as_mapping_get("rosbag2_bagfile_information"));
        let bag = bag.ok_or("no rosbag2_bagfile_information")?;
        let files = bag.as_mapping_get("relative_file_paths").and_then(Yaml::as_sequence);
        let files = files.ok_or("no relative_file_paths")?;
        let files = files.iter().filter_map(Yaml::as_str).map(PathBuf::from).collect();
        let mode = bag.as_mapping_get("compression_mode").and_then(Yaml::as_str).unwrap_or_default();
        let messages = bag.as_mapping_get("message_count").and_then(Yaml::as_integer);
        let messages = messages.and_then(|messages| u64::try_from(messages).ok()).unwrap_or(0);
        Ok(Self { files, messages, packed: mode.eq_ignore_ascii_case("message") })
    }
}

/// The bag files of a folder, in the order of the numbers at the end of their names.
fn bag_files(folder: &Path) -> Result<Vec<PathBuf>, FileError> {
    let failed = |error: std::io::Error| FileError::reading(folder, &error);
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let file = entry.map_err(failed)?.path();
        if file.extension().is_some_and(|ending| ending == "mcap" || ending == "db3" || ending == "zstd") {
            files.push(file);
        }
    }
    if files.is_empty() {
        return Err(FileError::new(folder, "no .mcap and no .db3 file; expected the folder of a ROS 2 bag"));
    }
    files.sort_by_key(|file| {
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let digits = name.chars().rev().take_while(char::is_ascii_digit).count();
        let (stem, number) = name.split_at(name.len() - digits);
        (stem.to_owned(), number.parse::<u64>().unwrap_or(0))
    });
    Ok(files)
}

/// Reads a bag file in `SQLite`, in the order in which rows were written; `file` is used in errors.
pub(crate) fn read_sqlite(opened: &Path, file: &Path, packed: bool, sink: &mut Sink<'_>) -> Result<(), FileError> {
    let failed = |error: rusqlite::Error| FileError::new(file, format!("as an SQLite bag: {error}"));
    if !opened.is_file() {
        return Err(FileError::new(file, "no such file"));
    }
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let database = Connection::open_with_flags(opened, flags).map_err(failed)?;
    let mut topics = topics(&database, file, sink).map_err(failed)?;
    let mut query = database.prepare("SELECT topic_id, timestamp, data FROM messages").map_err(failed)?;
    let mut rows = query.query([]).map_err(failed)?;
    let (mut read, mut orphans) = (0_u64, 0_u64);
    let (mut zstd, mut unpacked) = (Unzstd::default(), Vec::new());
    loop {
        let row = match rows.next() {
            Ok(Some(row)) => row,
            Ok(None) => break,
            Err(error) => {
                sink.damage(file, None, format!("{error}; {read} messages were read, those after them are lost"));
                break;
            }
        };
        read += 1;
        sink.of_topics.found += 1;
        let fields = (row.get_ref(0), row.get_ref(1), row.get_ref(2));
        let (Ok(topic), Ok(recorded), Ok(data)) = fields else { continue };
        let (Ok(topic), Ok(recorded), Ok(data)) = (topic.as_i64(), recorded.as_i64(), data.as_blob()) else {
            orphans += 1;
            continue;
        };
        let Some((_, topic)) = topics.iter_mut().find(|(id, _)| *id == topic) else {
            orphans += 1;
            continue;
        };
        let recorded_ns = u64::try_from(recorded).unwrap_or(0);
        if !packed {
            sink.message(topic, recorded_ns, data);
        } else if topic.has_readings() {
            match zstd.unpack(data, LARGEST_MESSAGE, &mut unpacked) {
                Ok(()) => sink.message(topic, recorded_ns, &unpacked),
                Err(_) => orphans += 1,
            }
        }
    }
    if orphans > 0 {
        sink.damage(file, None, format!("{orphans} messages cannot be read: their topic or their data is lost"));
    }
    for (_, topic) in topics {
        sink.close(&topic);
    }
    Ok(())
}

/// The topics by their numbers, with their schemas, which bags have from Iron on.
fn topics(database: &Connection, file: &Path, sink: &mut Sink<'_>) -> rusqlite::Result<Vec<(i64, Topic)>> {
    let schema = |type_name: &str| -> Option<String> {
        let definition = "SELECT encoded_message_definition FROM message_definitions WHERE topic_type = ?1";
        let text = database.query_row(definition, [type_name], |row| row.get::<_, String>(0)).ok()?;
        (!text.is_empty()).then_some(text)
    };
    let mut query = database.prepare("SELECT id, name, type, serialization_format FROM topics")?;
    let mut rows = query.query([])?;
    let mut topics = Vec::new();
    loop {
        let row = match rows.next() {
            Ok(Some(row)) => row,
            Ok(None) => break,
            Err(error) => {
                sink.damage(file, None, format!("{error}; some topics are lost"));
                break;
            }
        };
        let text = |column| row.get_ref(column).ok().and_then(|value| value.as_str().ok()).unwrap_or_default();
        let (Ok(id), name, type_name, format) = (row.get(0), text(1), text(2), text(3)) else { continue };
        let encoding = (format == "cdr").then_some(Encoding::Cdr);
        topics.push((id, sink.topic(name, type_name, schema(type_name).as_deref(), encoding)));
    }
    Ok(topics)
}
