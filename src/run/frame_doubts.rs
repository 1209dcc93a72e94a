//! What the uncertainty of the inputs makes of the results of a frame, shaken or struck: what every such run shares. In: a
//! frame of the plan, its damping, the rig's calibration. Out: the sources, inputs with sources moved, the runs to take again.
//! The run itself is not touched, and no rig is moved.

use super::inputs::Inputs;
use super::propagation::{LATE, reading_errors};
use super::session::Session;
use super::stepping::FrameSteps;
use super::stop::Stop;
use super::storey_impact::no_frame;
use super::study::{CLOSE, Effort, FINER, Refined, Study, give, give_entry, is_alike};
use crate::formula::{Formula, Operator, ProcedureId, ResultValue, Results};
use crate::mechanics::frame_path::{FrameDistortion, FramePath, FrameReading};
use crate::mechanics::frame_rerun::{Floors, FrameRun};
use crate::mechanics::recorded_path::Noise;
use crate::plan::{Frame, Mode, Plan, Shake, ShakeDamping, Stepping, StoreyImpact};
use crate::record::NamedResult;
use crate::rig::DeclaredNoise;
use crate::uncertainty::{Contribution, Moved, Source, sources_of};

/// Sources, and by how many of their standard uncertainties each is moved.
pub(super) type Shifts<'a> = &'a [(Source, f64)];

/// Everything uncertain about a frame.
#[derive(Clone, Copy)]
pub(super) struct FrameDoubts<'run> {
    pub whole: &'run Plan,
    /// By its place among the plan's specimens.
    pub specimen: usize,
    /// None of a specimen that is no frame, of which nothing is asked.
    pub frame: Option<&'run Frame>,
    pub damping: &'run ShakeDamping,
    pub damping_uncertainty: f64,
    pub stepping: &'run Stepping,
    pub results: &'run dyn Results,
    pub procedure: ProcedureId,
    pub noise: DeclaredNoise,
    /// By how much its damping ratio was raised to none.
    pub lift: f64,
    /// Which blow of the procedure it is, from 0: each has errors of its own.
    pub blow: u16,
}

impl<'run> FrameDoubts<'run> {
    pub fn of_shake(plan: &'run Shake, whole: &'run Plan, inputs: &Inputs<'run>, session: &Session<'_>) -> Self {
        let Shake { specimen, damping, damping_uncertainty, stepping, .. } = plan;
        Self::new((*specimen, damping, *damping_uncertainty, stepping), whole, inputs, session)
    }

    pub fn of_blow(plan: &'run StoreyImpact, whole: &'run Plan, inputs: &Inputs<'run>, session: &Session<'_>) -> Self {
        let StoreyImpact { specimen, damping, damping_uncertainty, stepping, .. } = plan;
        Self::new((*specimen, damping, *damping_uncertainty, stepping), whole, inputs, session)
    }

    fn new(
        (specimen, damping, damping_uncertainty, stepping): (usize, &'run ShakeDamping, f64, &'run Stepping),
        whole: &'run Plan,
        inputs: &Inputs<'run>,
        session: &Session<'_>,
    ) -> Self {
        Self {
            whole,
            specimen,
            frame: whole.specimens[specimen].frame.as_ref(),
            damping,
            damping_uncertainty,
            stepping,
            results: inputs.results(),
            procedure: inputs.procedure(),
            noise: session.guard.declared_noise(),
            lift: inputs.lift(),
            blow: 0,
        }
    }

    /// Of another blow of the same procedure, from 0.
    pub fn of_blow_number(self, index: usize) -> Self {
        Self { blow: u16::try_from(index).unwrap_or(u16::MAX), ..self }
    }

    /// Degrees of freedom.
    pub fn floors(&self) -> usize {
        self.frame.map_or(0, Frame::degrees_of_freedom)
    }

    /// Every source of the frame, the rig and the `formulas` that the procedure reads, each once; `stated` are more, with
    /// their uncertainties.
    pub fn sources(&self, formulas: &[&Formula], stated: &[(Source, f64)]) -> Vec<Source> {
        let ratios = self.ratios();
        let mut references = Vec::new();
        let read = || formulas.iter().copied().chain(ratios);
        read().for_each(|formula| formula.collect_references(&mut references));
        let mut sources = sources_of(&references, self.results);
        read().for_each(|formula| formula.collect_stated(&mut sources));
        let specimen = self.specimen;
        let storeys = self.frame.map_or(&[][..], |frame| &frame.storeys);
        let storeys = storeys.iter().enumerate().flat_map(|(storey, it)| {
            [
                (Source::StoreyMass { specimen, storey }, it.mass_uncertainty),
                (Source::StoreyStiffness { specimen, storey }, it.stiffness_uncertainty),
            ]
        });
        let [mass, stiffness] = self.frame.map_or([0.0; 2], |frame| frame.matrix_uncertainty);
        let matrices = [(Source::MassMatrix(specimen), mass), (Source::StiffnessMatrix(specimen), stiffness)];
        let procedure = self.procedure;
        let modes = (0..ratios.len()).map(|mode| (Source::DampingRatio { procedure, mode }, self.damping_uncertainty));
        let axes = (0..self.floors()).flat_map(|axis| {
            let calibration = self.whole.rig.calibration_of(axis);
            [
                (Source::ForceScale(axis), calibration.force_uncertainty),
                (Source::DisplacementScale(axis), calibration.displacement_uncertainty),
                (Source::ForceZero(axis), calibration.zero()),
            ]
        });
        let all = storeys.chain(matrices).chain(modes).chain(axes).chain(stated.iter().copied());
        sources.extend(all.filter(|(_, uncertainty)| *uncertainty > 0.0).map(|(source, _)| source));
        sources.sort_unstable();
        sources.dedup();
        sources
    }

    fn ratios(&self) -> &[Formula] {
        match self.damping {
            ShakeDamping::Rayleigh(ratio) => std::slice::from_ref(ratio),
            ShakeDamping::Modal(ratios) => ratios,
        }
    }

    fn is_sampled(&self) -> bool {
        self.errors(0).iter().any(|noise| noise.force > 0.0 || noise.displacement > 0.0)
    }

    /// How much a study of so many steps takes, by so many rules.
    pub fn effort(&self, steps: usize, rules: usize, sources: &[Source]) -> Effort {
        let alike = sources.iter().filter(|source| is_alike(**source)).count();
        let steps = (steps * rules * self.floors()) as u64;
        Effort::of(steps, sources.len(), alike, self.is_sampled())
    }

    /// One draw of the errors of all readings, axis by axis.
    fn errors(&self, draw: u16) -> Vec<Noise> {
        let of_axis = |axis| {
            let (force, displacement) = reading_errors(self.whole, self.noise, axis);
            Noise { force, displacement, draw }
        };
        (0..self.floors()).map(of_axis).collect()
    }

    /// The runs to take: `job` makes one of moved sources and a distorted way, in so many steps for each of the run, which `told` these
    /// numbers.
    pub fn study<J>(
        &self,
        sources: &[Source],
        effort: Effort,
        told: Vec<f64>,
        job: impl Fn(Shifts<'_>, FrameDistortion) -> Result<J, String>,
    ) -> Result<Study<J>, String> {
        let (drawn, moved): (Vec<Source>, Vec<Source>) = sources.iter().partition(|source| effort.together && is_alike(**source));
        let [half, quarter] = FINER.map(|finer| job(&[], FrameDistortion { finer, ..FrameDistortion::none(self.floors()) }));
        let refined = Refined { source: Source::TimeStep { procedure: self.procedure }, told, jobs: [half?, quarter?] };
        let mut study = Study { moved: Vec::new(), refined: Some(refined), draws: Vec::new() };
        let moved_alone = |(source, by): (Source, f64)| job(&[(source, by)], self.distortion(&[(source, by)], Vec::new()));
        for source in moved {
            study.moved.push((source, effort.shifted(|by| moved_alone((source, by)))?));
        }
        for (draw, source) in effort.draws(self.procedure, self.blow) {
            // Inputs are drawn as a reading is that the run never has.
            let sign = |place: u64| Noise { force: 1.0, displacement: 0.0, draw }.errors(u64::MAX >> 16 ^ place, 0)[0];
            let shifts: Vec<(Source, f64)> = drawn.iter().zip(0..).map(|(source, place)| (*source, sign(place))).collect();
            let drawn = |shifts: &[(Source, f64)]| job(shifts, self.distortion(shifts, self.errors(draw)));
            // What cannot be moved to one side is moved to the other.
            let within = |(source, by): &(Source, f64)| (*source, if moved_alone((*source, *by)).is_ok() { *by } else { -by });
            let made = drawn(&shifts).or_else(|_| drawn(&shifts.iter().map(within).collect::<Vec<(Source, f64)>>()));
            study.draws.push((source, made?));
        }
        Ok(study)
    }

    fn distortion(&self, shifts: Shifts<'_>, noise: Vec<Noise>) -> FrameDistortion {
        let mut distortion = FrameDistortion { noise, ..FrameDistortion::none(self.floors()) };
        for (source, by) in shifts {
            let calibration = |axis| self.whole.rig.calibration_of(axis);
            match *source {
                Source::ForceScale(axis) => distortion.force_scale[axis] += by * calibration(axis).force_uncertainty,
                Source::DisplacementScale(axis) => {
                    distortion.displacement_scale[axis] += by * calibration(axis).displacement_uncertainty;
                }
                Source::ForceZero(axis) => distortion.zero[axis] = by * calibration(axis).zero(),
                _ => {}
            }
        }
        distortion
    }

    /// The frame with its storeys as they are moved.
    pub fn moved_frame(&self, shifts: Shifts<'_>) -> Result<Frame, Stop> {
        let frame = self.frame.ok_or_else(no_frame)?;
        let mut factors = [1.0; 2];
        for (source, by) in shifts {
            match *source {
                Source::MassMatrix(specimen) if specimen == self.specimen => factors[0] += by * frame.matrix_uncertainty[0],
                Source::StiffnessMatrix(specimen) if specimen == self.specimen => factors[1] += by * frame.matrix_uncertainty[1],
                _ => {}
            }
        }
        if frame.storeys.is_empty() {
            return Ok(frame.scaled(factors));
        }
        Ok(frame.with(|storeys| {
            for (source, by) in shifts {
                match *source {
                    Source::StoreyMass { specimen, storey } if specimen == self.specimen => {
                        storeys[storey].mass += by * storeys[storey].mass_uncertainty;
                    }
                    Source::StoreyStiffness { specimen, storey } if specimen == self.specimen => {
                        storeys[storey].stiffness += by * storeys[storey].stiffness_uncertainty;
                    }
                    _ => {}
                }
            }
        }))
    }

    /// The damping as it is moved.
    pub fn moved_damping(&self, shifts: Shifts<'_>) -> ShakeDamping {
        let moved = |(mode, ratio): (usize, &Formula)| {
            let source = Source::DampingRatio { procedure: self.procedure, mode };
            let by: f64 = shifts.iter().filter(|(moved, _)| *moved == source).map(|(_, by)| by).sum();
            if by == 0.0 {
                return ratio.clone();
            }
            let more = Formula::Constant(by * self.damping_uncertainty);
            Formula::Binary(Operator::Add, Box::new(ratio.clone()), Box::new(more))
        };
        match self.damping {
            ShakeDamping::Rayleigh(ratio) => ShakeDamping::Rayleigh(moved((0, ratio))),
            ShakeDamping::Modal(ratios) => ShakeDamping::Modal(ratios.iter().enumerate().map(moved).collect()),
        }
    }

    /// Calls with inputs that read results with the sources moved.
    pub fn with_inputs<T>(
        &self,
        shifts: Shifts<'_>,
        then: &mut dyn FnMut(&mut Inputs<'_>) -> Result<T, Stop>,
    ) -> Result<T, Stop> {
        with_moved(self.results, shifts, &mut |results| then(&mut Inputs::moved(results, self.procedure, self.lift)))
    }

    /// How the run was integrated.
    pub fn run(&self, steps: &FrameSteps) -> FrameRun {
        FrameRun {
            matrices: steps.properties.matrices.clone(),
            integrator: self.stepping.integrator,
            i_modification: self.stepping.i_modification,
            tangents: steps.tangents,
            time_step: steps.time_step,
            steps: steps.steps,
            force_noise: self.noise.force,
            resolution: self.noise.resolution,
            gliding: matches!(self.stepping.mode, Mode::Continuous { .. }),
        }
    }

    /// The same in so many steps for each of its own.
    pub fn finer_run(&self, steps: &FrameSteps, finer: u8) -> FrameRun {
        let run = self.run(steps);
        FrameRun { time_step: run.time_step / f64::from(finer), steps: run.steps * u64::from(finer), ..run }
    }

    /// The way that was recorded.
    pub fn path(&self, steps: &FrameSteps, readings: Vec<FrameReading>) -> Result<FramePath, String> {
        self.passed(steps, readings, Vec::new())
    }

    /// The same way, once it is known how fast its targets were passed (m/s).
    pub fn under_way(&self, steps: &FrameSteps, path: FramePath, velocities: Vec<Vec<f64>>) -> Result<FramePath, String> {
        if velocities.is_empty() { Ok(path) } else { self.passed(steps, path.into_readings(), velocities) }
    }

    fn passed(&self, steps: &FrameSteps, readings: Vec<FrameReading>, velocities: Vec<Vec<f64>>) -> Result<FramePath, String> {
        let stiffness = &steps.properties.matrices.stiffness;
        let path = FramePath::new(readings, (velocities, steps.time_step), stiffness, self.noise.force, self.noise.resolution);
        path.ok_or_else(|| "nothing was recorded".to_owned())
    }
}

fn with_moved<T>(results: &dyn Results, shifts: Shifts<'_>, then: &mut dyn FnMut(&dyn Results) -> T) -> T {
    match shifts.split_first() {
        None => then(results),
        Some(((source, by), rest)) => with_moved(&Moved { results, source: *source, by: *by }, rest, then),
    }
}

/// Whether the floors came to what is told of them; `displacement` names the result with the floors' largest.
pub(super) fn leads_there(floors: &Floors, displacement: &str, told: &[NamedResult]) -> bool {
    // The largest shear is told without what noise adds to it: the drifts say that the way is the recorded one.
    let lists = [
        (displacement, floors.max_displacement.as_slice()),
        ("max_drift", &floors.max_drift),
        ("final_drift", &floors.final_drift),
    ];
    lists.into_iter().all(|(name, found)| {
        let told = match told.iter().find(|result| result.name == name).map(|result| &result.value) {
            Some(ResultValue::List(values)) => values.as_slice(),
            Some(ResultValue::Number { value, .. }) => value.as_slice(),
            None => return false,
        };
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= CLOSE * a.abs().max(b.abs());
        told.len() == found.len() && told.iter().zip(found).all(near)
    })
}

/// The numbers that a run told, in the order of a layout; NaN where one does not exist.
pub(super) fn numbers_told(layout: &[(&'static str, usize)], results: &[NamedResult]) -> Vec<f64> {
    let of = |(name, count): &(&'static str, usize)| {
        let values = match results.iter().find(|result| result.name == *name).map(|result| &result.value) {
            Some(ResultValue::List(values)) => values.clone(),
            Some(ResultValue::Number { value, .. }) => value.iter().copied().collect(),
            None => Vec::new(),
        };
        values.into_iter().chain(std::iter::repeat(f64::NAN)).take(*count).collect::<Vec<f64>>()
    };
    layout.iter().flat_map(of).collect()
}

/// Results that wait for the end of the run, beside those of any impact.
const LATE_OF_STOREYS: [&str; 2] = ["final_drift", "storey_energy"];

/// Says of what waits for the end of a run that swung back that it is not sure.
pub(super) fn mark_late(layout: &[(&'static str, usize)], contributions: &mut [Vec<Contribution>]) {
    let names = layout.iter().flat_map(|(name, count)| std::iter::repeat_n(*name, *count));
    let late = names.zip(contributions).filter(|(name, _)| LATE.contains(name) || LATE_OF_STOREYS.contains(name));
    for part in late.flat_map(|(_, parts)| parts) {
        part.smooth = false;
    }
}

/// Numbers of a study by the results that they are: a name with how many numbers it has, one of which may be no list.
pub(super) fn give_all(layout: &[(&'static str, usize)], parts: Vec<Vec<Contribution>>, results: &mut [NamedResult]) {
    let mut parts = parts.into_iter();
    for (name, count) in layout {
        let mine: Vec<Vec<Contribution>> = parts.by_ref().take(*count).collect();
        let Some(result) = results.iter_mut().find(|result| result.name == *name) else { continue };
        if matches!(result.value, ResultValue::List(_)) {
            result.contributions.clear();
            for (entry, parts) in mine.into_iter().enumerate() {
                give_entry(result, entry, parts);
            }
        } else {
            for parts in mine {
                give(result, parts);
            }
        }
    }
}
