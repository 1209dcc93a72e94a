//! Zero readings beside the equipment: before the test, after it, and their slopes at rest. In: a run. Out: blocks. If the zeros were not
//! read again, a note states it.

use crate::report::document::{Block, Column, Style, Table, Text};
use crate::report::number;
use crate::report::run::Run;
use crate::report::wording::zero_drift as wording;
use psd_plan::ZeroAfter;
use psd_plan::record::{AxisDrift, Drift};
use psd_plan::{named_axis, of_axis};
use psd_text::units::Dimension;

/// The zero readings of a rig with a declared allowed zero drift; for a real rig without it, a note.
pub(super) fn append(run: &Run<'_>, body: &mut Vec<Block>) {
    let Some(drift) = &run.record.drift else {
        if run.plan.rig.zero_drift.is_none() && run.plan.rig.link.as_real().is_some() {
            body.push(Block::note(wording::NOT_READ_AGAIN));
        }
        return;
    };
    body.push(Block::part(wording::TITLE));
    let [channel, before, after, change, allowed, slope, holds, state] = wording::COLUMNS;
    let columns = vec![
        Column::short(channel),
        Column::numbers(before),
        Column::numbers(after),
        Column::numbers(change),
        Column::numbers(allowed),
        Column::numbers(slope),
        Column::numbers(holds),
        Column::short(state),
    ];
    let axes = drift.axes.iter().enumerate();
    body.push(Block::Table(Table {
        columns,
        rows: axes
            .flat_map(|(index, axis)| channels(drift, index, axis))
            .collect(),
    }));
    body.push(Block::note(method(drift)));
}

/// Two rows: the force and the displacement of an axis.
fn channels(drift: &Drift, index: usize, axis: &AxisDrift) -> [Vec<Text>; 2] {
    let axis_name = of_axis(named_axis(index, drift.axes.len()));
    let in_holds = drift
        .held
        .slopes
        .get(index)
        .filter(|_| drift.held.count > 0);
    let before = axis.before;
    let force = Channel {
        before: before.force,
        after: axis.after.map(|zero| zero.force),
        allowed: Some(drift.check.force),
        slope: before.force_slope,
        slope_in_holds: in_holds.map(|(force, _)| *force),
        change_at_rest: before.force_slope * drift.check.over,
        grown: drift.held.grown,
        dimension: Dimension::FORCE,
    };
    let displacement = Channel {
        before: before.displacement,
        after: axis.after.map(|zero| zero.displacement),
        allowed: drift.check.displacement,
        slope: before.displacement_slope,
        slope_in_holds: in_holds.map(|(_, displacement)| *displacement),
        change_at_rest: before.displacement_slope * drift.check.over,
        grown: None,
        dimension: Dimension::LENGTH,
    };
    [
        force.row(&wording::force(&axis_name)),
        displacement.row(&wording::displacement(&axis_name)),
    ]
}

/// The zero of one channel, SI.
struct Channel {
    before: f64,
    after: Option<f64>,
    allowed: Option<f64>,
    /// Slope before the test, per second.
    slope: f64,
    /// The steepest slope in a dwell.
    slope_in_holds: Option<f64>,
    /// Change that results from the slope before the test over the time of one zero reading.
    change_at_rest: f64,
    /// Increase of the force in a dwell in which relaxation can only decrease it.
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
            self.slope_in_holds.map_or_else(|| "—".into(), slope),
            self.state(),
        ]
    }

    fn state(&self) -> Text {
        let Some(allowed) = self.allowed else {
            return Text::new().soft(wording::NOT_JUDGED);
        };
        let change = self.after.map(|after| (after - self.before).abs());
        let found = [change, Some(self.change_at_rest.abs()), self.grown]
            .into_iter()
            .flatten();
        // NaN fails every comparison.
        if found.into_iter().all(|size| size <= allowed) {
            Text::new().with(Style::Pass, wording::WITHIN)
        } else {
            Text::new().with(Style::Fail, wording::BEYOND)
        }
    }
}

/// The reading of the zeros, and the quantities that are compared with the allowed drift.
fn method(drift: &Drift) -> String {
    let over = number::stated(drift.check.over, Dimension::TIME);
    let after = match drift.check.after {
        ZeroAfter::Start => wording::AFTER_AT_START,
        ZeroAfter::Free => wording::AFTER_FREE,
        ZeroAfter::Nowhere => wording::NOT_AFTER,
    };
    let growth = drift.held.grown.map_or_else(String::new, |grown| {
        wording::growth(
            number::text(grown, Dimension::FORCE),
            number::stated(drift.check.force, Dimension::FORCE),
        )
    });
    let holds = match drift.held.count {
        0 => wording::no_hold(&over),
        1 => wording::one_hold(&over),
        count => wording::several_holds(count, &over),
    };
    wording::method(over, after, holds, growth)
}
