//! The worst stack of each public function of a ring, over all its calls: the compiler gives the size of each frame,
//! the disassembly the calls.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Result, anyhow};

use super::{BOARDS, Board, cargo, image, llvm};
use crate::toolchain::is_debian;

/// The functions of a ring of two phases, as the measured program exports them.
pub(super) const RING: [&str; 8] = [
    "ring_disable",
    "ring_echo",
    "ring_enable",
    "ring_new",
    "ring_next_deadline",
    "ring_poll",
    "ring_restart",
    "ring_stuck",
];

/// The functions of a flow ring whose stack is printed.
pub(super) const FLOW_RING: [&str; 2] = ["ring_restart", "ring_poll"];

/// Target of a call through a pointer.
const POINTER: &str = "a function by its pointer";

/// Returns true if stacks can be read: in Thumb code.
pub(super) fn is_read_on(board: &Board) -> bool {
    BOARDS[..2].iter().any(|known| known.name == board.name)
}

/// Returns the worst stack of each function of a program, in bytes.
pub(super) fn stack<const N: usize>(
    board: &Board,
    program: &str,
    functions: [&'static str; N],
) -> Result<[(&'static str, u64); N]> {
    // Rustup's core does not state its frames; if core was built here, all frames must be known.
    let all_known = is_debian(&cargo(board)?);
    let image = image(board, program)?;
    let calls = Program::new(
        &llvm("readelf", &["--stack-sizes"], &image)?,
        &llvm("objdump", &["-d", "--no-show-raw-insn"], &image)?,
        all_known,
    );
    let mut worst = functions.map(|name| (name, 0));
    for (name, bytes) in &mut worst {
        *bytes = calls.worst(name, 0).map_err(|why| anyhow!("{}, {program}: {why}", board.name))?;
    }
    Ok(worst)
}

/// Frames and calls of a program.
struct Program {
    frames: BTreeMap<String, u64>,
    calls: BTreeMap<String, BTreeSet<String>>,
    all_known: bool,
}

impl Program {
    /// Parses the output of `readelf --stack-sizes` and `objdump -d`.
    fn new(sizes: &str, disassembly: &str, all_known: bool) -> Self {
        let mut frames = BTreeMap::new();
        for line in sizes.lines() {
            if let Some((bytes, names)) = line.trim().split_once(char::is_whitespace)
                && let Ok(bytes) = bytes.parse::<u64>()
            {
                frames.extend(names.trim().split(", ").map(|name| (name.to_owned(), bytes)));
            }
        }
        let mut calls: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        let mut caller = String::new();
        for line in disassembly.lines() {
            if let Some(name) = line.strip_suffix(">:").and_then(|line| line.split_once('<')) {
                name.1.clone_into(&mut caller);
                continue;
            }
            let mut add = |callee: &str| calls.entry(caller.clone()).or_default().insert(callee.to_owned());
            let mut words = line.split_whitespace().skip_while(|word| word.ends_with(':'));
            if words.next() == Some("blx") && words.next().is_some_and(|to| !to.starts_with("0x")) {
                add(POINTER);
                continue;
            }
            // A branch within a function has an offset; to another one it is a call.
            let Some((_, callee)) = line.rsplit_once('<') else { continue };
            let callee = callee.split_once('>').map_or(callee, |(callee, _)| callee);
            if !callee.contains('+') && callee != caller {
                add(callee);
            }
        }
        Self { frames, calls, all_known }
    }

    /// Follows the calls, which form a tree since core has no recursion; a path that is too deep means recursion.
    fn worst(&self, name: &str, depth: u32) -> Result<u64, String> {
        if depth > 64 {
            return Err(format!("{name} calls itself"));
        }
        let frame = match self.frames.get(name) {
            Some(&frame) => frame,
            None if depth == 0 => return Err(format!("the program has no function {name}")),
            None if self.all_known || name == POINTER => return Err(format!("of {name} the stack is not known")),
            None => 0,
        };
        let mut below = 0;
        for callee in self.calls.get(name).into_iter().flatten() {
            below = self.worst(callee, depth + 1).map_err(|why| format!("{why}, called by {name}"))?.max(below);
        }
        Ok(frame + below)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES: &str =
        "Stack Sizes:\n         Size     Functions\n           24     ring_poll\n           16     push, add\n";

    fn calls(instruction: &str) -> String {
        format!(
            "00000100 <ring_poll>:\n     100: push\t{{r4, lr}}\n     102: {instruction}\n\
             00000200 <push>:\n     200: bx\tlr\n"
        )
    }

    #[test]
    fn a_stack_is_the_deepest_path_of_frames() {
        let program = Program::new(SIZES, &calls("bl\t0x200 <push>"), true);
        assert_eq!(program.worst("ring_poll", 0), Ok(40));
        assert_eq!(Program::new(SIZES, &calls("b\t0x104 <ring_poll+0x4>"), true).worst("ring_poll", 0), Ok(24));
    }

    #[test]
    fn what_is_not_there_or_not_known_or_called_by_a_pointer_fails() {
        let program = |call: &str, all_known| Program::new(SIZES, &calls(call), all_known).worst("ring_poll", 0);
        assert_eq!(
            Program::new(SIZES, "", true).worst("ring_stop", 0).unwrap_err(),
            "the program has no function ring_stop"
        );
        let unknown = program("bl\t0x300 <__aeabi_uidiv>", true);
        assert_eq!(unknown.unwrap_err(), "of __aeabi_uidiv the stack is not known, called by ring_poll");
        assert_eq!(program("bl\t0x300 <__aeabi_uidiv>", false), Ok(24));
        assert!(program("blx\tr3", false).unwrap_err().contains(POINTER));
        assert!(
            Program::new(SIZES, "<push>:\n  bl 0x1 <add>\n<add>:\n  bl 0x2 <push>\n", true).worst("push", 0).is_err()
        );
    }
}
