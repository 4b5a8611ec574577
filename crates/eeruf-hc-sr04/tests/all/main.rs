//! Rings of modules on pins, expanders, capture units and buses of their own, in one binary.

mod by_hardware;
mod capture;
mod expander;
mod flow;
mod four;
mod holds;
mod measuring;
mod measuring_drivers;
mod pins;
mod pio;
mod prices;
mod recovery;
mod ring;
mod sampled;
mod uneven;
mod while_it_runs;
