//! The first message of a generic client: eleven numbers that define the layout of the later ones. In: its bytes. Out: the
//! layout, if a rig with this number of degrees of freedom can serve it. It reads no later message.

/// Bytes of the first message: eleven 32-bit numbers, little-endian.
pub const HEADER: usize = 44;
/// Longest later message, words of 64 bits.
const LONGEST: i32 = 16_384;
/// Fewest words that OpenSees sends; a header in the other byte order is recognised because its numbers are far above the
/// longest.
const SHORTEST: i32 = 2;

/// How the later messages are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The measured quantities, in the order of an answer: displacement, velocity, acceleration, force, each a word per
    /// axis, and time.
    pub measured: [bool; 5],
    /// Length of every message in words.
    pub words: usize,
}

/// Reads the first message, for a rig with this number of axes.
///
/// # Errors
/// The reason why it cannot be served.
pub fn parse(bytes: &[u8; HEADER], axes: usize) -> Result<Layout, String> {
    let number = |at: usize| {
        i32::from_le_bytes([
            bytes[4 * at],
            bytes[4 * at + 1],
            bytes[4 * at + 2],
            bytes[4 * at + 3],
        ])
    };
    let words = number(10);
    if !(SHORTEST..=LONGEST).contains(&words) {
        let swapped = words.swap_bytes();
        let order = if (SHORTEST..=LONGEST).contains(&swapped) {
            ": it has the other byte order"
        } else {
            ""
        };
        return Err(format!(
            "a message of {words} words{order}; the limits are {SHORTEST} to {LONGEST}"
        ));
    }
    let sizes: [i32; 10] = std::array::from_fn(number);
    // The time is one word. Every other quantity has no words or one per axis.
    let most = |at: usize| {
        if at % 5 == 4 {
            Some(1)
        } else {
            i32::try_from(axes).ok()
        }
    };
    if let Some((_, size)) = sizes
        .iter()
        .enumerate()
        .find(|(at, size)| **size != 0 && Some(**size) != most(*at))
    {
        return Err(format!("{size} degrees of freedom; this rig has {axes}"));
    }
    let [control, measured] = [&sizes[..5], &sizes[5..]];
    if control[0] == 0 {
        return Err(
            "the client sends no displacement, but psd moves by displacement only".to_owned(),
        );
    }
    if control[3] != 0 {
        return Err("the client sends a force, but psd moves by displacement only".to_owned());
    }
    let needed = (1 + control.iter().sum::<i32>()).max(measured.iter().sum());
    if words < needed {
        return Err(format!(
            "messages of {words} words are too short for the {needed} that the client announces"
        ));
    }
    let measured = std::array::from_fn(|at| measured[at] > 0);
    let words = usize::try_from(words).map_err(|_| "invalid number of words".to_owned())?;
    Ok(Layout { measured, words })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(numbers: [i32; 11]) -> [u8; HEADER] {
        let bytes: Vec<u8> = numbers
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        bytes.try_into().unwrap()
    }

    #[test]
    fn the_headers_of_opensees_and_of_the_smallest_session() {
        let force = [false, false, false, true, false];
        assert_eq!(
            parse(&header([1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 256]), 1),
            Ok(Layout {
                measured: force,
                words: 256
            })
        );
        assert_eq!(
            parse(&header([1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2]), 1),
            Ok(Layout {
                measured: force,
                words: 2
            })
        );
        let three = [3, 3, 3, 0, 1, 0, 0, 0, 3, 0, 256];
        assert_eq!(
            parse(&header(three), 3),
            Ok(Layout {
                measured: force,
                words: 256
            })
        );
        assert!(
            parse(&header(three), 2)
                .unwrap_err()
                .contains("3 degrees of freedom; this rig has 2")
        );
        assert!(
            parse(&header([3, 3, 3, 0, 1, 0, 0, 0, 1, 0, 256]), 3).is_err(),
            "a force of one axis only"
        );
    }

    #[test]
    fn a_client_that_cannot_be_served_is_given_the_reason() {
        for (numbers, why) in [
            ([2, 2, 2, 0, 1, 0, 0, 0, 2, 0, 256], "2 degrees of freedom"),
            ([0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 256], "no displacement"),
            ([1, 0, 0, 1, 1, 0, 0, 0, 1, 0, 256], "sends a force"),
            ([1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 4], "too short for the 5"),
            ([1, 0, 0, 0, 0, 1, 1, 1, 1, -1, 256], "-1 degrees"),
            ([1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1], "1 words"),
            ([1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 16_385], "16385 words"),
            (
                [1, 1, 1, 0, 1, 0, 0, 0, 1, 0, 256].map(i32::swap_bytes),
                "other byte order",
            ),
        ] {
            let message = parse(&header(numbers), 1).unwrap_err();
            assert!(message.contains(why), "{message}");
        }
        let browser = b"GET / HTTP/1.1\r\nHost: 127.0.0.1:8090\r\nUser-A";
        assert!(parse(browser, 1).is_err());
    }
}
