//! An actuator of the virtual rig in force control, along the height of a storey. In: its target. Out: its force, the P-Δ that it adds to
//! the lateral reading, and its displacement. The column does not shorten by its force, only by its drift: u²/(2 h).

use super::load_cell::LoadCell;
use super::seed_of;
use psd_plan::{AxialColumn, Frame, Limits, Plan, VirtualLink};

pub(super) struct AxialActuator {
    column: AxialColumn,
    /// \[N/s\]
    rate: f64,
    /// \[N\]
    force: f64,
    cell: LoadCell,
}

impl AxialActuator {
    /// Those of a plan; its check has refused a storey without a height or with two scales.
    pub(super) fn of(plan: &Plan, frame: &Frame, link: &VirtualLink) -> Vec<Self> {
        let axes = plan.rig.axial_axes(&Limits::NONE);
        let lateral = plan.degrees_of_freedom() as u64;
        let axial = |((axis, _), number): ((psd_plan::AxialAxis, Limits), u64)| {
            Some(Self {
                column: axis.column(frame)?,
                rate: axis.rate,
                force: 0.0,
                cell: LoadCell::new(link, seed_of(link.seed, number)),
            })
        };
        axes.zip(lateral..).filter_map(axial).collect()
    }

    /// The spring that it loads, from 0.
    pub(super) const fn spring(&self) -> usize {
        self.column.tested
    }

    /// Reaches this force \[N\]; the time that it takes \[s\].
    pub(super) fn go_to(&mut self, force: f64) -> f64 {
        let before = std::mem::replace(&mut self.force, force);
        (force - before).abs() / self.rate
    }

    /// φ N/h \[N/m\]
    pub(super) fn p_delta_stiffness(&self) -> f64 {
        self.column.p_delta * self.force / self.column.height
    }

    /// u²/(2 h) \[m\], of the drift u.
    pub(super) fn shortening(&self, drift: f64) -> f64 {
        drift * drift / (2.0 * self.column.height)
    }

    /// One reading of its load cell \[N\] at the rig time \[s\].
    pub(super) fn read(&mut self, time: f64) -> f64 {
        self.cell.read(self.force, time)
    }
}
