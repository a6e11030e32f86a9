//! Any bytes as a crash file.
#![no_main]

#[path = "../checks/crash_file.rs"]
mod check;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| check::check(bytes));
