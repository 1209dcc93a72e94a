//! The words of a jog, `$J=G21G90G53X-2.25F60`. In: words, and the end of the last planned move. Out: target and speed in SI, or the
//! number of the error. It moves nothing and knows no limit.

/// A waiting move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jog {
    /// Machine coordinate \[m\].
    pub(super) target: f64,
    /// \[m/s\]
    pub(super) speed: f64,
}

impl Jog {
    /// The jog that these words command; a relative target counts from `end` \[m\].
    pub(super) fn read(words: &str, end: f64) -> Result<Self, u32> {
        let (mut millimetres, mut absolute, mut target, mut feed) = (1.0, true, None, None);
        let mut rest = words;
        while let Some(letter) = rest.chars().next() {
            let tail = &rest[letter.len_utf8()..];
            let length = tail
                .find(|next: char| !next.is_ascii_digit() && next != '.' && next != '-')
                .unwrap_or(tail.len());
            let value = number(&tail[..length]).ok_or(2_u32)?;
            rest = &tail[length..];
            match (letter, &tail[..length]) {
                ('G', "20") => millimetres = 25.4,
                ('G', "21") => millimetres = 1.0,
                ('G', "90") => absolute = true,
                ('G', "91") => absolute = false,
                ('G', "53") => {}
                ('X', _) => target = Some(value),
                ('F', _) => feed = Some(value),
                ('G', _) => return Err(16),
                _ => return Err(20),
            }
        }
        let target = target.ok_or(16_u32)? * millimetres / 1e3;
        let speed = feed.filter(|feed| *feed > 0.0).ok_or(22_u32)? * millimetres / 6e4;
        let target = if absolute { target } else { end + target };
        Ok(Self { target, speed })
    }
}

/// A number as Grbl reads it: digits and a point, no exponent, kept in 32 bits.
pub(super) fn number(text: &str) -> Option<f64> {
    let digits = text.strip_prefix('-').unwrap_or(text);
    let sound = digits.bytes().any(|byte| byte.is_ascii_digit())
        && digits
            .bytes()
            .all(|byte| byte.is_ascii_digit() || byte == b'.')
        && digits.matches('.').count() <= 1;
    if sound {
        text.parse::<f32>().ok().map(f64::from)
    } else {
        None
    }
}
