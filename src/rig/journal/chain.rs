//! The chain, which makes order and history verifiable. In: the content of a line. Out: 64 hexadecimal digits that depend
//! on it and on all lines before it. It knows no parts of a line.

use sha2::{Digest as _, Sha256};

/// Digits of one link.
pub const CHAIN_DIGITS: usize = 64;

/// The SHA-256 of all the entries so far, in lower-case hexadecimal digits.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Chain([u8; CHAIN_DIGITS]);

impl Chain {
    /// Before the first entry.
    pub const START: Self = Self([b'0'; CHAIN_DIGITS]);

    /// The chain after a line with `SEQ TYPE JSON`.
    #[must_use]
    pub fn after(&self, chained: &[u8]) -> Self {
        const DIGITS: &[u8; 16] = b"0123456789abcdef";
        let mut hash = Sha256::new();
        hash.update(self.0);
        hash.update(chained);
        let mut digits = [0; CHAIN_DIGITS];
        for (pair, byte) in digits
            .as_chunks_mut::<2>()
            .0
            .iter_mut()
            .zip(hash.finalize())
        {
            *pair = [
                DIGITS[usize::from(byte >> 4)],
                DIGITS[usize::from(byte & 15)],
            ];
        }
        Self(digits)
    }

    #[must_use]
    pub const fn digits(&self) -> &[u8; CHAIN_DIGITS] {
        &self.0
    }

    #[must_use]
    pub fn as_str(&self) -> &str {
        str::from_utf8(&self.0).expect("hexadecimal digits are ASCII")
    }
}

impl std::fmt::Debug for Chain {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::Chain;

    /// `{ printf '0%.0s' $(seq 64); printf '1 HEADER {"format":1}'; } | sha256sum`, and the same again over its answer.
    #[test]
    fn it_equals_that_of_sha256sum() {
        let first = Chain::START.after(br#"1 HEADER {"format":1}"#);
        assert_eq!(
            first.as_str(),
            "a3f4d32628859cf04d3fe4f65d148db18d47efb841f62a386e7962222dc3963a"
        );
        assert_eq!(
            first.after(br#"2 EVENT {"text":"a b"}"#).as_str(),
            "faf9030fc3c21c421a1032c227b5bafa4963c2ad76c6859429fd4e0ccb267395"
        );
    }
}
