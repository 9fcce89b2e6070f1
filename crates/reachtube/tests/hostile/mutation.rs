//! Seeded mutation of texts, as hostile input for readers.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Longest input, bytes, apart from nested brackets.
const LONGEST: usize = 1 << 15;

/// Longest time that a reader may take for one input.
const PATIENCE: Duration = Duration::from_secs(10);

/// Pieces of text that readers treat in a special way.
const PIECES: [&str; 40] = [
    "",
    " ",
    "\n",
    "\r\n",
    "\t",
    "\0",
    ",",
    ";",
    ":",
    "=",
    "\"",
    "'",
    "#",
    "\\",
    "-",
    "+",
    ".",
    "e",
    "[",
    "]",
    "{",
    "}",
    "[[",
    "[[joint]]\n",
    "<",
    ">",
    "</",
    "/>",
    "<!--",
    "&lt;",
    "&#x1b;",
    "<!DOCTYPE r [<!ENTITY a \"&b;&b;\">]>",
    "null",
    "true",
    "NaN",
    "inf",
    "../",
    "/etc/passwd",
    "\u{feff}",
    "\u{202e}",
];

/// Numbers at the edges of types and of sense.
const NUMBERS: [&str; 20] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "255",
    "256",
    "65536",
    "1000000",
    "2147483648",
    "4294967296",
    "18446744073709551616",
    "1e9",
    "1e-300",
    "1e300",
    "-1e308",
    "1e309",
    "1e-12",
    "0x10",
    "99999999999999999999999999999999999999999",
];

/// Runs a reader on `count` inputs made from `seeds`. A panic or a slow input is reported with its
/// number, which makes it again.
pub(crate) fn attack(name: &str, seeds: &[Vec<u8>], count: u64, mut read: impl FnMut(&[u8])) {
    for case in 0..count {
        let input = input(seeds, case);
        let start = Instant::now();
        let outcome = catch_unwind(AssertUnwindSafe(|| read(&input)));
        let took = start.elapsed();
        if outcome.is_err() || took > PATIENCE {
            let text = String::from_utf8_lossy(&input);
            panic!("{name}: input {case} took {took:?} or made it panic:\n{text}");
        }
    }
    println!("{name}: {count} inputs");
}

/// Returns the input of a case.
fn input(seeds: &[Vec<u8>], case: u64) -> Vec<u8> {
    let mut random = Random(Xoshiro256PlusPlus::seed_from_u64(case));
    let mut bytes = seeds[random.below(seeds.len())].clone();
    for _ in 0..=random.below(6) {
        random.mutate(&mut bytes, seeds);
        bytes.truncate(LONGEST);
    }
    if random.below(200) == 0 {
        random.nest(&mut bytes);
    }
    bytes
}

struct Random(Xoshiro256PlusPlus);

impl Random {
    /// Returns a number from 0 to `count` - 1; 0 if `count` is 0.
    fn below(&mut self, count: usize) -> usize {
        if count == 0 { 0 } else { self.0.random_range(0..count) }
    }

    fn range(&mut self, length: usize) -> std::ops::Range<usize> {
        let start = self.below(length + 1);
        let longest = if self.below(4) == 0 { length - start } else { (length - start).min(16) };
        start..start + self.below(longest + 1)
    }

    fn mutate(&mut self, bytes: &mut Vec<u8>, seeds: &[Vec<u8>]) {
        let range = self.range(bytes.len());
        match self.below(8) {
            0 => drop(bytes.drain(range)),
            1 => {
                let piece = bytes[range.clone()].to_vec();
                let times = 1 + self.below(8);
                drop(bytes.splice(range.start..range.start, piece.repeat(times)));
            }
            2 => {
                let piece = PIECES[self.below(PIECES.len())].bytes();
                drop(bytes.splice(range, piece));
            }
            3 => bytes[range].iter_mut().for_each(|byte| *byte ^= 1 << self.below(8)),
            4 => {
                let other = &seeds[self.below(seeds.len())];
                let piece = other[self.range(other.len())].to_vec();
                drop(bytes.splice(range, piece));
            }
            5 => bytes.truncate(range.start),
            _ => self.replace_number(bytes),
        }
    }

    /// Replaces one number of the text by one at an edge.
    fn replace_number(&mut self, bytes: &mut Vec<u8>) {
        let is_digit = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
        let from = self.below(bytes.len());
        let Some(start) = bytes[from..].iter().position(is_digit) else { return };
        let start = from + start;
        let length = bytes[start..].iter().take_while(|byte| is_digit(byte)).count();
        let number = NUMBERS[self.below(NUMBERS.len())].bytes();
        drop(bytes.splice(start..start + length, number));
    }

    /// Adds brackets or elements inside each other.
    fn nest(&mut self, bytes: &mut Vec<u8>) {
        let depth = 1 << self.below(16);
        let (open, close) =
            [("[", "]"), ("{\"a\":", "}"), ("<a>", "</a>"), ("a.", "")][self.below(4)];
        let at = self.below(bytes.len());
        let closing = if self.below(2) == 0 { close.repeat(depth) } else { String::new() };
        let nested = open.repeat(depth) + &closing;
        drop(bytes.splice(at..at, nested.into_bytes()));
    }
}
