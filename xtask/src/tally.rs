//! Counts of tests, read from what the runners print, and the tests that were skipped, by name.

use std::collections::BTreeSet;

/// How the line of a step begins that is skipped.
const STEP_SKIPPED: &str = "step skipped: ";

/// What was run so far.
#[derive(Debug, Default)]
pub struct Tally {
    /// Tests that did what they promise. A Rust test that is skipped counts here too, because its runner calls it passed.
    called_passed: usize,
    failed: usize,
    /// Rust tests that are skipped.
    skipped_in_rust: BTreeSet<String>,
    /// What else is skipped: tests in Python, and whole steps.
    skipped_elsewhere: BTreeSet<String>,
}

impl Tally {
    /// Takes one line of a runner's output: of `cargo test`, whose skipped tests tell so on a line of their own
    /// (`recrash_testing::skip`), of pytest with the plugin `tests/plugin/counted.py`, or of a step that is skipped.
    pub fn read(&mut self, line: &str) {
        if let Some(skipped) = line.strip_prefix("skipped: ") {
            self.skipped_in_rust.insert(skipped.to_owned());
        } else if let Some(skipped) = line.strip_prefix("pytest skipped: ") {
            self.skipped_elsewhere.insert(skipped.to_owned());
        } else if let Some(skipped) = line.strip_prefix(STEP_SKIPPED) {
            self.skipped_elsewhere.insert(skipped.to_owned());
        } else if let Some((_, counts)) = line.split_once("test result: ") {
            self.called_passed += number_before(counts, " passed");
            self.failed += number_before(counts, " failed");
        } else if let Some(counts) = line.strip_prefix("pytest: ") {
            self.called_passed += number_before(counts, " passed");
            self.failed += number_before(counts, " failed");
        }
    }

    /// A step that cannot run here. Told in a line of its own too, for who runs the step in a process of its own.
    pub fn skip_step(&mut self, step: &str, why: &str) {
        let skipped = format!("the step {step} ({why})");
        println!("{STEP_SKIPPED}{skipped}");
        self.skipped_elsewhere.insert(skipped);
    }

    /// What was skipped, and the closing line.
    pub fn closing(&self) -> String {
        let skipped = self.skipped_in_rust.len() + self.skipped_elsewhere.len();
        let passed = self.called_passed.saturating_sub(self.skipped_in_rust.len());
        let mut text = String::new();
        if skipped > 0 {
            text += &format!("{skipped} skipped:\n");
        }
        for name in self.skipped_in_rust.iter().chain(&self.skipped_elsewhere) {
            text += &format!("  {name}\n");
        }
        text + &format!("{passed} passed, {} failed, {skipped} skipped", self.failed)
    }
}

/// The number that stands before a word: 12 in `ok. 12 passed; 0 failed`.
fn number_before(text: &str, word: &str) -> usize {
    let before = text.split(word).next().filter(|before| before.len() < text.len()).unwrap_or_default();
    before.rsplit(|c: char| !c.is_ascii_digit()).next().and_then(|digits| digits.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runners_are_summed_and_a_skipped_test_has_not_passed() {
        let mut tally = Tally::default();
        for line in [
            "test a::b ... ok",
            "skipped: records real_files::the_archive (needs ../shared)",
            "skipped: records real_files::the_archive (needs ../shared)",
            "test result: ok. 12 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.01s",
            "test result: FAILED. 3 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.01s",
            "pytest skipped: tests/test_a.py::test_b (needs esmini)",
            "pytest: 5 passed, 2 failed",
            "step skipped: the step python (there is no .venv)",
        ] {
            tally.read(line);
        }
        tally.skip_step("browser", "Chromium is not installed");
        let expected = "4 skipped:\n  records real_files::the_archive (needs ../shared)\n  \
            tests/test_a.py::test_b (needs esmini)\n  the step browser (Chromium is not installed)\n  \
            the step python (there is no .venv)\n19 passed, 3 failed, 4 skipped";
        assert_eq!(tally.closing(), expected);
    }

    #[test]
    fn nothing_run_is_nothing_passed() {
        assert_eq!(Tally::default().closing(), "0 passed, 0 failed, 0 skipped");
    }
}
