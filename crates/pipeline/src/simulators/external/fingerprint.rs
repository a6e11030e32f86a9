//! What an external ego is made of: results of another program of the same name are other results.

use super::EgoCommand;
use crate::files::store::file_hash;
use std::path::{Path, PathBuf};

/// An input of a unit of work that was driven by an ego whose files nobody found: such a unit is never done, as nobody can say
/// whether it would be the same again.
pub(crate) const FILES_UNKNOWN: &str = "an ego whose files are not known";

/// Files of a package beyond which it is not read: somebody's data, rather than code.
const MOST_FILES: usize = 10_000;

/// The command with a hash of the program's file and of every file among its arguments, so that a changed script counts as
/// another ego; of a module of Python's, of its file and of the package that it is in. What a program reads beside them is not
/// known. Without the files of a module: [`FILES_UNKNOWN`].
pub(crate) fn fingerprint(command: &EgoCommand) -> Vec<String> {
    let program = on_path(&command.program);
    let module = command.python().filter(|ego| ego.file().is_none());
    let of_module = module.map(|ego| module_files(ego.module, &python_path()));
    let words = command.arguments.iter().flat_map(|word| named_file(word));
    let files = program.into_iter().chain(words).chain(of_module.iter().flatten().flatten().cloned());
    let hashes = files.filter_map(|file| file_hash(&file));
    let all = std::iter::once(command.as_str().to_owned()).chain(hashes).collect::<Vec<_>>().join(" ");
    match of_module {
        Some(None) => vec![all, FILES_UNKNOWN.to_owned()],
        _ => vec![all],
    }
}

/// Where Python looks for modules before its own folders: the current one, and those of `PYTHONPATH`.
fn python_path() -> Vec<PathBuf> {
    let named = std::env::var_os("PYTHONPATH").unwrap_or_default();
    let named = std::env::split_paths(&named).filter(|folder| !folder.as_os_str().is_empty());
    std::iter::once(PathBuf::from(".")).chain(named).collect()
}

/// The files of a module, in order: its own, and all of the outermost package that it is in. `None` where it is in none of these
/// folders, or its package holds more than code does.
fn module_files(module: &str, folders: &[PathBuf]) -> Option<Vec<PathBuf>> {
    let parts: Vec<&str> = module.split('.').collect();
    if parts.iter().any(|part| part.is_empty() || part.contains(['/', '\\'])) {
        return None;
    }
    folders
        .iter()
        .find_map(|folder| {
            let path = parts.iter().fold(folder.clone(), |path, part| path.join(part));
            let forms = [path.join("__init__.py"), path.with_extension("py")];
            forms.into_iter().find(|file| file.is_file()).map(|file| (folder, file))
        })
        .and_then(|(folder, file)| {
            let mut packages =
                (1..=parts.len()).map(|depth| parts[..depth].iter().fold(folder.clone(), |path, part| path.join(part)));
            let mut files = vec![file];
            if let Some(package) = packages.find(|package| package.join("__init__.py").is_file()) {
                add_files(&package, &mut files)?;
            }
            Some(files)
        })
}

/// Adds all files below a folder, in order of their names, without caches and what is hidden; `None` where they are too many.
fn add_files(folder: &Path, files: &mut Vec<PathBuf>) -> Option<()> {
    let mut entries: Vec<_> = std::fs::read_dir(folder).ok()?.flatten().collect();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    for entry in entries {
        let name = entry.file_name();
        let kind = entry.file_type().ok()?;
        if name == "__pycache__" || name.to_string_lossy().starts_with('.') {
            continue;
        }
        if kind.is_dir() {
            add_files(&entry.path(), files)?;
        } else {
            files.push(entry.path());
        }
    }
    (files.len() <= MOST_FILES).then_some(())
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
        assert_eq!(fingerprint(&option)[0].split(' ').next_back().unwrap().len(), 64);
    }

    #[test]
    fn a_module_is_its_file_and_the_package_that_it_is_in() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        };
        for name in ["stack/__init__.py", "stack/planner.py", "stack/net/weights.bin", "stack/__pycache__/planner.pyc"]
        {
            write(name);
        }
        for name in ["plain.py", "loose/ego.py", "loose/data.csv"] {
            write(name);
        }
        let folders = ["nowhere".into(), folder.path().to_owned()];
        let names = |module: &str| {
            let files = module_files(module, &folders)?;
            let name = |file: &PathBuf| file.strip_prefix(folder.path()).unwrap().to_string_lossy().replace('\\', "/");
            Some(files.iter().map(name).collect::<Vec<_>>().join(" "))
        };
        let package = "stack/__init__.py stack/net/weights.bin stack/planner.py";
        assert_eq!(names("plain").as_deref(), Some("plain.py"));
        assert_eq!(names("loose.ego").as_deref(), Some("loose/ego.py"));
        assert_eq!(names("stack"), Some(format!("stack/__init__.py {package}")));
        assert_eq!(names("stack.planner"), Some(format!("stack/planner.py {package}")));
        for unknown in ["numpy", "stack.other", "..plain", "a/b", ""] {
            assert_eq!(names(unknown), None, "{unknown}");
        }
    }

    #[test]
    fn an_ego_whose_module_is_nowhere_to_be_seen_is_not_known() {
        let command = EgoCommand::parse("py:no_such_module_of_ours:Planner").unwrap().unwrap();
        assert_eq!(fingerprint(&command)[1], FILES_UNKNOWN);
    }
}
