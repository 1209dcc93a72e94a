//! Letters outside a–z: letters that look like one of a–z, and the replacement of a word that contains them. In: a word. Out: a word of
//! a–z, 0–9 and _ whose length in bytes is not larger, so that it fits in the span of the first.

/// Letters of other scripts that look the same as one of a–z.
const LOOKALIKES: &[(char, char)] = &[
    ('а', 'a'),
    ('с', 'c'),
    ('ԁ', 'd'),
    ('е', 'e'),
    ('һ', 'h'),
    ('і', 'i'),
    ('ј', 'j'),
    ('ӏ', 'l'),
    ('о', 'o'),
    ('р', 'p'),
    ('ԛ', 'q'),
    ('ѕ', 's'),
    ('ԝ', 'w'),
    ('х', 'x'),
    ('у', 'y'),
    ('А', 'A'),
    ('В', 'B'),
    ('С', 'C'),
    ('Е', 'E'),
    ('Н', 'H'),
    ('І', 'I'),
    ('Ј', 'J'),
    ('К', 'K'),
    ('М', 'M'),
    ('О', 'O'),
    ('Р', 'P'),
    ('Ѕ', 'S'),
    ('Т', 'T'),
    ('Х', 'X'),
    ('У', 'Y'),
    ('α', 'a'),
    ('ι', 'i'),
    ('ν', 'v'),
    ('ο', 'o'),
    ('ρ', 'p'),
    ('υ', 'u'),
    ('Α', 'A'),
    ('Β', 'B'),
    ('Ε', 'E'),
    ('Ζ', 'Z'),
    ('Η', 'H'),
    ('Ι', 'I'),
    ('Κ', 'K'),
    ('Μ', 'M'),
    ('Ν', 'N'),
    ('Ο', 'O'),
    ('Ρ', 'P'),
    ('Τ', 'T'),
    ('Υ', 'Y'),
    ('Χ', 'X'),
    ('ı', 'i'),
];

/// Latin letters with a diacritic, by the letter without it.
const MARKED: &[(char, &str)] = &[
    ('a', "àáâãäåāăąæ"),
    ('c', "çćĉċč"),
    ('d', "ďđð"),
    ('e', "èéêëēĕėęě"),
    ('g', "ĝğġģ"),
    ('h', "ĥħ"),
    ('i', "ìíîïĩīĭį"),
    ('j', "ĵ"),
    ('k', "ķ"),
    ('l', "ĺļľŀł"),
    ('n', "ñńņňŋ"),
    ('o', "òóôõöøōŏőœ"),
    ('r', "ŕŗř"),
    ('s', "śŝşšßș"),
    ('t', "ţťŧțþ"),
    ('u', "ùúûüũūŭůűų"),
    ('w', "ŵ"),
    ('y', "ýÿŷ"),
    ('z', "źżž"),
];

/// The letter of a–z that looks the same.
#[must_use]
pub fn lookalike(letter: char) -> Option<char> {
    LOOKALIKES
        .iter()
        .find(|(foreign, _)| *foreign == letter)
        .map(|(_, latin)| *latin)
}

/// The letter without its diacritic: `a` for `ä`.
fn unmarked(letter: char) -> Option<char> {
    let lower = letter.to_lowercase().next()?;
    let (plain, _) = MARKED.iter().find(|(_, marked)| marked.contains(lower))?;
    Some(if lower == letter {
        *plain
    } else {
        plain.to_ascii_uppercase()
    })
}

/// Whether a character belongs to a word, within a–z or not.
#[must_use]
pub fn in_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || is_foreign(c) || matches!(c, '\u{300}'..='\u{36f}')
}

/// A letter that no name can contain. The micro sign is allowed in units.
#[must_use]
pub fn is_foreign(c: char) -> bool {
    !c.is_ascii() && c.is_alphabetic() && !matches!(c, 'µ' | 'μ' | 'º' | 'ª')
}

/// The word in a–z that is usually written for it, if there is one.
#[must_use]
pub fn written_plainly(word: &str) -> Option<String> {
    let plain = |c: char| {
        if c.is_ascii() {
            Some(c)
        } else {
            lookalike(c).or_else(|| unmarked(c))
        }
    };
    word.chars()
        .filter(|c| !matches!(c, '\u{300}'..='\u{36f}'))
        .map(plain)
        .collect()
}

/// A unique name for a word that cannot be written in a–z: two letters for each character.
#[must_use]
pub fn stand_in(word: &str) -> String {
    let mut name = String::with_capacity(word.len());
    for c in word.chars() {
        if c.is_ascii() {
            name.push(c);
        } else {
            let low = u32::from(c) % 256;
            name.extend(
                [low / 16, low % 16]
                    .iter()
                    .filter_map(|part| char::from_digit(part + 10, 26)),
            );
        }
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_fits_its_context() {
        for (word, plain) in [
            ("hämmer", Some("hammer")),
            ("strіker", Some("striker")),
            ("Łódź", Some("Lodz")),
            ("балка", None),
            ("梁", None),
        ] {
            assert_eq!(written_plainly(word).as_deref(), plain);
            assert!(stand_in(word).len() <= word.len(), "{word}");
            assert!(
                stand_in(word).chars().all(|c| c.is_ascii_alphanumeric()),
                "{word}"
            );
        }
        assert_ne!(stand_in("балка"), stand_in("балки"));
        assert!(
            is_foreign('ж')
                && !is_foreign('µ')
                && !is_foreign('a')
                && in_word('_')
                && !in_word('×')
        );
    }
}
