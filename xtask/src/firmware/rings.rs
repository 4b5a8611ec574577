//! Each file of `rings/` as firmware has it: emitted for C and for Arduino, by its table and as it is recommended,
//! built for a Cortex-M3, and run there until each sensor has fired and had its wall accepted.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::{Board, qemu};
use crate::steps::{Trouble, output, run};

const FOLDER: &str = "firmware/target/rings";
/// Forms, and the names of the table, of the settings of flow, and of those of the modules.
const FORMS: [[&str; 4]; 2] =
    [["c", "eeruf_schedule", "eeruf_flow_config", "EERUF_MODULES"], ["arduino", "RING", "RING", "RING_MODULES"]];
const COMPILER: &str = "arm-none-eabi-gcc";
const OPTIONS: [&str; 9] = [
    "-mcpu=cortex-m3",
    "-mthumb",
    "-Os",
    "-ffunction-sections",
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-Wno-unused",
];

pub(super) fn start(board: &Board) -> Result<(), Trouble> {
    let failed = |error: std::io::Error| Trouble::Failed(format!("{FOLDER}: {error}"));
    fs::create_dir_all(FOLDER).map_err(failed)?;
    // Arduino's class is not what is tried, but the table and the library below it.
    fs::write(Path::new(FOLDER).join("EerufArduino.h"), "#include \"eeruf.h\"\n").map_err(failed)?;
    let objects = ["c/eeruf.c", "c/examples/lm3s6965.c"].map(|source| (source, format!("{FOLDER}/{}.o", stem(source))));
    for (source, object) in &objects {
        run(Command::new(COMPILER).args(OPTIONS).args(["-c", source, "-Ic", "-o", object]))?;
    }
    let program = crate::program::program()?;
    let (mut started, mut flow) = (0, 0);
    for entry in fs::read_dir("rings").map_err(failed)? {
        let file = entry.map_err(failed)?.path();
        let name = stem(&file.to_string_lossy());
        // Those of the paper are tables already.
        if name.starts_with("table-") {
            continue;
        }
        for way in ["--period-only", "--places=1"] {
            for [form, table, config, modules] in FORMS {
                let what = format!("{}: {way} --emit {form}", file.display());
                let mut design = Command::new(&program);
                design.arg("design").arg(&file).args(["--no-atlas", way, "--emit", form]);
                let emitted = output(&mut design).ok_or_else(|| Trouble::Failed(format!("{what} failed")))? + "\n";
                let header = Path::new(FOLDER).join("ring.h");
                fs::write(&header, &emitted).map_err(failed)?;
                let flows = emitted.contains("EerufFlowConfig");
                let mut build = Command::new(COMPILER);
                build.args(OPTIONS).args(["-Ic", "-I", FOLDER, "-DTABLE=\"ring.h\""]);
                build.arg(if flows { format!("-DFLOW={config}") } else { format!("-DSCHEDULE={table}") });
                for (macro_name, constant) in [("SETTINGS", modules), ("CONFIG", "EERUF_RING_CONFIG")] {
                    if emitted.contains(constant) {
                        build.arg(format!("-D{macro_name}={constant}"));
                    }
                }
                let image = format!("{FOLDER}/ring.elf");
                build.arg("tests/claims/emitted/start.c").args(objects.iter().map(|(_, object)| object));
                build.args(["-nostartfiles", "--specs=rdimon.specs", "-T", "c/examples/lm3s6965.ld"]);
                run(build.args(["-Wl,--gc-sections", "-o", &image]))?;
                qemu(board, Path::new(&image), 6).map_err(|error| match error {
                    Trouble::Failed(why) => Trouble::Failed(format!("{what}: {why}")),
                    skipped => skipped,
                })?;
                (started, flow) = (started + 1, flow + u32::from(flows));
            }
        }
    }
    println!("rings/: {started} emitted rings started on {}, {flow} of them by flow", board.name);
    if started < 32 || flow < 8 {
        return Err(Trouble::Failed(format!("{started} rings started, {flow} by flow; expected 32 and 8 at least")));
    }
    Ok(())
}

fn stem(path: &str) -> String {
    Path::new(path).file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}
