//! The certificate of a design, and its claim.

use std::path::Path;

use clap::ValueEnum;
use eeruf_design::RingDesign;
use eeruf_design::certificate::{self, Stated};

use super::Answer;
use crate::console::{error, note};
use crate::files::error::InputError;
use crate::files::write::write;
use crate::report::watch::Watch;

/// Certificate format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum CertificateForm {
    /// One text for checker/check_period.py
    #[default]
    Eeruf,
    /// A model and a proof for VeriPB, which others wrote: FILE with the endings .opb and .pbp
    Veripb,
}

/// Proof of a design's period.
pub(crate) struct Written {
    /// The files' texts, by ending if there are several; or why there are none.
    texts: Result<Vec<(&'static str, String)>, String>,
    /// The claim that was proven, for the report.
    claim: String,
}

impl Written {
    /// Proves that the design's period is the shortest, or that none is below the search's bound; in eeruf's own form a
    /// lower bound, if budget and time do not suffice for that.
    pub(crate) fn new(form: CertificateForm, design: &RingDesign, budget: usize, watch: &mut Watch) -> Self {
        let go_on = |nodes| watch.go_on(|| format!("certificate: {nodes} nodes"));
        let proven = match form {
            CertificateForm::Eeruf => certificate::prove(design, budget, go_on).map(|text| {
                let claim = claim(&text, design);
                (vec![("", text)], claim)
            }),
            CertificateForm::Veripb => certificate::prove_to_veripb(design, budget, go_on).map(|proven| {
                let bound = design.bound.unwrap_or_default();
                let claim = format!("for VeriPB, that no schedule has a period below {bound}; {} nodes", proven.nodes);
                (vec![("opb", proven.model), ("pbp", proven.proof)], claim)
            }),
        };
        match proven {
            Ok((texts, claim)) => Self { texts: Ok(texts), claim },
            Err(why) => Self { texts: Err(why.to_string()), claim: String::new() },
        }
    }

    /// Writes the files and says what they prove.
    pub(crate) fn write(&self, file: &Path, condition: &str) -> Result<Answer, InputError> {
        let texts = match &self.texts {
            Ok(texts) => texts,
            Err(why) => {
                error(format_args!("{}: not written: {why}", file.display()));
                return Ok(Answer::No);
            }
        };
        let mut names = Vec::new();
        for (ending, text) in texts {
            let file = if ending.is_empty() { file.to_owned() } else { file.with_extension(ending) };
            write(&file, text)?;
            names.push(file.display().to_string());
        }
        note(format_args!("{}: {}{condition}", names.join(", "), self.claim));
        Ok(Answer::Yes)
    }
}

/// The certificate's claim, as the checker prints it.
pub(crate) fn claim_of(text: &str) -> String {
    Stated::read(text).map_or_else(String::new, |stated| stated.to_string())
}

/// The certificate's claim, and whether the search knows more.
fn claim(text: &str, design: &RingDesign) -> String {
    let (claim, known) = (claim_of(text), design.bound.unwrap_or_default());
    let is_less = |stated: Stated| stated.micros(stated.bound) < u64::from(known.as_micros());
    if Stated::read(text).is_some_and(is_less) {
        format!("{claim}; a proof of {known} is longer, give it more with --certificate-budget or --time-limit")
    } else {
        claim
    }
}
