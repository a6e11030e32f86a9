//! Any text as an OpenSCENARIO file.
#![no_main]

#[path = "../checks/openscenario.rs"]
mod check;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| check::check(bytes));
