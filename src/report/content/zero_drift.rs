//! What the zeros of the rig did, beside the equipment: before the test, after it, and while nothing moved. In: a run. Out:
//! blocks. Without them it is said that nobody looked.

use super::super::document::{Block, Column, Style, Table, Text};
use super::super::{Run, number};
use crate::plan::ZeroAfter;
use crate::record::{AxisDrift, Drift};
use crate::rig::{named_axis, of_axis};
use crate::units::Dimension;

/// Of a rig that says how far its zeros may drift; a real one that does not is told to be so.
pub(super) fn all(run: &Run<'_>, body: &mut Vec<Block>) {
    let Some(drift) = &run.record.drift else {
        if run.plan.rig.drift.is_none() && run.plan.rig.link.as_real().is_some() {
            body.push(Block::note(
                "The zeros of this rig were not read again after the test: that they did not drift is not shown by this record.",
            ));
        }
        return;
    };
    body.push(Block::part("Zeros before and after the test"));
    let columns = vec![
        Column::short("Channel"),
        Column::numbers("Before"),
        Column::numbers("After"),
        Column::numbers("Change"),
        Column::numbers("Allowed"),
        Column::numbers("Slope before"),
        Column::numbers("In holds"),
        Column::short("State"),
    ];
    let axes = drift.axes.iter().enumerate();
    body.push(Block::Table(Table {
        columns,
        rows: axes
            .flat_map(|(place, axis)| channels(drift, place, axis))
            .collect(),
    }));
    body.push(Block::note(how(drift)));
}

/// The force of an axis and its displacement.
fn channels(drift: &Drift, place: usize, axis: &AxisDrift) -> [Vec<Text>; 2] {
    let of = of_axis(named_axis(place, drift.axes.len()));
    let held = drift
        .held
        .slopes
        .get(place)
        .filter(|_| drift.held.count > 0);
    let before = axis.before;
    let force = Channel {
        before: before.force,
        after: axis.after.map(|zero| zero.force),
        allowed: Some(drift.check.force),
        slope: before.force_slope,
        held: held.map(|(force, _)| *force),
        change_at_rest: before.force_slope * drift.check.over,
        grown: drift.held.grown,
        dimension: Dimension::FORCE,
    };
    let displacement = Channel {
        before: before.displacement,
        after: axis.after.map(|zero| zero.displacement),
        allowed: drift.check.displacement,
        slope: before.displacement_slope,
        held: held.map(|(_, displacement)| *displacement),
        change_at_rest: before.displacement_slope * drift.check.over,
        grown: None,
        dimension: Dimension::LENGTH,
    };
    [
        force.row(&format!("force{of}")),
        displacement.row(&format!("displacement{of}")),
    ]
}

/// One row.
struct Channel {
    before: f64,
    after: Option<f64>,
    allowed: Option<f64>,
    /// A second.
    slope: f64,
    held: Option<f64>,
    change_at_rest: f64,
    grown: Option<f64>,
    dimension: Dimension,
}

impl Channel {
    fn row(&self, name: &str) -> Vec<Text> {
        let value = |value: f64| Text::from(number::text(value, self.dimension));
        let known = |known: Option<f64>| known.map_or_else(|| "—".into(), value);
        let slope = |slope: f64| Text::from(format!("{}/s", number::text(slope, self.dimension)));
        vec![
            name.into(),
            value(self.before),
            known(self.after),
            known(self.after.map(|after| after - self.before)),
            self.allowed.map_or_else(
                || "—".into(),
                |allowed| number::stated(allowed, self.dimension).into(),
            ),
            slope(self.slope),
            self.held.map_or_else(|| "—".into(), slope),
            self.state(),
        ]
    }

    fn state(&self) -> Text {
        let Some(allowed) = self.allowed else {
            return Text::new().soft("not judged");
        };
        let change = self.after.map(|after| (after - self.before).abs());
        let found = [change, Some(self.change_at_rest.abs()), self.grown]
            .into_iter()
            .flatten();
        // NaN is within nothing.
        if found.into_iter().all(|size| size <= allowed) {
            Text::new().with(Style::Pass, "within")
        } else {
            Text::new().with(Style::Fail, "BEYOND")
        }
    }
}

/// How the zeros were read, and what is judged.
fn how(drift: &Drift) -> String {
    let over = number::stated(drift.check.over, Dimension::TIME);
    let after = match drift.check.after {
        ZeroAfter::Start => "after it back where it began, with the specimen on",
        ZeroAfter::Free => {
            "after it where the rig stood, when a person had taken the specimen off the load cell"
        }
        ZeroAfter::Nowhere => "not again after it",
    };
    let holds = match drift.held.count {
        0 => format!("No hold was as long as {over}."),
        1 => format!("One hold was as long as {over}; its slope has drift and relaxation in it."),
        count => format!(
            "{count} holds were as long as {over}; their fastest slopes have drift and relaxation in them."
        ),
    };
    let grown = drift.held.grown.map_or_else(String::new, |grown| {
        let allowed = number::stated(drift.check.force, Dimension::FORCE);
        format!(
            " In those farther out than the specimen had been, where a force can only relax, it grew by at most {} ({allowed} is \
             allowed).",
            number::text(grown, Dimension::FORCE)
        )
    });
    format!(
        "A zero is the mean of readings over {over}, before the first move and {after}; that of the displacement is reading less \
         target. {holds}{grown} A drift beyond what is allowed leaves undecided what its readings enter."
    )
}
