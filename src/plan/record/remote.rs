//! The requests of a client that drives the rig: entries of the run log, whatever their protocol. A served session is a
//! function of its plan, of these requests and of the answers of the rig. It knows no protocol and no rig.

use serde::{Deserialize, Serialize};

/// One request of the client.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "asks")]
pub enum Request {
    /// A client has connected; its address.
    Come {
        client: String,
    },
    /// \[m\]
    Propose {
        target: f64,
    },
    /// Targets of every axis of a rig that has several \[m\].
    ProposeAll {
        targets: Vec<f64>,
    },
    /// Targets of every axis \[m\], and the speed \[m/s\].
    ProposeAt {
        targets: Vec<f64>,
        speed: f64,
    },
    /// A target that is not a finite number and cannot be logged as one: `NaN`, `inf`. It is refused like any other invalid target. For
    /// several axes every target, separated by spaces.
    ProposeNoNumber {
        said: String,
    },
    /// Execute the last proposal, settle, read.
    Execute,
    /// The step is final.
    Commit,
    Read,
    Hold,
    /// A remark in the client's text that moves nothing.
    Remark {
        text: String,
    },
    /// The client has disconnected, or was disconnected.
    Leave {
        disconnect: Disconnect,
        reason: String,
    },
    /// No further client is served.
    Close,
}

/// How a client's session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Disconnect {
    /// The client closed the session.
    Closed,
    /// A limit or the operator stopped it.
    Stopped,
    /// The client or the rig failed.
    Failed,
}

impl Request {
    /// A proposal of a target for every axis, finite or not.
    #[must_use]
    pub fn targets(targets: &[f64]) -> Self {
        match targets {
            [target] if target.is_finite() => Self::Propose { target: *target },
            targets if targets.iter().all(|target| target.is_finite()) => Self::ProposeAll {
                targets: targets.to_vec(),
            },
            targets => {
                let words: Vec<String> = targets.iter().map(f64::to_string).collect();
                Self::ProposeNoNumber {
                    said: words.join(" "),
                }
            }
        }
    }

    /// [`Self::targets`] at a speed \[m/s\].
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

    /// The proposed targets \[m\], one per axis, and the speed \[m/s\]; None for other requests.
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

/// Executed targets and the readings there, one entry per axis.
#[derive(Clone, Debug, PartialEq)]
pub struct DrivenStep {
    /// From 1, over all clients.
    pub step: u64,
    /// Rig time \[s\].
    pub time: f64,
    /// \[m\]
    pub command: Vec<f64>,
    /// \[m\]
    pub displacement: Vec<f64>,
    /// \[N\]
    pub force: Vec<f64>,
}
