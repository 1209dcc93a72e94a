//! A move in psd's own protocol, read back from the bytes that carried it: for who proves a record. In: the bytes on
//! record. Out: number, places and speed as they are written. It sends nothing, and judges nothing.

use super::codec::checksum;
use crate::rig::controllers::number;

/// The `MOVE` of some bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SentMove {
    pub id: u64,
    /// mm, one an axis.
    targets: Vec<String>,
    /// mm/s
    speed: String,
}

impl SentMove {
    /// The move of the last of these frames, each whole; those before it let go of a hold.
    #[must_use]
    pub fn of(wire: &[u8]) -> Option<Self> {
        let mut frames = str::from_utf8(wire)
            .ok()?
            .strip_suffix('\n')?
            .split('\n')
            .map(words)
            .rev();
        let last = frames.next().flatten()?;
        let ["MOVE", sequence, id, targets @ .., speed] = last.as_slice() else {
            return None;
        };
        let before = frames.all(|words| {
            words.is_some_and(|words| words.first() == Some(&"CLR") && words.len() == 2)
        });
        let whole = number::count(sequence.as_bytes()).is_some() && !targets.is_empty() && before;
        let id = number::count(id.as_bytes()).filter(|_| whole)?;
        Some(Self {
            id,
            targets: targets.iter().map(|word| (*word).to_owned()).collect(),
            speed: (*speed).to_owned(),
        })
    }

    /// Whether it says these places (m, one an axis, of the device) and this speed (m/s), as psd reads its own bytes back.
    #[must_use]
    pub fn says(&self, targets: &[f64], speed: f64) -> bool {
        let says = |word: &str, meant: f64| {
            number::read_back(word, 1e3, meant).is_some_and(|said| said == meant)
        };
        self.targets.len() == targets.len()
            && self
                .targets
                .iter()
                .zip(targets)
                .all(|(word, target)| says(word, *target))
            && says(&self.speed, speed)
    }
}

/// The words of a frame whose checksum holds, without its ending.
fn words(frame: &str) -> Option<Vec<&str>> {
    let (body, stated) = frame.strip_prefix('>')?.rsplit_once('*')?;
    (format!("{:04X}", checksum(body.as_bytes())) == stated).then(|| body.split(' ').collect())
}

#[cfg(test)]
mod tests {
    use super::SentMove;
    use crate::rig::controllers::native::codec::{Request, frame, length, lengths};

    #[test]
    fn a_move_says_what_it_was_made_of_and_nothing_else() {
        let targets = [1.234e-3, -5e-7];
        let (places, speed) = (lengths(&targets).unwrap(), length(2e-3).unwrap());
        let moving = frame(
            7,
            &Request::Move {
                id: 3,
                targets: &places,
                speed: &speed,
            },
        )
        .unwrap();
        let cleared = [frame(6, &Request::Clear).unwrap(), moving.clone()].concat();
        for wire in [&moving, &cleared] {
            let sent = SentMove::of(wire).unwrap();
            assert_eq!(sent.id, 3);
            assert!(sent.says(&targets, 2e-3));
            assert!(
                !sent.says(&[1.235e-3, -5e-7], 2e-3)
                    && !sent.says(&targets[..1], 2e-3)
                    && !sent.says(&targets, 1e-3)
            );
        }
        let altered = String::from_utf8(moving.clone())
            .unwrap()
            .replace("1.234", "1.235")
            .into_bytes();
        let other = frame(7, &Request::Status).unwrap();
        for none in [
            altered,
            other.clone(),
            [other, moving.clone()].concat(),
            moving[1..].to_vec(),
            Vec::new(),
        ] {
            assert_eq!(SentMove::of(&none), None);
        }
    }
}
