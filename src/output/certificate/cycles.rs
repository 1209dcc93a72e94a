//! The cycles of a `cycle`, one row each, and what the numbers mean. In: the history. Out: a table.

use maud::{Markup, html};

use super::super::number;
use crate::quantity::Dimension;
use crate::record::{CycleHistory, WholeCycle};

/// Cycles printed; the tables hold every one.
const PRINTED: usize = 40;

pub(super) fn table(history: &CycleHistory) -> Markup {
    let cycles = &history.cycles;
    let most = |read: fn(&WholeCycle) -> f64| cycles.iter().map(|cycle| read(cycle).abs()).fold(0.0, f64::max);
    let (amplitude, energy) = (most(|cycle| cycle.amplitude), most(|cycle| cycle.found.energy));
    let stiffness = most(|cycle| cycle.found.stiffness.unwrap_or(0.0));
    let force = most(|cycle| cycle.found.max_force).max(most(|cycle| cycle.found.min_force));
    let optional = |value: Option<f64>, largest: f64, dimension| {
        value.map_or_else(|| "—".to_owned(), |value| number::text_beside(value, largest, dimension))
    };
    html! {
        @if !cycles.is_empty() {
            table.results {
                thead {
                    tr {
                        th { "Cycle" }
                        th.number { "Amplitude" }
                        th.number { "Energy" }
                        th.number { "ζ" }
                        th.number { "Secant stiffness" }
                        th.number { "Largest force" }
                        th.number { "Smallest force" }
                    }
                }
                tbody {
                    @for cycle in cycles.iter().take(PRINTED) {
                        tr {
                            td { (cycle.cycle) @if cycle.repeat > 1 { span.soft { " (again)" } } }
                            td.number { (number::text_beside(cycle.amplitude, amplitude, Dimension::LENGTH)) }
                            td.number { (number::text_beside(cycle.found.energy, energy, Dimension::ENERGY)) }
                            td.number { (optional(cycle.found.damping_ratio.map(|ratio| 100.0 * ratio), 100.0, Dimension::NUMBER)) " %" }
                            td.number { (optional(cycle.found.stiffness, stiffness, Dimension::STIFFNESS)) }
                            td.number { (number::text_beside(cycle.found.max_force, force, Dimension::FORCE)) }
                            td.number { (number::text_beside(cycle.found.min_force, force, Dimension::FORCE)) }
                        }
                    }
                }
            }
            @if cycles.len() > PRINTED { p.note { (cycles.len() - PRINTED) " more cycles are in the table of this procedure." } }
            p.note {
                "Energy is ∫R dX over the cycle by the trapezoid through the readings. Secant stiffness is from the leftmost to the "
                "rightmost point of the loop. ζ = E/(4π E₀) with E₀ = ½ K a², K that stiffness and a half the width of the loop. The first "
                "cycle at an amplitude begins where the one before ended: it also holds what loading further took."
            }
        }
    }
}
