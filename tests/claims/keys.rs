//! The tables of keys in the documents match what the program reads.

use std::collections::BTreeSet;
use std::path::Path;

use eeruf_design::RingSpec;
use eeruf_sim::modules::{Interface, KEYS, NoEcho, PRESETS};
use eeruf_sim::{Physics, Pose, Robot, Room, Transducer, WorldParts};

/// Keys of older files, which are still read or refused by name.
const OLDER: [&str; 2] = ["transducer", "patience"];

/// The words between back quotes.
fn quoted(text: &str) -> BTreeSet<String> {
    text.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// The rows of a document's table under a heading, as cells.
fn rows(document: &str, heading: &str) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(document).unwrap();
    let (_, section) = text.split_once(heading).unwrap();
    let section = section.split("\n## ").next().unwrap();
    let rows = section.lines().filter(|line| line.starts_with("| "));
    let cells = rows.map(|row| row.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect());
    // Without its head.
    cells.skip(1).collect()
}

/// Returns the keys that a parser expects, from its message on an unknown one.
fn expected(message: &str) -> BTreeSet<String> {
    let (_, expected) = message.split_once("; expected").unwrap_or_else(|| panic!("{message}"));
    let keys = quoted(expected);
    assert!(!keys.is_empty(), "{message}");
    keys.into_iter().filter(|key| !OLDER.contains(&&**key)).collect()
}

// Each figure has a source, a document or a choice, and each module figures of a document.
#[test]
fn figures_of_modules_are_those_in_the_document() {
    const DOCUMENT: &str = "docs/reference/modules.md";
    let stubs = std::fs::read_to_string("python/eeruf/_eeruf.pyi").unwrap();
    let text = std::fs::read_to_string(DOCUMENT).unwrap();
    let all = rows(DOCUMENT, "# Modules\n");
    for module in PRESETS {
        let name = module.name;
        assert!(stubs.contains(&format!("        {name:?},\n")), "_eeruf.pyi: {name}");
        let heading = text.lines().find(|line| line.starts_with("### ") && line.ends_with(&format!(": `{name}`")));
        let heading = heading.unwrap_or_else(|| panic!("{name}: no heading"));
        let rows: Vec<_> = rows(DOCUMENT, heading).into_iter().take(KEYS.len()).collect();
        assert_eq!(rows.len(), KEYS.len(), "{name}");
        for (row, key) in rows.iter().zip(&KEYS) {
            let shown = (row[0].trim_matches('`'), row[1].trim_matches('`'));
            assert_eq!(shown, (key.name, &*key.of(module).to_string()), "{name}");
            assert!(!row[2].trim_start_matches("*choice*:").trim().is_empty(), "{name}: {}: no source", key.name);
        }
        assert!(rows.iter().any(|row| !row[2].starts_with("*choice*: ")), "{name}");
        // The first table, by interface.
        let title = heading.trim_start_matches("### ").split(": `").next().unwrap();
        let without_echo = match module.no_echo {
            NoEcho::Holds { us } => format!("holds its line for {} ms", f64::from(us) / 1e3),
            NoEcho::Silent => "no edge".to_owned(),
            NoEcho::Reports => "reports none".to_owned(),
        };
        let interface = Interface::NAMES.iter().find(|(_, known)| *known == module.interface).unwrap().0;
        let [sees_m, rest_ms] =
            [module.sees_to_mm, module.rest_us].map(|thousand| format!("{}", f64::from(thousand) / 1e3));
        let row = [format!("`{interface}`"), format!("`{name}`, {title}"), sees_m, rest_ms, without_echo];
        assert!(all.iter().any(|known| known[..] == row), "{row:?}");
    }
    let meanings: BTreeSet<_> = all.iter().filter(|row| row.len() == 2).flat_map(|row| quoted(&row[0])).collect();
    assert!(KEYS.iter().all(|key| meanings.contains(key.name)), "{meanings:?}");
}

#[test]
fn keys_of_ring_files_are_those_in_the_document() {
    let documented: BTreeSet<_> =
        rows("docs/reference/ring-files.md", "# Keys of ring files").iter().flat_map(|row| quoted(&row[0])).collect();
    assert_eq!(documented, expected(RingSpec::from_text("unknown = 1").unwrap_err().message()));
}

#[test]
fn keys_of_scene_files_are_those_in_the_document() {
    let rows = rows("docs/reference/scene-files.md", "# Keys of scene files");
    let documented = |table: &str| -> BTreeSet<String> {
        let of = rows.iter().filter(|row| row[0].trim_matches('`') == table);
        of.flat_map(|row| quoted(&row[1])).collect()
    };
    let refused = |text: &str| expected(&WorldParts::from_text(Path::new("s.toml"), text).unwrap_err().to_string());
    let robot = "[[robot]]\npose = { x_m = 0, y_m = 0 }\n";
    let ring = "ring = { sensors = 2, spacing_deg = 10, radius_m = 0.2 }\n";
    let mut tables = vec![
        ("top", "unknown = 1".to_owned()),
        ("robot", "[[robot]]\nunknown = 1".to_owned()),
        ("pose", "[[robot]]\npose = { unknown = 1 }".to_owned()),
        ("schedule", format!("{robot}{ring}schedule = {{ unknown = 1 }}")),
    ];
    tables.extend(["air", "noise", "firing"].map(|table| (table, format!("[{table}]\nunknown = 1"))));
    tables.extend(["wall", "pole", "fault"].map(|table| (table, format!("[[{table}]]\nunknown = 1"))));
    tables.extend(["ring", "motion", "clock", "body"].map(|table| (table, format!("{robot}{table}.unknown = 1"))));
    for (table, text) in &tables {
        assert_eq!(documented(table), refused(text), "{table}");
    }
    // A name or a table, which the parser does not list: what is written of one that differs in all.
    let physics = Physics { fading_time_s: 0.7, ..Physics::DEFAULT };
    let scene = eeruf_sim::Scene::new(vec![], vec![], eeruf_sim::Air::default()).unwrap();
    let scene = scene.with_room(Some(Room { ceiling_m: 2.2, ..Room::DEFAULT })).unwrap();
    let robots = vec![Robot::ring(Pose::identity(), 1, 0.1, 0.1, Transducer::HC_SR04)];
    let noise = eeruf_sim::Noise::default();
    let parts = WorldParts { scene, robots, noise, physics, max_order: 2, seed: 1, faults: vec![] };
    let written: toml::Table = parts.to_toml().parse().unwrap();
    let keys = |table: &str| -> BTreeSet<String> { written[table].as_table().unwrap().keys().cloned().collect() };
    let mut effects = keys("physics");
    effects.insert("preset".to_owned());
    assert_eq!(documented("physics"), effects);
    assert_eq!(documented("height"), keys("height"));
    // No row is of a table that nothing reads.
    let known: BTreeSet<&str> = tables.iter().map(|(table, _)| *table).chain(["physics", "height"]).collect();
    assert!(rows.iter().all(|row| known.contains(row[0].trim_matches('`'))), "{known:?}");
}
