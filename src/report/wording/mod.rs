//! The words of the report. A translation is one more file beside `english.rs`, chosen here. The descriptions of specimen
//! models are in `specimen.rs`; the text of one procedure is in its folder of `procedures`.

/// `NAME = "text";` is a constant; `fn name(value) = "text with {value}";` is a sentence that shows its values.
macro_rules! phrases {
    () => {};
    ($(#[$doc:meta])* fn $name:ident($($value:ident),+) = $text:literal; $($rest:tt)*) => {
        $(#[$doc])*
        pub(crate) fn $name($($value: impl std::fmt::Display),+) -> String {
            format!($text)
        }
        phrases! { $($rest)* }
    };
    ($(#[$doc:meta])* $name:ident = [$($text:literal),+]; $($rest:tt)*) => {
        $(#[$doc])*
        pub(crate) const $name: [&str; [$($text),+].len()] = [$($text),+];
        phrases! { $($rest)* }
    };
    ($(#[$doc:meta])* $name:ident = $text:literal; $($rest:tt)*) => {
        $(#[$doc])*
        pub(crate) const $name: &str = $text;
        phrases! { $($rest)* }
    };
}

/// One module of phrases per section.
macro_rules! wording {
    ($(mod $section:ident { $($phrases:tt)* })+) => {
        $(pub(crate) mod $section { phrases! { $($phrases)* } })+
    };
}

mod english;
mod issue;
pub(crate) mod reproductions;
pub(crate) mod requirements;
pub mod specimen;
pub(crate) mod study;

pub(crate) use english::*;
pub(crate) use issue::*;

/// Words that the layout of a page adds to the text.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub(crate) struct Labels {
    pub report: &'static str,
    pub amendment_to: &'static str,
    pub not_given: &'static str,
    pub figure: &'static str,
    pub page: &'static str,
    /// Between the number of a page and the number of pages.
    pub page_of: &'static str,
    /// Description of the attached files.
    pub attachment: &'static str,
}
