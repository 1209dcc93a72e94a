//! Effect of the uncertain inputs on the results of a frame under ground motion or impact: the part that all such runs share. In: a frame
//! of the plan, its damping, the rig's calibration. Out: the sources, inputs with sources perturbed, and the runs to re-integrate. The
//! run itself does not change, and no rig moves.

use super::setting::FrameSteps;
use crate::procedures::common::perturbed_inputs::{UncertainRun, out_of_bounds, uncertain_inputs};
use crate::procedures::common::results::index_of;
use crate::run::stop::Stop;
use psd_physics::reintegration::frame::{Floors, FrameRun};
use psd_physics::reintegration::frame_path::{FramePath, FrameReading};
use psd_physics::reintegration::recorded_path::ContinuousMotion;
use psd_physics::structure::assemblies::{Assemblies, StoreyReadings};
use psd_physics::structure::substructures::Substructures;
use psd_plan::formula::{Formula, Operator};
use psd_plan::procedures::shake::block as schema;
use psd_plan::record::{FloorMotion, NamedResult};
use psd_plan::schema::ResultKind;
use psd_plan::uncertainty::Source;
use psd_plan::uncertainty::engine::{CLOSE, Shifts};
use psd_plan::{Frame, Member, Mode, Part, ShakeDamping, Stepping};

/// The uncertain inputs of a frame.
#[derive(Clone, Copy)]
pub(crate) struct FrameUncertainty<'run> {
    pub run: UncertainRun<'run>,
    /// Index among the plan's specimens.
    specimen: usize,
    /// None for a specimen that is not a frame; no result of it is evaluated.
    frame: Option<&'run Frame>,
    damping: &'run ShakeDamping,
    damping_uncertainty: f64,
    stepping: &'run Stepping,
}

impl<'run> FrameUncertainty<'run> {
    /// For the frame of a specimen, with its damping and the uncertainty of that.
    pub fn new(
        run: UncertainRun<'run>,
        specimen: usize,
        damping: &'run ShakeDamping,
        damping_uncertainty: f64,
        stepping: &'run Stepping,
    ) -> Self {
        Self {
            run,
            specimen,
            frame: run.whole.specimens[specimen].frame.as_ref(),
            damping,
            damping_uncertainty,
            stepping,
        }
    }

    /// Axes of the rig.
    pub fn axes(&self) -> usize {
        self.frame.map_or(0, Frame::axes)
    }

    /// Every uncertain input of the frame and of the `formulas` that the procedure reads; `stated` adds further sources with their
    /// uncertainties.
    ///
    /// # Errors
    /// The uncertainty of a result that they read is withheld.
    pub fn sources(
        &self,
        formulas: &[&Formula],
        stated: &[(Source, f64)],
    ) -> Result<Vec<Source>, String> {
        let ratios = self.ratios();
        let formulas: Vec<&Formula> = formulas.iter().copied().chain(ratios).collect();
        let specimen = self.specimen;
        let storeys = self.frame.map_or(&[][..], |frame| &frame.storeys);
        let storeys = storeys.iter().enumerate().flat_map(|(storey, it)| {
            [
                (Source::StoreyMass { specimen, storey }, it.mass_uncertainty),
                (
                    Source::StoreyStiffness { specimen, storey },
                    it.stiffness_uncertainty,
                ),
            ]
        });
        let elements = self.frame.map_or(&[][..], |frame| &frame.elements);
        let elements = elements.iter().enumerate().map(|(element, it)| {
            let source = Source::ElementStiffness { specimen, element };
            (source, it.stiffness_uncertainty)
        });
        let [mass, stiffness] = self
            .frame
            .map_or([0.0; 2], |frame| frame.matrix_uncertainty);
        let matrices = [
            (Source::MassMatrix(specimen), mass),
            (Source::StiffnessMatrix(specimen), stiffness),
        ];
        let procedure = self.run.procedure;
        let modes = (0..ratios.len()).map(|mode| {
            (
                Source::DampingRatio { procedure, mode },
                self.damping_uncertainty,
            )
        });
        let all = storeys
            .chain(elements)
            .chain(matrices)
            .chain(modes)
            .chain(stated.iter().copied());
        uncertain_inputs(&formulas, all, self.run.results)
    }

    fn ratios(&self) -> &[Formula] {
        match self.damping {
            ShakeDamping::Rayleigh(ratio) => std::slice::from_ref(ratio),
            ShakeDamping::Modal(ratios) => ratios,
        }
    }

    /// The frame with its storeys perturbed.
    pub fn moved_frame(&self, shifts: Shifts<'_>) -> Result<Frame, String> {
        let frame = self.frame.ok_or_else(|| out_of_bounds(&Stop::no_frame()))?;
        let mut factors = [1.0; 2];
        for (source, by) in shifts {
            match *source {
                Source::MassMatrix(specimen) if specimen == self.specimen => {
                    factors[0] += by * frame.matrix_uncertainty[0];
                }
                Source::StiffnessMatrix(specimen) if specimen == self.specimen => {
                    factors[1] += by * frame.matrix_uncertainty[1];
                }
                _ => {}
            }
        }
        if frame.storeys.is_empty() {
            let mut elements = frame.elements.clone();
            for (source, by) in shifts {
                match *source {
                    Source::ElementStiffness { specimen, element } if specimen == self.specimen => {
                        let moved = &mut elements[element];
                        let stiffness = moved.stiffness;
                        moved.stiffness += by * moved.stiffness_uncertainty;
                        if moved.part == Part::Computed {
                            moved.behaviour = moved.behaviour.scaled(moved.stiffness / stiffness);
                        }
                    }
                    _ => {}
                }
            }
            return Ok(frame.scaled(factors).with_elements(elements));
        }
        Ok(frame.with(|storeys| {
            for (source, by) in shifts {
                match *source {
                    Source::StoreyMass { specimen, storey } if specimen == self.specimen => {
                        storeys[storey].mass += by * storeys[storey].mass_uncertainty;
                    }
                    Source::StoreyStiffness { specimen, storey } if specimen == self.specimen => {
                        let moved = &mut storeys[storey];
                        let stiffness = moved.stiffness;
                        moved.stiffness += by * moved.stiffness_uncertainty;
                        if moved.part == Part::Computed {
                            moved.behaviour = moved.behaviour.scaled(moved.stiffness / stiffness);
                        }
                    }
                    _ => {}
                }
            }
        }))
    }

    /// The damping with its sources perturbed.
    pub fn moved_damping(&self, shifts: Shifts<'_>) -> ShakeDamping {
        let moved = |(mode, ratio): (usize, &Formula)| {
            let source = Source::DampingRatio {
                procedure: self.run.procedure,
                mode,
            };
            let by: f64 = shifts
                .iter()
                .filter(|(moved, _)| *moved == source)
                .map(|(_, by)| by)
                .sum();
            if by == 0.0 {
                return ratio.clone();
            }
            let more = Formula::Constant(by * self.damping_uncertainty);
            Formula::Binary(Operator::Add, Box::new(ratio.clone()), Box::new(more))
        };
        match self.damping {
            ShakeDamping::Rayleigh(ratio) => ShakeDamping::Rayleigh(moved((0, ratio))),
            ShakeDamping::Modal(ratios) => {
                ShakeDamping::Modal(ratios.iter().enumerate().map(moved).collect())
            }
        }
    }

    /// The integration settings of the run.
    pub fn frame_run(&self, steps: &FrameSteps) -> FrameRun {
        FrameRun {
            matrices: steps.properties.matrices.clone(),
            operator: steps.properties.operator.clone(),
            elements: steps.properties.elements.clone(),
            computed_factors: Vec::new(),
            integrator: self.stepping.integrator,
            i_modification: self.stepping.i_modification,
            tangents: steps.tangents,
            time_step: steps.steps.time_step,
            steps: steps.steps.count,
            readings: self.readings(),
            continuous: matches!(self.stepping.mode, Mode::Continuous { .. }),
        }
    }

    /// The readings of the storeys.
    fn readings(&self) -> Vec<StoreyReadings> {
        let assemblies = self.frame.and_then(Assemblies::of);
        let floors = self.frame.map_or(0, Frame::degrees_of_freedom);
        assemblies.map_or_else(
            || StoreyReadings::of_floors(self.run.noise, floors),
            |assemblies| assemblies.readings(self.run.noise),
        )
    }

    /// The factor on the stiffness of every storey that is computed, in a run of `moved` instead of the frame; none if no storey is. That of
    /// the stiffness of the files beside elements is the last.
    pub fn computed_factors(&self, moved: &Frame) -> Vec<f64> {
        let Some(frame) = self.frame else {
            return Vec::new();
        };
        let has_elements = frame.has_elements();
        let is_computed = |member: Member<'_>| member.part == Part::Computed;
        if !has_elements && !frame.members().any(is_computed) {
            return Vec::new();
        }
        let members = frame.members().zip(moved.members());
        // All entries of a matrix have one factor.
        let of_matrix = frame
            .computed_stiffness
            .iter()
            .zip(&moved.computed_stiffness)
            .find_map(|(own, moved)| {
                let entries = own.iter().zip(moved).find(|(own, _)| **own != 0.0);
                entries.map(|(own, moved)| moved / own)
            });
        members
            .map(|(own, moved)| moved.stiffness / own.stiffness)
            .chain(has_elements.then(|| of_matrix.unwrap_or(1.0)))
            .collect()
    }

    /// The recorded path; `substructures` are those at the start of the run.
    pub fn path<'r>(
        &self,
        steps: &FrameSteps,
        recorded: impl Iterator<Item = &'r FloorMotion>,
        substructures: Option<&Substructures>,
    ) -> Result<FramePath, String> {
        let reading = |floors: &FloorMotion| FrameReading {
            target: floors.command.clone(),
            displacement: floors.displacement.clone(),
            force: floors.restoring_force.clone(),
            elements: floors.elements.clone(),
        };
        let readings = recorded.map(reading).collect();
        self.passed(steps, readings, Vec::new(), substructures)
    }

    /// The recorded path with the velocities of the floors at its targets \[m/s\].
    pub fn with_velocities(
        &self,
        steps: &FrameSteps,
        path: FramePath,
        velocities: Vec<Vec<f64>>,
        substructures: Option<&Substructures>,
    ) -> Result<FramePath, String> {
        if velocities.is_empty() {
            Ok(path)
        } else {
            self.passed(steps, path.into_readings(), velocities, substructures)
        }
    }

    fn passed(
        &self,
        steps: &FrameSteps,
        readings: Vec<FrameReading>,
        velocities: Vec<Vec<f64>>,
        substructures: Option<&Substructures>,
    ) -> Result<FramePath, String> {
        let stiffness = &steps.properties.matrices.stiffness;
        let path = FramePath::new(
            readings,
            ContinuousMotion {
                velocities,
                time_step: steps.steps.time_step,
            },
            stiffness,
            &self.readings(),
            substructures,
        );
        path.ok_or_else(|| "nothing was recorded".to_owned())
    }
}

/// The largest base shear and forces of elements of the re-run, in place of the reported ones. Those are without the part of noise; the
/// re-integrated ones have it in finer steps as well.
pub(crate) fn with_noise(floors: &Floors, layout: &[(&'static str, usize)], reported: &mut [f64]) {
    let found = [
        (schema::MAX_BASE_SHEAR, &[floors.max_base_shear][..]),
        (schema::MAX_ELEMENT_FORCE, &floors.max_element_force),
    ];
    for (kind, values) in found {
        if let Some(first) = index_of(layout, kind) {
            reported[first..first + values.len()].copy_from_slice(values);
        }
    }
}

/// Whether the re-run reproduces the recorded results of the floors; `displacement` is the result with the peaks of the floors.
pub(crate) fn leads_there(
    floors: &Floors,
    displacement: ResultKind,
    results: &[NamedResult],
) -> bool {
    // The largest shear is reported without the part of noise: the storey drifts show whether the path is the recorded one.
    let lists = [
        (displacement.name, floors.max_displacement.as_slice()),
        (schema::MAX_DRIFT.name, &floors.max_drift),
        (schema::FINAL_DRIFT.name, &floors.final_drift),
    ];
    lists.into_iter().all(|(name, found)| {
        let Some(recorded) = NamedResult::of(results, name) else {
            return false;
        };
        let recorded = recorded.value.values();
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= CLOSE * a.abs().max(b.abs());
        recorded.len() == found.len() && recorded.iter().zip(found).all(near)
    })
}
