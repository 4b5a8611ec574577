//! Links in the documents: each leads to an existing file of the repository, and to an existing heading.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use anyhow::{Result, ensure};
use fs_err as fs;
use pulldown_cmark::{Event, Parser, Tag, TagEnd};

use crate::steps::output;

/// A link or picture: its position in the text, brackets included, and its target.
pub(crate) struct Link {
    pub(crate) range: Range<usize>,
    pub(crate) target: String,
}

/// Follows every link of every document of the repository that leads to a file in it.
pub(crate) fn check_documents() -> Result<()> {
    let listed = output(Command::new("git").args(["ls-files", "*.md"]))?;
    let mut texts = BTreeMap::new();
    // Documents of the book alone use the book's paths, which its builder checks.
    for document in listed.lines().map(Path::new).filter(|document| !document.starts_with("site")) {
        texts.insert(document.to_owned(), fs::read_to_string(document)?);
    }
    let mut broken = Vec::new();
    for (document, text) in &texts {
        for Link { target, .. } in links(text).into_iter().filter(|link| within_reach(&link.target)) {
            let (file, heading) = parts(document, &target);
            let headings = texts.get(&file).map(|text| headings(text));
            if !file.exists() {
                broken.push(format!("{}: {target}: no such file", document.display()));
            } else if heading.is_some_and(|heading| headings.is_some_and(|all| !all.iter().any(|one| one == heading))) {
                broken.push(format!("{}: {target}: no such heading", document.display()));
            }
        }
    }
    ensure!(broken.is_empty(), "{}", broken.join("\n"));
    Ok(())
}

/// Returns true if a link leads into the repository, not to the web.
pub(crate) fn within_reach(target: &str) -> bool {
    !target.contains("://") && !target.starts_with("mailto:")
}

/// Returns the target file of a document's link, from the repository's root, and the heading in it.
pub(crate) fn parts<'a>(document: &Path, target: &'a str) -> (PathBuf, Option<&'a str>) {
    let (file, heading) = target.split_once('#').map_or((target, None), |(file, heading)| (file, Some(heading)));
    if file.is_empty() {
        return (document.to_owned(), heading);
    }
    let mut path = PathBuf::new();
    for part in document.parent().unwrap_or(Path::new("")).join(file).components() {
        match part {
            Component::ParentDir => drop(path.pop()),
            part => path.push(part),
        }
    }
    (path, heading)
}

/// The links and pictures of a document in Markdown, in order.
pub(crate) fn links(text: &str) -> Vec<Link> {
    let events = Parser::new(text).into_offset_iter();
    events
        .filter_map(|(event, range)| match event {
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                Some(Link { range, target: dest_url.into_string() })
            }
            _ => None,
        })
        .collect()
}

/// The headings as links name them: in small letters, without punctuation, with hyphens for spaces.
fn headings(text: &str) -> Vec<String> {
    let (mut headings, mut heading) = (Vec::new(), None);
    for event in Parser::new(text) {
        match event {
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => headings.extend(heading.take().map(|heading| slug(&heading))),
            Event::Text(words) | Event::Code(words) => {
                if let Some(heading) = &mut heading {
                    heading.push_str(&words);
                }
            }
            _ => {}
        }
    }
    headings
}

fn slug(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.flat_map(char::to_lowercase).map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{headings, links, parts};

    #[test]
    fn links_and_pictures_are_found_and_code_is_not() {
        let text = "[a](b.md) and `[c](d.md)`\n\n![e](f.png)\n\n```\n[g](h.md)\n```\n\n[i]: j.md\n\n[i]\n";
        let targets: Vec<_> = links(text).into_iter().map(|link| link.target).collect();
        assert_eq!(targets, ["b.md", "f.png", "j.md"]);
    }

    #[test]
    fn a_link_is_followed_from_where_its_document_lies() {
        let document = Path::new("docs/explanation/theory.md");
        assert_eq!(parts(document, "../../README.md"), ("README.md".into(), None));
        assert_eq!(parts(document, "../how-to/simulate.md#who"), ("docs/how-to/simulate.md".into(), Some("who")));
        assert_eq!(parts(document, "#here"), ("docs/explanation/theory.md".into(), Some("here")));
    }

    #[test]
    fn headings_are_named_as_hosts_of_documents_name_them() {
        assert_eq!(
            headings("# 2. The `d`, (13a)\n\ntext\n\n## No sensor's blind\n"),
            ["2-the-d-13a", "no-sensors-blind"]
        );
    }
}
