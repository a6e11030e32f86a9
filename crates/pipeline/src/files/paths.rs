//! Paths: how they are told, and the way from one to another.

use serde::Serializer;
use std::borrow::Cow;
use std::path::{Component, Path, PathBuf};

/// A path as JSON: text, with a mark for each byte that is none. For reports, which nobody reads back.
///
/// # Errors
/// The serialiser's.
pub fn as_text<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}

/// Several paths as JSON.
///
/// # Errors
/// The serialiser's.
pub fn as_texts<S: Serializer>(paths: &[PathBuf], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(paths.iter().map(|path| path.display().to_string()))
}

/// A word as a shell takes it. No shell can take a zero byte, and none is given one.
pub fn quoted(word: &str) -> String {
    shlex::try_quote(&word.replace('\0', "")).map_or_else(|_| word.to_owned(), Cow::into_owned)
}

/// The way from a folder to a file; the path as it is where there is none.
pub fn from_folder(folder: &Path, path: &Path) -> PathBuf {
    let (Ok(folder), Ok(path)) = (std::fs::canonicalize(folder), std::fs::canonicalize(path)) else {
        return path.to_owned();
    };
    let shared = folder.components().zip(path.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        // Another drive.
        return path;
    }
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(path.components().skip(shared)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_from_a_folder_goes_up_and_down() {
        let place = tempfile::tempdir().unwrap();
        let (suite, file) = (place.path().join("a/suite"), place.path().join("b/mine.toml"));
        std::fs::create_dir_all(&suite).unwrap();
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, "").unwrap();
        assert_eq!(from_folder(&suite, &file), Path::new("../../b/mine.toml"));
        assert_eq!(from_folder(&suite, Path::new("nowhere/x")), Path::new("nowhere/x"));
    }
}
