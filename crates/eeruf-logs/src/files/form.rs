//! The form of a file by its first bytes: forms that are read, forms that are unpacked first, and forms that another
//! tool must convert.

use std::fs::File;
use std::io::{self, BufReader, Read, Write as _};
use std::path::Path;

use eeruf_files::FileError;

use super::bag::Form as _;
use super::flight::Flight;
use super::mcap::Mcap;
use super::ros1::Ros1;
use crate::sink::Sink;

/// A form that is recognised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    Mcap,
    Ros1,
    Sqlite,
    /// Frames of the serial line.
    Serial,
    Text,
    Packed(Packing),
    Flight(Flight),
    Foreign(Foreign),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Packing {
    Gzip,
    Bzip2,
    Zstd,
}

/// A form that is recognised but not read: its name, and the function of pandas that reads it, if there is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Foreign(&'static str, &'static str);

const XZ: Foreign = Foreign("packed by xz", "");
const BINARY: Foreign = Foreign("binary data of an unknown form", "");

/// Forms by the first bytes of a file.
const MAGICS: [(&[u8], Form); 13] = [
    (Mcap::MAGIC, Form::Mcap),
    (Ros1::MAGIC, Form::Ros1),
    (b"SQLite format 3\0", Form::Sqlite),
    (&[0x1f, 0x8b], Form::Packed(Packing::Gzip)),
    (b"BZh", Form::Packed(Packing::Bzip2)),
    (&[0x28, 0xb5, 0x2f, 0xfd], Form::Packed(Packing::Zstd)),
    (b"\xfd7zXZ\0", Form::Foreign(XZ)),
    (b"ULog\x01\x12\x35", Form::Flight(Flight::ULog)),
    (&[0xa3, 0x95], Form::Flight(Flight::DataFlash)),
    (b"%PDF", Form::Foreign(Foreign("a PDF", ""))),
    (b"PK\x03\x04", Form::Foreign(Foreign("a zip archive or a spreadsheet", "read_excel"))),
    (b"PAR1", Form::Foreign(Foreign("a Parquet file", "read_parquet"))),
    (b"\x89HDF", Form::Foreign(Foreign("an HDF5 file", "read_hdf"))),
];

/// Forms by the ending of a file's name, if its first bytes do not say it.
const ENDINGS: [(&str, Form); 5] = [
    ("ulg", Form::Flight(Flight::ULog)),
    ("tlog", Form::Flight(Flight::Telemetry)),
    ("mcap", Form::Mcap),
    ("bag", Form::Ros1),
    ("db3", Form::Sqlite),
];

impl Form {
    /// Recognises a form by the first bytes of a file, or by the ending of its name.
    pub(crate) fn of(first: &[u8], file: &Path) -> Self {
        let ending = file.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let by_magic = MAGICS.iter().find(|(magic, _)| first.starts_with(magic)).map(|of| of.1);
        let by_frames = || super::serial::is_serial(first).then_some(Self::Serial);
        let by_ending = || ENDINGS.iter().find(|(own, _)| own.eq_ignore_ascii_case(ending)).map(|of| of.1);
        by_magic.or_else(by_frames).or_else(by_ending).unwrap_or_else(|| match first.get(8) {
            _ if !is_binary(first) => Self::Text,
            // A frame after its time.
            Some(0xfe | 0xfd) => Self::Flight(Flight::Telemetry),
            _ => Self::Foreign(BINARY),
        })
    }

    /// Reads the first bytes of a file.
    pub(crate) fn of_file(file: &Path) -> Result<Self, FileError> {
        let failed = |error: io::Error| FileError::reading(file, &error);
        Ok(Self::of(&first_bytes(File::open(file).map_err(failed)?).map_err(failed)?, file))
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Mcap => "MCAP",
            Self::Ros1 => "a ROS 1 bag",
            Self::Sqlite => "a ROS 2 bag's SQLite file",
            Self::Serial => "frames of the serial line",
            Self::Text => "text",
            Self::Packed(packing) => packing.name(),
            Self::Flight(flight) => flight.name(),
            Self::Foreign(foreign) => foreign.0,
        }
    }
}

/// Reads enough bytes to recognise the form.
pub(crate) fn first_bytes(input: impl Read) -> io::Result<Vec<u8>> {
    let mut first = Vec::new();
    input.take(512).read_to_end(&mut first)?;
    Ok(first)
}

/// Returns true for bytes that are not text: many are control characters. In UTF-16 every other byte is zero.
fn is_binary(first: &[u8]) -> bool {
    if matches!(first, [0xff, 0xfe, ..] | [0xfe, 0xff, ..]) {
        return false;
    }
    let zeroes = |odd: usize| first.iter().skip(odd).step_by(2).filter(|&&byte| byte == 0).count() * 2;
    if first.len() >= 4
        && (zeroes(0) + 2 >= first.len() && zeroes(1) == 0 || zeroes(1) + 2 >= first.len() && zeroes(0) == 0)
    {
        return false;
    }
    let control = first.iter().filter(|&&byte| byte < 0x20 && !b"\t\n\r\x0b\x0c\x1b".contains(&byte)).count();
    control * 10 > first.len()
}

impl Packing {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Gzip => "gzip",
            Self::Bzip2 => "bzip2",
            Self::Zstd => "zstd",
        }
    }

    /// Returns a reader that unpacks the input as it reads.
    pub(crate) fn unpack<'a>(self, input: impl Read + 'a) -> io::Result<Box<dyn Read + 'a>> {
        Ok(match self {
            Self::Gzip => Box::new(flate2::read::MultiGzDecoder::new(input)),
            Self::Bzip2 => Box::new(bzip2::read::MultiBzDecoder::new(input)),
            Self::Zstd => Box::new(zstd::stream::read::Decoder::new(input)?),
        })
    }
}

/// A log that is read in order, unpacked if it is packed as a whole.
pub(crate) struct Opened<'a> {
    pub(crate) form: Form,
    pub(crate) packing: Option<Packing>,
    input: Box<dyn Read + 'a>,
    /// The error that ended unpacking; the bytes before it can be read.
    pub(crate) error: Option<io::Error>,
}

impl<'a> Opened<'a> {
    /// Recognises the form of a log by its first bytes, or by the ending of its name.
    pub(crate) fn new(mut input: impl Read + 'a, name: &Path) -> io::Result<Self> {
        let first = first_bytes(&mut input)?;
        let form = Form::of(&first, name);
        let input = io::Cursor::new(first).chain(input);
        let Form::Packed(packing) = form else {
            return Ok(Self { form, packing: None, input: Box::new(input), error: None });
        };
        let input = packing.unpack(BufReader::new(input))?;
        let mut unpacked = Self { form, packing: Some(packing), input, error: None };
        let first = first_bytes(&mut unpacked)?;
        unpacked.form = Form::of(&first, name.file_stem().map_or(name, Path::new));
        unpacked.input = Box::new(io::Cursor::new(first).chain(unpacked.input));
        Ok(unpacked)
    }

    /// Copies a bag into a file that is deleted when dropped.
    pub(crate) fn copied(&mut self) -> io::Result<tempfile::NamedTempFile> {
        /// The largest bag that is copied.
        const LARGEST: u64 = 1 << 36;
        let mut file = tempfile::Builder::new().prefix("eeruf-").suffix(".bag").tempfile()?;
        io::copy(&mut self.take(LARGEST), &mut file)?;
        file.flush()?;
        Ok(file)
    }

    /// Notes an error that ended unpacking.
    pub(crate) fn tell(self, file: &Path, sink: &mut Sink<'_>) {
        if let Some(error) = self.error {
            sink.damage(file, None, format!("it cannot be unpacked to its end: {error}; what comes before was read"));
        }
    }
}

impl Read for Opened<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        match self.input.read(into) {
            Err(error) if self.packing.is_some() && error.kind() != io::ErrorKind::Interrupted => {
                self.error = Some(error);
                Ok(0)
            }
            other => other,
        }
    }
}

impl Foreign {
    /// The message about a file that cannot be read: its form, and lines of Python for converting it, separated by
    /// semicolons.
    pub(crate) fn refuse(self, file: &Path) -> FileError {
        let path = file.display().to_string().replace(['\\', '"'], "_");
        let Self(name, read) = self;
        let how = match read {
            "" if self == XZ => format!("`xz --decompress {path}`"),
            "" => "MCAP, a ROS 1 or ROS 2 bag, or text, also packed by gzip, bzip2 or zstd".to_owned(),
            read => format!(
                "in Python, after `pip install pandas`: import pandas; pandas.{read}(\"{path}\").to_csv(\"log.csv\", \
                 index=False); then `eeruf logs log.csv`"
            ),
        };
        FileError::new(file, format!("{name}, which eeruf does not read; expected {how}"))
    }
}
