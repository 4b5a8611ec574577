//! Claims of the paper and the documents, one module for each, in one binary, since linking takes longer than testing.

mod common;

mod atlas;
mod certificates;
mod documents;
mod emitted;
mod emitted_digests;
mod experiments;
mod faults;
mod field_cases;
mod inputs;
mod keys;
mod listings;
mod logs;
mod mistakes;
mod newcomers;
mod one_ring;
mod output;
mod program;
mod programs;
mod provoked;
mod recording;
mod rings_in_scenes;
mod rooms;
mod ros2;
mod scene;
mod seeds;
mod started;
mod study;
mod warnings;
