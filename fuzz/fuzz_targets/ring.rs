#![no_main]

libfuzzer_sys::fuzz_target!(|input: eeruf_fuzz::ring::Input| eeruf_fuzz::ring::check(&input));
