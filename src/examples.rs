//! The repository's scenes and rings and the checker of certificates, built into the program, so that the documents'
//! commands run anywhere.

use include_dir::{Dir, include_dir};

static SCENES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/scenes");
static RINGS: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/rings");
const CHECKER: (&str, &str) = ("checker/check_period.py", include_str!("../checker/check_period.py"));

/// Returns the examples, ordered by path: the path in the repository, such as `scenes/alcove.toml`, and the text.
pub fn all() -> Vec<(String, &'static str)> {
    let files = [("rings", &RINGS), ("scenes", &SCENES)].into_iter().flat_map(|(folder, files)| {
        files
            .files()
            .filter_map(move |file| Some((format!("{folder}/{}", file.path().display()), file.contents_utf8()?)))
    });
    let mut files: Vec<_> = files.chain([(CHECKER.0.to_owned(), CHECKER.1)]).collect();
    files.sort_unstable();
    files
}

/// Returns the text of the example with this path, such as `scenes/alcove.toml`; `None` if there is none.
pub fn text(path: &str) -> Option<&'static str> {
    all().into_iter().find_map(|(name, text)| (name == path).then_some(text))
}

#[cfg(test)]
mod tests {
    use super::{all, text};

    #[test]
    fn every_scene_and_ring_of_the_repository_is_an_example() {
        for folder in ["scenes", "rings"] {
            let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
            for file in std::fs::read_dir(root.join(folder)).expect("it is there") {
                let file = file.expect("it can be read").path();
                let name = format!("{folder}/{}", file.file_name().expect("a file").to_string_lossy());
                let here = text(&name).unwrap_or_else(|| panic!("{name} is no example"));
                assert_eq!(here, std::fs::read_to_string(&file).expect("it can be read"), "{name}");
            }
        }
        assert!(text("checker/check_period.py").is_some_and(|text| text.contains("eeruf-certificate")));
        assert!(all().is_sorted() && text("scenes/nowhere.toml").is_none());
    }
}
