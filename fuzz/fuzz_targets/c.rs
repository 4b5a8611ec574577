#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| eeruf_fuzz::c::check(bytes));
