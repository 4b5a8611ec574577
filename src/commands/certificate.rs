//! The certificate of a design, and its claim.

use std::path::Path;

use eeruf_design::RingDesign;
use eeruf_design::certificate::Stated;

use super::Answer;
use crate::console::{error, note};
use crate::files::error::InputError;
use crate::files::write::write;
use crate::report::watch::Watch;

/// Proof of a design's period.
pub(crate) struct Written {
    /// The file's text, or the reason why there is none.
    text: Result<String, String>,
    /// The claim that was proven, for the report.
    claim: String,
}

impl Written {
    /// Proves that the design's period is the shortest, or that none is below the search's bound; a lower bound, if
    /// budget and time do not suffice for that.
    pub(crate) fn new(design: &RingDesign, budget: usize, watch: &Watch) -> Self {
        let go_on = |nodes| watch.go_on(|| format!("certificate: {nodes} nodes"));
        match design.prove(budget, go_on) {
            Ok(text) => Self { claim: claim(&text, design), text: Ok(text) },
            Err(why) => Self { text: Err(why.to_string()), claim: String::new() },
        }
    }

    /// Writes the file and reports what it proves.
    pub(crate) fn write(&self, file: &Path, condition: &str) -> Result<Answer, InputError> {
        match &self.text {
            Ok(text) => {
                write(file, text)?;
                note(format_args!("{}: {}{condition}", file.display(), self.claim));
                Ok(Answer::Yes)
            }
            Err(why) => {
                error(format_args!("{}: not written: {why}", file.display()));
                Ok(Answer::No)
            }
        }
    }
}

/// The certificate's claim, as the checker prints it.
pub(crate) fn claim_of(text: &str) -> String {
    Stated::read(text).map_or_else(String::new, |stated| stated.to_string())
}

/// The certificate's claim, and a note if the search knows more.
fn claim(text: &str, design: &RingDesign) -> String {
    let (claim, known) = (claim_of(text), design.bound.unwrap_or_default());
    let is_less = |stated: Stated| stated.micros(stated.bound) < u64::from(known.as_micros());
    if Stated::read(text).is_some_and(is_less) {
        let proven = if design.found.proven { "proven, not certified: " } else { "" };
        format!("{claim}; {proven}a proof of {known} is longer, give it more with --certificate-budget or --time-limit")
    } else {
        claim
    }
}
