//! The questions that the page asks, and the form of the answers.

use std::path::Path;

use eeruf_sim::{Method, World};
use serde::{Deserialize, Serialize};

use crate::{design, paste, run, trace};

#[derive(Deserialize)]
#[serde(tag = "ask", rename_all = "snake_case", deny_unknown_fields)]
enum Question {
    /// The firing methods.
    Methods {},
    /// Every critical path of the first robot's ring.
    Trace { scene: String },
    /// A scene under a method.
    Run { scene: String, method: String, periods: u32, shown_s: f64 },
    /// The shortest period for a ring.
    Design { ring: String },
    /// Lines of a serial monitor, or any other text with ranges.
    Paste { text: String },
    /// Changes that would make the period shorter.
    Faster { ring: String },
    /// The certificate that the period is the shortest, and its checker.
    Certificate { ring: String },
}

/// A method that can be run.
#[derive(Serialize)]
struct MethodAnswer {
    id: &'static str,
    does: String,
}

impl MethodAnswer {
    fn of(method: Method) -> Self {
        Self { id: method.as_str(), does: method.about() + "." }
    }
}

/// A result, or one sentence about the failure.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Answer<T> {
    Ok(T),
    Error(String),
}

/// Answers a question.
pub(crate) fn answer(question: &[u8]) -> String {
    match serde_json::from_slice(question) {
        Ok(Question::Methods {}) => json(Ok(Method::usual().map(MethodAnswer::of).collect::<Vec<_>>())),
        Ok(Question::Trace { scene }) => json(world(&scene).and_then(|world| trace::trace(&world))),
        Ok(Question::Run { scene, method, periods, shown_s }) => json(world(&scene).and_then(|world| {
            let method = method.parse().map_err(|error: eeruf_sim::UnknownMethod| error.to_string())?;
            run::run(&world, method, periods, shown_s)
        })),
        Ok(Question::Design { ring }) => json(design::design(&ring)),
        Ok(Question::Paste { text }) => json(paste::paste(&text)),
        Ok(Question::Faster { ring }) => json(design::faster(&ring)),
        Ok(Question::Certificate { ring }) => json(design::certificate(&ring)),
        Err(error) => json::<()>(Err(error.to_string())),
    }
}

fn json<T: Serialize>(answer: Result<T, String>) -> String {
    let answer = match answer {
        Ok(answer) => Answer::Ok(answer),
        Err(error) => Answer::Error(error),
    };
    // Named fields, numbers and strings always serialise.
    serde_json::to_string(&answer).unwrap_or_default()
}

/// Reads the world that a scene's text describes.
fn world(scene: &str) -> Result<World, String> {
    World::from_text(Path::new("scene"), scene).map_err(|error| error.message().to_owned())
}
