//! Helpers of the command's tests.

use assert_cmd::Command;

/// The command, with a budget small enough for a test where it makes suites.
pub fn recrash(arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("recrash").expect("the binary is built with its tests");
    command.args(arguments);
    command
}
