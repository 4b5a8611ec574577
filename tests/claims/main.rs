//! What the paper and the documents claim, one module for each claim, in one binary: linking took longer than testing.

mod common;

mod certificates;
mod conditions;
mod crosstalk;
mod documents;
mod emitted;
mod experiments;
mod immediate_refiring;
mod inputs;
mod program;
mod ring;
mod scene;
mod study;
