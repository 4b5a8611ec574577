//! Chooses the board for the target: passes its name as a `cfg` and its memory map to the linker.

use std::path::PathBuf;
use std::{env, fs};

const ARM_INTERRUPTS: &str =
    "PROVIDE(ALARM = DefaultHandler);\nPROVIDE(ECHO = DefaultHandler);\nPROVIDE(SPARE = DefaultHandler);\n";

fn main() {
    let target = env::var("TARGET").expect("cargo sets TARGET");
    let (board, memory) = match target.as_str() {
        "thumbv6m-none-eabi" => ("microbit", arm("0x00000000, LENGTH = 256K", "0x20000000, LENGTH = 16K")),
        "thumbv7m-none-eabi" => ("lm3s6965", arm("0x00000000, LENGTH = 256K", "0x20000000, LENGTH = 64K")),
        "thumbv7em-none-eabihf" => ("an386", arm("0x00000000, LENGTH = 4M", "0x20000000, LENGTH = 4M")),
        "riscv32imac-unknown-none-elf" => ("rv_virt", RISC_V.to_owned()),
        _ => panic!("no board for the target {target}; expected one of the four in firmware/.cargo/config.toml"),
    };
    println!("cargo::rustc-check-cfg=cfg(board, values(\"microbit\", \"lm3s6965\", \"an386\", \"rv_virt\"))");
    println!("cargo::rustc-cfg=board=\"{board}\"");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join("memory.x"), memory).expect("OUT_DIR can be written");
    fs::write(out.join("device.x"), ARM_INTERRUPTS).expect("OUT_DIR can be written");
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rerun-if-changed=build.rs");
}

fn arm(flash: &str, ram: &str) -> String {
    format!("MEMORY\n{{\n  FLASH : ORIGIN = {flash}\n  RAM : ORIGIN = {ram}\n}}\n")
}

const RISC_V: &str = "MEMORY
{
  FLASH : ORIGIN = 0x80000000, LENGTH = 4M
  RAM : ORIGIN = 0x80400000, LENGTH = 4M
}
REGION_ALIAS(\"REGION_TEXT\", FLASH);
REGION_ALIAS(\"REGION_RODATA\", FLASH);
REGION_ALIAS(\"REGION_DATA\", RAM);
REGION_ALIAS(\"REGION_BSS\", RAM);
REGION_ALIAS(\"REGION_HEAP\", RAM);
REGION_ALIAS(\"REGION_STACK\", RAM);
";
