//! Compiles the C library, with the flat functions through which Rust calls it.

fn main() {
    let (c, shim) = ("../../c", "src/shim.c");
    for file in [&format!("{c}/eeruf.c"), &format!("{c}/eeruf.h"), &format!("{c}/eeruf_serial.h"), shim] {
        println!("cargo::rerun-if-changed={file}");
    }
    cc::Build::new()
        .std("c99")
        .include(c)
        .files([&format!("{c}/eeruf.c"), shim])
        .flag("-pedantic")
        .flag("-Wconversion")
        .warnings_into_errors(true)
        .compile("eeruf");
}
