//! EERUF's core and simulator for a page in a browser: questions and answers in JSON, rings and scenes in the same TOML
//! that the program `eeruf` reads.
//!
//! | file | content |
//! |---|---|
//! | `exports` | the functions that JavaScript calls: a text goes in, a text comes out |
//! | `question` | the questions that the page can ask |
//! | `trace` | every critical path of a ring, with its corners |
//! | `run` | a scene under a firing method: readings, figures, who fooled whom |
//! | `paste` | the crosstalk in a pasted log, as reported by `eeruf logs` |
//! | `design` | the shortest period for a ring, its proof, its certificate, its source texts |

mod design;
mod exports;
mod paste;
mod progress;
mod question;
mod run;
mod trace;
