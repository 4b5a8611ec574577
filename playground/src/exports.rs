//! Calls from JavaScript. JavaScript reserves room for a question, writes the question there, and asks; the answer is
//! at [`answer_at`]. Both are JSON in UTF-8.

use std::cell::RefCell;

use crate::question;

thread_local! {
    static QUESTION: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Reserves room for a question of this many bytes, valid until the next call.
// SAFETY: no other function in this module has this name; likewise for the other two.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn reserve(bytes: usize) -> *mut u8 {
    QUESTION.with_borrow_mut(|question| {
        question.clear();
        question.resize(bytes, 0);
        question.as_mut_ptr()
    })
}

/// Answers the question. Returns the length of the answer in bytes.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn ask() -> usize {
    let question = QUESTION.take();
    let answer = question::answer(&question);
    let bytes = answer.len();
    ANSWER.set(answer);
    bytes
}

/// Returns the address of the answer; valid until the next call.
#[unsafe(no_mangle)]
pub(crate) extern "C" fn answer_at() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.as_ptr())
}
