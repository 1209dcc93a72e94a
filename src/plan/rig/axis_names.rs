//! How a message names an axis. Only a rig of several axes numbers them.

/// ` of axis 2`, or nothing.
pub(crate) fn of_axis(axis: Option<usize>) -> String {
    axis.map_or_else(String::new, |axis| format!(" of axis {axis}"))
}

/// `axis 2`, or `the rig`.
pub(crate) fn who(axis: Option<usize>) -> String {
    axis.map_or_else(|| "the rig".to_owned(), |axis| format!("axis {axis}"))
}

/// The number of the axis at this place, from 1, for a fault that names it; None where the rig has no other.
pub(crate) fn named_axis(place: usize, axes: usize) -> Option<usize> {
    (axes > 1).then_some(place + 1)
}
