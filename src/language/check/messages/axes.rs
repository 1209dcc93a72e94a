//! Errors of the axes of a real rig: E615, E616, E626, E636, E637. In: names, numbers and spans. Out: diagnostics.

use crate::plan::Dialect;
use crate::text::diagnostic::{Code, Diagnostic};
use crate::text::source::Span;

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
            "list {storeys} of them, the lowest storey first: axes = [{}]",
            vec!["axis"; storeys].join(", ")
        ),
    };
    Diagnostic::new(
        Code::AxesDiffer,
        format!("the rig `{rig}` has {}, and {needs}", axes_of(axes)),
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
        "name one an axis, the lowest storey first, with commas between, as in `nees(\"{}\")`, and list as many `axes`",
        names.join(", ")
    );
    Diagnostic::new(
        Code::AxesDiffer,
        format!(
            "{named} cannot drive {}: every axis has its own",
            axes_of(axes)
        ),
    )
    .at(at, named)
    .help(help)
}

pub fn no_axis_left(at: Span) -> Diagnostic {
    Diagnostic::new(Code::ChannelsDiffer, "no axis is left for this device: each has one of its own")
        .at(at, "for which axis?")
        .help("leave it to one axis, which then names none of its own; or remove it, where it is the `load_cell`")
}

pub fn channels(channels: usize, axes: usize, dialect: &Dialect, at: Span) -> Diagnostic {
    let has = if channels == 1 {
        "one channel".to_owned()
    } else {
        format!("{channels} channels")
    };
    let help = match dialect {
        Dialect::Scpi { .. } => {
            "write the force of a unit of each channel, the lowest axis first: `scpi([2.5 kN, 1.2 kN])`"
        }
        Dialect::Native => {
            "weigh the axes with several devices: an axis may name a `load_cell` of its own"
        }
        _ => {
            "give each axis a `load_cell` of its own, on its own port; or use a device of several channels: `scpi` or `native`"
        }
    };
    let text = format!(
        "a load cell that speaks `{}` has {has} here, and cannot weigh {}",
        dialect.name(),
        axes_of(axes)
    );
    Diagnostic::new(Code::ChannelsDiffer, text)
        .at(at, has)
        .help(help)
}

pub fn not_asked(dialect: &Dialect, at: Span) -> Diagnostic {
    let text = format!(
        "several devices move the axes, and `{}` cannot be asked before it is told to",
        dialect.name()
    );
    Diagnostic::new(Code::NotAsked, text).at(at, "would move while another refuses").help(
        "let one controller move them all behind one line, as `native` does; or `nees` sites, which propose before they execute",
    )
}

pub fn too_many(axes: usize, most: usize, dialect: &Dialect, at: Span) -> Diagnostic {
    let text = format!(
        "a device that speaks `{}` drives at most {}, not {axes}",
        dialect.name(),
        axes_of(most)
    );
    Diagnostic::new(Code::TooManyAxes, text)
        .at(at, axes_of(axes))
        .help("several axes need one controller behind one `link`, which moves them together: `native` and `nees` do")
}

pub fn frame_on_one_axis(specimen: &str, storeys: usize, rig: &str, span: Span) -> Diagnostic {
    Diagnostic::new(
        Code::FrameOnRealRig,
        format!("the frame `{specimen}` needs {storeys} actuators with their load cells, and the rig `{rig}` has one"),
    )
    .at(span, "would move every storey")
    .help(format!(
        "list them in the rig, the lowest storey first: axes = [{}]; or run it on a virtual rig: leave `--rig` out",
        vec!["axis"; storeys].join(", ")
    ))
}
