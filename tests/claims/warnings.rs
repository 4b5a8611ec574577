//! Harm to users who copy our files and pages: settings known to hurt are absent, and dangers are stated where users
//! read first.

use std::path::Path;

fn read(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

// Each phrase is the shortest part that carries the warning; its page may say it otherwise, with this part kept.
#[test]
fn known_dangers_are_said_on_their_pages() {
    let first_lines: String = read("docs/how-to/autopilots.md").lines().take(10).collect::<Vec<_>>().join(" ");
    for said in ["A cut wire", "`hold` (the default)", "**free** after a second", "`unknown`: 65535", "*backs away*"] {
        assert!(first_lines.contains(said), "docs/how-to/autopilots.md, first lines: {said}");
    }
    let pages: [(&str, &[&str]); 4] = [
        ("docs/explanation/limits.md", &["can accept a distance that is wrong", "of the filter alone"]),
        ("docs/explanation/flow.md", &["Left to chance", "Tell it the speed"]),
        ("docs/how-to/firmware.md", &["distances that are too far"]),
        ("README.md", &["alone: standing", "sensor has been fired yet"]),
    ];
    for (page, phrases) in pages {
        let text = read(page).split_whitespace().collect::<Vec<_>>().join(" ");
        for said in phrases {
            assert!(text.contains(said), "{page} does not say: {said}");
        }
    }
}
