//! Stable codes. Each crate lists its own, by [`codes!`](crate::codes), in its file `codes.rs`.

use super::Severity;

/// A stable diagnostic code, shown as `E201`. Codes are never reused.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(&'static str);

impl Code {
    #[must_use]
    pub const fn new(id: &'static str) -> Self {
        Self(id)
    }

    /// The code as it is printed: `E201`.
    #[must_use]
    pub const fn id(self) -> &'static str {
        self.0
    }

    /// Its first letter.
    #[must_use]
    pub const fn severity(self) -> Severity {
        match self.0.as_bytes() {
            [b'W', ..] => Severity::Warning,
            _ => Severity::Error,
        }
    }
}

impl std::fmt::Display for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0)
    }
}

impl std::fmt::Debug for Code {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.0)
    }
}

/// The codes that a crate raises: a constant each, and `ALL`.
#[macro_export]
macro_rules! codes {
    ($($code:ident)*) => {
        $(pub const $code: $crate::diagnostic::Code = $crate::diagnostic::Code::new(stringify!($code));)*

        /// Every code of this crate, in order.
        pub const ALL: &[$crate::diagnostic::Code] = &[$($code),*];
    };
}
