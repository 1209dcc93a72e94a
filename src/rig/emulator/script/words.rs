//! The unread words of half a line of a script, and the readers of its numbers. In: text. Out: words, numbers with their units, or the
//! reason why they are none.

use std::collections::VecDeque;

/// The unread words of half a line.
pub(super) struct Words<'a>(VecDeque<&'a str>);

impl<'a> Words<'a> {
    pub(super) fn split(text: &'a str) -> Self {
        Self(text.split_whitespace().collect())
    }

    pub(super) fn next(&mut self) -> Result<&'a str, String> {
        self.0
            .pop_front()
            .ok_or_else(|| "the line ends too early".to_owned())
    }

    pub(super) fn take(&mut self, words: &[&str]) -> bool {
        let found = self.0.iter().take(words.len()).eq(words);
        if found {
            self.0.drain(..words.len());
        }
        found
    }

    pub(super) fn expect(&mut self, word: &str) -> Result<(), String> {
        let found = self.next()?;
        if found == word {
            Ok(())
        } else {
            Err(format!("found `{found}`, expected `{word}`"))
        }
    }

    pub(super) fn ended(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn end(&self) -> Result<(), String> {
        self.0
            .front()
            .map_or(Ok(()), |word| Err(format!("unexpected `{word}`")))
    }

    pub(super) fn count(&mut self) -> Result<u64, String> {
        let word = self.next()?;
        word.parse().map_err(|_| format!("`{word}` is not a count"))
    }

    /// The index of an axis, from its number (from 1).
    pub(super) fn axis(&mut self) -> Result<usize, String> {
        let word = self.next()?;
        word.parse::<usize>()
            .ok()
            .and_then(|axis| axis.checked_sub(1))
            .ok_or_else(|| format!("`{word}` is not an axis: the first is 1"))
    }

    pub(super) fn size(&mut self) -> Result<usize, String> {
        let word = self.next()?;
        word.parse().map_err(|_| format!("`{word}` is not a count"))
    }

    pub(super) fn bytes(&mut self) -> Result<usize, String> {
        let count = self.size()?;
        match self.next()? {
            "byte" | "bytes" if count <= 16 << 20 => Ok(count),
            "byte" | "bytes" => Err(format!("{count} bytes are too many (limit 16 MiB)")),
            other => Err(format!("found `{other}`, expected `bytes`")),
        }
    }

    pub(super) fn number(&mut self) -> Result<f64, String> {
        let word = self.next()?;
        word.parse()
            .ok()
            .filter(|value: &f64| value.is_finite())
            .ok_or_else(|| format!("`{word}` is not a number"))
    }

    /// A number with its required unit.
    pub(super) fn amount(&mut self, unit: &str) -> Result<f64, String> {
        let value = self.number()?;
        self.expect(unit)?;
        Ok(value)
    }

    /// `reply`, `replies 3`, `replies for ever`.
    pub(super) fn replies(&mut self) -> Result<Option<u64>, String> {
        match self.next()? {
            "reply" => Ok(Some(1)),
            "replies" if self.take(&["for", "ever"]) => Ok(None),
            "replies" => self.count().map(Some),
            other => Err(format!("found `{other}`, expected `reply` or `replies`")),
        }
    }

    /// `with 0.01` at the end.
    pub(super) fn probability(&mut self) -> Result<Option<f64>, String> {
        let Some(at) = self.0.iter().position(|word| *word == "with") else {
            return Ok(None);
        };
        let mut rest = Words(self.0.split_off(at));
        rest.expect("with")?;
        let probability = rest.number()?;
        rest.end()?;
        let sound = (0.0..=1.0).contains(&probability);
        if sound {
            Ok(Some(probability))
        } else {
            Err(format!("{probability} is not a probability"))
        }
    }
}
