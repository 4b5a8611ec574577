//! The integration tests as one binary, since linking takes longer than running most of them.

#![expect(clippy::disallowed_methods, reason = "a judge may compute by itself")]

mod amplitudes;
mod bumper;
mod corpus;
#[path = "../common/corpus.rs"]
mod corpus_reader;
mod facts;
mod flow;
mod image_source;
mod interference;
mod kept;
mod map_rooms;
mod measure;
mod modules;
mod open;
mod own;
mod panels;
mod physics;

mod properties;
mod random;
mod room;
mod set_one;
mod set_three;
mod set_two;
mod simulation;
mod sketches;
mod uneven;
mod worlds;
