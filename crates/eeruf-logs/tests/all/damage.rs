//! Files that are cut off or have a wrong byte.

use std::path::{Path, PathBuf};

use eeruf_logs::Options;

use crate::{BAGS, bag, read};

/// Pseudo-random numbers, the same on every machine.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % limit as u64) as usize
    }
}

/// The file of a bag that holds its messages.
fn data_file(bag: &Path) -> PathBuf {
    if bag.is_file() {
        return bag.to_owned();
    }
    let mut entries = std::fs::read_dir(bag).unwrap().map(|entry| entry.unwrap().path());
    entries.find(|file| file.extension().is_some_and(|ending| ending == "mcap" || ending == "db3")).unwrap()
}

#[test]
fn of_every_cut_or_flipped_file_what_can_be_read_is_and_the_rest_is_said() {
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
