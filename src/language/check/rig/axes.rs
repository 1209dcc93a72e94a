//! `axes = [axis(…), …]` of a rig: the entries of each actuator with its load cell. In: the block of a rig. Out:
//! an [`AxisPlan`] each. It also compares their number with the storeys of the specimen; `device` reads the devices.

use crate::check::checker::{Checker, Context};
use crate::check::expressions::calendar;
use crate::check::expressions::choice::Chosen;
use crate::check::violations::{DayOfNoCalibration, EmptyList, NotADay};
use crate::check::wording::axes_of;
use crate::codes::E615;
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::schema::{limits, rig as schema};
use psd_plan::{AxisCalibration, AxisPlan, Frame, Part, Specimen};
use psd_text::count::counted_in_words;
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;

use super::axial;
use super::device::{Device, device};
use super::probe::probe;
use super::{CheckedRig, context_of, item_of};

/// One axis, with the spans of its separate devices.
pub struct CheckedAxis {
    pub plan: AxisPlan,
    pub actuator: Option<Device>,
    pub load_cell: Option<Device>,
}

/// The axes that a rig lists; empty if it lists none.
pub fn axes(checker: &mut Checker, block: usize) -> Option<Vec<CheckedAxis>> {
    let Some((_, written)) = checker.field(block, schema::AXES.name) else {
        return Some(Vec::new());
    };
    let (at, context) = (
        written.value.span,
        context_of(checker, block, schema::AXES.name)?,
    );
    let chosen = checker.choices(block, schema::AXES.name)?;
    if chosen.is_empty() {
        return checker.fail(EmptyList { span: at });
    }
    let axes: Vec<Option<CheckedAxis>> = chosen
        .iter()
        .map(|chosen| axis(checker, block, chosen, context))
        .collect();
    let axes: Vec<CheckedAxis> = axes.into_iter().collect::<Option<_>>()?;
    let is_axial: Vec<bool> = axes.iter().map(|axis| axis.plan.axial.is_some()).collect();
    axial::check_order(checker, block, &is_axial)?;
    Some(axes)
}

/// The axes that a virtual rig lists.
pub fn simulated(checker: &mut Checker, block: usize) -> Option<Vec<AxisPlan>> {
    if checker.field(block, schema::AXES.name).is_some() {
        for chosen in checker.choices(block, schema::AXES.name)? {
            axial::simulated(checker, &chosen);
        }
    }
    let axes = axes(checker, block)?;
    Some(axes.into_iter().map(|axis| axis.plan).collect())
}

fn axis<'a>(
    checker: &mut Checker<'a>,
    block: usize,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<CheckedAxis> {
    let polarity = match chosen.span(schema::POLARITY.name) {
        Some(_) => checker
            .chosen_argument(chosen, schema::POLARITY.name)
            .map(|word| {
                Some(if word.variant.name == "negative" {
                    -1.0
                } else {
                    1.0
                })
            }),
        None => Some(None),
    };
    let pretest_check = match chosen.span(schema::PRETEST_CHECK.name) {
        Some(_) => checker
            .chosen_argument(chosen, schema::PRETEST_CHECK.name)
            .and_then(|pretest_check| probe(checker, &pretest_check, context))
            .map(Some),
        None => Some(None),
    };
    let (displacement, force) = (
        checker.bounds_argument(chosen, limits::DISPLACEMENT.name, context),
        checker.bounds_argument(chosen, limits::FORCE.name, context),
    );
    let (resolution, noise) = (
        checker.optional_argument(chosen, schema::RESOLUTION.name, context),
        checker.optional_argument(chosen, schema::NOISE.name, context),
    );
    let force_range = checker.bounds_argument(chosen, schema::FORCE_RANGE.name, context);
    let calibration = calibration(checker, block, chosen, context);
    let (actuator, load_cell) = (
        own_device(checker, chosen, schema::ACTUATOR.name, context),
        own_device(checker, chosen, schema::LOAD_CELL.name, context),
    );
    let (actuator, load_cell) = (actuator?, load_cell?);
    let link = |device: &Option<Device>| device.as_ref().map(|device| device.link.clone());
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count from 1 to 64"
    )]
    let index = |number: f64| number as usize - 1;
    let [storey, element] = [schema::AXIS_STOREY, schema::AXIS_ELEMENT]
        .map(|named| checker.optional_argument(chosen, named, context));
    let axial = axial::axial(checker, chosen, displacement?, context);
    let plan = AxisPlan {
        storey: storey?.map(index),
        element: element?.map(index),
        polarity: polarity?,
        pretest_check: pretest_check?,
        displacement: displacement?,
        force: force?,
        resolution: resolution?,
        noise: noise?,
        force_range: force_range?,
        calibration: calibration?,
        actuator: link(&actuator),
        load_cell: link(&load_cell),
        axial: axial?,
    };
    Some(CheckedAxis {
        plan,
        actuator,
        load_cell,
    })
}

/// A separate device of the axis: `Some(None)` if it has none.
#[expect(
    clippy::option_option,
    reason = "left out and faulty are different things here"
)]
fn own_device<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    role: &str,
    context: Context,
) -> Option<Option<Device>> {
    let Some(at) = chosen.span(role) else {
        return Some(None);
    };
    let link = checker.chosen_argument(chosen, role)?;
    device(checker, &link, at, context).map(Some)
}

/// The calibrations of one axis.
fn calibration<'a>(
    checker: &mut Checker<'a>,
    block: usize,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<AxisCalibration> {
    let mut day = |name: &str| match checker.text_argument(chosen, name)? {
        Some((day, at)) if !calendar::is_day(&day) => checker.fail(NotADay {
            day: &day,
            span: at,
        }),
        day => Some(day),
    };
    let (due, displacement_due) = (
        day(schema::CALIBRATION_DUE.name),
        day(schema::DISPLACEMENT_CALIBRATION_DUE.name),
    );
    let mut text = |name: &str| {
        checker
            .text_argument(chosen, name)
            .map(|given| given.map(|(text, _)| text))
    };
    let (reference, displacement) = (
        text(schema::CALIBRATION.name),
        text(schema::DISPLACEMENT_CALIBRATION.name),
    );
    let (force_class, displacement_class) = (
        text(schema::FORCE_CLASS.name),
        text(schema::DISPLACEMENT_CLASS.name),
    );
    let mut number = |name: &str| checker.optional_argument(chosen, name, context);
    let (force, length) = (
        number(schema::FORCE_UNCERTAINTY.name),
        number(schema::DISPLACEMENT_UNCERTAINTY.name),
    );
    let zero = number(schema::ZERO_UNCERTAINTY.name);
    let (newtons_per_count, zero_offset) = (
        number(schema::FORCE_PER_COUNT.name),
        number(schema::ZERO_OFFSET.name),
    );
    let mut range = |name: &str| checker.bounds_argument(chosen, name, context);
    let (force_calibrated, displacement_calibrated) = (
        range(schema::FORCE_CALIBRATION_RANGE.name),
        range(schema::DISPLACEMENT_CALIBRATION_RANGE.name),
    );
    let (displacement, displacement_due) = (displacement?, displacement_due?);
    if let (None, None, Some((_, at))) = (
        &displacement,
        checker.field(block, schema::DISPLACEMENT_CALIBRATION.name),
        &displacement_due,
    ) {
        return checker.fail(DayOfNoCalibration {
            field: schema::DISPLACEMENT_CALIBRATION_DUE.name,
            at: *at,
        });
    }
    let text = |given: Option<(String, Span)>| given.map(|(text, _)| text);
    Some(AxisCalibration {
        reference: reference?,
        due: text(due?),
        force_class: force_class?,
        force_calibrated: force_calibrated?,
        displacement,
        displacement_due: text(displacement_due),
        displacement_class: displacement_class?,
        displacement_calibrated: displacement_calibrated?,
        newtons_per_count: newtons_per_count?,
        zero_offset: zero_offset?,
        force_uncertainty: force?,
        displacement_uncertainty: length?,
        zero_uncertainty: zero?,
    })
}

struct AnotherNumberOfAxes<'a> {
    rig: &'a str,
    /// That move a storey sideways.
    axes: usize,
    axial: usize,
    specimen: &'a str,
    storeys: usize,
    word: &'static str,
    is_hybrid: bool,
    at: Span,
}

impl Violation for AnotherNumberOfAxes<'_> {
    const CODE: Code = E615;

    fn diagnostic(self) -> Diagnostic {
        let Self {
            rig,
            axes,
            axial,
            specimen,
            storeys,
            word,
            is_hybrid,
            at,
        } = self;
        let needs = match storeys {
            _ if is_hybrid => {
                format!(
                    "the frame `{specimen}` has {} tested",
                    members_of(word, storeys)
                )
            }
            1 => format!("`{specimen}` has one degree of freedom"),
            _ => format!("the frame `{specimen}` has {storeys} storeys"),
        };
        let help = match storeys {
            _ if axial > 0 => format!(
                "list {} before the axial ones, the lowest storey first",
                axes_of(storeys)
            ),
            1 => "remove `axes`: a rig without it has one axis".to_owned(),
            _ => format!(
                "list {storeys} axes, {}: axes = [{}]",
                if word == "storey" {
                    "the lowest storey first"
                } else {
                    "in the order of the elements"
                },
                vec!["axis"; storeys].join(", ")
            ),
        };
        Diagnostic::new(
            Self::CODE,
            format!(
                "number of axes differs: rig `{rig}` has {}{}, {needs}",
                axes_of(axes),
                if axial > 0 {
                    " that move a storey sideways"
                } else {
                    ""
                }
            ),
        )
        .at(at, axes_of(axes))
        .help(help)
    }
}

/// A rig must have as many axes as its specimen has storeys.
pub fn check_specimen(checker: &mut Checker, rig: Option<&CheckedRig>, specimen: &Specimen) {
    let Some(CheckedRig {
        plan,
        block: Some(block),
        ..
    }) = rig
    else {
        return;
    };
    let Some((_, written)) = checker.field(*block, schema::AXES.name) else {
        return;
    };
    let listed = plan.listed_axes();
    let lateral = listed.iter().take_while(|axis| axis.axial.is_none());
    let axes = lateral.count();
    let storeys = specimen.degrees_of_freedom();
    if axes != storeys {
        checker.report(AnotherNumberOfAxes {
            rig: &plan.name,
            axes,
            axial: listed.len() - axes,
            specimen: &specimen.name,
            storeys,
            word: specimen
                .frame
                .as_ref()
                .map_or("storey", Frame::word_for_a_member),
            is_hybrid: specimen.frame.as_ref().and_then(Assemblies::of).is_some(),
            at: written.value.span,
        });
        return;
    }
    if let Some(frame) = &specimen.frame {
        check_members(checker, frame, &listed[..axes], *block);
    }
    if let Some(rig) = rig {
        axial::check_storeys(checker, rig, specimen);
    }
}

#[derive(Violation)]
#[violation(E615, "axis {axis} moves {word} {member}, which is not on the rig")]
#[help("{}", help)]
struct AxisWithoutMember {
    axis: usize,
    word: &'static str,
    member: usize,
    #[label("{}", label)]
    at: Span,
    label: String,
    help: String,
}

#[derive(Violation)]
#[violation(E615, "{word} {member} is tested, but no axis moves it")]
#[help("list the axes {order}, one for each tested {word}: `axis({word}: {member})`")]
struct MemberWithoutAxis {
    word: &'static str,
    member: usize,
    order: &'static str,
    #[label("this axis moves {word} {moves}")]
    at: Span,
    moves: usize,
}

#[derive(Violation)]
#[violation(E615, "axis {axis} names a {named}, but the frame has {word}s")]
#[help("write `axis({word}: 1)`, with the number of a tested {word}")]
struct AxisOfAnotherFrame {
    axis: usize,
    named: &'static str,
    word: &'static str,
    #[label("of another frame")]
    at: Span,
}

/// The storeys or elements that axes name are the tested ones, in their order.
fn check_members(checker: &mut Checker, frame: &Frame, axes: &[AxisPlan], block: usize) {
    let has_elements = frame.has_elements();
    let word = frame.word_for_a_member();
    let parts: Vec<Part> = if frame.is_matrix_on_the_rig() {
        vec![Part::TESTED; frame.degrees_of_freedom()]
    } else {
        frame.members().map(|member| member.part).collect()
    };
    let is_tested = |member: usize| {
        parts
            .get(member)
            .is_some_and(|part| *part != Part::Computed)
    };
    let tested: Vec<usize> = (0..parts.len())
        .filter(|member| is_tested(*member))
        .collect();
    for (axis, plan) in axes.iter().enumerate() {
        let Some(at) = item_of(checker, block, axis) else {
            return;
        };
        let (own, other) = if has_elements {
            (plan.element, plan.storey)
        } else {
            (plan.storey, plan.element)
        };
        if other.is_some() {
            checker.report(AxisOfAnotherFrame {
                axis: axis + 1,
                named: if has_elements { "storey" } else { "element" },
                word,
                at,
            });
            return;
        }
        let Some(member) = own else { continue };
        if !is_tested(member) {
            let known = tested.iter().map(|member| (member + 1).to_string());
            let (label, help) = if member < parts.len() {
                (
                    format!("the {word} is computed"),
                    format!("write `part: tested` in the {word}, or name a tested one: "),
                )
            } else {
                (format!("no such {word}"), format!("name a tested {word}: "))
            };
            checker.report(AxisWithoutMember {
                axis: axis + 1,
                word,
                member: member + 1,
                at,
                label,
                help: format!("{help}{}", known.collect::<Vec<String>>().join(", ")),
            });
            return;
        }
        if tested[axis] != member {
            checker.report(MemberWithoutAxis {
                word,
                member: tested[axis] + 1,
                order: if has_elements {
                    "in the order of the elements"
                } else {
                    "from the ground up"
                },
                at,
                moves: member + 1,
            });
            return;
        }
    }
}

/// `one storey`, or `3 storeys`.
fn members_of(word: &str, count: usize) -> String {
    counted_in_words(count, word, &format!("{word}s"))
}
