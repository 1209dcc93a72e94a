//! Check of `rig NAME { … }`: connection, reading rules, axes, and which rig a run uses. In: the
//! blocks of the plan. Out: the checked rig. It opens no port.

pub mod axes;
pub mod axial;
pub mod axis_devices;
pub mod device;
pub mod dialect;
pub mod line_text;
pub mod probe;
pub mod real;
pub mod real_warnings;
pub mod zero_drift;

use crate::check::violations::{DayOfNoCalibration, NotADay};
use crate::check::wording::suggestion;
use crate::codes::{E401, E603, E614};
use crate::syntax::ast::{Expr, ExprKind, Ident};
use psd_plan::schema::{Kind, RigKind, rig as schema};
use psd_plan::{Calibration, Link, RigPlan, Settle, VirtualLink};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::{FileId, Span};

use super::checker::{Checker, Context};
use super::expressions::calendar;
use super::expressions::choice::Chosen;

/// An immediate move, for a settling time of up to ten seconds.
const IMMEDIATE: Settle = Settle {
    band: 0.0,
    force_rate: 0.0,
    dwell: 0.0,
    timeout: 10.0,
};

/// The rig of the run, its block, and the `limits` block it names.
pub struct CheckedRig {
    pub plan: RigPlan,
    pub limits: Option<usize>,
    /// None for the ideal rig, which is not declared.
    pub block: Option<usize>,
}

/// The rig of the run, if it moves a real specimen: only if `--rig` names it.
pub fn real_rig_of_run(checker: &Checker, requested: Option<&str>) -> Option<usize> {
    let named = |name: Option<&crate::syntax::ast::Ident>| {
        name.is_some_and(|name| Some(name.node.as_str()) == requested)
    };
    let block = checker
        .scope
        .of_kind(Kind::Rig)
        .find(|(_, block)| named(block.name))
        .map(|(index, _)| index);
    // If its link is missing or invalid, its other entries determine the kind of the rig.
    let real = |block: usize| {
        kind(checker, block).map_or_else(
            || has_fields_of_real_rigs(checker, block),
            |kind| kind == RigKind::Real,
        )
    };
    block.filter(|block| real(*block))
}

/// Whether a rig's block has a field that only real rigs read.
pub fn has_fields_of_real_rigs(checker: &Checker, block: usize) -> bool {
    let declared = &checker.scope.blocks[block];
    let real_only = |key: &str| {
        declared
            .kind
            .field(key)
            .is_some_and(|field| field.real_rig_only)
    };
    declared
        .block
        .fields
        .iter()
        .any(|entry| real_only(&entry.key.node))
}

/// The fields that connect the rig of the run, if it moves a real specimen.
pub fn links_of_run(checker: &Checker, requested: Option<&str>) -> Vec<Span> {
    let Some(block) = real_rig_of_run(checker, requested) else {
        return Vec::new();
    };
    let entries = &checker.scope.blocks[block].block.fields;
    let reach = |key: &str| {
        key == schema::LINK.name
            || key == schema::AXES.name
            || key.starts_with(schema::ACTUATOR.name)
            || key.starts_with(schema::LOAD_CELL.name)
    };
    entries
        .iter()
        .filter(|entry| reach(&entry.key.node))
        .map(|entry| entry.key.span.to(entry.value.span))
        .collect()
}

struct UnknownRig<'a> {
    name: &'a str,
    known: &'a [&'a str],
}

impl Violation for UnknownRig<'_> {
    const CODE: Code = E603;

    fn diagnostic(self) -> Diagnostic {
        let Self { name, known } = self;
        let help = if known.is_empty() {
            "remove `--rig`: the plan declares no rig and runs on an ideal one".to_owned()
        } else {
            suggestion(name, known.iter().copied())
        };
        Diagnostic::new(Self::CODE, format!("`--rig {name}`: unknown rig")).help(help)
    }
}

/// Checks every rig; returns the one named by `--rig`, else the first virtual one of the plan itself, else an ideal one.
pub fn rig_of_run(checker: &mut Checker, requested: Option<&str>) -> Option<CheckedRig> {
    let rigs: Vec<(usize, bool)> = checker
        .scope
        .of_kind(Kind::Rig)
        .map(|(index, block)| {
            (
                index,
                block.span.file == FileId(0) && kind(checker, index) != Some(RigKind::Real),
            )
        })
        .collect();
    let names: Vec<&str> = checker
        .scope
        .of_kind(Kind::Rig)
        .filter_map(|(_, block)| block.name)
        .map(|name| name.node.as_str())
        .collect();
    let mut checked: Vec<(bool, Option<CheckedRig>)> = rigs
        .into_iter()
        .map(|(index, is_default)| (is_default, rig(checker, index)))
        .collect();
    if let Some(requested) = requested {
        let position = names.iter().position(|name| *name == requested);
        return match position {
            Some(position) => checked.swap_remove(position).1,
            None if requested == IDEAL => Some(ideal()),
            None if checker.names_lost => None,
            None => checker.fail(UnknownRig {
                name: requested,
                known: &names,
            }),
        };
    }
    match checked.iter().position(|(is_default, _)| *is_default) {
        Some(first) => checked.swap_remove(first).1,
        None => Some(ideal()),
    }
}

/// Name of the virtual rig without errors.
const IDEAL: &str = "ideal";

fn ideal() -> CheckedRig {
    let plan = RigPlan {
        name: IDEAL.to_owned(),
        link: Link::Virtual(VirtualLink::default()),
        settle: IMMEDIATE,
        polarity: 1.0,
        calibration: Calibration::default(),
        zero_drift: None,
        simulated_axes: Vec::new(),
    };
    CheckedRig {
        plan,
        limits: None,
        block: None,
    }
}

/// The kind of a rig, by its link; None if the link is invalid.
pub fn kind(checker: &Checker, block: usize) -> Option<RigKind> {
    if checker.field(block, schema::ACTUATOR.name).is_some()
        || checker.field(block, schema::LOAD_CELL.name).is_some()
    {
        return Some(RigKind::Real);
    }
    match word(&checker.field(block, schema::LINK.name)?.1.value)? {
        "virtual" => Some(RigKind::Virtual),
        "serial" | "tcp" => Some(RigKind::Real),
        _ => None,
    }
}

/// The word of a variant: `serial` of `serial(…)`.
fn word(written: &Expr) -> Option<&str> {
    match &written.kind {
        ExprKind::Name(name) => Some(name),
        ExprKind::Call { name, .. } => Some(&name.node),
        ExprKind::Parenthesised(inner) => word(inner),
        _ => None,
    }
}

fn rig(checker: &mut Checker, block: usize) -> Option<CheckedRig> {
    let kind = kind(checker, block);
    let calibration = calibration(checker, block);
    let link = match kind {
        Some(RigKind::Real) => real::real_link(checker, block).map(Link::Real),
        Some(RigKind::Virtual) => {
            without_use(checker, block);
            let chosen = checker.choice(block, schema::LINK.name);
            chosen
                .and_then(|chosen| {
                    virtual_link(
                        checker,
                        &chosen,
                        context_of(checker, block, schema::LINK.name)?,
                    )
                })
                .map(Link::Virtual)
        }
        // Reports its error.
        None => checker.choice(block, schema::LINK.name).and(None),
    };
    let settle = match checker.field(block, schema::SETTLE.name) {
        Some((entry, _)) => {
            let context = checker.context_of(block, entry);
            checker
                .choice(block, schema::SETTLE.name)
                .and_then(|chosen| settle(checker, &chosen, context, kind))
        }
        None => Some(IMMEDIATE),
    };
    let polarity = checker
        .word(block, schema::POLARITY.name, "positive")
        .map(|word| if word == "negative" { -1.0 } else { 1.0 });
    let limits = match checker.field(block, schema::LIMITS.name) {
        Some(_) => checker
            .reference(block, schema::LIMITS.name, Kind::Limits)
            .map(Some),
        None => Some(None),
    };
    let drift = zero_drift::zero_drift(checker, block, kind);
    let simulated_axes = match kind {
        Some(RigKind::Virtual) => axes::simulated(checker, block),
        _ => Some(Vec::new()),
    };
    let name = checker.scope.blocks[block].name?.node.clone();
    let (mut calibration, drift) = (calibration?, drift?);
    // Rectangular distribution of the zero drift within its bound (JCGM 100:2008, 4.3.7).
    calibration.zero_drift = drift.map_or(0.0, |check| check.force / 3.0_f64.sqrt());
    let plan = RigPlan {
        name,
        link: link?,
        settle: settle?,
        polarity: polarity?,
        calibration,
        zero_drift: drift,
        simulated_axes: simulated_axes?,
    };
    Some(CheckedRig {
        plan,
        limits: limits?,
        block: Some(block),
    })
}

struct FieldOfRealRigs<'a> {
    key: &'a Ident,
}

impl Violation for FieldOfRealRigs<'_> {
    const CODE: Code = E614;

    fn diagnostic(self) -> Diagnostic {
        let Self { key } = self;
        let field = &key.node;
        let help = match field.as_str() {
            name if [schema::NOISE.name, schema::RESOLUTION.name].contains(&name) => {
                format!(
                    "write it inside the link, as in `link = virtual({field}: …)`, or remove it"
                )
            }
            _ => format!("remove `{field}`"),
        };
        Diagnostic::new(
            Self::CODE,
            format!("`{field}` applies to real rigs only, but this rig is virtual"),
        )
        .at(key.span, "not used")
        .help(help)
    }
}

/// Fields of a real rig have no effect on a virtual one, which is reported.
fn without_use(checker: &mut Checker, block: usize) {
    let declared = &checker.scope.blocks[block];
    for entry in &declared.block.fields {
        if declared
            .kind
            .field(&entry.key.node)
            .is_some_and(|field| field.real_rig_only)
        {
            checker.report(FieldOfRealRigs { key: &entry.key });
        }
    }
}

/// The span of the entry of a field.
pub fn context_of(checker: &Checker, block: usize, field: &str) -> Option<Context> {
    checker
        .field(block, field)
        .map(|(entry, _)| checker.context_of(block, entry))
}

/// The span of an axis in the list of a rig.
pub fn item_of(checker: &Checker, block: usize, axis: usize) -> Option<Span> {
    let (_, written) = checker.field(block, schema::AXES.name)?;
    Some(written.value.item_span(axis))
}

fn virtual_link<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
) -> Option<VirtualLink> {
    let mut number = |name: &str| checker.constant_argument(chosen, name, context);
    let (noise, resolution, force_resolution) = (
        number(schema::NOISE.name),
        number(schema::RESOLUTION.name),
        number(schema::FORCE_RESOLUTION.name),
    );
    let (lag, tracking, drift, seed) = (
        number(schema::LAG.name),
        number(schema::TRACKING.name),
        number(schema::ZERO_DRIFT.name),
        number(schema::SEED.name),
    );
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the schema bounds it to 0 .. 2^53, whole"
    )]
    let seed = seed? as u64;
    Some(VirtualLink {
        noise: noise?,
        resolution: resolution?,
        force_resolution: force_resolution?,
        lag: lag?,
        tracking: tracking?,
        drift: drift?,
        seed,
        predicted: None,
    })
}

#[derive(Violation)]
#[violation(
    E401,
    "`{field}` of a real rig must be greater than 0: readings always vary"
)]
#[help("write a tolerance of a few times the noise of the rig")]
struct NeverSettles<'a> {
    field: &'a str,
    #[label("too small")]
    span: Span,
}

fn settle<'a>(
    checker: &mut Checker<'a>,
    chosen: &Chosen<'a>,
    context: Context,
    kind: Option<RigKind>,
) -> Option<Settle> {
    let mut number = |name: &str| checker.constant_argument(chosen, name, context);
    let (band, force_rate, dwell, timeout) = (
        number(schema::SETTLED_WITHIN.name),
        number(schema::FORCE_RATE.name),
        number(schema::SETTLED_FOR.name),
        number(schema::TIMEOUT.name),
    );
    let settle = Settle {
        band: band?,
        force_rate: force_rate?,
        dwell: dwell?,
        timeout: timeout?,
    };
    for (name, bound) in [
        (schema::SETTLED_WITHIN.name, settle.band),
        (schema::FORCE_RATE.name, settle.force_rate),
    ] {
        if let (Some(RigKind::Real), Some(span)) = (kind, chosen.span(name))
            && bound == 0.0
        {
            return checker.fail(NeverSettles { field: name, span });
        }
    }
    Some(settle)
}

/// The calibrations; the scale factor of raw counts is checked with the real rig.
fn calibration(checker: &mut Checker, block: usize) -> Option<Calibration> {
    let mut text = |field: &str| match checker.field(block, field) {
        Some(_) => checker.text_field(block, field).map(Some),
        None => Some(None),
    };
    let (reference, due, force_class) = (
        text(schema::CALIBRATION.name),
        text(schema::CALIBRATION_DUE.name),
        text(schema::FORCE_CLASS.name),
    );
    let (own, own_due) = (
        text(schema::DISPLACEMENT_CALIBRATION.name),
        text(schema::DISPLACEMENT_CALIBRATION_DUE.name),
    );
    let displacement_class = text(schema::DISPLACEMENT_CLASS.name);
    for (field, due) in [
        (schema::CALIBRATION_DUE.name, &due),
        (schema::DISPLACEMENT_CALIBRATION_DUE.name, &own_due),
    ] {
        if let (Some(Some(day)), Some((_, entry))) = (due, checker.field(block, field))
            && !calendar::is_day(day)
        {
            return checker.fail(NotADay {
                day,
                span: entry.value.span,
            });
        }
    }
    let newtons_per_count = match checker.field(block, schema::FORCE_PER_COUNT.name) {
        Some(_) => checker
            .constant(block, schema::FORCE_PER_COUNT.name)
            .map(Some),
        None => Some(None),
    };
    let zero_offset = checker.constant(block, schema::ZERO_OFFSET.name);
    let (own, own_due) = (own?, own_due?);
    if own.is_none()
        && let Some((_, entry)) = checker.field(block, schema::DISPLACEMENT_CALIBRATION_DUE.name)
    {
        return checker.fail(DayOfNoCalibration {
            field: &entry.key.node,
            at: entry.key.span,
        });
    }
    let (force, displacement) = (
        checker.constant(block, schema::FORCE_UNCERTAINTY.name),
        checker.constant(block, schema::DISPLACEMENT_UNCERTAINTY.name),
    );
    let zero = checker.constant(block, schema::ZERO_UNCERTAINTY.name);
    let mut range = |field| {
        checker
            .bounds(block, field)
            .map(|range| range.is_bounded().then_some(range))
    };
    let (force_calibrated, displacement_calibrated) = (
        range(schema::FORCE_CALIBRATION_RANGE.name),
        range(schema::DISPLACEMENT_CALIBRATION_RANGE.name),
    );
    Some(Calibration {
        reference: reference?,
        due: due?,
        force_class: force_class?,
        force_calibrated: force_calibrated?,
        displacement: own.map(|reference| (reference, own_due)),
        displacement_class: displacement_class?,
        displacement_calibrated: displacement_calibrated?,
        newtons_per_count: newtons_per_count?,
        zero_offset: zero_offset?,
        force_uncertainty: force?,
        displacement_uncertainty: displacement?,
        zero_uncertainty: zero?,
        zero_drift: 0.0,
    })
}
