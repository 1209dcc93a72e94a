//! The blows of an `escalate`, one row each. In: the history. Out: a table.

use maud::{Markup, html};

use super::super::number;
use crate::formula::ResultValue;
use crate::quantity::Dimension;
use crate::record::{Blow, EscalateHistory};

/// Blows printed; the tables hold every one.
const PRINTED: usize = 40;

pub(super) fn table(history: &EscalateHistory) -> Markup {
    let of = |blow: &Blow, name: &str| match blow.results.iter().find(|result| result.name == name).map(|result| &result.value) {
        Some(ResultValue::Number { value, .. }) => *value,
        _ => None,
    };
    let largest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
    let energy = largest(&mut history.blows.iter().map(|blow| blow.energy));
    let travel = largest(&mut history.blows.iter().filter_map(|blow| of(blow, "max_displacement")));
    let shown = |value: Option<f64>, beside: f64, dimension| {
        value.map_or_else(|| "—".to_owned(), |value| number::text_beside(value, beside, dimension))
    };
    html! {
        @if !history.blows.is_empty() {
            table.results {
                thead {
                    tr {
                        th { "Blow" }
                        th.number { "Velocity" }
                        th.number { "Energy" }
                        th.number { "Largest X" }
                        th.number { "Absorbed" }
                        th.number { "At rest at" }
                        th { "Condition" }
                    }
                }
                tbody {
                    @for (index, blow) in history.blows.iter().take(PRINTED).enumerate() {
                        tr {
                            td { (index + 1) }
                            td.number { (number::text(blow.velocity, Dimension::VELOCITY)) }
                            td.number { (shown(Some(blow.energy), energy, Dimension::ENERGY)) }
                            td.number { (shown(of(blow, "max_displacement"), travel, Dimension::LENGTH)) }
                            td.number { (shown(of(blow, "absorbed_energy"), energy, Dimension::ENERGY)) }
                            td.number { (shown(blow.rest.map(|(displacement, _)| displacement), travel, Dimension::LENGTH)) }
                            td { @match blow.held { Some(true) => "held", Some(false) => "no longer held", None => "not complete" } }
                        }
                    }
                }
            }
            @if history.blows.len() > PRINTED { p.note { (history.blows.len() - PRINTED) " more blows are in the table of this procedure." } }
            p.note {
                "X counts from where the specimen was born; the striker of each blow touches the surface where it then was. Every blow has a "
                "table of its own."
            }
        }
    }
}
