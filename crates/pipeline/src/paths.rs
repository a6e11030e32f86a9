//! Paths: which ones a command reads, and how they are told.

use crate::error::PipelineError;
use crate::external::{EGO_COMMAND_PREFIX, EgoCommand};
use crate::options::{Options, RecordSource, quoted};
use crate::profiles::PROFILE_NAMES;
use serde::Serializer;
use std::path::{Component, Path, PathBuf};

/// Files that a profile and an ego are read from: none for what is built in.
pub fn of_profile_and_ego(profile: Option<&str>, ego: Option<&str>) -> Vec<PathBuf> {
    let profile = profile.filter(|name| !PROFILE_NAMES.contains(name)).map(PathBuf::from);
    let command = ego.and_then(|ego| EgoCommand::parse(ego).ok().flatten());
    let words = command.into_iter().flat_map(|command| std::iter::once(command.program).chain(command.arguments));
    profile.into_iter().chain(words.map(PathBuf::from)).collect()
}

/// Refuses options with a path that a suite file cannot hold.
///
/// # Errors
/// A path is not UTF-8.
pub fn must_be_text(options: &Options) -> Result<(), PipelineError> {
    let records: &[PathBuf] = match &options.records {
        RecordSource::Sample => &[],
        RecordSource::Files(files) => files,
    };
    let all = records.iter().chain(&options.mapping).chain(&options.model_dir);
    match all.into_iter().find(|path| path.to_str().is_none()) {
        None => Ok(()),
        Some(path) => Err(PipelineError::bad_input(format!(
            "{}: the path is not UTF-8, and a suite keeps its paths as text; rename it, or use a link with another name",
            path.display()
        ))),
    }
}

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

/// A profile as it is named from a folder.
pub fn profile_from_folder(folder: &Path, profile: &str) -> String {
    if PROFILE_NAMES.contains(&profile) {
        return profile.to_owned();
    }
    from_folder(folder, Path::new(profile)).display().to_string()
}

/// An ego as it is named from a folder: of a program, the words that are files.
pub fn ego_from_folder(folder: &Path, ego: &str) -> String {
    let Ok(Some(command)) = EgoCommand::parse(ego) else { return ego.to_owned() };
    let word = |word: &String, is_program: bool| {
        // A program without a folder is looked for where the system has its programs.
        let is_path = !is_program || Path::new(word).components().count() > 1;
        let path = Path::new(word);
        if is_path && path.is_relative() && path.exists() {
            from_folder(folder, path).display().to_string()
        } else {
            word.clone()
        }
    };
    let arguments = command.arguments.iter().map(|argument| word(argument, false));
    let words: Vec<String> = std::iter::once(word(&command.program, true)).chain(arguments).collect();
    if words[1..] == command.arguments && words[0] == command.program {
        return ego.to_owned();
    }
    let quoted: Vec<String> = words.iter().map(|word| quoted(word)).collect();
    format!("{EGO_COMMAND_PREFIX}{}", quoted.join(" "))
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
