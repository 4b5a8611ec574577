//! What the paper and the documents claim, one module for each claim, in one binary: linking took longer than testing.

mod common;

mod certificates;
mod conditions;
mod crosstalk;
mod documents;
mod emitted;
mod experiments;
mod hopping;
mod immediate_refiring;
mod inputs;
mod logs;
mod program;
mod ring;
mod scene;
mod study;
