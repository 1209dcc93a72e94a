//! Errors of the axes of a real rig: E615, E616, E626, E636, E637. In: names, numbers and spans. Out: diagnostics.

use psd_plan::Dialect;
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Span;

/// `one axis`, `3 axes`
fn axes_of(count: usize) -> String {
    if count == 1 {
        "one axis".to_owned()
    } else {
        format!("{count} axes")
    }
}

pub fn another_number(
    rig: &str,
    axes: usize,
    specimen: &str,
    storeys: usize,
    at: Span,
) -> Diagnostic {
    let needs = match storeys {
        1 => format!("`{specimen}` has one degree of freedom"),
        _ => format!("the frame `{specimen}` has {storeys} storeys"),
    };
    let help = match storeys {
        1 => "remove `axes`: a rig without it has one axis".to_owned(),
        _ => format!(
            "list {storeys} axes, the lowest storey first: axes = [{}]",
            vec!["axis"; storeys].join(", ")
        ),
    };
    Diagnostic::new(
        Code::AxesDiffer,
        format!(
            "number of axes differs: rig `{rig}` has {}, {needs}",
            axes_of(axes)
        ),
    )
    .at(at, axes_of(axes))
    .help(help)
}

pub fn control_points(points: usize, axes: usize, at: Span) -> Diagnostic {
    let named = if points == 1 {
        "one control point".to_owned()
    } else {
        format!("{points} control points")
    };
    let names: Vec<String> = (1..=axes.max(2))
        .map(|axis| format!("MDL-00-{axis:02}"))
        .collect();
    let help = format!(
        "write one control point per axis, the lowest storey first, separated by commas, as in `nees(\"{}\")`; list as many `axes`",
        names.join(", ")
    );
    Diagnostic::new(
        Code::AxesDiffer,
        format!(
            "{named} cannot drive {}: every axis has a separate device",
            axes_of(axes)
        ),
    )
    .at(at, named)
    .help(help)
}

pub fn no_axis_left(at: Span) -> Diagnostic {
    Diagnostic::new(
        Code::ChannelsDiffer,
        "device without an axis: every axis has a separate one",
    )
    .at(at, "no axis left")
    .help("remove the separate device of one axis, or remove this device if it is the `load_cell`")
}

pub fn channels(channels: usize, axes: usize, dialect: &Dialect, at: Span) -> Diagnostic {
    let has = if channels == 1 {
        "one channel".to_owned()
    } else {
        format!("{channels} channels")
    };
    let help = match dialect {
        Dialect::Scpi { .. } => {
            "write the force per unit of each channel, the lowest axis first: `scpi([2.5 kN, 1.2 kN])`"
        }
        Dialect::Native => "use several load cells: an axis can name a separate `load_cell`",
        _ => {
            "add a `load_cell` to each axis, on a separate port, or use a device with several channels: `scpi` or `native`"
        }
    };
    let text = format!(
        "too few channels: `{}` load cell has {has} and must read {}",
        dialect.name(),
        axes_of(axes)
    );
    Diagnostic::new(Code::ChannelsDiffer, text)
        .at(at, has)
        .help(help)
}

pub fn not_asked(dialect: &Dialect, at: Span) -> Diagnostic {
    let text = format!(
        "`{}` cannot confirm a move before it starts, so it cannot share a rig of several axes",
        dialect.name()
    );
    Diagnostic::new(Code::NotAsked, text).at(at, "moves immediately").help(
        "use one controller for all axes, such as `native`, or `nees` sites, which confirm before they move",
    )
}

pub fn too_many(axes: usize, most: usize, dialect: &Dialect, at: Span) -> Diagnostic {
    let text = format!(
        "too many axes for `{}`: {axes} (at most {})",
        dialect.name(),
        axes_of(most)
    );
    Diagnostic::new(Code::TooManyAxes, text)
        .at(at, axes_of(axes))
        .help("use one controller at one `link` that moves all axes together: `native` or `nees`")
}

pub fn frame_on_one_axis(specimen: &str, storeys: usize, rig: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::FrameOnRealRig,
        format!("frame `{specimen}` requires {storeys} actuators and load cells, but rig `{rig}` has one"),
    )
    .at(span, "moves all storeys")
    .help(format!(
        "list them in the rig, the lowest storey first: axes = [{}]; or leave `--rig` out for a virtual rig",
        vec!["axis"; storeys].join(", ")
    ))
}
