//! `rig NAME { … }`: how it is reached, when a reading counts; and which rig a run uses.

use super::checker::{Checker, Place};
use super::choice::Chosen;
use super::faults::whole as fault;
use crate::plan::{Calibration, Link, RigPlan, Settle, VirtualLink};
use crate::schema::Kind;
use crate::source::FileId;

/// At once, for as long as it takes up to ten seconds.
const AT_ONCE: Settle = Settle { band: 0.0, force_rate: 0.0, dwell: 0.0, timeout: 10.0 };

/// The rig of the run, and the `limits` block it names.
pub struct CheckedRig {
    pub plan: RigPlan,
    pub limits: Option<usize>,
}

/// Checks every rig; gives the one named by `--rig`, else the first of the plan itself, else an ideal one.
pub fn rig_of_run(checker: &mut Checker, asked: Option<&str>) -> Option<CheckedRig> {
    let rigs: Vec<(usize, bool)> =
        checker.scope.of_kind(Kind::Rig).map(|(index, block)| (index, block.span.file == FileId(0))).collect();
    let names: Vec<&str> =
        checker.scope.of_kind(Kind::Rig).filter_map(|(_, block)| block.name).map(|name| name.node.as_str()).collect();
    let mut checked: Vec<(bool, Option<CheckedRig>)> = rigs.into_iter().map(|(index, own)| (own, rig(checker, index))).collect();
    if let Some(asked) = asked {
        let position = names.iter().position(|name| *name == asked);
        return match position {
            Some(position) => checked.swap_remove(position).1,
            None if asked == IDEAL => Some(ideal()),
            None if checker.names_lost => None,
            None => checker.fail(fault::unknown_rig(asked, &names)),
        };
    }
    match checked.iter().position(|(own, _)| *own) {
        Some(first) => checked.swap_remove(first).1,
        None => Some(ideal()),
    }
}

/// Name of the virtual rig that adds nothing to the specimen.
const IDEAL: &str = "ideal";

fn ideal() -> CheckedRig {
    let plan = RigPlan {
        name: IDEAL.to_owned(),
        link: Link::Virtual(VirtualLink::default()),
        settle: AT_ONCE,
        sign: 1.0,
        calibration: Calibration::default(),
    };
    CheckedRig { plan, limits: None }
}

fn rig(checker: &mut Checker, block: usize) -> Option<CheckedRig> {
    let link = match checker.choice(block, "link") {
        Some(chosen) => virtual_link(checker, &chosen, place_of(checker, block, "link")?),
        None => None,
    };
    let settle = match checker.given(block, "settle") {
        Some((entry, _)) => {
            let place = checker.place(block, entry);
            checker.choice(block, "settle").and_then(|chosen| settle(checker, &chosen, place))
        }
        None => Some(AT_ONCE),
    };
    let sign = checker.word(block, "sign", "positive").map(|word| if word == "negative" { -1.0 } else { 1.0 });
    let calibration = match checker.given(block, "calibration") {
        Some(_) => checker.text_field(block, "calibration").map(Some),
        None => Some(None),
    };
    let limits = match checker.given(block, "limits") {
        Some(_) => checker.reference(block, "limits", Kind::Limits).map(Some),
        None => Some(None),
    };
    let name = checker.scope.blocks[block].name?.node.clone();
    let plan = RigPlan {
        name,
        link: Link::Virtual(link?),
        settle: settle?,
        sign: sign?,
        calibration: Calibration { reference: calibration?, ..Calibration::default() },
    };
    Some(CheckedRig { plan, limits: limits? })
}

fn place_of(checker: &Checker, block: usize, field: &str) -> Option<Place> {
    checker.given(block, field).map(|(entry, _)| checker.place(block, entry))
}

fn virtual_link<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>, place: Place) -> Option<VirtualLink> {
    let mut number = |name: &str| checker.constant_argument(chosen, name, place);
    let (noise, resolution, force_resolution) = (number("noise"), number("resolution"), number("force_resolution"));
    let (lag, tracking, drift, seed) = (number("lag"), number("tracking"), number("drift"), number("seed"));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the schema bounds it to 0 .. 2^53, whole")]
    let seed = seed? as u64;
    Some(VirtualLink {
        noise: noise?,
        resolution: resolution?,
        force_resolution: force_resolution?,
        lag: lag?,
        tracking: tracking?,
        drift: drift?,
        seed,
    })
}

fn settle<'a>(checker: &mut Checker<'a>, chosen: &Chosen<'a>, place: Place) -> Option<Settle> {
    let mut number = |name: &str| checker.constant_argument(chosen, name, place);
    let (band, force_rate, dwell, timeout) = (number("displacement"), number("force_rate"), number("for"), number("timeout"));
    Some(Settle { band: band?, force_rate: force_rate?, dwell: dwell?, timeout: timeout? })
}
