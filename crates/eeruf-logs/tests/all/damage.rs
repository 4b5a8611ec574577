//! Files that are cut or have a wrong byte.

use std::path::{Path, PathBuf};

use eeruf_logs::{LogReading, McapWriter, Options};

use crate::random::Random;
use crate::{BAGS, bag, read};

/// The file of a bag that holds its messages.
fn data_file(bag: &Path) -> PathBuf {
    if bag.is_file() {
        return bag.to_owned();
    }
    let mut entries = std::fs::read_dir(bag).unwrap().map(|entry| entry.unwrap().path());
    entries.find(|file| file.extension().is_some_and(|ending| ending == "mcap" || ending == "db3")).unwrap()
}

#[test]
fn damaged_files_are_read_and_the_rest_reported() {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(1);
    let (mut files, mut partly) = (0, 0);
    for name in BAGS {
        let bag = bag(name, folder.path());
        let file = data_file(&bag);
        let whole = std::fs::read(&file).unwrap();
        let (_, all) = read(&bag, &Options::default()).unwrap();
        for round in 0..30 {
            let mut bytes = whole.clone();
            let cut = round % 2 == 0;
            if cut {
                bytes.truncate(random.below(whole.len()));
            } else {
                let at = random.below(whole.len());
                bytes[at] ^= 1 << random.below(8);
            }
            std::fs::write(&file, &bytes).unwrap();
            files += 1;
            match read(&bag, &Options::default()) {
                Err(error) => assert!(!error.message().is_empty()),
                Ok((report, readings)) => {
                    let lost = readings.len() < all.len();
                    let said = !report.damage.is_empty() || !report.skipped.is_empty();
                    assert!(said || !lost, "{name}, round {round}: {} of {}", readings.len(), all.len());
                    assert!(report.damage.iter().all(|damage| !damage.to_string().contains('\n')));
                    partly += usize::from(lost && !readings.is_empty());
                }
            }
        }
        std::fs::write(&file, &whole).unwrap();
    }
    assert!(files >= 200 && partly >= 10, "{partly} of {files}");
}

#[test]
fn a_recording_that_was_cut_off_gives_all_its_whole_messages() {
    let folder = tempfile::tempdir().unwrap();
    let bag = bag("mcap-jazzy", folder.path());
    let file = data_file(&bag);
    let whole = std::fs::read(&file).unwrap();
    let (_, all) = read(&bag, &Options::default()).unwrap();
    let mut kept = Vec::new();
    for length in (0..whole.len()).step_by(16).chain([whole.len() - 1]) {
        std::fs::write(&file, &whole[..length]).unwrap();
        let (report, readings) = read(&bag, &Options::default()).unwrap();
        assert!(!report.damage.is_empty() || readings.len() == all.len(), "{length}");
        kept.push(readings.len());
    }
    kept.dedup();
    assert_eq!(kept, (0..=all.len()).collect::<Vec<_>>());
}

/// Positions of the chunks of an MCAP file.
fn mcap_chunks(bytes: &[u8]) -> Vec<usize> {
    let (mut at, mut chunks) = (8, vec![]);
    while at + 9 < bytes.len() {
        if bytes[at] == 0x06 {
            chunks.push(at);
        }
        at += 9 + u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
    }
    chunks
}

#[test]
fn a_wrong_length_in_mcap_takes_no_more_than_its_chunk() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("out.mcap");
    let mut out = McapWriter::create(&file).unwrap();
    let reading = LogReading {
        sensor: 0,
        at_ns: Some(1),
        radiation: 0,
        field_of_view_rad: 0.25,
        min_range_m: 0.25,
        max_range_m: 4.0,
        range_m: 1.5,
        variance: None,
    };
    let messages = 60_000;
    for number in 0..messages {
        out.range("/sonar", "s", &LogReading { at_ns: Some(number), ..reading }).unwrap();
    }
    out.finish().unwrap();
    let whole = std::fs::read(&file).unwrap();
    let chunks = mcap_chunks(&whole);
    assert!(chunks.len() >= 4, "{chunks:?}");
    let per_chunk = messages as usize / chunks.len();
    // Far too long, and too short; a message index that seems to be the end of the data; an index of chunks that is
    // wrong itself, which its check sum says.
    let index = chunks[2] + 9 + u64::from_le_bytes(whole[chunks[2] + 1..][..8].try_into().unwrap()) as usize;
    assert_eq!(whole[index], 0x07);
    let last = whole.len() - 60;
    for (at, flip, lost) in [(chunks[1] + 8, 1, 1), (chunks[1] + 2, 0x80, 1), (index, 0x08, 0), (last, 1, 0)] {
        let mut bytes = whole.clone();
        bytes[at] ^= flip;
        std::fs::write(&file, &bytes).unwrap();
        let (report, readings) = read(&file, &Options::default()).unwrap();
        assert_eq!(report.damage.is_empty(), lost == 0 && at != last, "{at}: {:?}", report.damage);
        let missing = messages as usize - readings.len();
        assert!(missing <= lost * per_chunk * 5 / 4, "{at}: {missing}");
    }
}

/// The records of a ROS 1 bag: positions, and the `op` of their headers.
fn ros1_records(bytes: &[u8]) -> Vec<(usize, u8)> {
    let (mut at, mut records) = (13, vec![]);
    let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    while at < bytes.len() {
        let head = &bytes[at + 4..][..number(at)];
        let op = head.windows(3).position(|name| name == b"op=").map(|place| head[place + 3]).unwrap();
        records.push((at, op));
        at += 4 + number(at);
        at += 4 + number(at);
    }
    records
}

#[test]
fn a_wrong_length_in_a_ros_1_bag_takes_no_more_than_its_chunk() {
    // The chunk of the bag three times, and the index of each.
    let folder = tempfile::tempdir().unwrap();
    let file = bag("ros1-none.bag", folder.path());
    let one = std::fs::read(&file).unwrap();
    let records = ros1_records(&one);
    let start_of = |op: u8| records.iter().find(|record| record.1 == op).unwrap().0;
    // The bag's own record, then the chunk and its index, then connections, then what is said of chunks.
    let (chunk, connections, infos) = (start_of(5), records.iter().rfind(|record| record.1 == 4).unwrap(), start_of(6));
    let after_chunk = records.iter().find(|record| record.0 > connections.0).unwrap().0;
    let patch = |bytes: &mut Vec<u8>, from: usize, name: &[u8], value: u64| {
        let place = bytes[from..].windows(name.len()).position(|window| window == name).unwrap() + from + name.len();
        bytes[place..place + 8].copy_from_slice(&value.to_le_bytes());
    };
    let mut whole = one[..chunk].to_vec();
    let mut chunks = vec![];
    for _ in 0..3 {
        chunks.push(whole.len());
        whole.extend(&one[chunk..after_chunk]);
    }
    let index = whole.len() as u64;
    patch(&mut whole, 0, b"index_pos=", index);
    whole.extend(&one[after_chunk..infos]);
    for &chunk in &chunks {
        let from = whole.len();
        whole.extend(&one[infos..]);
        patch(&mut whole, from, b"chunk_pos=", chunk as u64);
    }
    std::fs::write(&file, &whole).unwrap();
    let (report, all) = read(&file, &Options::default()).unwrap();
    assert_eq!((&report.damage[..], all.len()), (&[][..], 3 * 20));
    // The length of a header, and of a chunk; too long for the file, too long, too short.
    let head = u32::from_le_bytes(whole[chunks[1]..][..4].try_into().unwrap()) as usize;
    for (at, flip) in [(3, 0x40), (1, 0x02), (0, 0x10), (4 + head + 3, 0x40), (4 + head + 1, 0x20), (4 + head + 1, 1)] {
        let mut bytes = whole.clone();
        bytes[chunks[1] + at] ^= flip;
        std::fs::write(&file, &bytes).unwrap();
        let (report, readings) = read(&file, &Options::default()).unwrap();
        let said: Vec<_> = report.damage.iter().map(ToString::to_string).collect();
        assert!(readings.len() >= 2 * 20 && !said.is_empty(), "{at}: {} of {}: {said:?}", readings.len(), all.len());
    }
}

#[test]
fn missing_messages_of_a_bag_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let bag = bag("sqlite-jazzy", folder.path());
    let database = rusqlite::Connection::open(data_file(&bag)).unwrap();
    let row = "(SELECT id FROM messages LIMIT 1 OFFSET 4)";
    assert_eq!(database.execute(&format!("DELETE FROM messages WHERE id = {row}"), []).unwrap(), 1);
    drop(database);
    let (report, readings) = read(&bag, &Options::default()).unwrap();
    let said: Vec<_> = report.damage.iter().map(eeruf_files::FileError::message).collect();
    assert_eq!((readings.len(), &said[..]), (11, &["1 of the 12 messages that it counts were not found"][..]));
}
