//! What the paper and the documents claim, one module for each claim, in one binary: linking took longer than testing.

mod common;

mod atlas;
mod certificates;
mod documents;
mod emitted;
mod experiments;
mod hopping;
mod inputs;
mod logs;
mod program;
mod recording;
mod scene;
mod study;
