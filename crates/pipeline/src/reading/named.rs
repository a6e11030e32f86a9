//! What a profile and an ego name on the disk.

use crate::files::paths::{from_folder, quoted};
use crate::profiles::PROFILE_NAMES;
use crate::simulators::external::{EGO_COMMAND_PREFIX, EgoCommand, PYTHON_PREFIX};
use std::path::{Path, PathBuf};

/// Files that a profile and an ego are read from: none for what is built in.
pub fn of_profile_and_ego(profile: Option<&str>, ego: Option<&str>) -> Vec<PathBuf> {
    let profile = profile.filter(|name| !PROFILE_NAMES.contains(name)).map(PathBuf::from);
    let command = ego.and_then(|ego| EgoCommand::parse(ego).ok().flatten());
    let words = command.into_iter().flat_map(|command| match command.python() {
        Some(ego) => ego.file().map(Path::to_owned).into_iter().collect::<Vec<_>>(),
        None => std::iter::once(command.program).chain(command.arguments).map(PathBuf::from).collect(),
    });
    profile.into_iter().chain(words).collect()
}

/// A profile as it is named from a folder.
pub fn profile_from_folder(folder: &Path, profile: &str) -> String {
    if PROFILE_NAMES.contains(&profile) {
        return profile.to_owned();
    }
    from_folder(folder, Path::new(profile)).display().to_string()
}

/// What stands before a command that is typed in a folder, so that Python finds there what it finds here: nothing for an ego that
/// is no class or function in Python.
pub fn python_path_from_folder(folder: &Path, ego: &str) -> Option<String> {
    EgoCommand::parse(ego).ok().flatten()?.python()?;
    let here = from_folder(folder, Path::new("."));
    let here = if here.as_os_str().is_empty() { PathBuf::from(".") } else { here };
    Some(format!("PYTHONPATH={}:$PYTHONPATH", quoted(&here.display().to_string())))
}

/// An ego as it is named from a folder: of a program, the words that are files; of a class or function in Python, its file where it
/// is named by that. A module keeps its name: see [`python_path_from_folder`].
pub fn ego_from_folder(folder: &Path, ego: &str) -> String {
    let Ok(Some(command)) = EgoCommand::parse(ego) else { return ego.to_owned() };
    if let Some(python) = command.python() {
        let Some(file) = python.file().filter(|file| file.is_relative() && file.exists()) else {
            return ego.to_owned();
        };
        return format!("{PYTHON_PREFIX}{}:{}", from_folder(folder, file).display(), python.name);
    }
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
