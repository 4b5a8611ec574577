//! Result of a study, as text, as JSON, and as pictures.

pub(crate) mod fooled;
pub(crate) mod found;
pub(crate) mod json;
pub(crate) mod pictures;
pub(crate) mod text;
