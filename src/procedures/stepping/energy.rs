//! The energy balance of a procedure that integrates: an observation if it does not close, its curves, its table. In: energies. Out: an
//! event, series of a chart, a table of a report. It knows no procedure.

use std::borrow::Borrow;

use crate::report::document::{Block, Column, Table, Text};
use crate::report::figures::chart::{DASH_DOT, DASHED, LONG, Series, Style, palette};
use crate::report::number;
use crate::report::number::percent;
use crate::run::session::Session;
use psd_physics::impact::energy::UNBALANCED;
use psd_plan::record::EventKind;
use psd_text::units::Dimension;
use psd_text::units::display::significant;

/// Records an energy error, over the input energy, that is large enough to be mistaken for a property of the specimen.
pub(crate) fn observe_imbalance(energy_error: f64, session: &mut Session<'_>) {
    if energy_error.is_nan() || energy_error.abs() > UNBALANCED {
        let off = if energy_error.is_nan() {
            "the energy balance cannot be computed: its energies are not finite".to_owned()
        } else {
            format!(
                "energy balance error: {} % of the input energy",
                significant(100.0 * energy_error, 3)
            )
        };
        let text = format!("{off}: use a shorter time step");
        session.event(EventKind::Remark, text);
    }
}

/// One energy of a step over simulated time.
pub(crate) struct EnergyCurve<S> {
    pub label: &'static str,
    /// \[J\]
    pub read: fn(&S) -> f64,
    pub style: Style,
}

impl<S> EnergyCurve<S> {
    pub(crate) const fn new(label: &'static str, read: fn(&S) -> f64, style: Style) -> Self {
        Self { label, read, style }
    }

    /// Energy of the restoring forces.
    pub(crate) const fn restoring(read: fn(&S) -> f64) -> Self {
        Self::new("restoring", read, Style::line(palette::BLUE, 2.0, LONG))
    }

    /// Work of the weights on the floors.
    pub(crate) const fn weights(read: fn(&S) -> f64) -> Self {
        Self::new(
            "weights",
            read,
            Style::line(palette::VERMILION, 1.6, DASHED),
        )
    }

    /// Energy of the dampers.
    pub(crate) const fn damping(read: fn(&S) -> f64) -> Self {
        Self::new("damping", read, Style::line(palette::PURPLE, 2.0, DASH_DOT))
    }
}

/// The curves of the energies that are not 0 throughout; `time` gives the simulated time of a step \[s\].
pub(crate) fn nonzero_curves<S>(
    steps: &(impl Iterator<Item = impl Borrow<S>> + Clone),
    time: fn(&S) -> f64,
    curves: impl IntoIterator<Item = EnergyCurve<S>>,
) -> Vec<Series> {
    curves
        .into_iter()
        .filter(|curve| {
            let mut steps = steps.clone();
            steps.any(|step| (curve.read)(step.borrow()) != 0.0)
        })
        .map(|curve| Series {
            label: curve.label.to_owned(),
            points: steps
                .clone()
                .map(|step| (time(step.borrow()), (curve.read)(step.borrow())))
                .collect(),
            style: curve.style,
        })
        .collect()
}

/// An energy of the balance \[J\], by its name.
pub(crate) type NamedEnergy = (&'static str, f64);

/// The balance at the end of a run: the input, and each part as a fraction of it.
pub(crate) fn balance_table(input: NamedEnergy, parts: &[NamedEnergy]) -> Block {
    let (name, input) = input;
    let row = |(name, energy): &NamedEnergy| -> Vec<Text> {
        vec![
            (*name).into(),
            number::part_of(*energy, input, 5, Dimension::ENERGY).into(),
            fraction(*energy, input).into(),
        ]
    };
    let input_row = vec![
        name.into(),
        number::part_of(input, input, 5, Dimension::ENERGY).into(),
        "100\u{a0}%".into(),
    ];
    let columns = vec![
        Column::words("Energy balance at the end of the run", 1),
        Column::numbers("Energy"),
        Column::numbers("Fraction of input"),
    ];
    Block::Table(Table {
        columns,
        rows: std::iter::once(input_row)
            .chain(parts.iter().map(row))
            .collect(),
    })
}

/// An energy as a fraction of the input; a dash if the input is zero.
pub(crate) fn fraction(energy: f64, input: f64) -> String {
    if input > 0.0 {
        percent(energy / input)
    } else {
        "—".to_owned()
    }
}
