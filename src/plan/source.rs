//! The sources of uncertainty: the uncertain inputs of a plan, of its rig and of the readings of a run. Beside them the time step, whose
//! effect is known and not in u.

/// Position of a procedure in the plan, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProcedureId(pub usize);

/// An uncertain input quantity, independent of every other source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Source {
    /// The uncertainty of a fitted result from the scatter of a procedure. If several results are fitted together: the part that is
    /// independent of the results before it.
    Fit {
        procedure: ProcedureId,
        result: &'static str,
    },
    /// The same for one entry of a list of results.
    FitEntry {
        procedure: ProcedureId,
        result: &'static str,
        entry: usize,
    },
    /// Mass of a striker, by its index in the plan.
    StrikerMass(usize),
    StrikerVelocity(usize),
    /// Mass of a specimen, by its index in the plan.
    SpecimenMass(usize),
    /// The mass of one floor of a frame, both indices from 0.
    StoreyMass {
        specimen: usize,
        storey: usize,
    },
    /// The stiffness of one storey of a frame, as stated in the plan.
    StoreyStiffness {
        specimen: usize,
        storey: usize,
    },
    /// The stiffness of one element of a frame of matrices, as stated in the plan.
    ElementStiffness {
        specimen: usize,
        element: usize,
    },
    /// The scale factor of the mass matrix of a frame, as a whole.
    MassMatrix(usize),
    /// The scale factor of the stiffness matrix of a frame, as a whole.
    StiffnessMatrix(usize),
    /// The computed damping ratio of one mode of a frame, from 0; for Rayleigh damping its single ratio.
    DampingRatio {
        procedure: ProcedureId,
        mode: usize,
    },
    /// The scale factor of a ground-motion record, by its index in the plan.
    GroundScale(usize),
    /// The scale factor of the load cell of an axis, by the index of the axis; each axis has a separate cell.
    ForceScale(usize),
    /// The scale factor of the displacement transducer of an axis, by the index of the axis.
    DisplacementScale(usize),
    /// The zero offset of the load cell of an axis, by the index of the axis.
    ForceZero(usize),
    /// The forces of an axis below the lower end of its calibrated range, by the index of the axis.
    ForceBelowRange(usize),
    /// The displacements of an axis below the lower end of its calibrated range, by the index of the axis.
    DisplacementBelowRange(usize),
    /// Noise and resolution of the readings of a procedure: one Monte Carlo trial.
    Readings {
        procedure: ProcedureId,
        draw: u16,
    },
    /// The same, with simulated errors also of the inputs that exist once per floor, mode or axis.
    Drawn {
        procedure: ProcedureId,
        draw: u16,
    },
    /// One of the readings that determined the unloaded position of the specimen after an impact of a procedure. The impact is counted
    /// from 0, or is 0 without impacts.
    RestReading {
        procedure: ProcedureId,
        impact: u16,
        reading: u16,
    },
    /// The load that remains at the unloaded position and that the readings cannot distinguish from zero.
    RestLoad {
        procedure: ProcedureId,
        impact: u16,
    },
    /// The resolution of the readings of a procedure, in a fitted result or list entry, beyond the part that the scatter shows.
    Rounding {
        procedure: ProcedureId,
        result: &'static str,
        entry: usize,
    },
    /// The error from the resolution that all readings of a fit have in common.
    CommonRounding {
        procedure: ProcedureId,
    },
    /// The stiffness of the passes of a damping sweep. It corrects the readings of a lagging actuator to one position.
    StrokeStiffness {
        procedure: ProcedureId,
    },
    /// The sampling of the loops of a procedure: the force between two points is not known.
    LoopSampling {
        procedure: ProcedureId,
    },
    /// A duration that is counted in whole time steps.
    WholeSteps {
        procedure: ProcedureId,
    },
    /// The time steps of all integrations. It is no source of uncertainty: its effect is a difference of known size and sign, and is not
    /// in u.
    TimeStep(Refinement),
}

/// Integrations of the whole plan along their recorded paths, whose results differ from those of the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Refinement {
    /// In the steps of the run. Peaks and stops are interpolated between their ends, at which the run reports them.
    Own,
    /// In half of the steps of the run.
    Half,
    /// In a quarter of the steps of the run.
    Quarter,
}

impl Refinement {
    pub const ALL: [Self; 3] = [Self::Own, Self::Half, Self::Quarter];

    /// Refinement for each step of the run.
    #[must_use]
    pub const fn finer(self) -> u8 {
        match self {
            Self::Own => 1,
            Self::Half => 2,
            Self::Quarter => 4,
        }
    }
}

impl Source {
    /// Whether it is a source of uncertainty, whose contribution is in u.
    #[must_use]
    pub const fn is_of_uncertainty(self) -> bool {
        !matches!(self, Self::TimeStep(_))
    }

    /// Whether it is the error of readings below the lower end of a calibrated range.
    #[must_use]
    pub const fn is_below_range(self) -> bool {
        matches!(
            self,
            Self::ForceBelowRange(_) | Self::DisplacementBelowRange(_)
        )
    }
}
