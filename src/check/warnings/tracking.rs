//! The warning that the delay of a virtual rig would add much energy to a test (W719). In: the delays of the procedures, the rig. Out:
//! warnings.

use crate::codes::W719;
use crate::procedures;
use crate::procedures::facts::Delay;
use psd_language::check::checker::Checker;
use psd_language::check::wording::shown;
use psd_physics::tracking::monitor;
use psd_plan::schema::rig::LINK;
use psd_plan::{Link, Mode, Plan, Stepping, VirtualLink};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::Dimension;
use psd_text::units::display::{minus, significant};

/// A change that would keep a run below its bound.
enum Remedy {
    /// A time step of at most this \[s\].
    Shorter(f64),
    /// A time scale of at least this.
    Slower(f64),
    /// A pause that is longer by this \[s\].
    Longer(f64),
}

/// An actuator with a delay.
struct Late<'a> {
    name: &'a str,
    /// The energy that one cycle absorbs, over that of the vibration.
    energy: f64,
    /// The limit at which a run is held, over the input energy.
    bound: f64,
    /// As a fraction of each increment.
    short: f64,
    /// Laboratory time \[s\].
    lag: f64,
    /// Simulated time \[s\].
    delay: f64,
    /// The effect of the delay.
    damping_ratio: f64,
    remedy: Remedy,
}

struct TrackingIsLate<'a> {
    late: &'a Late<'a>,
    head: Span,
    link: Span,
}

impl Violation for TrackingIsLate<'_> {
    const CODE: Code = W719;

    fn diagnostic(self) -> Diagnostic {
        let Self { late, head, link } = self;
        let percent = |share: f64| format!("{} %", significant(100.0 * share, 2));
        let time = |seconds: f64| shown(seconds, Dimension::TIME);
        let Late {
            name,
            energy,
            bound,
            short,
            lag,
            damping_ratio,
            ..
        } = late;
        let message = format!(
            "tracking may stop `{name}`: actuator delay adds {} to the energy of a vibration per cycle (limit {} of the input energy)",
            percent(*energy),
            percent(*bound)
        );
        let correct = "write `i_modification = true`, which corrects the force to the target";
        let help = match late.remedy {
            Remedy::Shorter(step) => {
                format!(
                    "{correct}; or write a `time_step` of at most {}",
                    time(step)
                )
            }
            Remedy::Slower(scale) => format!(
                "{correct}; or write a `time_scale` of at least {}",
                significant(scale, 3)
            ),
            Remedy::Longer(pause) => {
                format!(
                    "{correct}; or add {} to `pause`, or a tolerance in `settle`",
                    time(pause)
                )
            }
        };
        let misses = [
            (*short != 0.0).then(|| format!("undershoots increments by {}", percent(short.abs()))),
            (*lag > 0.0).then(|| format!("lags by {}", time(*lag))),
        ];
        let misses: Vec<String> = misses.into_iter().flatten().collect();
        let amounts = format!(
            "{}: delay {} of simulated time, damping ratio {}",
            misses.join(" and "),
            minus(&time(late.delay)),
            minus(&percent(*damping_ratio))
        );
        Diagnostic::new(Self::CODE, message)
            .at(head, "integrated with this delay")
            .at(link, amounts)
            .help(help)
    }
}

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
        let late = Late {
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
        checker.report(TrackingIsLate {
            late: &late,
            head,
            link: errs,
        });
    }
}

/// A change that would reduce the delay to this fraction.
fn remedy(stepping: &Stepping, link: &VirtualLink, delay: Delay, part: f64) -> Remedy {
    match stepping.mode {
        _ if link.lag == 0.0 => Remedy::Shorter(part * delay.time_step),
        Mode::Continuous { time_scale } => Remedy::Slower(time_scale / part),
        // The remaining lag after a step decays with its time constant.
        Mode::RampAndHold => Remedy::Longer(-link.lag * part.ln()),
    }
}
