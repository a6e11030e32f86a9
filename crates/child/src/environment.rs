//! What a program that is started sees of our environment: a list of what programs need, and nothing else. Keys of
//! models and of other services stay with us.

use std::env;
use std::ffi::OsString;
use std::process::Command;

/// Variable with the names of further variables that programs may see, with commas between; a star at the end of a name
/// stands for any ending.
pub const PASS_VARIABLE: &str = "RECRASH_PASS_ENV";

/// What programs need to be found, to find their libraries, files and devices, and to speak the user's language.
const NEEDED: &str = "PATH HOME USER LOGNAME SHELL LANG LANGUAGE LC_* TZ TERM PWD TMPDIR TEMP TMP XDG_* DISPLAY \
    WAYLAND_DISPLAY XAUTHORITY LD_LIBRARY_PATH DYLD_* PYTHON* VIRTUAL_ENV CONDA_* PYENV_* CUDA_* NVIDIA_* ROCM_* HIP_* \
    OMP_* MKL_* OPENBLAS_* NUMEXPR_* RAYON_* ROS_* AMENT_* COLCON_* RMW_* CARLA_* SUMO_HOME HF_HOME HF_HUB_CACHE \
    HF_HUB_OFFLINE SystemRoot SystemDrive windir ComSpec PATHEXT USERPROFILE APPDATA LOCALAPPDATA PROGRAM*";

/// Parts of the names of variables that hold something secret: no star lets them through.
const SECRET: [&str; 6] = ["KEY", "TOKEN", "SECRET", "PASSW", "CREDENTIAL", "AUTH"];

/// Takes out of a program's environment what it does not need. What was set for it by name stays.
pub(crate) fn clean(command: &mut Command) {
    let named = env::var(PASS_VARIABLE).unwrap_or_default();
    let allowed: Vec<&str> = NEEDED.split(' ').chain(named.split(',').map(str::trim)).collect();
    let set: Vec<OsString> = command.get_envs().map(|(name, _)| name.to_owned()).collect();
    for (name, _) in env::vars_os() {
        let text = name.to_string_lossy();
        if !set.contains(&name) && !fits(&text, &allowed) {
            command.env_remove(&name);
        }
    }
}

/// Lets a program see further variables of ours, such as `PIP_*`.
pub fn let_through(command: &mut Command, names: &[&str]) {
    for (name, value) in env::vars_os().filter(|(name, _)| fits(&name.to_string_lossy(), names)) {
        command.env(name, value);
    }
}

/// Whether a variable is one of these. A name in full fits whatever it says; a star does not reach for secrets.
fn fits(variable: &str, names: &[&str]) -> bool {
    let same = |a: &str, b: &str| if cfg!(windows) { a.eq_ignore_ascii_case(b) } else { a == b };
    let upper = variable.to_ascii_uppercase();
    let secret = variable != "XAUTHORITY" && SECRET.iter().any(|part| upper.contains(part));
    names.iter().any(|name| match name.strip_suffix('*') {
        Some(beginning) => !secret && variable.get(..beginning.len()).is_some_and(|start| same(start, beginning)),
        None => same(variable, name),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_get_what_they_need_and_no_key() {
        let needed: Vec<&str> = NEEDED.split(' ').collect();
        for name in ["PATH", "HOME", "LC_ALL", "PYTHONPATH", "CUDA_VISIBLE_DEVICES", "VIRTUAL_ENV", "XAUTHORITY"] {
            assert!(fits(name, &needed), "{name}");
        }
        for name in ["OPENAI_API_KEY", "HF_TOKEN", "PYTHON_API_KEY", "CARLA_PASSWORD", "AWS_PROFILE", "RECRASH_API_KEY"]
        {
            assert!(!fits(name, &needed), "{name}");
        }
    }

    #[test]
    fn a_name_in_full_is_let_through_and_a_star_reaches_for_no_secret() {
        assert!(fits("MY_STACK_TOKEN", &["MY_STACK_TOKEN"]));
        assert!(fits("MY_STACK_MODE", &["MY_*"]) && !fits("MY_STACK_TOKEN", &["MY_*"]));
    }

    #[test]
    #[cfg(unix)]
    fn a_program_sees_what_was_set_for_it() {
        let mut command = Command::new("env");
        command.env("SET_FOR_IT_KEY", "yes");
        let told = crate::run(&mut command, std::time::Duration::from_secs(20)).expect("env").expect("in time").stdout;
        assert!(told.lines().any(|line| line == "SET_FOR_IT_KEY=yes"), "{told}");
        assert!(told.lines().any(|line| line.starts_with("PATH=")), "{told}");
        assert!(!told.contains("CARGO_"), "{told}");
    }
}
