//! The few opcodes of Python's pickle (protocol 3) that dicts, lists, texts, numbers and NumPy arrays need.
//!
//! An array is written as NumPy writes it: an empty array by `numpy.core.multiarray._reconstruct`, filled by `BUILD` with
//! shape, type and bytes. NumPy 1 and 2 both read that. No other name is ever called on reading, and nothing is shared.

/// What a pickle of ours holds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Text(String),
    Integer(i32),
    Number(f64),
    Truth(bool),
    List(Vec<Value>),
    /// In the order given.
    Dict(Vec<(String, Value)>),
    /// Rows of single-precision numbers, each of so many columns; one dimension where that is 0.
    Floats(Vec<f32>, usize),
    /// Truth values, one dimension.
    Truths(Vec<bool>),
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl Value {
    /// A dict with these keys.
    pub fn dict<const N: usize>(entries: [(&str, Self); N]) -> Self {
        Self::Dict(entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
    }

    /// Texts.
    pub fn texts(texts: impl IntoIterator<Item = String>) -> Self {
        Self::List(texts.into_iter().map(Self::Text).collect())
    }

    /// The pickle.
    pub fn pickled(&self) -> Vec<u8> {
        let mut bytes = vec![0x80, 3];
        self.write(&mut bytes);
        bytes.push(b'.');
        bytes
    }

    fn write(&self, to: &mut Vec<u8>) {
        match self {
            Self::Text(text) => write_text(text, to),
            Self::Integer(number) => write_integer(*number, to),
            Self::Number(number) => {
                debug_assert!(number.is_finite(), "a number that is none");
                to.push(b'G');
                to.extend(number.to_be_bytes());
            }
            Self::Truth(truth) => to.push(if *truth { 0x88 } else { 0x89 }),
            Self::List(items) => {
                to.push(b']');
                if !items.is_empty() {
                    to.push(b'(');
                    items.iter().for_each(|item| item.write(to));
                    to.push(b'e');
                }
            }
            Self::Dict(entries) => {
                to.push(b'}');
                if !entries.is_empty() {
                    to.push(b'(');
                    for (key, value) in entries {
                        write_text(key, to);
                        value.write(to);
                    }
                    to.push(b'u');
                }
            }
            Self::Floats(numbers, columns) => {
                debug_assert!(numbers.iter().all(|number| number.is_finite()), "a row with a number that is none");
                let shape = match columns {
                    0 => vec![numbers.len()],
                    columns => vec![numbers.len() / columns, *columns],
                };
                let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
                write_array(&shape, ("f4", "<"), &bytes, to);
            }
            Self::Truths(truths) => {
                let bytes: Vec<u8> = truths.iter().map(|truth| u8::from(*truth)).collect();
                write_array(&[truths.len()], ("b1", "|"), &bytes, to);
            }
        }
    }
}

/// BINUNICODE.
fn write_text(text: &str, to: &mut Vec<u8>) {
    to.push(b'X');
    to.extend(count(text.len()));
    to.extend(text.as_bytes());
}

/// BININT.
fn write_integer(number: i32, to: &mut Vec<u8>) {
    to.push(b'J');
    to.extend(number.to_le_bytes());
}

/// BINBYTES.
fn write_bytes(bytes: &[u8], to: &mut Vec<u8>) {
    to.push(b'B');
    to.extend(count(bytes.len()));
    to.extend(bytes);
}

/// GLOBAL: a module and a name in it.
fn write_global(module: &str, name: &str, to: &mut Vec<u8>) {
    to.extend(format!("c{module}\n{name}\n").as_bytes());
}

/// An array: its shape, its type and byte order as NumPy names them, and its bytes row by row.
fn write_array(shape: &[usize], (kind, order): (&str, &str), bytes: &[u8], to: &mut Vec<u8>) {
    write_global("numpy.core.multiarray", "_reconstruct", to);
    write_global("numpy", "ndarray", to);
    write_integer(0, to);
    to.push(0x85); // a tuple of one
    write_bytes(b"b", to);
    to.extend([0x87, b'R', b'(']); // a tuple of three, called; the state begins
    write_integer(1, to);
    to.push(b'(');
    for &size in shape {
        write_integer(i32::try_from(size).expect("an array of a rollout is small"), to);
    }
    to.push(b't');
    write_global("numpy", "dtype", to);
    write_text(kind, to);
    to.extend([0x89, 0x88, 0x87, b'R', b'(']); // no alignment, a copy; called; its state begins
    write_integer(3, to);
    write_text(order, to);
    to.extend(*b"NNN");
    write_integer(-1, to);
    write_integer(-1, to);
    write_integer(0, to);
    to.extend([b't', b'b', 0x89]); // built; not in columns first
    write_bytes(bytes, to);
    to.extend(*b"tb");
}

fn count(length: usize) -> [u8; 4] {
    u32::try_from(length).expect("a text or an array of a rollout is small").to_le_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pickle_is_what_python_writes_but_for_its_memo() {
        let value = Value::dict([("a", Value::List(vec![Value::Integer(7), Value::Truth(true), Value::Number(0.5)]))]);
        // pickletools.dis: PROTO 3, EMPTY_DICT, MARK, 'a', EMPTY_LIST, MARK, 7, NEWTRUE, 0.5, APPENDS, SETITEMS, STOP.
        let wanted = b"\x80\x03}(X\x01\0\0\0a](J\x07\0\0\0\x88G\x3f\xe0\0\0\0\0\0\0eu.";
        assert_eq!(value.pickled(), wanted);
    }

    #[test]
    fn an_array_carries_its_shape_and_its_bytes() {
        let bytes = Value::Floats(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 3).pickled();
        let shape = [b"(J".as_slice(), &2_i32.to_le_bytes(), b"J", &3_i32.to_le_bytes(), b"t"].concat();
        assert!(bytes.windows(shape.len()).any(|window| window == shape), "2 rows of 3");
        let data = [b"B".as_slice(), &24_u32.to_le_bytes(), &1.0_f32.to_le_bytes()].concat();
        assert!(bytes.windows(data.len()).any(|window| window == data), "24 bytes, the first number in front");
    }

    #[test]
    fn empty_ones_are_empty() {
        assert_eq!(Value::List(Vec::new()).pickled(), b"\x80\x03].");
        assert_eq!(Value::Dict(Vec::new()).pickled(), b"\x80\x03}.");
    }
}
