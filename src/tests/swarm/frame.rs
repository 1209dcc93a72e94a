//! The frame of a life, and what the test does with it: tested and computed storeys or elements, scales, weights, ground motions, impacts.
//! In: random choices. Out: plain data, the parts of a plan, and the numbers on the rig that belong to numbers of the prototype. It asks
//! no code of psd for these.

use super::draw::Draw;
use crate::tests::testing::{every, impact};
use psd_plan::formula::{Formula, ProcedureId, ResultPart, ResultReference};
use psd_plan::record::{FloorMotion, History, ProcedureRecord, StruckFrame};
use psd_plan::{
    Behaviour, Between, Comparison, Condition, Contact, Element, Escalate, Frame, Ground, Impact,
    ImpactTarget, Integrator, Part, Preload, ProcedureKind, Scale, Shake, ShakeDamping, Stepping,
    Storey, StoreyTarget, Test, Unload, Until,
};
use psd_text::units::Dimension;

/// Stiffness of a specimen on the rig \[N/m\], and mass of a floor \[kg\].
const STIFFNESS: f64 = 1e5;
const MASS: f64 = 1000.0;
/// Drift at which a specimen yields, on the rig \[m\].
const YIELD: f64 = 1e-4;
/// \[s\]
const TIME_STEP: f64 = 0.02;
/// Height of a storey \[m\], and weight of a floor \[N\].
const HEIGHT: f64 = 3.0;
const WEIGHT: f64 = 20e3;

/// A storey, or an element of a frame of matrices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Member {
    /// The degrees of freedom, from 0, that it joins. None is the ground.
    pub(super) ends: [Option<usize>; 2],
    pub(super) yields: bool,
    pub(super) part: Part,
}

/// What happens to the frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Load {
    /// Ground motion of this many steps, with this peak acceleration \[m/s²\].
    Shake { steps: u32, peak: f64 },
    /// One impact on a floor.
    Impact { floor: usize },
    /// Impacts on a floor, with these velocities of the striker \[m/s\].
    Escalate {
        floor: usize,
        velocities: Vec<f64>,
        between: Between,
    },
    /// To zero restoring force.
    Unload,
}

/// An axial axis, which loads a tested storey before all else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axial {
    /// Index of the storey.
    pub(super) storey: usize,
    /// On the rig \[N\].
    pub(super) force: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct FrameTest {
    /// Storeys from the ground up, or elements beside a matrix. None: the rig carries the frame of a matrix.
    pub(super) members: Vec<Member>,
    /// Degrees of freedom of a frame of matrices; None: a frame of storeys.
    pub(super) matrix: Option<usize>,
    pub(super) weights: bool,
    pub(super) axial: Option<Axial>,
    pub(super) integrator: Integrator,
    pub(super) loads: Vec<Load>,
}

impl FrameTest {
    pub(super) fn drawn(draw: &mut Draw) -> Self {
        let matrix = draw.chance(0.25).then(|| draw.one_of(&[2, 2, 3]));
        let members = match matrix {
            None => storeys(draw),
            Some(floors) => elements(draw, floors),
        };
        let mut test = Self {
            weights: matrix.is_none() && draw.chance(0.3),
            axial: None,
            members,
            matrix,
            integrator: draw.one_of(&[
                Integrator::Tangent,
                Integrator::Explicit,
                Integrator::AlphaOs { alpha: -0.05 },
            ]),
            loads: Vec::new(),
        };
        let floors = test.floors();
        let has_elements = matrix.is_some() && !test.is_whole_matrix();
        test.loads = (0..draw.one_of(&[1, 1, 2]))
            .map(|_| load(draw, floors, has_elements))
            .collect();
        if draw.chance(0.2) {
            test.loads.push(Load::Unload);
        }
        if matrix.is_none() && draw.chance(0.3) {
            let tested: Vec<usize> = (0..floors)
                .filter(|storey| test.members[*storey].part != Part::Computed)
                .collect();
            test.axial = Some(Axial {
                storey: draw.one_of(&tested),
                force: 200.0 * f64::from(draw.between(1, 6)),
            });
        }
        test
    }

    /// The same without its axial axis.
    pub(super) fn without_axial(&self) -> Self {
        Self {
            axial: None,
            ..self.clone()
        }
    }

    /// Number of procedures before the loads.
    pub(super) const fn before_loads(&self) -> usize {
        match self.axial {
            Some(_) => 1,
            None => 0,
        }
    }

    /// Floors, or degrees of freedom.
    pub(super) fn floors(&self) -> usize {
        self.matrix.unwrap_or(self.members.len())
    }

    /// The tested storeys or elements, each with whether it stands on the tested storey below.
    fn tested(&self) -> Vec<(Member, bool)> {
        let mut below = false;
        let mut tested = Vec::new();
        for member in &self.members {
            let stands = std::mem::replace(&mut below, false);
            if let Part::Tested { apart, .. } = member.part {
                below = self.matrix.is_none();
                tested.push((*member, stands && !apart));
            }
        }
        tested
    }

    /// The frame of a matrix that the rig carries as a whole.
    fn is_whole_matrix(&self) -> bool {
        self.members.is_empty()
    }

    /// Whether a specimen has a memory.
    pub(super) fn yields(&self) -> bool {
        self.members.iter().any(|member| member.yields)
    }

    /// The same with every specimen at full scale.
    pub(super) fn at_full_scale(&self) -> Self {
        let mut test = self.clone();
        for member in &mut test.members {
            if let Part::Tested { scale, .. } = &mut member.part {
                *scale = Scale::FULL;
            }
        }
        test
    }

    /// Stiffness at each axis of the rig while the others stand still \[N/m\].
    pub(super) fn stiffness_at_axes(&self) -> Vec<f64> {
        if self.is_whole_matrix() {
            let floors = 0..self.floors();
            return floors
                .map(|floor| matrix(self.floors())[floor][floor])
                .collect();
        }
        let tested = self.tested();
        let above = |axis: usize| tested.get(axis + 1).is_some_and(|(_, on_it)| *on_it);
        (0..tested.len())
            .map(|axis| STIFFNESS + if above(axis) { STIFFNESS } else { 0.0 })
            .collect()
    }

    /// Displacements of the axes \[m\] that belong to these displacements of the floors.
    pub(super) fn axes_of(&self, floors: &[f64]) -> Vec<f64> {
        if self.is_whole_matrix() {
            return floors.to_vec();
        }
        let at = |end: Option<usize>| end.map_or(0.0, |end| floors[end]);
        let mut base = None;
        let tested = self.tested().into_iter().map(|(member, on_it)| {
            let [from, to] = member.ends;
            if !on_it {
                base = from;
            }
            member.part.scale().displacement * (at(to) - at(base))
        });
        tested.collect()
    }

    /// Forces of the axes \[N\] that belong to the restoring forces at a step.
    pub(super) fn forces_of(&self, step: &FloorMotion) -> Vec<f64> {
        let floors = &step.restoring_force;
        if self.is_whole_matrix() {
            return floors.clone();
        }
        if self.matrix.is_some() {
            let members = self.members.iter().zip(&step.elements);
            let tested = members.filter(|(member, _)| member.part != Part::Computed);
            return tested
                .map(|(member, read)| {
                    let scale = member.part.scale();
                    read.force * scale.force / scale.represents
                })
                .collect();
        }
        // The shear of a storey is the sum of the forces of its floor and of all above.
        let shear = |storey: usize| floors[storey..].iter().sum::<f64>();
        let tested = self.tested();
        let above = |axis: usize| tested.get(axis + 1).is_some_and(|(_, on_it)| *on_it);
        let axes = tested.iter().enumerate().map(|(axis, (member, _))| {
            let [_, floor] = member.ends;
            let floor = floor.expect("a floor");
            let shears = shear(floor) - if above(axis) { shear(floor + 1) } else { 0.0 };
            let scale = member.part.scale();
            shears * scale.force / scale.represents
        });
        axes.collect()
    }

    /// The measured displacements of the axes \[m\] at a step.
    pub(super) fn measured_at(&self, step: &FloorMotion) -> Vec<f64> {
        if self.matrix.is_none() || self.is_whole_matrix() {
            return self.axes_of(&step.displacement);
        }
        let members = self.members.iter().zip(&step.elements);
        let tested = members.filter(|(member, _)| member.part != Part::Computed);
        tested
            .map(|(member, read)| member.part.scale().displacement * read.deformation)
            .collect()
    }

    pub(super) fn frame(&self) -> Frame {
        let stiffness = |member: &Member| {
            let Scale {
                displacement,
                force,
                represents,
            } = member.part.scale();
            STIFFNESS * displacement * represents / force
        };
        let behaviour = |member: &Member| {
            if member.yields {
                Behaviour::Bilinear {
                    stiffness: STIFFNESS,
                    yield_force: YIELD * STIFFNESS,
                    post_yield_ratio: 0.1,
                }
            } else {
                Behaviour::Elastic {
                    stiffness: STIFFNESS,
                }
            }
        };
        let Some(floors) = self.matrix else {
            let storeys = self.members.iter().enumerate().map(|(storey, member)| {
                let axial = self.axial.filter(|axial| axial.storey == storey);
                let Scale {
                    force, represents, ..
                } = member.part.scale();
                Storey {
                    part: member.part,
                    height: (self.weights || axial.is_some()).then_some(HEIGHT),
                    gravity: if self.weights { WEIGHT } else { 0.0 },
                    axial_load: axial.map_or(0.0, |axial| axial.force * represents / force),
                    ..Storey::new(MASS, stiffness(member), behaviour(member))
                }
            });
            return Frame::of_storeys(storeys.collect());
        };
        let elements = self.members.iter().map(|member| Element {
            ends: member.ends,
            stiffness: stiffness(member),
            stiffness_uncertainty: 0.0,
            behaviour: behaviour(member),
            damping: 0.0,
            coulomb: 0.0,
            part: member.part,
        });
        let mass =
            |row: usize| (0..floors).map(move |column| if row == column { MASS } else { 0.0 });
        let mass = (0..floors).map(|row| mass(row).collect()).collect();
        Frame::of_matrices(mass, matrix(floors)).with_elements(elements.collect())
    }

    /// The ground motions, and the procedure of each load.
    pub(super) fn procedures(&self) -> (Vec<Ground>, Vec<ProcedureKind>) {
        let mut grounds = Vec::new();
        let preload = self.axial.map(|axial| {
            ProcedureKind::Preload(Preload {
                storey: axial.storey,
                force: axial.force,
            })
        });
        let loads = (self.before_loads()..).zip(&self.loads);
        let kinds = loads.map(|(index, load)| {
            let stepping = Stepping {
                integrator: self.integrator,
                max_tangent_ratio: Formula::Constant(2.0),
                ..every(TIME_STEP)
            };
            match load {
                Load::Shake { steps, peak } => {
                    grounds.push(ground(index, *peak));
                    ProcedureKind::Shake(Shake {
                        specimen: 0,
                        ground: grounds.len() - 1,
                        damping: ShakeDamping::Rayleigh(Formula::Constant(0.02)),
                        damping_uncertainty: 0.0,
                        stepping,
                        scale: Formula::Constant(1.0),
                        duration: Some(duration(*steps)),
                        until: None,
                    })
                }
                Load::Unload => ProcedureKind::Unload(Unload {
                    specimen: 0,
                    stiffness: None,
                    within: None,
                    speed: None,
                    keep_axial_load: false,
                }),
                Load::Impact { floor } => ProcedureKind::Impact(impact_on(*floor, stepping)),
                Load::Escalate {
                    floor,
                    velocities,
                    between,
                } => ProcedureKind::Escalate(Escalate {
                    own: ProcedureId(index),
                    impact: impact_on(*floor, stepping),
                    velocities: velocities.iter().copied().map(Formula::Constant).collect(),
                    energies: None,
                    condition: vec![goes_on(index)],
                    between: *between,
                    inspect_between: false,
                }),
            }
        });
        let kinds = preload.into_iter().chain(kinds).collect();
        (grounds, kinds)
    }
}

/// The floors at every completed step of a procedure, in their order.
pub(super) fn steps_of(procedure: &ProcedureRecord) -> Vec<&FloorMotion> {
    match &procedure.history {
        History::Shake(history) => {
            let steps = history.steps.iter().skip(1);
            steps.map(|step| &step.floors).collect()
        }
        History::Impact(history) => struck(history.frame.as_ref()).collect(),
        History::Escalate(history) => {
            let impacts = history.storeys();
            impacts.flat_map(|storey| struck(Some(storey))).collect()
        }
        _ => Vec::new(),
    }
}

fn struck(frame: Option<&StruckFrame>) -> impl Iterator<Item = &FloorMotion> {
    let steps = frame
        .into_iter()
        .flat_map(|frame| frame.floors.iter().skip(1));
    steps.map(|step| &step.floors)
}

pub(super) fn duration(steps: u32) -> Formula {
    Formula::Constant(f64::from(steps) * TIME_STEP)
}

/// K of a frame of matrices \[N/m\].
fn matrix(floors: usize) -> Vec<Vec<f64>> {
    let entry = |row: usize, column: usize| match row.abs_diff(column) {
        0 if row + 1 == floors => STIFFNESS,
        0 => 2.0 * STIFFNESS,
        1 => -STIFFNESS,
        _ => 0.0,
    };
    (0..floors)
        .map(|row| (0..floors).map(|column| entry(row, column)).collect())
        .collect()
}

/// One period of a sine, then rest.
fn ground(index: usize, peak: f64) -> Ground {
    let samples = 0..60_u32;
    Ground {
        name: format!("ground{index}"),
        file: format!("ground{index}.csv"),
        unit: 1.0,
        scale: 1.0,
        scale_uncertainty: 0.0,
        times: samples
            .clone()
            .map(|sample| 0.01 * f64::from(sample))
            .collect(),
        accelerations: samples
            .map(|sample| peak * (0.25 * f64::from(sample)).sin())
            .collect(),
    }
}

fn impact_on(floor: usize, stepping: Stepping) -> Impact {
    Impact {
        target: ImpactTarget::Storey(StoreyTarget {
            storey: floor,
            damping: ShakeDamping::Rayleigh(Formula::Constant(0.02)),
            damping_uncertainty: 0.0,
        }),
        // Restitution finds the instant of the contact by a tangent.
        contact: if stepping.integrator == Integrator::Tangent {
            Contact::Restitution {
                coefficient: Formula::Constant(0.5),
            }
        } else {
            Contact::Rigid
        },
        stepping,
        duration: duration(4),
        until: Until::Duration,
        ..impact(Formula::Constant(STIFFNESS))
    }
}

/// A condition that each impact satisfies.
fn goes_on(procedure: usize) -> Condition {
    Condition {
        text: String::new(),
        value: Formula::Result(ResultReference {
            procedure: ProcedureId(procedure),
            name: "steps",
            part: ResultPart::Value,
        }),
        test: Test::Compare {
            comparison: Comparison::Greater,
            limit: Formula::Constant(0.0),
        },
        dimension: Dimension::NUMBER,
    }
}

fn scale(draw: &mut Draw) -> Scale {
    draw.one_of(&[
        Scale::FULL,
        Scale::FULL,
        Scale {
            displacement: 0.5,
            force: 0.25,
            represents: 2.0,
        },
        Scale {
            displacement: 0.5,
            force: 0.3,
            represents: 1.0,
        },
    ])
}

/// One to three tested storeys among up to two computed ones.
fn storeys(draw: &mut Draw) -> Vec<Member> {
    let mut tested: Vec<bool> = vec![true; draw.one_of(&[1, 2, 2, 2, 3])];
    for _ in 0..draw.one_of(&[0, 1, 1, 2]) {
        tested.insert(draw.below(tested.len() + 1), false);
    }
    let mut below: Option<Scale> = None;
    let storey = |(floor, tested): (usize, bool)| {
        let part = if tested {
            let apart = below.is_some() && draw.chance(0.3);
            // The storeys of one specimen have one scale.
            let scale = below.filter(|_| !apart).unwrap_or_else(|| scale(draw));
            below = Some(scale);
            Part::Tested { apart, scale }
        } else {
            below = None;
            Part::Computed
        };
        Member {
            ends: [floor.checked_sub(1), Some(floor)],
            yields: draw.chance(0.3),
            part,
        }
    };
    tested.into_iter().enumerate().map(storey).collect()
}

/// No element, or one or two tested ones and perhaps a computed one, each between two of the degrees of freedom or the ground.
fn elements(draw: &mut Draw, floors: usize) -> Vec<Member> {
    if draw.chance(0.3) {
        return Vec::new();
    }
    let mut parts: Vec<Part> = (0..draw.one_of(&[1, 2, 2]))
        .map(|_| Part::Tested {
            apart: false,
            scale: scale(draw),
        })
        .collect();
    if draw.chance(0.4) {
        parts.insert(draw.below(parts.len() + 1), Part::Computed);
    }
    // From 0: the ground.
    let all: Vec<[usize; 2]> = (0..floors)
        .flat_map(|from| (from + 1..=floors).map(move |to| [from, to]))
        .collect();
    let first = draw.below(all.len());
    let member = |(index, part): (usize, Part)| {
        let ends = all[(first + index) % all.len()].map(|end| end.checked_sub(1));
        Member {
            ends: if draw.chance(0.3) {
                [ends[1], ends[0]]
            } else {
                ends
            },
            yields: draw.chance(0.3),
            part,
        }
    };
    parts.into_iter().enumerate().map(member).collect()
}

/// `has_elements`: a series of impacts is for storeys.
fn load(draw: &mut Draw, floors: usize, has_elements: bool) -> Load {
    if draw.chance(0.7) {
        return Load::Shake {
            steps: draw.between(4, 10),
            peak: 0.02 * f64::from(draw.between(1, 6)),
        };
    }
    let floor = draw.below(floors);
    if has_elements {
        return Load::Impact { floor };
    }
    Load::Escalate {
        floor,
        velocities: [5e-3, 8e-3][..draw.one_of(&[1, 2])].to_vec(),
        between: draw.one_of(&[Between::Unload, Between::Home, Between::Stay]),
    }
}
