//! A crash file read from its beginning to its end, with the bytes of the row at hand: a file of 1 GB costs no memory of
//! its own.

use recrash_model::hash::hexadecimal;
use sha2::{Digest, Sha256};
use std::io::{self, Read, Seek, SeekFrom};

/// Bytes that can be read from any place: a file, or a text in memory.
pub trait Bytes: Read + Seek {}

impl<T: Read + Seek> Bytes for T {}

/// Bytes that are forgotten at once. [byte]
const LEAST_FORGOTTEN: usize = 1 << 16;

/// SHA-256 of everything, in hexadecimal.
pub fn sha256(bytes: &mut dyn Bytes) -> io::Result<String> {
    bytes.rewind()?;
    let mut hasher = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        match bytes.read(&mut buffer)? {
            0 => return Ok(hexadecimal(&hasher.finalize())),
            read => hasher.update(&buffer[..read]),
        }
    }
}

/// Bytes behind a mark, of which those since a certain place are remembered.
pub struct Stream<'a> {
    bytes: &'a mut dyn Bytes,
    /// Bytes before the first one that counts.
    mark: u64,
    length: u64,
    remembered: Vec<u8>,
    /// Of those remembered, how many are forgotten already.
    forgotten: usize,
    /// Place of the first byte that is not forgotten.
    from: u64,
}

impl<'a> Stream<'a> {
    /// A stream at its beginning.
    pub fn new(bytes: &'a mut dyn Bytes, mark: usize) -> io::Result<Self> {
        let mark = mark as u64;
        let length = bytes.seek(SeekFrom::End(0))?.saturating_sub(mark);
        bytes.seek(SeekFrom::Start(mark))?;
        Ok(Self { bytes, mark, length, remembered: Vec::new(), forgotten: 0, from: 0 })
    }

    /// All bytes.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Forgets what stands before a place.
    pub fn forget_before(&mut self, place: u64) {
        let forgotten = place.saturating_sub(self.from).min((self.remembered.len() - self.forgotten) as u64);
        self.from += forgotten;
        self.forgotten += forgotten as usize;
        if self.forgotten > LEAST_FORGOTTEN {
            self.remembered.drain(..std::mem::take(&mut self.forgotten));
        }
    }

    /// The bytes between two places, as far as they are remembered.
    pub fn between(&self, start: u64, end: u64) -> &[u8] {
        let all = &self.remembered[self.forgotten..];
        let at = |place: u64| (place.saturating_sub(self.from) as usize).min(all.len());
        &all[at(start)..at(end)]
    }
}

impl Read for Stream<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.bytes.read(buffer)?;
        self.remembered.extend_from_slice(&buffer[..read]);
        Ok(read)
    }
}

impl Seek for Stream<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let SeekFrom::Start(place) = to else {
            return Err(io::Error::new(io::ErrorKind::Unsupported, "places are counted from the beginning"));
        };
        self.bytes.seek(SeekFrom::Start(self.mark + place))?;
        self.remembered.clear();
        (self.forgotten, self.from) = (0, place);
        Ok(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn what_is_not_forgotten_is_remembered() {
        let text: Vec<u8> = (0..200_000_u32).map(|n| (n % 251) as u8).collect();
        let mut cursor = Cursor::new([b"mark", &text[..]].concat());
        let mut stream = Stream::new(&mut cursor, 4).unwrap();
        assert_eq!(stream.length(), 200_000);
        let mut buffer = vec![0; 150_000];
        stream.read_exact(&mut buffer).unwrap();
        stream.forget_before(100_000);
        assert_eq!(stream.between(100_000, 150_000), &text[100_000..150_000]);
        assert_eq!(stream.between(0, 100_001), &text[100_000..100_001]);
        stream.seek(SeekFrom::Start(7)).unwrap();
        stream.read_exact(&mut buffer[..10]).unwrap();
        assert_eq!(stream.between(8, 12), &text[8..12]);
    }
}
