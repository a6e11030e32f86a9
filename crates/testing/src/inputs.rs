//! Inputs of the fuzz targets: those written by hand, a file each with a name that says what it is; and those that fuzzing
//! found, one a line of one file, with bytes that are no plain text as in Rust's byte strings (`\n`, `\xff`).

use crate::root;
use std::fs;
use std::path::PathBuf;

/// Runs a check over all inputs of a target, and over the beginnings of those written by hand, as if they had been cut.
pub fn over_all(target: &str, check: fn(&[u8])) {
    let written = written(target);
    assert!(written.len() >= 4, "{target}: {} inputs written by hand", written.len());
    for bytes in written {
        for part in 1..=16 {
            check(&bytes[..bytes.len() * part / 16]);
        }
    }
    let found = found(target);
    assert!(found.len() >= 40, "{target}: {} inputs that fuzzing found", found.len());
    found.iter().for_each(|bytes| check(bytes));
}

/// The inputs written by hand, in the order of their names.
pub fn written(target: &str) -> Vec<Vec<u8>> {
    let folder = root().join("fuzz/corpus").join(target);
    let entries = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a readable folder").path()).collect();
    paths.sort();
    paths.iter().map(|path| fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))).collect()
}

/// The inputs that fuzzing found; none where nobody has kept any yet.
pub fn found(target: &str) -> Vec<Vec<u8>> {
    let file = found_file(target);
    if !file.exists() {
        return Vec::new();
    }
    let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    text.lines().map(|line| unpacked(line).unwrap_or_else(|| panic!("{}: {line}", file.display()))).collect()
}

/// The file of the inputs that fuzzing found.
pub fn found_file(target: &str) -> PathBuf {
    root().join("fuzz/found").join(format!("{target}.txt"))
}

/// Text of the file with these inputs: a line each, in order, none twice.
pub fn packed(mut inputs: Vec<Vec<u8>>) -> String {
    inputs.sort();
    inputs.dedup();
    inputs.iter().map(|bytes| format!("{}\n", bytes.escape_ascii())).collect()
}

/// The input of one line; `None` where it was not written by [`packed`].
fn unpacked(line: &str) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut rest = line.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'\\' => match rest.next()? {
                b'n' => b'\n',
                b'r' => b'\r',
                b't' => b'\t',
                b'x' => {
                    let digit = |byte: u8| char::from(byte).to_digit(16);
                    u8::try_from(digit(rest.next()?)? * 16 + digit(rest.next()?)?).ok()?
                }
                plain @ (b'\\' | b'\'' | b'"') => plain,
                _ => return None,
            },
            byte => byte,
        });
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_bytes_come_back() {
        let all: Vec<u8> = (0..=255).collect();
        for input in [&all[..], b"", b"a\\n\n\"'\x00", "Z\u{fc}rich".as_bytes()] {
            let text = packed(vec![input.to_vec()]);
            assert!(text.is_ascii() && text.lines().count() == 1, "{text}");
            assert_eq!(unpacked(text.trim_end_matches('\n')).as_deref(), Some(input));
        }
        assert_eq!(unpacked(r"\q"), None);
        assert_eq!(unpacked(r"\x1"), None);
    }
}
