//! The command of an external ego, as it is typed: `cmd:PROGRAM [ARGS]`, or `py:MODULE:NAME` for Python.

use std::fmt;
use std::path::{Path, PathBuf};

/// What an ego's name begins with where it is a program.
pub const EGO_COMMAND_PREFIX: &str = "cmd:";

/// What an ego's name begins with where it is a class or function in Python.
pub(crate) const PYTHON_PREFIX: &str = "py:";

/// The variable that names the Python interpreter, and the one where it does not.
const PYTHON: (&str, &str) = ("RECRASH_PYTHON", "python3");

/// The module of the Python package that speaks the protocol for a class or function.
const PYTHON_MODULE: &str = "recrash.ego";

/// A program with its arguments.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EgoCommand {
    /// As typed, prefix and all.
    text: String,
    /// The program to look for, or its path. [`PYTHON_PREFIX`] names none: see [`EgoCommand::interpreted_by`].
    pub(crate) program: String,
    pub(crate) arguments: Vec<String>,
    is_python: bool,
}

/// A class or function in Python that drives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PythonEgo<'a> {
    /// A module, or the path of a file `.py`.
    pub module: &'a str,
    /// The class or function in it.
    pub name: &'a str,
}

impl PythonEgo<'_> {
    /// The file, where it is named by its path.
    pub(crate) fn file(&self) -> Option<&Path> {
        self.module.ends_with(".py").then(|| Path::new(self.module))
    }
}

/// The interpreter of who names none: `RECRASH_PYTHON`, else `python3`.
pub fn default_python() -> PathBuf {
    std::env::var_os(PYTHON.0).map_or_else(|| PYTHON.1.into(), PathBuf::from)
}

impl EgoCommand {
    /// Reads `cmd:PROGRAM [ARGS]` or `py:MODULE:NAME`; `None` where the name begins with neither.
    ///
    /// `MODULE` is a module of Python's, or the path of a file `.py`; `NAME` a class or function in it. The interpreter is named
    /// later ([`EgoCommand::interpreted_by`]), and has the package recrash.
    ///
    /// Words are separated by white space; quotes of both kinds and backslashes work as in a shell. No shell is run.
    ///
    /// # Errors
    /// There is no program, or a quote is not closed.
    pub fn parse(ego: &str) -> Result<Option<Self>, String> {
        if let Some(named) = ego.strip_prefix(PYTHON_PREFIX) {
            return Self::of_python(ego, named).map(Some);
        }
        let Some(line) = ego.strip_prefix(EGO_COMMAND_PREFIX) else { return Ok(None) };
        let mut words = split(line).ok_or_else(|| format!("a quote is not closed in the ego '{ego}'"))?.into_iter();
        match words.next() {
            Some(program) if !program.is_empty() => {
                Ok(Some(Self { text: ego.to_owned(), program, arguments: words.collect(), is_python: false }))
            }
            _ => Err("the ego cmd: needs a program, such as 'cmd:python3 my_ego.py'".to_owned()),
        }
    }

    fn of_python(ego: &str, named: &str) -> Result<Self, String> {
        let Some((module, name)) =
            named.rsplit_once(':').filter(|(module, name)| !module.is_empty() && !name.is_empty())
        else {
            return Err(format!(
                "the ego {ego} needs a module and a name in it, such as py:my_stack:Planner or py:ego.py:drive"
            ));
        };
        let arguments = ["-m", PYTHON_MODULE, module, name].map(str::to_owned).to_vec();
        Ok(Self { text: ego.to_owned(), program: PYTHON.1.to_owned(), arguments, is_python: true })
    }

    /// With this interpreter, where it is a class or function in Python; any other program as it is.
    pub fn interpreted_by(self, python: &Path) -> Self {
        match self.is_python {
            true => Self { program: python.to_string_lossy().into_owned(), ..self },
            false => self,
        }
    }

    /// The class or function in Python that it is, where it is one.
    pub(crate) fn python(&self) -> Option<PythonEgo<'_>> {
        match self.arguments.as_slice() {
            [_, _, module, name] if self.is_python => Some(PythonEgo { module, name }),
            _ => None,
        }
    }

    /// Whether the program can be found, as far as that is seen without starting it: on Windows names go without endings.
    pub(crate) fn is_there(&self) -> bool {
        let program = Path::new(&self.program);
        if cfg!(windows) || program.components().count() > 1 || program.is_absolute() {
            return cfg!(windows) || program.is_file();
        }
        let folders = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&folders).any(|folder| folder.join(program).is_file())
    }

    /// As it was typed.
    pub fn as_str(&self) -> &str {
        &self.text
    }
}

impl fmt::Display for EgoCommand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", self.text)
    }
}

/// Words of a command line; `None` where a quote is not closed.
fn split(line: &str) -> Option<Vec<String>> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut letters = line.chars();
    while let Some(letter) = letters.next() {
        match letter {
            '\'' => loop {
                match letters.next()? {
                    '\'' => break word.get_or_insert_default().push_str(""),
                    inside => word.get_or_insert_default().push(inside),
                }
            },
            '"' => loop {
                match letters.next()? {
                    '"' => break word.get_or_insert_default().push_str(""),
                    '\\' => word.get_or_insert_default().push(letters.next()?),
                    inside => word.get_or_insert_default().push(inside),
                }
            },
            '\\' => word.get_or_insert_default().push(letters.next()?),
            space if space.is_whitespace() => words.extend(word.take()),
            other => word.get_or_insert_default().push(other),
        }
    }
    words.extend(word);
    Some(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_split_as_in_a_shell() {
        let words = |line: &str| split(line).map(|words| words.join("|"));
        assert_eq!(words(" python3  ego.py "), Some("python3|ego.py".into()));
        assert_eq!(
            words(r#"'my stack/ego' --name "a \"b\"" c\ d ''"#),
            Some(r#"my stack/ego|--name|a "b"|c d|"#.into())
        );
        assert_eq!(words("ego 'open"), None);
        assert_eq!(words(""), Some(String::new()));
    }

    #[test]
    fn a_name_without_the_prefix_is_no_command_and_an_empty_one_is_refused() {
        assert_eq!(EgoCommand::parse("idm"), Ok(None));
        assert!(EgoCommand::parse("cmd: ").unwrap_err().contains("needs a program"));
        assert!(EgoCommand::parse("cmd:'a").unwrap_err().contains("quote"));
        let command = EgoCommand::parse("cmd:python3 ego.py").unwrap().unwrap();
        assert_eq!((command.program.as_str(), command.arguments.len()), ("python3", 1));
        assert_eq!(command.to_string(), "`cmd:python3 ego.py`");
    }

    #[test]
    fn a_class_in_python_is_a_command_that_has_its_file_among_its_words() {
        let command = EgoCommand::parse("py:egos/mine.py:Careful").unwrap().unwrap();
        assert_eq!(command.arguments, ["-m", "recrash.ego", "egos/mine.py", "Careful"]);
        assert_eq!(command.as_str(), "py:egos/mine.py:Careful");
        assert_eq!(command.interpreted_by(Path::new("venv/bin/python")).program, "venv/bin/python");
        let other = EgoCommand::parse("cmd:ego").unwrap().unwrap();
        assert_eq!(other.clone().interpreted_by(Path::new("python")), other);
        for wrong in ["py:", "py:mine", "py:mine:", "py::Careful"] {
            assert!(EgoCommand::parse(wrong).unwrap_err().contains("needs a module and a name"), "{wrong}");
        }
    }
}
