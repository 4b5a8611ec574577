//! `cargo xtask site`: the documents as one book, with the page and the references for Rust and Python, every link
//! followed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::links::{CHAPTERS, links, parts, within_reach};
use crate::steps::{Steps, Trouble, output, run};

/// The site, for any web server or a disk.
const SITE: &str = "target/site/book";
/// Sources of the book.
const SOURCES: &str = "target/site/src";
/// Where the book leads to what lies beside it: the references and the page.
const REFERENCES: &str = "site/references.md";
/// Where links to sources lead.
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
        run(Command::new("cargo").args(["doc", "--workspace", "--no-deps", "--locked"]))?;
        copy_folder(Path::new("target/doc"), &Path::new(SITE).join("rust"))
    });
    steps.step("reference for Python", || crate::python::reference(&Path::new(SITE).join("python")));
    steps.step("the page", || {
        crate::page::page(crate::page::Tests::No)?;
        copy_folder(Path::new("target/page/folder"), &Path::new(SITE).join("page"))
    });
    steps.step("links of the site", links_lead_somewhere);
    println!("{SITE}/index.html");
}

/// Copies the documents, with links as the book has them, and builds it.
fn book() -> Result<(), Trouble> {
    let sources = Path::new(SOURCES);
    if sources.exists() {
        fs::remove_dir_all(sources).map_err(|error| failed(sources, &error))?;
    }
    copy_folder(Path::new("docs"), sources)?;
    write(&sources.join("SUMMARY.md"), &read(Path::new(CHAPTERS))?)?;
    write(&sources.join("references.md"), &read(Path::new(REFERENCES))?)?;
    for (name, chapter) in OUTSIDE {
        let text = read(Path::new(name))?;
        write(&sources.join(chapter), &rewritten(Path::new(name), &text))?;
    }
    for document in files("docs", "md")? {
        let text = rewritten(&document, &read(&document)?);
        write(&sources.join(document.strip_prefix("docs").unwrap_or(&document)), &text)?;
    }
    let site = std::path::absolute(SITE).map_err(|error| failed(Path::new(SITE), &error))?;
    run(Command::new(mdbook()?).args(["build", "site", "--dest-dir"]).arg(site))
}

/// mdBook, installed under `target/` where there is none of this version.
fn mdbook() -> Result<PathBuf, Trouble> {
    let root = Path::new("target/tools");
    let ours = root.join("bin/mdbook");
    for program in [Path::new("mdbook"), &ours] {
        let version = output(Command::new(program).arg("--version"));
        if version.is_some_and(|version| version.trim() == format!("mdbook v{MDBOOK}")) {
            return Ok(program.to_owned());
        }
    }
    let install =
        ["install", "mdbook", "--locked", "--version", MDBOOK, "--no-default-features", "--features", "search"];
    run(Command::new("cargo").args(install).arg("--root").arg(root))?;
    Ok(ours)
}

/// A document with links as they are in the book: to chapters and pictures there, to anything else in the repository.
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
        // What is shown may be the target as well, and stands before it.
        let whole = &text[link.range.clone()];
        let at = whole.rfind(&link.target).unwrap_or(whole.len());
        rewritten += &[&whole[..at], &target, whole.get(at + link.target.len()..).unwrap_or_default()].concat();
        end = link.range.end;
    }
    rewritten + &text[end..]
}

/// Follows the links of the book's pages that stay within the site.
fn links_lead_somewhere() -> Result<(), Trouble> {
    let mut broken = Vec::new();
    for page in files(SITE, "html")? {
        if ["rust", "python", "page"].iter().any(|folder| page.starts_with(Path::new(SITE).join(folder))) {
            continue;
        }
        let text = read(&page)?;
        // Within tags alone: listings show links as well.
        let tags = text.split('<').filter_map(|tag| tag.split('>').next());
        let keys = |tag| ["href=\"", "src=\""].map(|key| str::split(tag, key).nth(1)).into_iter().flatten();
        for target in tags.flat_map(keys).filter_map(|rest| rest.split('"').next()) {
            let (file, _) = parts(&page, target);
            if within_reach(target) && !target.starts_with("data:") && !file.exists() {
                broken.push(format!("{}: {target}", page.display()));
            }
        }
    }
    if broken.is_empty() { Ok(()) } else { Err(Trouble::Failed(broken.join("\n"))) }
}

/// The files below a folder that have this ending.
fn files(folder: impl AsRef<Path>, ending: &str) -> Result<Vec<PathBuf>, Trouble> {
    let folder = folder.as_ref();
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(|error| failed(folder, &error))? {
        let path = entry.map_err(|error| failed(folder, &error))?.path();
        if path.is_dir() {
            found.extend(files(&path, ending)?);
        } else if path.extension().is_some_and(|its| its == ending) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

fn copy_folder(from: &Path, to: &Path) -> Result<(), Trouble> {
    fs::create_dir_all(to).map_err(|error| failed(to, &error))?;
    for entry in fs::read_dir(from).map_err(|error| failed(from, &error))? {
        let entry = entry.map_err(|error| failed(from, &error))?;
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy_folder(&path, &to)?;
        } else {
            fs::copy(&path, &to).map_err(|error| failed(&path, &error))?;
        }
    }
    Ok(())
}

fn read(file: &Path) -> Result<String, Trouble> {
    fs::read_to_string(file).map_err(|error| failed(file, &error))
}

fn write(file: &Path, text: &str) -> Result<(), Trouble> {
    fs::write(file, text).map_err(|error| failed(file, &error))
}

fn failed(what: &Path, error: &std::io::Error) -> Trouble {
    Trouble::Failed(format!("{}: {error}", what.display()))
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
