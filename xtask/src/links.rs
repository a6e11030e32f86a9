//! Links of pages that lead nowhere. Units stand in brackets, such as [m/s], and rustdoc takes them for links: of its warnings those count
//! that are of a link as it is written here, in backticks or with a path.

use crate::steps::Result;
use std::process::Command;

/// Runs rustdoc, and shows what it says of anything but units.
///
/// # Errors
/// It fails, or a link leads nowhere.
pub fn checked(rustdoc: &mut Command) -> Result {
    rustdoc.args(["--force-warn", "rustdoc::broken_intra_doc_links"]);
    let said = rustdoc.output().map_err(|error| format!("cannot start {:?}: {error}", rustdoc.get_program()))?;
    let text = String::from_utf8_lossy(&said.stderr);
    let worth: Vec<&str> = text.split("\n\n").filter(|block| !is_of_units(block)).collect();
    worth.iter().for_each(|block| eprintln!("{block}\n"));
    let broken = worth.iter().filter(|block| link(block).is_some()).count();
    match (said.status.success(), broken) {
        (true, 0) => Ok(()),
        (true, broken) => Err(format!("{broken} links of pages lead nowhere")),
        (false, _) => Err(format!("{rustdoc:?} ended with {}", said.status)),
    }
}

/// The link that this part of rustdoc's words calls broken.
fn link(block: &str) -> Option<&str> {
    block.split_once("unresolved link to `")?.1.split('`').next()
}

/// Whether it says no more than that a unit is no link, or how many warnings there were.
fn is_of_units(block: &str) -> bool {
    let counts = block.trim_start().starts_with("warning: ") && block.trim_end().ends_with("emitted");
    let unit = |link: &str| !link.contains("::") && !block.contains(&format!("[`{link}"));
    block.trim().is_empty() || counts || link(block).is_some_and(unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_count_and_units_do_not() {
        let said = |link: &str, line: &str| {
            format!("warning: unresolved link to `{link}`\n --> a.rs:1:2\n  |\n1 | /// {line}\n")
        };
        assert!(is_of_units(&said("m/s", "How fast. [m/s]")));
        assert!(!is_of_units(&said("Suite::run_stage", "[`Suite::run_stage`] runs one.")));
        assert!(!is_of_units(&said("gone", "[`gone`] is not here.")));
        assert!(!is_of_units(&said("crate::gone", "[this](crate::gone) is not here.")));
        assert!(!is_of_units("warning: unclosed HTML tag `b`\n --> a.rs:1:2"));
        assert!(is_of_units("warning: 2 warnings emitted\n"));
    }
}
