//! Mutations of bytes. In: good inputs, and a source of random numbers. Out: an input that is nearly good.

use rand::RngExt as _;
use rand_pcg::Pcg64Mcg;

/// Most bytes of an input.
const LONGEST: usize = 64 << 10;

/// Letters, marks and words that readers treat in a special way.
#[rustfmt::skip]
const WORDS: &[&str] = &[
    "1e400", "-1e400", "1e-400", "nan", "inf", "-0", "0", "-1", "18446744073709551616", "9223372036854775807", "4294967296",
    "65536", "1e9", "0.1", "\r", "\n", "\r\n", "\t", "\0", "\"", "'", "{", "}", "(", ")", "[", "]", ",", ";", ":", ".", "..", "=",
    "==", "<", "+", "-", "*", "/", "^", "~", "#", "%", " ", "\\", "\\u0000", "\\ud800", "null", "true", "{}", "[]", "µ", "é", "漢",
    "😀", "\u{feff}", "\u{2028}", "\u{202e}", "```", "```psd\n", "mm", "kN/m", "use \"a\"\n", "let a = ", "require ", "ok\n",
    "Content-Length: ",
];

/// One of the inputs, changed at a few places.
pub fn mutated(random: &mut Pcg64Mcg, seeds: &[Vec<u8>]) -> Vec<u8> {
    let mut input = one_of(random, seeds).clone();
    for _ in 0..=random.random_range(0..4) {
        mutate(random, &mut input, seeds);
    }
    input.truncate(LONGEST);
    input
}

fn one_of<'a, T>(random: &mut Pcg64Mcg, all: &'a [T]) -> &'a T {
    &all[random.random_range(0..all.len())]
}

/// A part of the bytes, most often a short one.
fn part(random: &mut Pcg64Mcg, length: usize) -> std::ops::Range<usize> {
    let start = random.random_range(0..=length);
    let longest = 1 << random.random_range(0..12);
    start..(start + random.random_range(0..=longest)).min(length)
}

fn mutate(random: &mut Pcg64Mcg, input: &mut Vec<u8>, seeds: &[Vec<u8>]) {
    let range = part(random, input.len());
    let at = range.start;
    match random.random_range(0..9) {
        0 => {
            if let Some(byte) = input.get_mut(at) {
                *byte ^= 1 << random.random_range(0..8);
            }
        }
        1 => {
            if let Some(byte) = input.get_mut(at) {
                *byte = random.random();
            }
        }
        2 => {
            input.splice(at..at, one_of(random, WORDS).bytes());
        }
        3 => {
            input.splice(number_at(input, at), one_of(random, WORDS).bytes());
        }
        4 => {
            input.drain(range);
        }
        5 => {
            let copied = input[range].to_vec();
            let to = random.random_range(0..=input.len());
            input.splice(to..to, copied);
        }
        6 => {
            let times = 1 << random.random_range(1..11);
            let repeated = input[range].repeat(times);
            let room = LONGEST.saturating_sub(input.len());
            input.splice(at..at, repeated.into_iter().take(room));
        }
        7 => {
            let other = one_of(random, seeds);
            let from = random.random_range(0..=other.len());
            input.truncate(at);
            input.extend(&other[from..]);
        }
        _ => input.truncate(at),
    }
}

/// The number at or after a place; nothing at the end.
fn number_at(input: &[u8], at: usize) -> std::ops::Range<usize> {
    let is_digit = |byte: &u8| byte.is_ascii_digit();
    let start = at
        + input[at..]
            .iter()
            .position(is_digit)
            .unwrap_or(input.len() - at);
    let length = input[start..]
        .iter()
        .take_while(|byte| is_digit(byte))
        .count();
    start..start + length
}
