//! Names of the axes in messages. Only a rig with several axes numbers them.

/// ` of axis 2`, or an empty string.
pub fn of_axis(axis: Option<usize>) -> String {
    axis.map_or_else(String::new, |axis| format!(" of axis {axis}"))
}

/// `axis 2`, or `the rig`.
pub fn who(axis: Option<usize>) -> String {
    axis.map_or_else(|| "the rig".to_owned(), |axis| format!("axis {axis}"))
}

/// The number (from 1) of the axis with this index, for a fault message; None if the rig has only one axis.
pub fn named_axis(axis_index: usize, axes: usize) -> Option<usize> {
    (axes > 1).then_some(axis_index + 1)
}
