//! An actuator of the virtual rig in force control, along the height of a storey. In: its target. Out: its force, the P-Δ that it adds to
//! the lateral reading, and its displacement. The column does not shorten by its force, only by its drift: u²/(2 h).

use super::load_cell::LoadCell;
use super::seed_of;
use psd_plan::{Frame, Limits, Part, Plan, VirtualLink};

pub(super) struct AxialActuator {
    /// The spring that it loads, from 0.
    pub spring: usize,
    /// Height on the rig \[m\].
    height: f64,
    /// φ
    p_delta: f64,
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
        let tested: Vec<usize> = (0..frame.storeys.len())
            .filter(|storey| frame.storeys[*storey].part != Part::Computed)
            .collect();
        let axial = |((axis, _), number): ((psd_plan::AxialAxis, Limits), u64)| {
            let spring = tested.iter().position(|storey| *storey == axis.storey)?;
            let storey = &frame.storeys[axis.storey];
            Some(Self {
                spring,
                height: storey.height? * storey.part.scale().displacement,
                p_delta: axis.p_delta,
                rate: axis.rate,
                force: 0.0,
                cell: LoadCell::new(link, seed_of(link.seed, number)),
            })
        };
        axes.zip(tested.len() as u64..).filter_map(axial).collect()
    }

    /// Reaches this force \[N\]; the time that it takes \[s\].
    pub(super) fn go_to(&mut self, force: f64) -> f64 {
        let before = std::mem::replace(&mut self.force, force);
        (force - before).abs() / self.rate
    }

    /// φ N/h \[N/m\]
    pub(super) fn p_delta_stiffness(&self) -> f64 {
        self.p_delta * self.force / self.height
    }

    /// u²/(2 h) \[m\], of the drift u.
    pub(super) fn shortening(&self, drift: f64) -> f64 {
        drift * drift / (2.0 * self.height)
    }

    /// One reading of its load cell \[N\] at the rig time \[s\].
    pub(super) fn read(&mut self, time: f64) -> f64 {
        self.cell.read(self.force, time)
    }
}
