//! Reading of JSON in the plain form that psd writes: no spaces, strings without escapes except `\\` and `\"`, numbers that are not near the
//! limits of a float. In: text. Out: values, or None for any other form, which `serde_json` reads or refuses.

/// Deepest nesting that is read here.
const DEEPEST: u32 = 16;

/// The text that is not read yet.
#[derive(Clone, Copy, Debug)]
pub struct Plain<'a>(&'a str);

impl<'a> Plain<'a> {
    #[must_use]
    pub const fn of(json: &'a str) -> Self {
        Self(json)
    }

    /// Whether everything is read.
    #[must_use]
    pub fn end(self) -> Option<()> {
        self.0.is_empty().then_some(())
    }

    /// Reads this text if it is next.
    pub fn skip(&mut self, text: &str) -> bool {
        let rest = self.0.strip_prefix(text);
        self.0 = rest.unwrap_or(self.0);
        rest.is_some()
    }

    /// Reads this text, which must be next.
    pub fn expect(&mut self, text: &str) -> Option<()> {
        self.skip(text).then_some(())
    }

    /// A finite number.
    pub fn number(&mut self) -> Option<f64> {
        self.number_text()?.parse().ok()
    }

    /// A whole number that is not negative.
    pub fn whole(&mut self) -> Option<u64> {
        self.number_text()?.parse().ok()
    }

    /// `[1.0,2.0]`
    pub fn numbers(&mut self) -> Option<Vec<f64>> {
        self.list(1, Self::number)
    }

    /// `["a","b"]`
    pub fn strings(&mut self) -> Option<Vec<String>> {
        self.list(1, Self::string)
    }

    /// A list; most of them have `usual` items.
    pub fn list<T>(
        &mut self,
        usual: usize,
        mut item: impl FnMut(&mut Self) -> Option<T>,
    ) -> Option<Vec<T>> {
        self.expect("[")?;
        let mut items = Vec::with_capacity(usual);
        if self.skip("]") {
            return Some(items);
        }
        loop {
            items.push(item(self)?);
            if self.skip("]") {
                return Some(items);
            }
            self.expect(",")?;
        }
    }

    pub fn string(&mut self) -> Option<String> {
        let text = self.string_text()?;
        if !text.contains('\\') {
            return Some(text.to_owned());
        }
        let mut escaped = false;
        // A backslash that is not itself escaped is not part of the text.
        let kept = text.chars().filter(|character| {
            escaped = *character == '\\' && !escaped;
            !escaped
        });
        Some(kept.collect())
    }

    /// The field `t` of an object that is read to its end. Inner None: it has none.
    #[must_use]
    pub fn time_of_object(mut self) -> Option<Option<f64>> {
        let mut time = None;
        self.expect("{")?;
        if !self.skip("}") {
            loop {
                let name = self.string_text()?;
                self.expect(":")?;
                let mut value = self;
                self.value(DEEPEST)?;
                if name == "t" {
                    // Only the last of two counts.
                    if time.is_some() {
                        return None;
                    }
                    time = Some(value.number()?);
                }
                if self.skip("}") {
                    break;
                }
                self.expect(",")?;
            }
        }
        self.end()?;
        Some(time)
    }

    /// Any value.
    fn value(&mut self, depth: u32) -> Option<()> {
        match self.0.as_bytes().first()? {
            b'"' => self.string_text().map(drop),
            b'[' | b'{' if depth == 0 => None,
            b'[' => self.list(0, |item| item.value(depth - 1)).map(drop),
            b'{' => {
                self.expect("{")?;
                if self.skip("}") {
                    return Some(());
                }
                loop {
                    self.string_text()?;
                    self.expect(":")?;
                    self.value(depth - 1)?;
                    if self.skip("}") {
                        return Some(());
                    }
                    self.expect(",")?;
                }
            }
            b't' => self.expect("true"),
            b'f' => self.expect("false"),
            b'n' => self.expect("null"),
            _ => self.number_text().map(drop),
        }
    }

    /// The text between the quotes, with its escapes.
    fn string_text(&mut self) -> Option<&'a str> {
        self.expect("\"")?;
        let text = self.0.as_bytes();
        let mut at = 0;
        loop {
            match text.get(at)? {
                b'"' => break,
                b'\\' if matches!(text.get(at + 1)?, b'\\' | b'"') => at += 2,
                b' '..=b'~' if text[at] != b'\\' => at += 1,
                _ => return None,
            }
        }
        let read = &self.0[..at];
        self.0 = &self.0[at + 1..];
        Some(read)
    }

    /// The text of a number as JSON allows it, short and far from the largest float.
    fn number_text(&mut self) -> Option<&'a str> {
        const LONGEST: usize = 40;
        let text = self.0.as_bytes();
        let digits = |from: usize| {
            let rest = text.get(from..).unwrap_or_default();
            rest.iter().take_while(|byte| byte.is_ascii_digit()).count()
        };
        let mut at = usize::from(text.first() == Some(&b'-'));
        let whole = digits(at);
        if whole == 0 || whole > 1 && text[at] == b'0' {
            return None;
        }
        at += whole;
        if text.get(at) == Some(&b'.') {
            let decimals = digits(at + 1);
            if decimals == 0 {
                return None;
            }
            at += 1 + decimals;
        }
        if matches!(text.get(at), Some(b'e' | b'E')) {
            at += 1 + usize::from(matches!(text.get(at + 1), Some(b'+' | b'-')));
            let exponent = digits(at);
            if !matches!(exponent, 1 | 2) {
                return None;
            }
            at += exponent;
        }
        if at > LONGEST {
            return None;
        }
        let (number, rest) = self.0.split_at(at);
        self.0 = rest;
        Some(number)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::Plain;

    fn number(text: &str) -> Option<f64> {
        let mut plain = Plain::of(text);
        let number = plain.number()?;
        plain.end().map(|()| number)
    }

    /// Each number is the one that `serde_json` reads, or is left to it.
    #[test]
    fn a_number_is_the_same_or_is_left_to_the_other_reader() {
        for text in [
            "0",
            "-0",
            "0.0",
            "-0.0",
            "1",
            "12",
            "0.1",
            "-12.75",
            "1e5",
            "1E5",
            "1e+16",
            "1.5e-7",
            "5e-99",
            "123456789012345680.0",
            "9007199254740993",
            "18446744073709551616",
        ] {
            let expected: f64 = serde_json::from_str(text).unwrap();
            assert_eq!(
                number(text).map(f64::to_bits),
                Some(expected.to_bits()),
                "{text}"
            );
        }
        for text in [
            "",
            "-",
            "+1",
            "01",
            "-01",
            ".5",
            "5.",
            "1e",
            "1e+",
            "1e400",
            "1e-400",
            "1e300",
            "nan",
            "inf",
            "1_000",
            "0x10",
            "1.0.0",
            "1 ",
            "11111111111111111111111111111111111111111",
        ] {
            assert_eq!(number(text), None, "{text}");
        }
        assert_eq!(Plain::of("12,").whole(), Some(12));
        for text in ["-1", "1.0", "1e2", "18446744073709551616"] {
            assert_eq!(Plain::of(text).whole(), None, "{text}");
        }
    }

    #[test]
    fn a_text_is_the_same_or_is_left_to_the_other_reader() {
        for text in ["", "a b", "\\n", "a\\\\b", "\"q\"", "\\\"", "\\x1b"] {
            let json = serde_json::to_string(text).unwrap();
            let mut plain = Plain::of(&json);
            assert_eq!(plain.string().as_deref(), Some(text));
            assert_eq!(plain.end(), Some(()));
        }
        for json in [
            r#""a"#,
            r#""\n""#,
            r#""\u0041""#,
            "\"\u{e9}\"",
            "\"\t\"",
            r#""\"#,
        ] {
            assert_eq!(Plain::of(json).string(), None, "{json}");
        }
    }

    #[test]
    fn an_object_gives_its_time_as_the_other_reader_does() {
        let objects = [
            json!({}),
            json!({"t": 1.5}),
            json!({"x": {"t": 2.0}, "y": [[], [1, {}], "t"], "z": [true, false, null]}),
            json!({"x": [0.1, -2e-7], "t": 12, "raw": ["a\\b", "\"t\":3"]}),
        ];
        for object in objects {
            let json = object.to_string();
            let time = object.get("t").and_then(Value::as_f64);
            assert_eq!(Plain::of(&json).time_of_object(), Some(time), "{json}");
            for end in 0..json.len() {
                assert_eq!(
                    Plain::of(&json[..end]).time_of_object(),
                    None,
                    "{json} to {end}"
                );
            }
        }
        for json in [
            "[]",
            "1",
            "{} ",
            "{}{}",
            "{ }",
            r#"{"t":"1"}"#,
            r#"{"t":1,"t":2}"#,
            r#"{"a":1e400}"#,
            r#"{"a":01}"#,
            r#"{"a":}"#,
            r#"{"a"}"#,
            r#"{"a":1,}"#,
            r#"{"a":tru}"#,
            "{a:1}",
        ] {
            assert_eq!(Plain::of(json).time_of_object(), None, "{json}");
        }
        let deep = format!("{{\"a\":{}{}}}", "[".repeat(40), "]".repeat(40));
        assert_eq!(Plain::of(&deep).time_of_object(), None);
    }
}
