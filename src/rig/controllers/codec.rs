//! Dialects: what rigs and load cells say, as bytes and as messages. In: bytes. Out: messages in SI, and the reverse.
//! No dialect reads a port or a clock, and all of them take their numbers from `number.rs` alone.
