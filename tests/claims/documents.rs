//! The documents: their examples are what the program prints, and their pictures exist.
//!
//! In a block `console` a line that begins with `$ ` is run, from the root of the repository, and what follows is what
//! it prints; `...` and `[..]` stand for what may differ. What takes long is marked `printed by (large):` and left to
//! `cargo xtask reprint --check`, other commands than `eeruf` to `cargo xtask test`.

use std::path::{Path, PathBuf};

use crate::common::eeruf;
use crate::newcomers::{commands, shell};

/// The files below a folder whose names have one of the endings.
fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| match path.is_dir() {
            true => files(&path, endings),
            false => vec![path],
        })
        .filter(|path| endings.iter().any(|ending| path.extension().is_some_and(|of| of == *ending)))
        .collect()
}

/// The Markdown files below a folder.
fn documents(folder: &Path) -> Vec<PathBuf> {
    files(folder, &["md"])
}

// TRYCMD=overwrite writes what the program prints now into the documents.
#[test]
fn examples_in_documents_are_what_the_program_prints() {
    let program = Path::new(env!("CARGO_BIN_EXE_eeruf"));
    trycmd::TestCases::new()
        .register_bin("eeruf", program)
        .case("README.md")
        .case("docs/**/*.md")
        .case("tests/data/*.trycmd");
}

// `cargo xtask reprint --check` compares them with what the program prints.
#[test]
fn answers_quoted_by_a_guide_are_printed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &str| std::fs::read_to_string(root.join(path)).unwrap();
    let (guide, printed) = (read("docs/how-to/design.md"), read("tests/data/rooms.txt"));
    let blocks = guide.split("```text\n").skip(1).filter_map(|rest| rest.split("```").next());
    let quoted: Vec<_> = blocks.filter(|block| block.contains(": recommended: ")).collect();
    assert_eq!(quoted.len(), 1, "{quoted:?}");
    assert!(printed.contains(quoted[0]), "tests/data/rooms.txt does not have\n{}", quoted[0]);
}

// The table by which a reader decides is the one that was printed.
#[test]
fn table_of_readme_is_in_the_tables_that_are_kept() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &str| std::fs::read_to_string(root.join(path)).unwrap();
    let (readme, kept) = (read("README.md"), read("tests/data/flow-tables.txt"));
    let shown = readme.lines().skip_while(|line| !line.starts_with("| | one by one | with a median")).skip(2);
    let shown: Vec<_> = shown.take_while(|line| line.starts_with('|')).collect();
    let conditions = ["standing", "0.5 m/s", "90 degrees/s"];
    let conditions = conditions.map(str::to_owned).into_iter().chain(conditions.map(|of| format!("{of}, meeting")));
    let figures = |condition: &str, way: &str| {
        let row = kept.lines().find_map(|line| line.strip_prefix(&format!("| {condition} | {way} | "))).unwrap();
        let values: Vec<_> = row.split(" | ").map(|cell| cell.split(' ').next().unwrap()).collect();
        format!("{}; {:.0}", values[0], values[2].parse::<f64>().unwrap().round())
    };
    let printed: Vec<_> = conditions
        .map(|of| ["one by one", "one by one, median", "flow"].map(|way| figures(&of, way)).join(" | "))
        .collect();
    assert_eq!(shown.len(), printed.len());
    for (shown, printed) in shown.iter().zip(printed) {
        assert!(shown.ends_with(&format!("| {printed} |")), "{shown}\nexpected {printed}");
    }
}

// The first picture shows what the first command simulates, in words that say what it counts.
#[test]
fn first_picture_and_command_of_readme_are_of_one_scene() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &str| std::fs::read_to_string(root.join(path)).unwrap();
    let readme = read("README.md");
    let (first, _) = readme.split_once("```sh\n").and_then(|(_, rest)| rest.split_once('\n')).unwrap();
    let scene = first.split(' ').find_map(|word| word.strip_prefix("scenes/")).unwrap();
    assert!(read("docs/pictures/second.py").contains(&format!("\"{scene}\"")), "{first}");
    let (said, _) = readme.split_once("](docs/pictures/second.svg)").unwrap();
    let said = said.rsplit("![").next().unwrap();
    let picture = read("docs/pictures/second.svg");
    let counts: Vec<_> = picture
        .split(" wrong in this second")
        .filter_map(|part| part.rsplit('>').next()?.split_once(" right, "))
        .collect();
    assert_eq!(counts.len(), 3, "{counts:?}");
    for (right, wrong) in counts {
        assert!(said.contains(&format!("{right} right")) && said.contains(&format!(" {wrong} wrong")), "{said}");
    }
}

// The site has a page of it.
#[test]
fn reference_of_options_describes_each_one() {
    let reference = eeruf(&["man", "--markdown"]).out;
    let listed: Vec<_> = reference.lines().filter(|line| line.starts_with("* `")).collect();
    assert!(listed.len() > 150, "{reference}");
    let undescribed: Vec<_> = listed.into_iter().filter(|line| !line.contains("` — ")).collect();
    assert!(undescribed.is_empty(), "{undescribed:?}");
}

#[test]
fn every_picture_in_the_docs_is_small() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut pictures = 0;
    for document in documents(&root.join("docs")) {
        let text = std::fs::read_to_string(&document).unwrap();
        for picture in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if [".png", ".svg"].iter().any(|ending| picture.ends_with(ending)) {
                let size = std::fs::metadata(document.parent().unwrap().join(picture)).unwrap().len();
                assert!(size < 300_000, "{picture}: {size}");
                pictures += 1;
            }
        }
    }
    assert!(pictures >= 10, "{pictures}");
}

// Pictures by the program are drawn again and compared byte by byte; each picture is shown by a document.
#[test]
fn pictures_are_what_their_commands_draw() {
    let (page, root) = ("docs/project/pictures.md", Path::new(env!("CARGO_MANIFEST_DIR")));
    let read = |path: &Path| std::fs::read_to_string(path).unwrap();
    let folder = tempfile::tempdir().unwrap();
    assert!(shell("eeruf examples .", folder.path()).status.success());
    for command in commands(page) {
        let output = shell(&command, folder.path());
        assert!(output.stderr.is_empty(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
    }
    let (kept, mut drawn) = (root.join("docs/pictures"), 0);
    let shown = documents(&root.join("docs")).iter().map(|document| read(document)).collect::<String>();
    let shown = shown + &read(&root.join("README.md"));
    for picture in files(&kept, &["png", "svg"]) {
        let name = picture.strip_prefix(&kept).unwrap().to_str().unwrap();
        assert!(shown.contains(&format!("pictures/{name})")), "{name}: no document shows it");
        let Ok(fresh) = std::fs::read(folder.path().join(name)) else {
            assert!(read(&root.join(page)).contains(&format!("`{name}`")), "{name}: {page} does not name it");
            continue;
        };
        drawn += 1;
        if std::env::var_os("EERUF_WRITE").is_some() {
            std::fs::write(&picture, fresh).unwrap();
        } else {
            assert!(fresh == std::fs::read(&picture).unwrap(), "{name}: its command draws another picture ({page})");
        }
    }
    assert!(drawn >= 10, "{drawn}");
}

/// Counts the words of a text, like `wc -w`.
fn words(text: &str) -> usize {
    text.split_whitespace().count()
}

#[test]
fn each_document_is_a_page_of_the_site() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let summary = std::fs::read_to_string(root.join("site/SUMMARY.md")).unwrap();
    let docs = root.join("docs");
    for document in documents(&docs) {
        let page = document.strip_prefix(&docs).unwrap().to_str().unwrap().replace('\\', "/");
        assert!(page == "README.md" || summary.contains(&format!("({page})")), "{page}");
    }
}

#[test]
fn user_path_has_at_most_20_000_words() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let mut path = documents(&docs.join("tutorial"));
    path.extend(documents(&docs.join("how-to")));
    path.push(docs.join("faq.md"));
    let words: usize = path.iter().map(|document| words(&std::fs::read_to_string(document).unwrap())).sum();
    assert!(words <= 20_000, "{words}; say a thing once, and link to it");
}

// Figures that other documents quote, and roads not taken.
#[test]
fn log_has_at_most_20_000_words() {
    let log = documents(&Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/log"));
    let words: usize = log.iter().map(|document| words(&std::fs::read_to_string(document).unwrap())).sum();
    assert!(words <= 20_000, "{words}; keep what other documents quote, and what was left out in a line each");
}

/// Returns a text without the parts from one mark to another.
fn without(text: &str, begin: &str, end: &str) -> String {
    let mut parts = text.split(begin);
    let first = parts.next().unwrap().to_owned();
    parts.fold(first, |kept, part| kept + part.split_once(end).unwrap().1)
}

// Counted: every document in docs/ but docs/log, tables and printed parts included. Not counted: in docs/reference,
// what is printed or a listing of a file elsewhere; the READMEs of crates, examples and libraries; and the files at the
// repository's root (README, ARCHITECTURE, CONTRIBUTING, CHANGELOG and the like).
#[test]
fn documents_have_at_most_45_000_words() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
    let counted = documents(&docs).into_iter().filter(|document| !document.starts_with(docs.join("log")));
    let words = counted.map(|document| {
        let mut text = std::fs::read_to_string(&document).unwrap();
        if document.starts_with(docs.join("reference")) {
            text = without(&text, "<!-- printed by", "<!-- end -->");
            text = without(&text, "<!-- figures", "<!-- end -->");
            text = without(&text, "<!-- listing: ", "\n```\n");
        }
        words(&text)
    });
    let words: usize = words.sum();
    assert!(words <= 45_000, "{words}; say a thing once, and link to it");
}

// Rows of tables that users read, as they stand in the source.
#[test]
fn tables_of_users_have_at_most_100_columns() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = ["docs/tutorial", "docs/how-to", "docs/explanation"];
    let mut read = folders.iter().flat_map(|folder| documents(&root.join(folder))).collect::<Vec<_>>();
    read.extend(
        ["README.md", "docs/README.md", "docs/faq.md", "docs/glossary.md", "docs/paper.md"].map(|x| root.join(x)),
    );
    let (mut rows, mut wide) = (0, String::new());
    for document in read {
        let (text, mut code) = (std::fs::read_to_string(&document).unwrap(), false);
        for (line, row) in (1..).zip(text.lines()) {
            code ^= row.starts_with("```");
            let is_row = row.starts_with('|') && !code;
            rows += usize::from(is_row);
            if is_row && row.chars().count() > 100 {
                wide += &format!("\n{}:{line}: {} columns", document.display(), row.chars().count());
            }
        }
    }
    assert!(rows > 200 && wide.is_empty(), "{rows} rows{wide}\nexpected at most 100 columns: split it, or make a list");
}
