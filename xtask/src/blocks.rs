//! Parts of documents that a program printed: a comment before them says which, `<!-- end -->` ends them.

use crate::steps::Trouble;

const END: &str = "<!-- end -->";

/// A part that was printed.
pub(crate) struct Block<'a> {
    /// The comment after its first words.
    pub(crate) label: &'a str,
    pub(crate) body: &'a str,
}

/// The parts of a text whose comments begin with these words.
pub(crate) fn blocks<'a>(text: &'a str, begin: &str) -> Result<Vec<Block<'a>>, Trouble> {
    text.split(begin).skip(1).map(|rest| Ok(split(rest)?.0)).collect()
}

/// The text with the body of each part replaced by what `fresh` gives for it.
pub(crate) fn replaced(
    text: &str,
    begin: &str,
    mut fresh: impl FnMut(&Block<'_>) -> Result<String, Trouble>,
) -> Result<String, Trouble> {
    let mut pieces = text.split(begin);
    let mut out = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (block, after) = split(piece)?;
        out += &format!("{begin}{} -->\n\n{}\n\n{END}{after}", block.label, fresh(&block)?.trim());
    }
    Ok(out)
}

fn split(rest: &str) -> Result<(Block<'_>, &str), Trouble> {
    let failed = |why: &str| Trouble::Failed(why.to_owned());
    let (label, rest) = rest.split_once(" -->\n").ok_or_else(|| failed("a comment has no end"))?;
    let (body, after) = rest.split_once(END).ok_or_else(|| failed(&format!("no {END} after {label}")))?;
    Ok((Block { label, body }, after))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "a\n<!-- made by x y -->\n\n1\n\n<!-- end -->\nb\n<!-- made by z -->\n\n2\n\n<!-- end -->\n";

    #[test]
    fn every_block_is_found_with_its_label_and_body() {
        let Ok(found) = blocks(TEXT, "<!-- made by ") else { panic!("two blocks") };
        let found: Vec<_> = found.iter().map(|block| (block.label, block.body.trim())).collect();
        assert_eq!(found, [("x y", "1"), ("z", "2")]);
    }

    #[test]
    fn replacing_a_body_by_itself_changes_nothing() {
        assert_eq!(replaced(TEXT, "<!-- made by ", |block| Ok(block.body.to_owned())).ok(), Some(TEXT.to_owned()));
    }

    #[test]
    fn a_block_without_an_end_is_an_error() {
        assert!(blocks("<!-- made by x -->\n1\n", "<!-- made by ").is_err());
    }
}
