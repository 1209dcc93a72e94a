//! The sources of uncertainty: what a plan, its rig and the readings of a run do not know exactly.

/// Position of a procedure in the plan, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProcedureId(pub usize);

/// Something that is not known exactly, independent of every other source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Source {
    /// What a procedure's own scatter leaves open of a result; of one fitted together with others, what goes beyond those
    /// before it.
    Fit {
        procedure: ProcedureId,
        result: &'static str,
    },
    /// The same of one entry of a list of results.
    FitEntry {
        procedure: ProcedureId,
        result: &'static str,
        entry: usize,
    },
    /// By its place among the plan's strikers.
    StrikerMass(usize),
    StrikerVelocity(usize),
    /// By its place among the plan's specimens.
    SpecimenMass(usize),
    /// The mass of one floor of a frame, both from 0.
    StoreyMass {
        specimen: usize,
        storey: usize,
    },
    /// The stiffness of one storey of a frame, as the plan states it.
    StoreyStiffness {
        specimen: usize,
        storey: usize,
    },
    /// The factor on the matrix of the masses of a frame, as a whole.
    MassMatrix(usize),
    /// The factor on the matrix of its stiffnesses, as a whole.
    StiffnessMatrix(usize),
    /// The computed damping ratio of one mode of a frame, from 0; of Rayleigh damping the one ratio that it has.
    DampingRatio {
        procedure: ProcedureId,
        mode: usize,
    },
    /// The factor on a record of the ground, by its place among the plan's grounds.
    GroundScale(usize),
    /// The factor between newtons and those of the load cell of an axis, by its place; each axis has a cell of its own.
    ForceScale(usize),
    /// The factor between metres and those of the transducer of an axis, by its place.
    DisplacementScale(usize),
    /// What the load cell of an axis, by its place, reads of no force.
    ForceZero(usize),
    /// Noise and resolution of a procedure's readings: one of the draws by which they are sampled.
    Readings {
        procedure: ProcedureId,
        draw: u16,
    },
    /// The same, with the inputs of which there is one a floor, a mode or an axis drawn together with them.
    Drawn {
        procedure: ProcedureId,
        draw: u16,
    },
    /// One of the readings by which the place was found where a specimen rests after a blow of a procedure, from 0, or after
    /// none.
    RestReading {
        procedure: ProcedureId,
        blow: u16,
        reading: u16,
    },
    /// What it still carries there beyond what readings can tell from none.
    RestLoad {
        procedure: ProcedureId,
        blow: u16,
    },
    /// The resolution of a procedure's readings in a fitted result, or in an entry of a list, beyond what its scatter shows.
    Rounding {
        procedure: ProcedureId,
        result: &'static str,
        entry: usize,
    },
    /// The error by their resolution that all readings of a fit have in common.
    CommonRounding {
        procedure: ProcedureId,
    },
    /// The stiffness of the strokes of a damping sweep, which brings readings of a lagging actuator to one place.
    StrokeStiffness {
        procedure: ProcedureId,
    },
    /// The points of the loops of a procedure: what lies between them is not known.
    LoopSampling {
        procedure: ProcedureId,
    },
    /// The time step of an integration, and that times are told to a whole one: the run is integrated again in finer steps.
    TimeStep {
        procedure: ProcedureId,
    },
}
