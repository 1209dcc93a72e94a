//! Size limits of a plan file and its parts. Constants only; `tokens` and `lower` enforce them.

/// Bytes of one file.
pub const FILE_BYTES: usize = 1 << 20;
/// Bytes of one line, without its end.
pub const LINE_BYTES: usize = 4 << 10;
/// Characters of one name.
pub const NAME_CHARS: usize = 64;
/// Bytes of one string between its quotes.
pub const TEXT_BYTES: usize = 1 << 10;
/// Characters of one number.
pub const NUMBER_CHARS: usize = 40;
/// Depth of nested brackets.
pub const NESTING: usize = 64;
/// Number of words, numbers, strings and characters of one file.
pub const TOKENS: usize = 200_000;
/// Operators on the path from the root of an expression to a leaf. Every walk over a tree is recursive, its release
/// from memory included, so this limit keeps the stack small.
pub const OPERATORS: usize = 1_000;
/// Errors reported for one file; more would not help.
pub const ERRORS: usize = 1_000;
