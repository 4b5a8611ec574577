//! Digests of all texts that `eeruf design --emit` writes: they show any change of a ring's source text.

use crate::common::eeruf;
use crate::started::rings;

/// The file: a line for each text, with its digest and the arguments of `design`.
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/emitted-digests.txt");

/// FNV-1a of 64 bits.
fn digest(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

fn line(asked: &str) -> String {
    let emitted = eeruf(&["design"].into_iter().chain(asked.split(' ')).collect::<Vec<_>>());
    assert!(emitted.code == Some(0) && !emitted.out.is_empty(), "eeruf design {asked}: {}", emitted.err);
    format!("{:016x} {asked}\n", digest(&emitted.out))
}

// EERUF_WRITE=1 writes the digests.
#[test]
fn emitted_texts_have_their_digests() {
    let kept = std::fs::read_to_string(FILE).unwrap();
    let asked = kept.lines().map(|line| line.split_once(' ').expect("a digest and options").1).collect::<Vec<_>>();
    for ring in rings() {
        let name = ring.file_name().unwrap().to_str().unwrap();
        for form in ["toml", "rust", "c", "arduino"] {
            let wanted = format!("rings/{name} --no-atlas --period-only --emit {form}");
            assert!(asked.contains(&&*wanted), "{FILE}: `{wanted}` is missing; expected each ring in each form");
        }
    }
    let now = asked.into_iter().map(line).collect::<String>();
    if std::env::var_os("EERUF_WRITE").is_some() {
        std::fs::write(FILE, &now).unwrap();
        return;
    }
    let changed = now.lines().zip(kept.lines()).filter(|(now, kept)| now != kept).map(|(now, _)| now);
    let changed = changed.collect::<Vec<_>>();
    assert!(changed.is_empty(), "other texts than kept; EERUF_WRITE=1 writes their digests:\n{}", changed.join("\n"));
}
