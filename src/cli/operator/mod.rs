//! The operator: prompts, the release of motion, the live screen and the plain lines. In: what the
//! run reports, and keys. Out: answers and stop requests. It commands no rig.

pub(crate) mod confirm_release;
pub(crate) mod dialogue;
pub(crate) mod expected;
pub(crate) mod held;
pub(crate) mod hold_status;
pub(crate) mod pace;
pub(crate) mod question;
pub(crate) mod real_rig;
pub(crate) mod screen;
pub(crate) mod shown;
pub(crate) mod watch;
