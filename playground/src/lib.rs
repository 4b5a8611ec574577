//! EERUF's core and simulator for a page in a browser: questions and answers in JSON, rings and scenes in the same TOML
//! that the program `eeruf` reads.
//!
//! | file | content |
//! |---|---|
//! | `exports` | what JavaScript calls: a text goes in, a text comes out |
//! | `question` | which questions there are |
//! | `trace` | every critical path of a ring, with its corners |
//! | `run` | a scene under a firing method: readings, figures, who fooled whom |
//! | `paste` | whether a pasted log shows crosstalk, as `eeruf logs` says it |
//! | `design` | the shortest period for a ring, its proof, its certificate, its source texts |

mod design;
mod exports;
mod paste;
mod progress;
mod question;
mod run;
mod trace;
