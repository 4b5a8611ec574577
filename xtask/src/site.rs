//! `cargo xtask site`: the documents as one book, with the page and the references for Rust and Python, every link
//! followed.

use std::path::{Path, PathBuf, absolute};
use std::process::Command;

use anyhow::{Result, ensure};
use fs_err as fs;

use crate::links::{links, parts, within_reach};
use crate::steps::{Steps, command, empty, output, run, run_line};

/// The site, for any web server or a disk.
const SITE: &str = "target/site/book";
/// Sources of the book.
const SOURCES: &str = "target/site/src";
/// Target of links to sources.
const REPOSITORY: &str = "https://github.com/eeruf/eeruf/blob/main";
/// The version of mdBook that the site is built with, so that two builds look alike.
const MDBOOK: &str = "0.5.4";
/// Chapters from outside `docs/`, and their files in the book.
const OUTSIDE: [(&str, &str); 6] = [
    ("README.md", "introduction.md"),
    ("CHANGELOG.md", "changes.md"),
    ("ARCHITECTURE.md", "architecture.md"),
    ("CONTRIBUTING.md", "contributing.md"),
    ("SECURITY.md", "security.md"),
    ("CODE_OF_CONDUCT.md", "conduct.md"),
];

pub(crate) fn site(steps: &mut Steps) {
    steps.step("the book", book);
    steps.step("reference for Rust", || {
        run_line("cargo doc --workspace --no-deps --locked")?;
        copy_folder("target/doc/.", &Path::new(SITE).join("rust"))
    });
    steps.step("reference for Python", || crate::python::reference(&Path::new(SITE).join("python")));
    steps.step("the page", || {
        crate::page::page(false, false)?;
        copy_folder("target/page/folder/.", &Path::new(SITE).join("page"))
    });
    steps.step("links of the site", links_lead_somewhere);
    println!("{SITE}/index.html");
}

/// Copies the documents, with links adapted to the book, prints all verbs and options, and builds it.
fn book() -> Result<()> {
    let sources = Path::new(SOURCES);
    empty(sources)?;
    copy_folder("docs/.", sources)?;
    // The order of the chapters, and the chapter of links to the references and the page; mdBook's settings are beside.
    for name in ["SUMMARY.md", "references.md"] {
        fs::copy(Path::new("site").join(name), sources.join(name))?;
    }
    for (name, chapter) in OUTSIDE {
        fs::write(sources.join(chapter), rewritten(Path::new(name), &fs::read_to_string(name)?))?;
    }
    for document in files("docs", "md")? {
        let text = rewritten(&document, &fs::read_to_string(&document)?);
        fs::write(sources.join(document.strip_prefix("docs")?), text)?;
    }
    let options = output(&mut command("cargo run --quiet --locked --package eeruf -- man --markdown"))?;
    fs::write(sources.join("reference/options.md"), options)?;
    run(Command::new(mdbook()?).args(["build", "site", "--dest-dir"]).arg(absolute(SITE)?))
}

/// mdBook, installed under `target/` unless this version is there.
fn mdbook() -> Result<PathBuf> {
    let root = "target/tools";
    let install = "cargo install mdbook --quiet --locked --no-default-features --features search --version";
    run_line(&format!("{install} {MDBOOK} --root {root}"))?;
    Ok(Path::new(root).join("bin/mdbook"))
}

/// Adapts a document's links to the book: to chapters and pictures there, to anything else in the repository.
fn rewritten(document: &Path, text: &str) -> String {
    let (mut rewritten, mut end) = (String::new(), 0);
    for link in links(text) {
        let (file, heading) = parts(document, &link.target);
        if !within_reach(&link.target) || link.target.starts_with('#') || link.range.start < end {
            continue;
        }
        let up = "../".repeat(document.strip_prefix("docs").map_or(0, |inside| inside.components().count() - 1));
        let target = match (file.strip_prefix("docs"), OUTSIDE.iter().find(|(name, _)| Path::new(name) == file)) {
            (_, Some((_, chapter))) => format!("{up}{chapter}"),
            (Ok(inside), None) if !inside.starts_with("notebooks") => format!("{up}{}", inside.display()),
            _ => format!("{REPOSITORY}/{}", file.display()),
        };
        let target = heading.map_or(target.clone(), |heading| format!("{target}#{heading}"));
        rewritten += &text[end..link.range.start];
        // The shown text may equal the target, and comes before it.
        let whole = &text[link.range.clone()];
        let at = whole.rfind(&link.target).unwrap_or(whole.len());
        rewritten += &[&whole[..at], &target, whole.get(at + link.target.len()..).unwrap_or_default()].concat();
        end = link.range.end;
    }
    rewritten + &text[end..]
}

/// Follows the links of the book's pages that stay within the site.
fn links_lead_somewhere() -> Result<()> {
    let mut broken = Vec::new();
    for page in files(SITE, "html")? {
        if ["rust", "python", "page"].iter().any(|folder| page.starts_with(Path::new(SITE).join(folder))) {
            continue;
        }
        let text = fs::read_to_string(&page)?;
        // Only within tags, since listings show links too.
        let tags = text.split('<').filter_map(|tag| tag.split('>').next());
        let keys = |tag| ["href=\"", "src=\""].map(|key| str::split(tag, key).nth(1)).into_iter().flatten();
        for target in tags.flat_map(keys).filter_map(|rest| rest.split('"').next()) {
            let (file, _) = parts(&page, target);
            if within_reach(target) && !target.starts_with("data:") && !file.exists() {
                broken.push(format!("{}: {target}", page.display()));
            }
        }
    }
    ensure!(broken.is_empty(), "{}", broken.join("\n"));
    Ok(())
}

/// Returns the files below a folder with this ending.
fn files(folder: &str, ending: &str) -> Result<Vec<PathBuf>> {
    let found = output(Command::new("find").args([folder, "-name", &format!("*.{ending}")]))?;
    Ok(found.lines().map(PathBuf::from).collect())
}

fn copy_folder(from: &str, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    run(Command::new("cp").args(["-r", from]).arg(to))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::rewritten;

    // Links lead to chapters in the book and to sources in the repository.
    #[test]
    fn links_lead_to_chapters_and_sources() {
        let text = "[docs/how-to/simulate.md](docs/how-to/simulate.md#who) ![b](docs/pictures/b.png) \
                    [c](CHANGELOG.md) [d](src/main.rs) [e](https://e.org/)";
        let expected = "[docs/how-to/simulate.md](how-to/simulate.md#who) ![b](pictures/b.png) [c](changes.md) \
                        [d](https://github.com/eeruf/eeruf/blob/main/src/main.rs) [e](https://e.org/)";
        assert_eq!(rewritten(Path::new("README.md"), text), expected);
        let text = "[a](../explanation/theory.md) [b](../../README.md) [c](../notebooks) [d](#here)";
        let expected = "[a](../explanation/theory.md) [b](../introduction.md) \
                        [c](https://github.com/eeruf/eeruf/blob/main/docs/notebooks) [d](#here)";
        assert_eq!(rewritten(Path::new("docs/how-to/simulate.md"), text), expected);
    }
}
