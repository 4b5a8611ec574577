//! The C library in `c/` and its users: strict compilers, misuse by callers, the sample for Zephyr, equality with the
//! Rust crates under sanitizers, MicroPython's class.

use std::fmt::Write as _;
use std::path::{Path, absolute};
use std::process::{Command, Stdio};

use anyhow::{Context as _, Result, bail, ensure};
use fs_err as fs;

use crate::steps::{empty, need, output, run};

const STRICT: [&str; 7] = ["-Wall", "-Wextra", "-Werror", "-pedantic", "-Wconversion", "-Wshadow", "-Ic"];
/// Compilers, and the languages as which each compiles the library.
const COMPILERS: [(&str, &[&str]); 7] = [
    ("gcc", &["-std=c99"]),
    ("gcc", &["-std=c17"]),
    ("g++", &["-xc++", "-std=c++11"]),
    ("g++", &["-xc++", "-std=c++20"]),
    ("avr-gcc", &["-mmcu=atmega328p", "-std=c99"]),
    ("avr-g++", &["-mmcu=atmega328p", "-xc++", "-std=gnu++11"]),
    ("arm-none-eabi-gcc", &["-mcpu=cortex-m0", "-mthumb", "-std=c99"]),
];
const SANITIZERS: [&str; 3] = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
/// The sample of `c/zephyr`.
const SAMPLE: &str = "c/zephyr/samples/ring";
/// Folder of MicroPython's class and its tests.
const MICROPYTHON: &str = "c/micropython";

pub(crate) fn c() -> Result<()> {
    need("g++ --version", "apt install g++")?;
    need("avr-g++ --version", "apt install gcc-avr avr-libc")?;
    need("arm-none-eabi-gcc --version", "apt install gcc-arm-none-eabi libnewlib-arm-none-eabi")?;
    let target = Path::new("target/c");
    fs::create_dir_all(target.join("zephyr"))?;
    let object = target.join("eeruf.o");
    for (compiler, language) in COMPILERS {
        run(Command::new(compiler).args(language).args(STRICT).args(["-Os", "-c", "c/eeruf.c", "-o"]).arg(&object))?;
    }
    run(Command::new("gcc").args(STRICT).args(["-std=c99", "-c", "c/examples/flow.c", "-o"]).arg(&object))?;
    for (compiler, language) in &COMPILERS[..4] {
        let program = target.join("misuse");
        let sources = ["c/tests/misuse.c", "c/eeruf.c", "-o"];
        run(Command::new(compiler).args(*language).args(STRICT).args(SANITIZERS).args(sources).arg(&program))?;
        run(&mut Command::new(program))?;
    }
    package(&target.join("package"))?;
    sample(&target.join("zephyr"))?;
    esphome(&target.join("esphome"))?;
    equal_under_sanitizers()
}

/// Installs the library with an option of its own, and builds an example by `find_package`, from the checkout and by
/// pkg-config: each must see the option's value.
fn package(target: &Path) -> Result<()> {
    need("cmake --version", "apt install cmake pkg-config")?;
    empty(target)?;
    let (built, prefix) = (target.join("built"), absolute(target.join("prefix"))?);
    let cmake = |arguments: &[&str], folder: &Path| output(Command::new("cmake").args(arguments).arg(folder));
    let configured = |source: &str, folder: &Path, more: &[String]| {
        run(Command::new("cmake").args(["-S", source, "-B"]).arg(folder).args(more).stdout(Stdio::null()))
    };
    let prefixed = |key: &str| format!("-D{key}={}", prefix.display());
    configured(
        "c",
        &built,
        &[prefixed("CMAKE_INSTALL_PREFIX"), "-DCMAKE_INSTALL_LIBDIR=lib".to_owned(), "-DEERUF_FIRINGS=6".to_owned()],
    )?;
    cmake(&["--build"], &built)?;
    cmake(&["--install"], &built)?;
    for (name, more, expected) in [("installed", vec![prefixed("CMAKE_PREFIX_PATH")], "=6"), ("checkout", vec![], "=4")]
    {
        let folder = target.join(name);
        configured("c/examples", &folder, &more)?;
        let said = output(Command::new("cmake").arg("--build").arg(&folder).arg("--verbose"))?;
        ensure!(said.contains(&format!("EERUF_FIRINGS{expected}")), "{name}: {said}");
    }
    let mut pkg_config = Command::new("pkg-config");
    let found =
        output(pkg_config.args(["--cflags", "--libs", "eeruf"]).env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig")))?;
    ensure!(found.contains("-DEERUF_FIRINGS=6"), "{found}");
    run(Command::new("gcc").arg("c/examples/flow.c").args(found.split_whitespace()).arg("-o").arg(target.join("flow")))
}

/// The sample for Zephyr on this machine: compiled against declarations of our own, with the pins of its overlay, also
/// for a Cortex-M4, and run for two minutes of simulated time among HC-SR04 modules. CI cannot install Zephyr itself.
fn sample(target: &Path) -> Result<()> {
    let overlay = fs::read_to_string(format!("{SAMPLE}/boards/nucleo_f401re.overlay"))?;
    fs::write(target.join("overlay.h"), overlay_header(&overlay).with_context(|| format!("overlay of {SAMPLE}"))?)?;
    let gcc = |compiler: &str, more: &[&str]| {
        let mut gcc = Command::new(compiler);
        gcc.args(more).args(STRICT).args(["-std=c17", "-Ic/tests/zephyr/include", "-Itarget/c/zephyr"]);
        gcc
    };
    let main = format!("{SAMPLE}/src/main.c");
    let compile = ["-Dmain=sample_main", "-c", &main, "-o"];
    let board = ["-mcpu=cortex-m4", "-mthumb", "-Os"];
    run(gcc("arm-none-eabi-gcc", &board).args(compile).arg(target.join("sample-m4.o")))?;
    let (object, program) = (target.join("sample.o"), target.join("ring"));
    run(gcc("gcc", &SANITIZERS).args(compile).arg(&object))?;
    run(gcc("gcc", &SANITIZERS).arg(&object).args(["c/tests/zephyr/board.c", "c/eeruf.c", "-o"]).arg(&program))?;
    run(&mut Command::new(program))
}

/// Tests the component in `ESPHome`; the test replaces the clock and the pins of the host platform.
fn esphome(target: &Path) -> Result<()> {
    let python = crate::python::environment(&target.join("python"), &["esphome==2026.6.5"])?;
    let mut test = Command::new("sh");
    test.arg("c/tests/esphome/test.sh").arg(target).arg(absolute(python.with_file_name("esphome"))?);
    run(test.arg(crate::toolchain::program()?))
}

/// The macros that replace the devicetree: a specification of each pin, and the list of them.
fn overlay_header(overlay: &str) -> Result<String> {
    let mut header = "#include <zephyr/device.h>\nextern const struct device ports[8];\n".to_owned();
    for list in ["trigger_gpios", "echo_gpios"] {
        let property = list.replace('_', "-");
        let (_, cells) = overlay.split_once(&format!("{property} =")).with_context(|| format!("no {property}"))?;
        let (cells, _) = cells.split_once(';').with_context(|| format!("{property} does not end"))?;
        let mut names = Vec::new();
        for (index, cell) in cells.split(',').enumerate() {
            let words = cell.trim().trim_matches(['<', '>']).split_whitespace().collect::<Vec<_>>();
            let ["&gpioa" | "&gpiob" | "&gpioc", pin, flags] = words[..] else {
                bail!("{property}: {cell}; expected a port, a pin and flags");
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

/// Compares C and Rust by `eeruf-c-equal`, with sanitizers on the C side.
fn equal_under_sanitizers() -> Result<()> {
    let host = output(Command::new("rustc").args(["--print", "host-tuple"]))?;
    let asan = output(Command::new("gcc").arg("-print-file-name=libasan.so"))?;
    // A target is named so that build scripts are built as usual. The sanitizer must be loaded before everything else.
    let runner = format!("CARGO_TARGET_{}_RUNNER", host.to_uppercase().replace('-', "_"));
    run(Command::new("cargo")
        .args(["test", "--quiet", "--locked", "--package", "eeruf-c-equal", "--target", &host, "--tests"])
        .args(["--target-dir", "target/c/sanitized"])
        .env("CFLAGS", SANITIZERS.join(" "))
        .env("RUSTFLAGS", "-Clink-arg=-lasan -Clink-arg=-lubsan")
        .env(runner, format!("env LD_PRELOAD={asan}")))
}

/// Compares `c/micropython/` with the corpus that a test of the core writes, on simulated modules and with faults of a
/// line, in MicroPython's WebAssembly build and in CPython.
pub(crate) fn micropython() -> Result<()> {
    need("node --version", "apt install nodejs")?;
    fs::create_dir_all("target")?;
    // Cargo runs tests in the folder of their package. All of them are built, as they are for `cargo test`.
    let corpus = absolute("target/corpus.txt")?;
    run(Command::new("cargo")
        .args(["test", "--quiet", "--locked", "--workspace", "--test", "all", "corpus_matches_golden"])
        .env("EERUF_CORPUS", &corpus))?;
    let python = |test: &str| {
        let mut python = Command::new("python3");
        python.current_dir(MICROPYTHON).args(["-B", test]);
        python
    };
    run(python("test_corpus.py").arg(&corpus))?;
    run(&mut python("test_modules.py"))?;
    run(&mut python("test_line_faults.py"))?;
    npm(MICROPYTHON, "ci --ignore-scripts --no-audit --no-fund")?;
    npm(MICROPYTHON, "run --silent test -- ../../target/corpus.txt")
}

/// Runs npm in a folder.
pub(crate) fn npm(folder: &str, words: &str) -> Result<()> {
    let npm = if cfg!(windows) { "npm.cmd" } else { "npm" };
    need(&format!("{npm} --version"), "apt install npm")?;
    run(Command::new(npm).current_dir(folder).args(words.split(' ')))
}
