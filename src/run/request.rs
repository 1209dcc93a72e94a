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
    /// A target that is no number and that no line of the record can hold: `NaN`, `inf`. Refused as any other.
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
    /// A target, whatever number it is.
    #[must_use]
    pub fn target(target: f64) -> Self {
        if target.is_finite() { Self::Propose { target } } else { Self::ProposeNoNumber { said: target.to_string() } }
    }
}
