//! Reads files of records, most of them in chunks, in the order in which they were recorded: MCAP and ROS 1 bags.
//!
//! The crates for these forms end at the first damaged record, or need the index. Recordings often end when the battery
//! is empty, so that this module reads record by record and loses only what is damaged: no record reaches into the next
//! chunk, whose place the index at the file's end has.

use std::collections::HashMap;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use super::bytes::{Bytes, Input, Order};
use super::topics::Topic;
use super::unzstd::Unzstd;
use crate::sink::Sink;
use eeruf_files::FileError;

/// The largest chunk that is unpacked, and the largest record that is read.
pub(crate) const LARGEST: u64 = 1 << 30;

/// A form of such files.
pub(crate) trait Form {
    /// The first bytes.
    const MAGIC: &'static [u8];
    const NAME: &'static str;

    /// Reads the head of a record that is followed by at most `room` bytes; `None` if it does not fit.
    fn head(input: &mut dyn Read, room: u64) -> io::Result<Option<Head>>;

    /// Takes a record of a chunk or of the index: its header and its body.
    fn split<'a>(rest: &mut Bytes<'a>) -> Option<(&'a [u8], &'a [u8])>;

    /// The chunk in a record; a cut one has fewer bytes than it says, unless it must be `whole`.
    fn chunk<'a>(header: &'a [u8], body: &'a [u8], whole: bool) -> Option<Chunk<'a>>;

    /// The bytes of the index at the end of the file, which repeats topics; `None` if their check sum is wrong.
    fn index(file: &mut dyn Input, size: u64) -> io::Result<Option<Vec<u8>>>;

    /// Reads one record that is not a chunk; `None` if its fields do not fit.
    fn record(&mut self, header: &[u8], body: &[u8], known: &mut Known, sink: &mut Sink<'_>) -> Option<()>;
}

/// The treatment of a record.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Chunk,
    /// A message, or what messages need.
    Content,
    Skipped,
    /// The end of the data; what follows is an index.
    End,
}

/// The head of a record.
pub(crate) struct Head {
    pub(crate) kind: Kind,
    pub(crate) header: Vec<u8>,
    /// Length of the head and of the body, in bytes.
    pub(crate) size: u64,
    pub(crate) length: u64,
}

/// A packed chunk.
pub(crate) struct Chunk<'a> {
    /// Number of unpacked bytes.
    pub(crate) length: u64,
    /// Check sum of the unpacked bytes; 0 for none.
    pub(crate) sum: u32,
    pub(crate) compression: &'a [u8],
    pub(crate) packed: &'a [u8],
}

/// Knowledge of a file from the records so far.
#[derive(Default)]
pub(crate) struct Known {
    pub(crate) topics: HashMap<u32, Topic>,
    /// Number of messages, if the index says so.
    pub(crate) counted: u64,
    /// Places of the chunks, by the index: reading continues there after a record with a wrong length.
    pub(crate) chunks: Vec<u64>,
    /// True if the file was completed.
    pub(crate) is_closed: bool,
    pub(crate) zstd: Unzstd,
}

/// Reads a file to its end, or as far as it can be read; `file` is used in errors.
pub(crate) fn read<F: Form>(
    mut form: F,
    opened: &mut dyn Input,
    file: &Path,
    sink: &mut Sink<'_>,
) -> Result<(), FileError> {
    let failed = |error: io::Error| FileError::reading(file, &error);
    let size = opened.seek(SeekFrom::End(0)).map_err(failed)?;
    let (mut known, found_before) = (Known::default(), sink.of_topics.found);
    // Topics are in the chunks too, so that a missing index is no damage.
    match F::index(opened, size) {
        Ok(Some(index)) => _ = records(&mut form, &index, &mut known, sink),
        Ok(None) => sink.damage(file, None, "the check sum of the summary at its end is wrong; it is not used"),
        Err(_) => {}
    }
    known.chunks.sort_unstable();
    opened.rewind().map_err(failed)?;
    let mut input = BufReader::with_capacity(1 << 18, opened);
    let mut magic = vec![0; F::MAGIC.len()];
    if input.read_exact(&mut magic).is_err() || magic != F::MAGIC {
        sink.damage(file, Some(0), format!("the first bytes are not those of {}", F::NAME));
    }
    let (mut at, mut body, mut chunk) = (F::MAGIC.len() as u64, Vec::new(), Vec::new());
    while at < size {
        let next =
            known.chunks.get(known.chunks.partition_point(|&start| start <= at)).copied().filter(|&start| start < size);
        let room = next.unwrap_or(size) - at;
        let head = F::head(&mut input, room).map_err(failed)?;
        let Some(head) = head.as_ref().filter(|head| head.length <= room - head.size) else {
            let Some(start) = next else {
                let why =
                    "the bag is cut, or a length in it is wrong: a record does not fit; what stands before was read";
                sink.damage(file, Some(at), why);
                if let Some(head) = head.filter(|head| head.kind == Kind::Chunk) {
                    body.clear();
                    (&mut input).take(LARGEST).read_to_end(&mut body).map_err(failed)?;
                    // Reads the part of the chunk before the cut.
                    _ = unpack::<F>(&head, &body, false, &mut known.zstd, &mut chunk);
                    records(&mut form, &chunk, &mut known, sink);
                }
                known.is_closed = true;
                break;
            };
            input.seek(SeekFrom::Start(start)).map_err(failed)?;
            let there = F::head(&mut input, size - start).map_err(failed)?;
            if there.is_some_and(|head| head.kind == Kind::Chunk && head.length <= size - start - head.size) {
                let why = format!("what stands from here to the chunk at byte {start} is lost: its records do not fit");
                sink.damage(file, Some(at), why);
                at = start;
            } else {
                known.chunks.retain(|&known| known != start);
            }
            input.seek(SeekFrom::Start(at)).map_err(failed)?;
            continue;
        };
        if head.kind == Kind::End && next.is_none() {
            known.is_closed = true;
            break;
        }
        let begin = at;
        at += head.size + head.length;
        let is_read = matches!(head.kind, Kind::Chunk | Kind::Content);
        if !is_read || head.length > LARGEST {
            if is_read {
                let why = format!("a record of {} bytes is lost; expected at most {LARGEST}", head.length);
                sink.damage(file, Some(begin), why);
            }
            input.seek_relative(head.length.cast_signed()).map_err(failed)?;
            continue;
        }
        body.clear();
        (&mut input).take(head.length).read_to_end(&mut body).map_err(failed)?;
        if head.kind == Kind::Content {
            if form.record(&head.header, &body, &mut known, sink).is_none() {
                sink.damage(file, Some(begin), "a record does not have the fields of its kind");
            }
            continue;
        }
        match unpack::<F>(head, &body, true, &mut known.zstd, &mut chunk) {
            Err(why) => sink.damage(file, Some(begin), format!("a chunk is lost: {why}")),
            Ok(()) => match records(&mut form, &chunk, &mut known, sink) {
                None => sink.damage(file, Some(begin), "the rest of a chunk is lost: its records do not fit"),
                Some(0) => {}
                Some(lost) => sink.damage(file, Some(begin), format!("{lost} records of a chunk cannot be read")),
            },
        }
    }
    if !known.is_closed {
        sink.damage(file, None, "the bag was not closed, or its end is cut off; what stands before was read");
    }
    sink.counted(file, known.counted, found_before);
    known.topics.values().for_each(|topic| sink.close(topic));
    Ok(())
}

/// Reads the records of a chunk or of an index, and returns the number of unreadable ones; `None` if they do not fit
/// into it.
fn records<F: Form>(form: &mut F, chunk: &[u8], known: &mut Known, sink: &mut Sink<'_>) -> Option<u64> {
    let (mut rest, mut lost) = (Bytes::new(chunk, Order::Little), 0);
    while rest.left() > 0 {
        let (header, body) = F::split(&mut rest)?;
        lost += u64::from(form.record(header, body, known, sink).is_none());
    }
    Some(lost)
}

/// Unpacks a chunk, a cut one as far as possible.
fn unpack<F: Form>(
    head: &Head,
    body: &[u8],
    whole: bool,
    zstd: &mut Unzstd,
    chunk: &mut Vec<u8>,
) -> Result<(), String> {
    chunk.clear();
    let of = F::chunk(&head.header, body, whole).ok_or("it does not have the fields of a chunk")?;
    let Chunk { length, sum, compression, packed } = of;
    if length > LARGEST {
        return Err(format!("it says that it holds {length} bytes; expected at most {LARGEST}"));
    }
    let mut all = |reader: &mut dyn Read| reader.take(length).read_to_end(chunk).map(drop).map_err(|e| e.to_string());
    let unpacked = match compression {
        b"" | b"none" => all(&mut &*packed),
        b"bz2" => all(&mut bzip2::read::BzDecoder::new(packed)),
        b"lz4" => all(&mut lz4_flex::frame::FrameDecoder::new(packed)),
        b"zstd" => zstd.unpack(packed, length as usize, chunk),
        other => {
            let other = String::from_utf8_lossy(other);
            return Err(format!("it is compressed by `{other}`; expected bz2, lz4, zstd or nothing"));
        }
    };
    unpacked.map_err(|why| format!("it cannot be unpacked: {why}"))?;
    if chunk.len() as u64 != length {
        return Err(format!("it holds {} bytes instead of {length}", chunk.len()));
    }
    if sum != 0 && crc32fast::hash(chunk) != sum {
        return Err("its check sum is wrong".to_owned());
    }
    Ok(())
}
