//! What is installed of all that recrash can use, and how to get the rest.

use crate::embedding::weights::{find_weights, is_published_model};
use recrash_child::{printable, run};
use recrash_metadrive::{INSTALL_HINT, METADRIVE_VERSION, inspect};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// How long MetaDrive may take to be imported. [s]
const METADRIVE_PATIENCE: Duration = Duration::from_secs(120);

/// How long another program may take to say its version. [s]
const PATIENCE: Duration = Duration::from_secs(20);

/// How it stands with something.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// It can be used.
    Ready,
    /// It is not there.
    Missing,
    /// It is there, but cannot be used as it is.
    Unusable,
}

impl State {
    /// For tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ready => "ready",
            Self::Missing => "missing",
            Self::Unusable => "unusable",
        }
    }
}

/// Something that recrash can use.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct DoctorItem {
    /// Name.
    pub name: &'static str,
    /// What needs it.
    pub needed_for: &'static str,
    /// How it stands.
    pub state: State,
    /// Version, path, or what is wrong with it.
    pub found: String,
    /// How to get it; empty where it is ready.
    pub remedy: String,
}

impl DoctorItem {
    fn ready(name: &'static str, needed_for: &'static str, found: String) -> Self {
        Self { name, needed_for, state: State::Ready, found, remedy: String::new() }
    }

    fn missing(name: &'static str, needed_for: &'static str, remedy: impl Into<String>) -> Self {
        Self { name, needed_for, state: State::Missing, found: String::new(), remedy: remedy.into() }
    }

    fn unusable(name: &'static str, needed_for: &'static str, found: String, remedy: impl Into<String>) -> Self {
        Self { name, needed_for, state: State::Unusable, found, remedy: remedy.into() }
    }
}

/// Where to look.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DoctorRequest {
    /// Python interpreter.
    pub python: PathBuf,
    /// Folder with the files of all-MiniLM-L6-v2; looked for where not given.
    pub model_dir: Option<PathBuf>,
}

/// Looks at everything. Nothing of it is needed for a run with the defaults.
pub fn doctor(request: &DoctorRequest) -> Vec<DoctorItem> {
    let version = env!("CARGO_PKG_VERSION");
    let mut all = vec![DoctorItem::ready("recrash", "everything by default", format!("{version}, native simulator"))];
    let python = python(&request.python);
    let runs = python.state == State::Ready;
    all.push(python);
    all.push(metadrive(&request.python, runs));
    all.push(minilm(request.model_dir.as_deref(), &request.python));
    all.push(esmini());
    all.push(package(&request.python, runs, "Scenic", "scenic", "running exports in Scenic", "scenic==3.1.1"));
    all.push(package(
        &request.python,
        runs,
        "CommonRoad",
        "commonroad-io",
        "reading exports in CommonRoad",
        "commonroad-io==2026.1",
    ));
    all.push(chromium());
    all
}

fn python(python: &Path) -> DoctorItem {
    let (name, needed_for) = ("Python", "MetaDrive, Scenic, CommonRoad");
    let hint = "install Python 3.7 to 3.11, or name another interpreter";
    match ask(python, &["-c", "import sys; print('%d.%d.%d %s' % (*sys.version_info[:3], sys.executable))"]) {
        Ok(text) => DoctorItem::ready(name, needed_for, text),
        Err(Silence::NotThere) => DoctorItem::missing(name, needed_for, hint),
        Err(Silence::Said(what)) => DoctorItem::unusable(name, needed_for, what, hint),
    }
}

fn metadrive(python: &Path, runs: bool) -> DoctorItem {
    let (name, needed_for) = ("MetaDrive", "the simulator metadrive, recrash parity");
    if !runs {
        return DoctorItem::missing(name, needed_for, INSTALL_HINT);
    }
    let found = inspect(python, METADRIVE_PATIENCE);
    match found.problem {
        None => DoctorItem::ready(name, needed_for, METADRIVE_VERSION.to_owned()),
        Some(problem) if problem.is_missing() => DoctorItem::missing(name, needed_for, INSTALL_HINT),
        Some(problem) => DoctorItem::unusable(name, needed_for, problem.to_string(), INSTALL_HINT),
    }
}

fn minilm(model_dir: Option<&Path>, python: &Path) -> DoctorItem {
    let (name, needed_for) = ("MiniLM weights", "embedding narratives as the paper does");
    let remedy = "recrash model pull";
    let found = model_dir.map(Path::to_owned).or_else(|| find_weights(python).map(|weights| weights.folder));
    match found {
        None => DoctorItem::missing(name, needed_for, remedy),
        Some(folder) => match is_published_model(&folder) {
            Ok(true) => DoctorItem::ready(name, needed_for, folder.display().to_string()),
            Ok(false) => {
                DoctorItem::ready(name, needed_for, format!("{}, not the published weights", folder.display()))
            }
            Err(why) => DoctorItem::unusable(name, needed_for, why.to_string(), remedy),
        },
    }
}

fn esmini() -> DoctorItem {
    let (name, needed_for) = ("esmini", "playing exports in OpenSCENARIO");
    let program = std::env::var_os("ESMINI_BIN").map_or_else(|| PathBuf::from("esmini"), PathBuf::from);
    let remedy = "unpack a release of github.com/esmini/esmini, and set ESMINI_BIN to its bin/esmini";
    match ask(&program, &["--version"]) {
        Ok(text) => DoctorItem::ready(name, needed_for, format!("{text}, {}", program.display())),
        Err(Silence::NotThere) => DoctorItem::missing(name, needed_for, remedy),
        Err(Silence::Said(what)) => DoctorItem::unusable(name, needed_for, what, remedy),
    }
}

fn package(
    python: &Path,
    runs: bool,
    name: &'static str,
    package: &str,
    needed_for: &'static str,
    pinned: &str,
) -> DoctorItem {
    let remedy = format!("pip install {pinned}");
    let version = format!("from importlib import metadata; print(metadata.version('{package}'))");
    match runs.then(|| ask(python, &["-c", &version])) {
        Some(Ok(text)) => DoctorItem::ready(name, needed_for, text),
        _ => DoctorItem::missing(name, needed_for, remedy),
    }
}

fn chromium() -> DoctorItem {
    let (name, needed_for) = ("Chromium", "tests of the report's page (development)");
    let remedy = "install Chromium, or set CHROMIUM to its path";
    let places = std::env::var_os("CHROMIUM").map_or_else(
        || ["chromium", "chromium-browser", "google-chrome"].map(PathBuf::from).to_vec(),
        |path| vec![PathBuf::from(path)],
    );
    let found = places.iter().find_map(|program| ask(program, &["--version"]).ok());
    found
        .map_or_else(|| DoctorItem::missing(name, needed_for, remedy), |text| DoctorItem::ready(name, needed_for, text))
}

/// Why a program said nothing that can be used.
enum Silence {
    /// It could not be started.
    NotThere,
    /// It failed, hung or said something odd.
    Said(String),
}

/// The first line a program prints.
fn ask(program: &Path, arguments: &[&str]) -> Result<String, Silence> {
    match run(Command::new(program).args(arguments), PATIENCE) {
        Err(_) => Err(Silence::NotThere),
        Ok(None) => Err(Silence::Said(format!("it did not answer within {} s", PATIENCE.as_secs()))),
        Ok(Some(finished)) => {
            let line = printable(finished.stdout.lines().next().unwrap_or_default(), 200).trim().to_owned();
            if finished.status.success() && !line.is_empty() {
                Ok(line)
            } else {
                Err(Silence::Said(format!("it ended with {}", finished.status)))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn item(all: &[DoctorItem], name: &str) -> DoctorItem {
        all.iter().find(|item| item.name == name).cloned().expect("an item of that name")
    }

    #[test]
    fn without_python_everything_says_how_to_get_it_and_recrash_is_ready() {
        let request = DoctorRequest { python: "no-such-python".into(), model_dir: None };
        let all = doctor(&request);
        assert_eq!(item(&all, "recrash").state, State::Ready);
        for name in ["Python", "MetaDrive", "Scenic", "CommonRoad"] {
            assert_eq!(item(&all, name).state, State::Missing, "{name}");
        }
        assert!(item(&all, "MetaDrive").remedy.contains("metadrive-simulator==0.4.3"));
        assert!(all.iter().all(|item| (item.state == State::Ready) == item.remedy.is_empty()));
    }

    #[test]
    fn a_program_that_fails_is_unusable_and_a_folder_without_weights_too() {
        let folder = tempfile::tempdir().expect("a folder");
        let request = DoctorRequest { python: "false".into(), model_dir: Some(folder.path().to_owned()) };
        let all = doctor(&request);
        if cfg!(unix) {
            assert_eq!(item(&all, "Python").state, State::Unusable);
        }
        assert_eq!(item(&all, "MiniLM weights").state, State::Unusable);
    }
}
