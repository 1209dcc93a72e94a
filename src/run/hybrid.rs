//! The substructures of a run: the part of a frame that the rig carries, and the models of the other storeys. In: a plan, readings of the
//! axes. Out: displacements and restoring forces of the floors. It knows no rig and no procedure.

use psd_physics::structure::elements::ElementReading;
use psd_physics::structure::substructures::Substructures;
use psd_plan::Plan;
use psd_rig::Reading;

/// The substructures of a run. The computed storeys keep their state from one procedure to the next.
pub(crate) struct Hybrid {
    pub substructures: Substructures,
    /// Where the last procedure that integrates began.
    pub at_start: Substructures,
    /// The last targets of the floors \[m\].
    pub commanded: Vec<f64>,
    /// The last reading of the axes.
    pub axes: Reading,
}

impl Hybrid {
    pub fn of(plan: &Plan) -> Option<Self> {
        let frame = plan.frame_on_the_rig()?;
        let substructures = Substructures::of(frame)?;
        Some(Self {
            at_start: substructures.clone(),
            substructures,
            commanded: vec![0.0; frame.degrees_of_freedom()],
            axes: Reading {
                time: 0.0,
                displacement: Vec::new(),
                force: Vec::new(),
                raw: Vec::new(),
            },
        })
    }

    /// The floors at the last reading of the axes.
    pub fn floors(&self) -> Reading {
        self.floors_at(&self.axes.displacement)
    }

    /// The elements of a frame of matrices at the last reading of the axes.
    pub fn elements(&self) -> Vec<ElementReading> {
        self.elements_at(&self.axes.displacement)
    }

    /// The same with the axes at other displacements \[m\].
    fn elements_at(&self, axes: &[f64]) -> Vec<ElementReading> {
        let axes = (axes, self.axes.force.as_slice());
        self.substructures.elements_read(axes)
    }

    /// Deformations \[m\] and forces \[N\] of the elements with the axes at these displacements \[m\]; None for storeys.
    pub fn elements_alone(&self, axes: &[f64]) -> Option<Reading> {
        self.substructures.assemblies().elements()?;
        let elements = self.elements_at(axes);
        Some(Reading {
            time: self.axes.time,
            displacement: elements.iter().map(|read| read.deformation).collect(),
            force: elements.iter().map(|read| read.force).collect(),
            raw: Vec::new(),
        })
    }

    /// The same with the axes at other displacements \[m\].
    pub fn floors_at(&self, axes: &[f64]) -> Reading {
        let (mut displacement, mut force) = (Vec::new(), Vec::new());
        let axes = (axes, self.axes.force.as_slice());
        self.substructures
            .floors(axes, &mut displacement, &mut force);
        Reading {
            time: self.axes.time,
            displacement,
            force,
            raw: Vec::new(),
        }
    }
}
