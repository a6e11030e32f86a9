//! What holds for any bytes given as a scenario file. Shared by the fuzz target and by a test over its corpus.

use recrash_model::Outcome;

/// Reading and checking never panic; what was read can be written and is read back as the same; and a draft that is
/// refused is refused with a reason.
pub fn check(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match recrash_roads::read_draft(text) {
        Ok(Outcome { value: draft, .. }) => {
            let again = recrash_roads::read_draft(&recrash_roads::write_draft(&draft));
            assert_eq!(again.map(|outcome| outcome.value).as_ref(), Ok(&draft));
            if let Err(problems) = recrash_roads::check(draft) {
                assert!(!problems.is_empty());
            }
        }
        Err(problems) => assert!(!problems.is_empty()),
    }
}
