//! What the fuzz targets check, once over every input of theirs: the short run of fuzzing that every build does.

#[path = "../../../../fuzz/checks/crash_file.rs"]
mod crash_file;
#[path = "../../../../fuzz/checks/mapping.rs"]
mod mapping;

use recrash_testing::inputs::over_all;

#[test]
fn crash_files() {
    over_all("crash_file", crash_file::check);
}

#[test]
fn mapping_files() {
    over_all("mapping", mapping::check);
}
