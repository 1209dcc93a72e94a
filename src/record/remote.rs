//! What a client asks of the rig that it drives: the words of the record, whatever protocol they came in. A served session
//! is a function of its plan, of these requests and of what the rig answers. It knows no protocol and no rig.

use serde::{Deserialize, Serialize};

/// One request, as it was taken from the client.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "asks")]
pub enum Request {
    /// A client has come; its address.
    Come {
        client: String,
    },
    /// m
    Propose {
        target: f64,
    },
    /// Targets of every axis of a rig that has several, m.
    ProposeAll {
        targets: Vec<f64>,
    },
    /// Targets of every axis, m, and how fast, m/s.
    ProposeAt {
        targets: Vec<f64>,
        speed: f64,
    },
    /// A target that is no number and that no line of the record can hold: `NaN`, `inf`. Refused as any other. Of several axes
    /// every target, with blanks between.
    ProposeNoNumber {
        said: String,
    },
    /// Carry out what was proposed last, settle, read.
    Execute,
    /// The step is final.
    Commit,
    Read,
    Hold,
    /// Something in the client's words that moves nothing.
    Remark {
        text: String,
    },
    /// The client is gone, or was sent away.
    Leave {
        parting: Parting,
        reason: String,
    },
    /// Nobody is served any more.
    Close,
}

/// How a client's session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Parting {
    /// The client said so.
    Closed,
    /// A limit or a person stopped it.
    Stopped,
    /// The client or the rig failed.
    Failed,
}

impl Request {
    /// A target for every axis, whatever numbers they are.
    #[must_use]
    pub fn targets(targets: &[f64]) -> Self {
        match targets {
            [target] if target.is_finite() => Self::Propose { target: *target },
            targets if targets.iter().all(|target| target.is_finite()) => Self::ProposeAll {
                targets: targets.to_vec(),
            },
            targets => {
                let said: Vec<String> = targets.iter().map(f64::to_string).collect();
                Self::ProposeNoNumber {
                    said: said.join(" "),
                }
            }
        }
    }

    /// [`Self::targets`] at a speed, m/s.
    #[must_use]
    pub fn targets_at(targets: &[f64], speed: Option<f64>) -> Self {
        match speed.filter(|_| targets.iter().all(|target| target.is_finite())) {
            Some(speed) => Self::ProposeAt {
                targets: targets.to_vec(),
                speed,
            },
            None => Self::targets(targets),
        }
    }

    /// The targets that are proposed, m, one an axis, and how fast, m/s; none where something else is asked.
    #[must_use]
    pub fn proposed(&self) -> Option<(Vec<f64>, Option<f64>)> {
        let targets = match self {
            Self::Propose { target } => Some(vec![*target]),
            Self::ProposeAll { targets } | Self::ProposeAt { targets, .. } => Some(targets.clone()),
            Self::ProposeNoNumber { said } => Some(
                said.split(' ')
                    .map(|word| word.parse().unwrap_or(f64::NAN))
                    .collect(),
            ),
            _ => None,
        }?;
        let speed = if let Self::ProposeAt { speed, .. } = self {
            Some(*speed)
        } else {
            None
        };
        Some((targets, speed))
    }
}

/// Targets carried out and what was read there, one entry an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivenStep {
    /// From 1, over all clients.
    pub step: u64,
    /// Rig time, s.
    pub time: f64,
    /// m
    pub command: Vec<f64>,
    /// m
    pub displacement: Vec<f64>,
    /// N
    pub force: Vec<f64>,
}
