//! The warning that the delay of a virtual rig would add much energy to a test (W719). In: the delays of the procedures, the rig. Out:
//! warnings.

use crate::language::check::checker::Checker;
use crate::language::check::messages::methods as message;
use crate::physics::tracking::monitor;
use crate::plan::{Link, Mode, Plan, Stepping, VirtualLink};
use crate::procedures;
use crate::procedures::facts::Delay;
use crate::schema::rig::LINK;

/// Warns of every procedure in which one cycle absorbs the energy that the limit on tracking allows. `blocks` are those of the plan's
/// procedures, `rig` is that of its rig.
pub fn warn(checker: &mut Checker, plan: &Plan, blocks: &[usize], rig: Option<usize>) {
    let Link::Virtual(link) = &plan.rig.link else {
        return;
    };
    let Some(errs) = rig
        .and_then(|rig| checker.field(rig, LINK.name))
        .map(|(_, entry)| entry.value.span)
    else {
        return;
    };
    let limit = plan.limits.tracking_energy_error;
    let bound = if limit.is_bounded() {
        limit.high
    } else {
        monitor::HOLD
    };
    for (index, block) in blocks.iter().enumerate() {
        let Some(delay) = procedures::delay(&plan.procedures[index].kind, plan)
            .filter(|delay| delay.late > 0.0 && delay.energy() > bound)
        else {
            continue;
        };
        let procedure = &plan.procedures[index];
        let Some(stepping) = procedures::facts_of(&procedure.kind)
            .stepping
            .filter(|stepping| !stepping.i_modification)
        else {
            continue;
        };
        let late = message::Late {
            name: &procedure.name,
            energy: delay.energy(),
            bound,
            short: link.tracking,
            lag: link.lag,
            delay: delay.late,
            damping_ratio: delay.damping_ratio(),
            remedy: remedy(stepping, link, delay, 0.8 * bound / delay.energy()),
        };
        let head = checker.scope.blocks[*block].block.head;
        checker
            .diagnostics
            .push(message::tracking_is_late(&late, head, errs));
    }
}

/// A change that would reduce the delay to this fraction.
fn remedy(stepping: &Stepping, link: &VirtualLink, delay: Delay, part: f64) -> message::Remedy {
    match stepping.mode {
        _ if link.lag == 0.0 => message::Remedy::Shorter(part * delay.time_step),
        Mode::Continuous { time_scale } => message::Remedy::Slower(time_scale / part),
        // The remaining lag after a step decays with its time constant.
        Mode::StepAndPause => message::Remedy::Longer(-link.lag * part.ln()),
    }
}
