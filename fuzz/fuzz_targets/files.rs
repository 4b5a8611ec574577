#![no_main]

libfuzzer_sys::fuzz_target!(|input: eeruf_fuzz::files::Input| eeruf_fuzz::files::check(&input));
