//! The sample of `c/zephyr` on this machine: compiled against declarations of our own, with the pins of its overlay,
//! and run for two minutes of simulated time among HC-SR04 modules. CI cannot install Zephyr itself.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::steps::{Trouble, run};

const SAMPLE: &str = "c/zephyr/samples/ring";
const STRICT: [&str; 10] = [
    "-std=c17",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-pedantic",
    "-Wconversion",
    "-Wshadow",
    "-Ic",
    "-Ic/tests/zephyr/include",
    "-Itarget/c/zephyr",
];

/// Compiles the sample for this machine and for a Cortex-M4, and runs it.
pub(crate) fn sample() -> Result<(), Trouble> {
    let target = Path::new("target/c/zephyr");
    let failed = |error: std::io::Error| Trouble::Failed(error.to_string());
    fs::create_dir_all(target).map_err(failed)?;
    let overlay = fs::read_to_string(format!("{SAMPLE}/boards/nucleo_f401re.overlay")).map_err(failed)?;
    let header = overlay_header(&overlay).map_err(|why| Trouble::Failed(format!("overlay of {SAMPLE}: {why}")))?;
    fs::write(target.join("overlay.h"), header).map_err(failed)?;
    let main = format!("{SAMPLE}/src/main.c");
    let compile = ["-Dmain=sample_main", "-c", &main, "-o"];
    let board = ["-mcpu=cortex-m4", "-mthumb", "-Os"];
    run(Command::new("arm-none-eabi-gcc").args(board).args(STRICT).args(compile).arg(target.join("sample-m4.o")))?;
    let watched = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    let object = target.join("sample.o");
    run(Command::new("gcc").args(watched).args(STRICT).args(compile).arg(&object))?;
    let program = target.join("ring");
    let sources = ["c/tests/zephyr/board.c", "c/eeruf.c", "-o"];
    run(Command::new("gcc").args(watched).args(STRICT).arg(&object).args(sources).arg(&program))?;
    run(&mut Command::new(program))
}

/// The macros that stand for the devicetree: a specification of each pin, and the list of them.
fn overlay_header(overlay: &str) -> Result<String, String> {
    let mut header = "#include <zephyr/device.h>\nextern const struct device ports[8];\n".to_owned();
    for list in ["trigger_gpios", "echo_gpios"] {
        let property = list.replace('_', "-");
        let (_, cells) = overlay.split_once(&format!("{property} =")).ok_or(format!("no {property}"))?;
        let (cells, _) = cells.split_once(';').ok_or(format!("{property} does not end"))?;
        let mut names = Vec::new();
        for (index, cell) in cells.split(',').enumerate() {
            let words = cell.trim().trim_matches(['<', '>']).split_whitespace().collect::<Vec<_>>();
            let ["&gpioa" | "&gpiob" | "&gpioc", pin, flags] = words[..] else {
                return Err(format!("{property}: {cell}; expected a port, a pin and flags"));
            };
            let port = words[0].as_bytes()[5] - b'a';
            _ = writeln!(header, "#define PIN_{list}_{index} {{&ports[{port}], {pin}, {flags}}}");
            names.push(format!("macro(node, {list}, {index})"));
        }
        let names = names.join(" separator ");
        _ = writeln!(header, "#define OVERLAY_{list}(node, macro, separator) {names}");
    }
    Ok(header)
}
