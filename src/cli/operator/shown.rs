//! The displacement and the force of a step that the screen, the bar and the lines show. In: a plan, the axes of a step. Out: two numbers
//! with their names. One axis is shown alone, a whole frame by its top floor and its base shear. If the rig carries a part of a frame,
//! the last axis is shown alone: the sum of forces of several specimens is not the shear of any storey.

use psd::run::StepReport;
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::Plan;

/// The part of a step that is shown.
#[derive(Clone, Debug, Default)]
pub struct Shown {
    /// The number of the last axis and of its storey, if the rig has several axes and does not carry the whole frame.
    pub last_axis: Option<(usize, usize)>,
    /// Whether the axis moves an element and not a storey.
    pub is_element: bool,
    /// What follows displacements and forces: ` on the rig` if those of the prototype are others.
    pub of_rig: &'static str,
}

/// The names of the numbers.
pub struct Names {
    pub displacement: String,
    pub force: String,
    /// The displacement over which the force is drawn.
    pub across: String,
}

impl Shown {
    pub fn of(plan: &Plan) -> Self {
        let frame = plan.frame_on_the_rig();
        let is_element = plan.tests_elements();
        let assemblies = frame.and_then(Assemblies::of);
        let last_axis = assemblies.filter(|assemblies| !assemblies.is_whole_frame());
        let last_axis = last_axis.and_then(|assemblies| {
            let last = assemblies.tested().enumerate().last();
            last.map(|(axis, storey)| (axis + 1, storey + 1))
        });
        Self {
            last_axis: last_axis.filter(|(axis, _)| *axis > 1),
            is_element,
            of_rig: match plan.specimens_at_scale() {
                Some(_) => " on the rig",
                None => "",
            },
        }
    }

    /// The names for a step of so many axes.
    pub fn names(&self, axes: usize) -> Names {
        let [displacement, force, across] = match self.last_axis {
            Some((axis, storey)) => [
                format!(
                    "axis {axis} ({} {storey})",
                    if self.is_element { "element" } else { "storey" }
                ),
                format!("force of axis {axis}"),
                format!("axis {axis}"),
            ],
            None if axes > 1 => ["top floor", "base shear", "first floor"].map(str::to_owned),
            None => ["X", "R", "X"].map(str::to_owned),
        };
        Names {
            displacement,
            force,
            across,
        }
    }

    /// Of the forces of all axes \[N\].
    pub fn force(&self, mut axes: impl DoubleEndedIterator<Item = f64>) -> f64 {
        if self.last_axis.is_some() {
            axes.next_back().unwrap_or(0.0)
        } else {
            axes.sum()
        }
    }

    /// Of a step \[N\].
    pub fn force_of(&self, step: &StepReport) -> f64 {
        self.force(step.axes.iter().map(|axis| axis.force))
    }

    /// The displacement of a step over which its force is drawn \[m\].
    pub fn across(&self, step: &StepReport) -> f64 {
        if self.last_axis.is_some() {
            step.highest()
        } else {
            step.axes.first().map_or(0.0, |axis| axis.displacement)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_plan::{Behaviour, Frame, Part, Storey};
    use psd_testing::plans::struck_frame;

    fn shown(parts: [Part; 3]) -> Shown {
        let mut plan = struck_frame();
        let storey = |part| Storey {
            part,
            ..Storey::new(1.0, 1e3, Behaviour::Elastic { stiffness: 1e3 })
        };
        plan.specimens[0].frame = Some(Frame::of_storeys(parts.map(storey).into()));
        Shown::of(&plan)
    }

    #[test]
    fn a_part_of_a_frame_is_shown_by_its_last_axis() {
        let step = StepReport::of_readings(1, 0.0, &[0.1, 0.2], &[0.1, 0.2], &[30.0, 4.0]);
        let part = shown([Part::TESTED, Part::Computed, Part::TESTED]);
        let names = part.names(2);
        assert_eq!(
            [names.displacement, names.force, names.across],
            ["axis 2 (storey 3)", "force of axis 2", "axis 2"]
        );
        assert_eq!([part.force_of(&step), part.across(&step)], [4.0, 0.2]);
        let whole = shown([Part::TESTED; 3]);
        assert_eq!(whole.names(3).displacement, "top floor");
        assert_eq!([whole.force_of(&step), whole.across(&step)], [34.0, 0.1]);
        let one = shown([Part::Computed, Part::TESTED, Part::Computed]);
        assert_eq!(one.names(1).displacement, "X");
    }
}
