#![no_main]

libfuzzer_sys::fuzz_target!(|input: eeruf_fuzz::flow::Input| eeruf_fuzz::flow::check(&input));
