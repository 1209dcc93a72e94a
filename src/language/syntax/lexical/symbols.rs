//! The text that the grammar reads: one character for each token. In: tokens. Out: [`Symbols`]. Spaces and comments are not in it, so
//! the grammar skips none, and a word of any length is one character. The characters are those of `grammar/psd.pest`.

use psd_text::source::Span;

use super::tokens::{JOINING_WORDS, Kind, Token, Tokens};
use crate::syntax::ast::ITEM_WORDS;

/// The tokens of a piece of a file that the grammar reads, and their characters.
pub struct Symbols<'a> {
    tokens: &'a Tokens<'a>,
    list: Vec<Token>,
    /// The byte at an index is the character of the token at that index.
    pub text: String,
}

impl<'a> Symbols<'a> {
    /// The tokens `start..end` of a file.
    #[must_use]
    pub fn new(tokens: &'a Tokens<'a>, start: usize, end: usize) -> Self {
        let piece = &tokens.list[start..end];
        let mut list = Vec::with_capacity(piece.len());
        let mut text = String::with_capacity(piece.len());
        for (index, token) in piece.iter().enumerate() {
            if token.kind != Kind::Comment {
                list.push(*token);
                text.push(symbol(tokens, start + index));
            }
        }
        Self { tokens, list, text }
    }

    /// The text of the token at `index`, as written.
    #[must_use]
    pub fn written(&self, index: usize) -> &'a str {
        self.tokens.text_of(self.list[index])
    }

    /// The span of the tokens `start..end`, of which there is at least one.
    #[must_use]
    pub fn span(&self, start: usize, end: usize) -> Span {
        self.tokens
            .span(self.list[start].start, self.list[end - 1].end)
    }

    /// The first byte of the token at `index`; None after the last token.
    #[must_use]
    pub fn start(&self, index: usize) -> Option<usize> {
        self.list.get(index).map(|token| token.start)
    }
}

fn symbol(tokens: &Tokens, index: usize) -> char {
    let token = tokens.list[index];
    let written = tokens.text_of(token);
    match token.kind {
        Kind::Word => match written {
            "use" => 'u',
            "param" => 'p',
            "let" => 'l',
            "require" => 'r',
            "between" => 'b',
            "and" => 'a',
            "within" if tokens.is(index + 1, "(") => 'c',
            "within" => 'w',
            "of" => 'o',
            "step" => 's',
            "in" => 'i',
            _ => 'n',
        },
        Kind::Number => '0',
        Kind::Unit if begins_with_keyword(written) => '?',
        Kind::Unit => '%',
        Kind::Text => '"',
        Kind::Newline => '\n',
        Kind::Sign => match written {
            ".." => '_',
            "<" | "<=" | ">" | ">=" | "==" | "!=" | "~" => '<',
            _ => written
                .chars()
                .next()
                .filter(|sign| written.len() == 1 && "+-*/^=,:.()[]{}".contains(*sign))
                .unwrap_or('?'),
        },
        Kind::Comment => '#',
    }
}

/// Whether it is a unit such as `and/m`, which would read a keyword as a unit.
fn begins_with_keyword(unit: &str) -> bool {
    let end = unit.find(|next: char| !(next.is_ascii_alphanumeric() || next == '_'));
    let word = &unit[..end.unwrap_or(unit.len())];
    ITEM_WORDS.contains(&word) || JOINING_WORDS.contains(&word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_text::source::FileId;

    #[test]
    fn a_token_is_one_character_and_a_comment_is_none() {
        let text = "let a_1 = b within (1 kN/m) # c\n .. 2 and/m\nb.of <= \"t u\" within 3 in";
        let tokens = Tokens::read(text, FileId(0));
        let symbols = Symbols::new(&tokens, 0, tokens.list.len());
        assert_eq!(symbols.text, "ln=nc(0%)\n_0?\nn.o<\"w0%");
        assert_eq!(symbols.written(1), "a_1");
        assert_eq!(symbols.written(7), "kN/m");
        assert_eq!(symbols.start(9), text.find('\n'));
        assert_eq!(symbols.start(symbols.text.len()), None);
        let span = symbols.span(3, 9);
        assert_eq!(&text[span.range()], "b within (1 kN/m)");
    }
}
