#![no_main]

libfuzzer_sys::fuzz_target!(|firings: eeruf_fuzz::filter::Firings| eeruf_fuzz::filter::check(&firings));
