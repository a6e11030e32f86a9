//! What an external ego is made of: results of another program of the same name are other results.

use super::EgoCommand;
use crate::files::store::file_hash;
use std::path::{Path, PathBuf};

/// The command with a hash of the program's file and of every file among its arguments, so that a changed script counts as
/// another ego. What a program reads beside them is not known.
pub(crate) fn fingerprint(command: &EgoCommand) -> String {
    let program = on_path(&command.program);
    let files = program.iter().cloned().chain(command.arguments.iter().flat_map(|word| named_file(word)));
    let hashes = files.filter_map(|file| file_hash(&file));
    std::iter::once(command.as_str().to_owned()).chain(hashes).collect::<Vec<_>>().join(" ")
}

/// The program as the system finds it.
fn on_path(program: &str) -> Option<PathBuf> {
    let path = Path::new(program);
    if path.components().count() > 1 {
        return Some(path.to_owned());
    }
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders).map(|folder| folder.join(program)).find(|file| file.is_file())
}

/// The file that a word names: itself, or what stands behind `=`, as in `--policy=net.onnx`.
fn named_file(word: &str) -> Option<PathBuf> {
    let behind = word.split_once('=').map(|(_, value)| value);
    [Some(word), behind].into_iter().flatten().map(PathBuf::from).find(|file| file.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_script_is_another_ego() {
        let folder = tempfile::tempdir().unwrap();
        let script = folder.path().join("ego.py");
        let command = EgoCommand::parse(&format!("cmd:python3 '{}' --fast", script.display())).unwrap().unwrap();
        std::fs::write(&script, "a").unwrap();
        let first = fingerprint(&command);
        assert_eq!(first, fingerprint(&command));
        std::fs::write(&script, "b").unwrap();
        assert_ne!(first, fingerprint(&command));
        let option = EgoCommand::parse(&format!("cmd:ego --script={}", script.display())).unwrap().unwrap();
        assert_eq!(fingerprint(&option).split(' ').next_back().unwrap().len(), 64);
    }
}
