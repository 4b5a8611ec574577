//! The part of the corpus that the repository keeps: for each ring the number and the digest of its lines, and as many
//! of its first lines as show something new.
//!
//! `# table 67 190 1f2e...` is the title of ring `table 67`; the lines after it are as in the corpus, so that each port
//! can play them.

use std::collections::BTreeSet;
use std::fmt::Write;

use eeruf_core::ReadingKind;

/// Rings by title, each with its lines.
fn rings(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.split("# ").filter_map(|ring| ring.split_once('\n'))
}

/// FNV-1a of 64 bits.
fn digest(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

fn title(name: &str, lines: &str) -> String {
    format!("{name} {} {:016x}", lines.lines().count(), digest(lines))
}

/// The properties for which a line may be kept: its letter and event within its family of rings, and its kind, state,
/// reason and explanation in any family.
fn shown(name: &str, line: &str) -> Vec<String> {
    let family = name.split(' ').next().unwrap_or(name);
    let words = line.split(' ').collect::<Vec<_>>();
    let by = |by: &str| format!("by {}", if ["254", "255"].contains(&by) { by } else { "sensor" });
    match words[..] {
        ["P", _, _, "1", _, _, _, kind, _, _, _, sensor] => {
            vec![format!("{family} P 1"), format!("reading {kind}"), by(sensor)]
        }
        ["O", _, _, state, _, _, why, sensor] => {
            vec![format!("{family} O"), format!("state {state}"), format!("why {why}"), by(sensor)]
        }
        ["P", _, _, event, ..] => vec![format!("{family} P {event}")],
        _ => vec![format!("{family} {}", words[0])],
    }
}

/// Picks the lines to keep from each ring of the corpus, starting where a line shows most.
pub(super) fn of(corpus: &str) -> String {
    let rings = rings(corpus).map(|(name, lines)| (name, lines.lines().collect::<Vec<_>>())).collect::<Vec<_>>();
    let mut kept = vec![0; rings.len()];
    let mut seen = BTreeSet::new();
    loop {
        // The new properties, the number of lines for them, the ring, and its lines to keep.
        let mut best = (BTreeSet::new(), 1, 0, 0);
        for (ring, (name, lines)) in rings.iter().enumerate() {
            let mut new = BTreeSet::new();
            for (added, line) in lines[kept[ring]..].iter().enumerate() {
                new.extend(shown(name, line).into_iter().filter(|it| !seen.contains(it)));
                if new.len() * best.1 > best.0.len() * (added + 1) {
                    best = (new.clone(), added + 1, ring, kept[ring] + added + 1);
                }
            }
        }
        if best.0.is_empty() {
            break;
        }
        seen.extend(best.0);
        kept[best.2] = best.3;
    }
    let mut text = String::new();
    for ((name, lines), kept) in self::rings(corpus).zip(kept) {
        writeln!(text, "# {}", title(name, lines)).unwrap();
        text.extend(lines.split_inclusive('\n').take(kept));
    }
    text
}

/// The differences between the corpus and its kept part, one for each ring.
pub(super) fn differences(golden: &str, corpus: &str) -> String {
    let mut text = String::new();
    let mut now = rings(corpus);
    for (kept, start) in rings(golden) {
        let Some((name, lines)) = now.next() else {
            writeln!(text, "{kept}: is gone").unwrap();
            continue;
        };
        let title = title(name, lines);
        if title == kept && lines.starts_with(start) {
            continue;
        }
        let mut pairs = start.lines().zip(lines.lines().chain([""])).enumerate();
        match pairs.find(|(_, (kept, now))| kept != now) {
            Some((line, (kept, now))) => writeln!(text, "{name}, line {}: {now}; kept is {kept}", line + 1),
            None => writeln!(text, "{title}; kept is {kept}, lines that differ are not kept"),
        }
        .unwrap();
    }
    now.for_each(|(name, _)| writeln!(text, "{name}: is new").unwrap());
    text
}

/// Panics unless the kept lines have each kind of reading, state, reason and explanation.
pub(super) fn assert_complete(golden: &str) {
    let seen = rings(golden).flat_map(|(name, lines)| lines.lines().flat_map(move |line| shown(name, line)));
    let seen = seen.collect::<BTreeSet<_>>();
    let numbered = |what: &str, count: usize| (0..count).map(|it| format!("{what} {it}")).collect::<Vec<_>>();
    let by = ["by sensor", "by 254", "by 255"].map(str::to_owned);
    // None of these rings has a tentative reading.
    let kinds = ReadingKind::ALL.into_iter().filter(|&kind| kind != ReadingKind::Tentative);
    let kinds = kinds.map(|kind| format!("reading {}", kind as u32)).collect::<Vec<_>>();
    let wanted = [kinds, numbered("state", 5), numbered("why", 4), by.to_vec()];
    let missing = wanted.concat().into_iter().filter(|it| !seen.contains(it)).collect::<Vec<_>>();
    assert!(missing.is_empty(), "not in the golden: {missing:?}");
}
