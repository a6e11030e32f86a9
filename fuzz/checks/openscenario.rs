//! What holds for any bytes given as an OpenSCENARIO file. Shared by the fuzz target and by a test over its corpus.

use recrash_export::{ExportOptions, Format, export, import};

/// Importing never panics; a file that is refused is refused with a reason; and what was read can be exported, and comes
/// back as the same.
pub fn check(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let read = match import(text) {
        Ok(read) => read.value,
        Err(problems) => return assert!(!problems.is_empty()),
    };
    let files =
        export(&read, None, &[], &ExportOptions::new(Format::OpenScenario)).expect("acting partners need no rollout");
    let file = files.iter().find(|file| file.name.ends_with(".xosc")).expect("a scenario");
    let again = import(std::str::from_utf8(&file.content).expect("text")).expect("what was written is read");
    assert_eq!(again.value.draft(), read.draft());
}
