//! How large a plan file and its parts may be. Constants only; `tokens` and `lower` hold to them.

/// Bytes of one file.
pub const FILE_BYTES: usize = 1 << 20;
/// Bytes of one line, its end not counted.
pub const LINE_BYTES: usize = 4 << 10;
/// Characters of one name.
pub const NAME_CHARS: usize = 64;
/// Bytes of one text between its quotes.
pub const TEXT_BYTES: usize = 1 << 10;
/// Characters of one number.
pub const NUMBER_CHARS: usize = 40;
/// Brackets inside brackets.
pub const NESTING: usize = 64;
/// Words, numbers, texts and signs of one file.
pub const TOKENS: usize = 200_000;
/// Operators on the way from the root of an expression to a leaf. Every walk over a tree is recursive, its release
/// from memory included, so this is what keeps the stack small.
pub const OPERATORS: usize = 1_000;
/// Faults reported for one file; what comes after is noise.
pub const FAULTS: usize = 1_000;
