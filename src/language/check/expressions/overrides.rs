//! Inputs of a plan by name: a `param`, a field such as `beam.mass`, an argument such as `beam.behaviour.stiffness`, or one of an entry of
//! a list, counted from 1, such as `frame.storeys.1.mass`. In: the name and the declarations. Out: the position at which the plan writes its value, or why there is none; and the values given from outside for such places.

use std::collections::BTreeMap;

use crate::check::checker::{Checker, Context, Reads, Traced, Typed};
use crate::check::rig;
use crate::check::scope::{Meaning, Scope, Setting};
use crate::check::violations::{NotFinite, OutOfRange, WrongDimensionOfQuantity};
use crate::check::wording::{one_of, suggestion};
use crate::codes::{E203, E206, E214, E656};
use crate::syntax::ast::{Argument, Entry, Expr, ExprKind};
use psd_plan::ProcedureBlock;
use psd_plan::formula::{Formula, ResultPart, ResultReference};
use psd_plan::schema::{Field, FieldType, Kind, Presence, RigKind, Variant};
use psd_text::diagnostic::{Code, Diagnostic, Violation};
use psd_text::source::Span;
use psd_text::units::{Dimension, Quantity};

/// Where the plan writes the value of an input.
#[derive(Clone, Copy)]
pub enum InputLocation<'a> {
    /// A `param`, as an index among the values.
    Parameter(usize),
    /// A field of a block, or an argument in the value of one.
    Field {
        block: usize,
        entry: usize,
        field: &'static Field,
        written: &'a Expr,
    },
    /// A measured result of an identification: the plan reads another value in its place.
    Result {
        reference: ResultReference,
        dimension: Dimension,
    },
}

/// A setting whose name has a point, and where the plan writes the value that it replaces.
pub struct LocatedSetting<'a> {
    name: &'a str,
    setting: &'a Setting,
    location: Result<InputLocation<'a>, NoInput>,
}

impl<'a> LocatedSetting<'a> {
    /// All of these settings whose names have a point.
    #[must_use]
    pub fn all(scope: &Scope<'a>, settings: &'a BTreeMap<String, Setting>) -> Vec<Self> {
        let with_points = settings.iter().filter(|(name, _)| name.contains('.'));
        let located = with_points.map(|(name, setting)| {
            let path: Vec<&str> = name.split('.').collect();
            Self {
                name,
                setting,
                location: find_input(scope, &path),
            }
        });
        located.collect()
    }
}

/// An unknown first word.
pub struct UnknownName {
    pub name: String,
    pub known: Vec<String>,
}

/// Why a field gives no number.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum NoField {
    Unknown,
    /// A known field that the plan does not write.
    NotWritten,
    /// Calculated from other fields.
    Derived,
    /// The result of a procedure.
    Result,
    List,
    NotANumber,
}

fn one_of_inputs(inputs: &[String]) -> String {
    match inputs {
        [] => "write a `param`, use it in the block, and name it here".to_owned(),
        _ => format!(
            "write a field, {}",
            one_of(inputs.iter().map(String::as_str))
        ),
    }
}

/// Why a name is not an input of the plan.
pub enum NoInput {
    Unknown(UnknownName),
    /// The name of a `let`.
    Let(String),
    /// A block without a field.
    Block {
        name: String,
        inputs: Vec<String>,
    },
    /// A name behind a number.
    InsideANumber(String),
    /// A field of a block that gives no number. `inputs`: the numbers that the block writes.
    NoField {
        path: String,
        inputs: Vec<String>,
        reason: NoField,
    },
    /// Its declaration has an error, which is reported.
    Reported,
}

impl NoInput {
    fn code(&self) -> Code {
        match self {
            Self::Unknown(_) => E203,
            Self::NoField {
                reason: NoField::Unknown,
                ..
            } => E206,
            _ => E656,
        }
    }

    fn message(&self) -> String {
        match self {
            Self::Unknown(unknown) => format!("unknown name `{}`", unknown.name),
            Self::Let(name) => format!("`{name}` is a `let`, which is calculated"),
            Self::Block { name, .. } => format!("`{name}` is a block, not a number"),
            Self::InsideANumber(name) => format!("`{name}` is one number"),
            Self::Reported => String::new(),
            Self::NoField { path, reason, .. } => match reason {
                NoField::Unknown => format!("the plan writes no `{path}`"),
                NoField::NotWritten => format!("the plan does not write `{path}`"),
                NoField::Derived => format!("`{path}` is calculated from other fields"),
                NoField::Result => format!("`{path}` is a result, not an input"),
                NoField::List => format!("`{path}` is a list, not one number"),
                NoField::NotANumber => format!("`{path}` is not a number"),
            },
        }
    }

    fn label(&self) -> &'static str {
        match self {
            Self::Unknown(_) => "unknown name",
            Self::Let(_) => "a `let`",
            Self::Block { .. } => "a block",
            Self::InsideANumber(_) | Self::Reported => "one number",
            Self::NoField { reason, .. } => match reason {
                NoField::Unknown => "unknown field",
                NoField::NotWritten => "not written in the block",
                NoField::Derived => "calculated",
                NoField::Result => "a result",
                NoField::List => "a list",
                NoField::NotANumber => "not a number",
            },
        }
    }

    fn help(&self) -> String {
        match self {
            Self::Unknown(unknown) => {
                suggestion(&unknown.name, unknown.known.iter().map(String::as_str))
            }
            Self::Let(name) => format!("write `param {name} = …` in the plan"),
            Self::Block { inputs, .. } => one_of_inputs(inputs),
            Self::InsideANumber(name) => format!("write `{name}` alone"),
            Self::Reported => String::new(),
            Self::NoField {
                path,
                inputs,
                reason,
            } => match reason {
                NoField::Unknown | NoField::Derived if !inputs.is_empty() => {
                    let last = path.rsplit('.').next().unwrap_or_default();
                    match inputs.as_slice() {
                        [only] if only.ends_with(&format!(".{last}")) => {
                            format!("write `{only}`")
                        }
                        _ => suggestion(path, inputs.iter().map(String::as_str)),
                    }
                }
                NoField::NotWritten => {
                    let field = path.rsplit('.').next().unwrap_or_default();
                    format!("write `{field} = …` in the block")
                }
                NoField::Result => {
                    let name = path.replace('.', "_");
                    format!(
                        "write `param {name} = …`, use it in the plan instead, and name `{name}` here"
                    )
                }
                _ => "write a `param`, use it in the field, and name it here".to_owned(),
            },
        }
    }
}

/// The position of the input with this path.
///
/// # Errors
/// Why the path names no input.
pub fn find_input<'a>(scope: &Scope<'a>, path: &[&str]) -> Result<InputLocation<'a>, NoInput> {
    let (&owner, rest) = path.split_first().unwrap_or((&"", &[]));
    let block = match scope.meaning(owner) {
        Some(Meaning::Value(index)) if scope.values[index].keyword == "param" => {
            return match rest.first() {
                None => Ok(InputLocation::Parameter(index)),
                Some(_) => Err(NoInput::InsideANumber(owner.to_owned())),
            };
        }
        Some(Meaning::Value(_)) => return Err(NoInput::Let(owner.to_owned())),
        Some(Meaning::Block(index)) => index,
        Some(Meaning::Poisoned) => return Err(NoInput::Reported),
        None => return Err(NoInput::Unknown(unknown(scope, owner))),
    };
    let declared = &scope.blocks[block];
    let Some((&name, rest)) = rest.split_first() else {
        return Err(NoInput::Block {
            name: owner.to_owned(),
            inputs: inputs_of(scope, block),
        });
    };
    let no_field = |reason: NoField| {
        Err(NoInput::NoField {
            path: path.join("."),
            inputs: near(inputs_of(scope, block), path),
            reason,
        })
    };
    let field = declared.kind.field(name);
    let mut entries = declared.block.fields.iter().enumerate();
    let written = entries.find(|(_, entry)| entry.key.node == name);
    if let (Some(result), Some(procedure), []) =
        (declared.kind.result(name), declared.procedure, rest)
        && matches!(
            declared.kind.kind,
            Kind::Procedure(ProcedureBlock::StiffnessRamp | ProcedureBlock::DampingSweep)
        )
        && result.measured
        && !result.list
    {
        let reference = ResultReference {
            procedure,
            name: result.name,
            part: ResultPart::Value,
        };
        return Ok(InputLocation::Result {
            reference,
            dimension: result.dimension,
        });
    }
    let (Some(field), Some((entry, written))) = (field, written) else {
        return no_field(if field.is_none() && declared.kind.result(name).is_some() {
            NoField::Result
        } else if field.is_some_and(|field| matches!(field.presence, Presence::Default { .. })) {
            NoField::NotWritten
        } else if declared.kind.export(name).is_some() {
            NoField::Derived
        } else if field.is_some() {
            NoField::NotWritten
        } else {
            NoField::Unknown
        });
    };
    let mut at = Some((field, &written.value));
    let mut variants = None;
    for name in rest {
        at = at.and_then(|(field, written)| inside(field, written, &mut variants, name));
    }
    match at {
        Some((field, written)) if is_number(field, written) => Ok(InputLocation::Field {
            block,
            entry,
            field,
            written,
        }),
        Some((field, written))
            if matches!(field.ty, FieldType::Quantities(_) | FieldType::Choices(_))
                && matches!(written.kind, ExprKind::List { .. } | ExprKind::Range { .. }) =>
        {
            no_field(NoField::List)
        }
        Some(_) => no_field(NoField::NotANumber),
        None => no_field(NoField::Unknown),
    }
}

/// Whether a field has one number. A field for one or several may have one.
fn is_number(field: &Field, written: &Expr) -> bool {
    match field.ty {
        FieldType::Quantity(_) | FieldType::Count => true,
        FieldType::Quantities(_) => {
            !matches!(written.kind, ExprKind::List { .. } | ExprKind::Range { .. })
        }
        _ => false,
    }
}

/// The argument `name` of the variant that is the value of a field, or the entry with this number. `outer`: the variants of the field
/// itself, which an inner model shares.
fn inside<'a>(
    field: &'static Field,
    written: &'a Expr,
    outer: &mut Option<&'static [Variant]>,
    name: &str,
) -> Option<(&'static Field, &'a Expr)> {
    match field.ty {
        FieldType::Choice(variants) => *outer = Some(variants),
        FieldType::Choices(variants) => {
            *outer = Some(variants);
            if let ExprKind::List { items, .. } = &written.kind {
                let number: usize = name.parse().ok()?;
                return Some((field, items.get(number.checked_sub(1)?)?));
            }
        }
        FieldType::Inner => {}
        _ => return None,
    }
    let arguments = arguments_of((*outer)?, written);
    arguments
        .into_iter()
        .find(|(argument, _)| argument.name == name)
}

/// The arguments of a call, with the schema's argument for each.
fn arguments_of<'a>(
    variants: &'static [Variant],
    written: &'a Expr,
) -> Vec<(&'static Field, &'a Expr)> {
    match &written.kind {
        ExprKind::Parenthesised(inner) => arguments_of(variants, inner),
        ExprKind::Call { name, arguments } => {
            let variant = variants.iter().find(|variant| variant.name == name.node);
            let of_variant = |(at, argument): (usize, &'a Argument)| {
                let field = match &argument.name {
                    Some(name) => variant?.argument(&name.node)?,
                    None => variant?.arguments.get(at)?,
                };
                Some((field, &argument.value))
            };
            arguments
                .iter()
                .enumerate()
                .filter_map(of_variant)
                .collect()
        }
        _ => Vec::new(),
    }
}

/// The paths of the numbers that a block writes.
fn inputs_of(scope: &Scope, block: usize) -> Vec<String> {
    fn add(
        path: &str,
        field: &'static Field,
        written: &Expr,
        outer: Option<&'static [Variant]>,
        into: &mut Vec<String>,
    ) {
        if !matches!(field.ty, FieldType::Count) && is_number(field, written) {
            into.push(path.to_owned());
            return;
        }
        let variants = match field.ty {
            FieldType::Choice(variants) | FieldType::Choices(variants) => variants,
            FieldType::Inner => outer.unwrap_or(&[]),
            _ => return,
        };
        if let (FieldType::Choices(_), ExprKind::List { items, .. }) = (field.ty, &written.kind) {
            for (number, item) in (1..).zip(items) {
                add(&format!("{path}.{number}"), field, item, outer, into);
            }
        }
        for (argument, written) in arguments_of(variants, written) {
            let path = format!("{path}.{}", argument.name);
            add(&path, argument, written, Some(variants), into);
        }
    }
    let declared = &scope.blocks[block];
    let owner = declared.name.map_or("", |name| name.node.as_str());
    let mut inputs = Vec::new();
    let known = |entry: &'_ Entry| declared.kind.field(&entry.key.node);
    for entry in &declared.block.fields {
        if let Some(field) = known(entry) {
            let path = format!("{owner}.{}", field.name);
            add(&path, field, &entry.value, None, &mut inputs);
        }
    }
    inputs
}

/// Those inputs whose last word is the one of the path; if none, all.
fn near(inputs: Vec<String>, path: &[&str]) -> Vec<String> {
    let last = path.last().copied().unwrap_or_default();
    let ends = |input: &&String| input.rsplit('.').next() == Some(last);
    let same: Vec<String> = inputs.iter().filter(ends).cloned().collect();
    if same.is_empty() { inputs } else { same }
}

/// An unknown first word, with the names that it may be.
fn unknown(scope: &Scope, name: &str) -> UnknownName {
    let values = scope.values.iter().filter(|value| value.keyword == "param");
    let values = values.map(|value| value.name.node.clone());
    let blocks = scope.blocks.iter().filter_map(|block| block.name);
    UnknownName {
        name: name.to_owned(),
        known: values.chain(blocks.map(|name| name.node.clone())).collect(),
    }
}

/// `--set bench.force_per_count=1N`
#[derive(Violation)]
#[violation(E214, "`--set {name}`: a number of a real rig is in the plan only")]
#[help("change it in the rig's block")]
struct SettingOfARealRig<'a> {
    name: &'a str,
}

/// `--set beam.mas=2kg`
#[derive(Violation)]
#[violation(E214, "`--set {name}`: {}", reason.message())]
#[help("{}", reason.help())]
struct SettingWithoutInput<'a> {
    name: &'a str,
    reason: &'a NoInput,
}

impl<'a> Checker<'a> {
    /// Takes these settings. Those that name nothing are errors, and so are numbers of a real rig: its scale factors and times are in the
    /// plan alone.
    pub fn override_fields(&mut self, settings: &[LocatedSetting<'a>]) {
        for LocatedSetting {
            name,
            setting,
            location,
        } in settings
        {
            match location {
                Ok(InputLocation::Field { block, .. })
                    if self.scope.blocks[*block].kind.kind == Kind::Rig
                        && rig::kind(self, *block) == Some(RigKind::Real) =>
                {
                    self.report(SettingOfARealRig { name });
                }
                Ok(InputLocation::Field { written, .. }) => {
                    self.overrides.insert(written.span, (name, setting));
                }
                Ok(InputLocation::Parameter(_)) => {}
                Ok(InputLocation::Result {
                    reference,
                    dimension,
                }) => self.override_result(name, setting, *reference, *dimension),
                Err(reason) => self.report(SettingWithoutInput { name, reason }),
            }
        }
    }

    /// A result that the plan reads as this number instead. A result of a real rig is measured, and stays so.
    fn override_result(
        &mut self,
        name: &str,
        setting: &'a Setting,
        reference: ResultReference,
        dimension: Dimension,
    ) {
        if self.real_rig.is_some() {
            self.report(SettingOfARealRig { name });
            return;
        }
        let Some(owner) = self.procedure(reference.procedure) else {
            return;
        };
        let head = self.scope.blocks[owner].block.head;
        let Traced { value, is_bound } = self.traced(|checker| match setting {
            Setting::Written(set) => checker.setting(set, dimension, name),
            Setting::Bound(input) if input.dimension == dimension => {
                let formula = Formula::Constant(checker.bound_value(*input).value);
                Some(Typed::number(formula, dimension, head))
            }
            Setting::Bound(_) => None,
        });
        if let Some(value) = value {
            self.results.push((reference, Traced { value, is_bound }));
        }
    }

    /// The number of a setting, of this dimension. It reads nothing of the plan.
    fn setting(&mut self, set: &'a Expr, dimension: Dimension, name: &str) -> Option<Typed> {
        let context = Context {
            entry: None,
            reads: Reads::Nothing("a setting"),
            critical: false,
        };
        let typed = self.single(set, context)?;
        self.expect(typed, dimension, name, set)
    }

    /// The value given from outside the plan for a field or argument, checked as the plan's own would be. None: there is none.
    pub fn overridden(
        &mut self,
        field: &'static Field,
        written: &'a Expr,
    ) -> Option<Option<(Typed, &'a Expr)>> {
        let (name, setting) = self.overrides.get(&written.span).copied()?;
        let dimension = field.dimension()?;
        Some(match setting {
            Setting::Written(set) => self.setting(set, dimension, name).map(|typed| (typed, set)),
            Setting::Bound(input) => {
                let quantity = self.bound_value(*input);
                self.typed_bound(field, quantity, written.span)
                    .map(|typed| (typed, written))
            }
        })
    }

    /// A number that is bound without any text; its range is checked here, because no text shows it.
    fn typed_bound(
        &mut self,
        field: &'static Field,
        quantity: Quantity,
        span: Span,
    ) -> Option<Typed> {
        let dimension = field.dimension()?;
        if quantity.dimension != dimension {
            return self.fail(WrongDimensionOfQuantity {
                bound: quantity,
                wanted: dimension,
                parameter: field.name,
                declared_at: span,
            });
        }
        if !quantity.value.is_finite() {
            return self.fail(NotFinite { span });
        }
        if !field.range.contains(quantity.value) {
            let text = quantity.in_plan_syntax();
            return self.fail(OutOfRange {
                field,
                dimension,
                value: quantity.value,
                text: &text,
                span,
            });
        }
        let formula = Formula::Constant(quantity.value);
        Some(Typed::number(formula, dimension, span))
    }
}

/// An entry of `vary`, or an intensity. None if it is reported elsewhere.
pub fn no_input(reason: &NoInput, span: Span) -> Option<Diagnostic> {
    if matches!(reason, NoInput::Reported) {
        return None;
    }
    Some(
        Diagnostic::new(reason.code(), reason.message())
            .at(span, reason.label())
            .help(reason.help()),
    )
}
