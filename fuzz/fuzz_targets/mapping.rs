//! Any text as a mapping file with its tables.
#![no_main]

#[path = "../checks/mapping.rs"]
mod check;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| check::check(bytes));
