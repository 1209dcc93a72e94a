//! Tables of floors, one row per step and storey: for ground motion with its record, for an impact on a storey with striker and contact,
//! and for an unloading. In: steps. Out: columns in SI. Quantities of the whole frame are the same in every row of a step; the tracking
//! energy is that of each floor. If a specimen on the rig has a scale, the numbers of each axis are in columns beside those of the prototype.

use crate::report::tables::TableColumn::{self, Integer, Number, Optional, Text};
use crate::report::tables::{Column, Table, numeric, written};
use psd_physics::structure::substructures::Assemblies;
use psd_plan::record::{
    FloorStep, Floors, FloorsAt, ImpactStep, ShakeHistory, ShakeStep, UnloadStep,
};
use psd_plan::schema::Column as SchemaColumn;
use psd_plan::schema::columns::{self, column};
use psd_text::units::Dimension;

/// A storey at the end of a step.
pub(crate) struct FloorRow<'a, S> {
    step: &'a S,
    floors: FloorsAt<'a>,
    floor: usize,
    /// Of the storey; NaN, and not written, for a frame of matrices with elements.
    drift: f64,
    /// The same, net of P-Δ.
    shear: f64,
    spring_shear: f64,
    /// Command and measured displacement \[m\], and force \[N\] of the axis at the storey on the rig.
    on_the_rig: Option<[f64; 3]>,
}

/// An impact on a storey: the step of the striker, and that of the floors.
pub(crate) struct StruckStep<'a> {
    impact: &'a ImpactStep,
    floors: &'a FloorStep,
}

/// The storeys of a step after each other, from the ground up; `scaled` if a specimen on the rig has a scale.
fn rows<'a, F: Floors + 'a, S>(
    steps: impl Iterator<Item = (&'a F, &'a S)>,
    scaled: Option<&Assemblies>,
) -> Vec<FloorRow<'a, S>> {
    let storeys = |(floors, step): (&'a F, &'a S)| {
        // Elements have a table of their own.
        let on_the_rig = match scaled.filter(|_| !floors.has_elements()) {
            Some(assemblies) => {
                let read = [floors.measured(), floors.restoring_force()];
                assemblies.of_members(
                    assemblies.axes_of(floors.command()),
                    assemblies.axes_read(read, &[]),
                )
            }
            None => vec![None; floors.command().len()],
        };
        let of_storeys = if floors.has_elements() {
            vec![[f64::NAN; 3]; floors.command().len()]
        } else {
            let shears = floors.net_shear().into_iter().zip(floors.shear());
            let storeys = floors.drift().into_iter().zip(shears);
            storeys
                .map(|(drift, (shear, spring_shear))| [drift, shear, spring_shear])
                .collect()
        };
        let storeys = of_storeys.into_iter().enumerate();
        storeys.map(move |(floor, [drift, shear, spring_shear])| FloorRow {
            step,
            floors: floors.at(),
            floor,
            drift,
            shear,
            spring_shear,
            on_the_rig: on_the_rig[floor],
        })
    };
    steps.flat_map(storeys).collect()
}

/// The columns of steps that contain their floors.
fn written_steps<'a, S: Floors>(
    columns: Vec<TableColumn<FloorRow<'a, S>>>,
    steps: &'a [S],
    scaled: Option<&Assemblies>,
) -> Vec<Column> {
    let rows = rows(steps.iter().map(|step| (step, step)), scaled);
    written_rows(columns, &rows, scaled)
}

/// The columns of these rows: those of P-Δ only if a floor has a weight, those of the rig only if a specimen has a scale, those of storeys
/// not for a frame of matrices with elements.
fn written_rows<'a, S>(
    mut columns: Vec<TableColumn<FloorRow<'a, S>>>,
    rows: &[FloorRow<'a, S>],
    scaled: Option<&Assemblies>,
) -> Vec<Column> {
    let weighs = rows
        .first()
        .is_some_and(|row| !row.floors.gravity_force.is_empty());
    let of_weights = [columns::SPRING_SHEAR, columns::GRAVITY_ENERGY].map(Some);
    columns.retain(|column| weighs || !of_weights.contains(&column.numeric()));
    let has_elements = rows
        .first()
        .is_some_and(|row| !row.floors.elements.is_empty());
    let of_storeys = [
        columns::DRIFT,
        columns::STOREY_SHEAR,
        columns::STOREY_ENERGY,
        columns::TRACKING_ENERGY_ERROR,
        columns::TRACKING_INDICATOR,
    ]
    .map(Some);
    columns.retain(|column| !has_elements || !of_storeys.contains(&column.numeric()));
    let of_rig = scaled
        .filter(|_| !has_elements)
        .map_or_else(Vec::new, |_| on_the_rig());
    written(&joined([columns, of_rig]), rows)
}

/// The number of the storey, from 1.
const fn storey<'a, S>() -> TableColumn<FloorRow<'a, S>> {
    Integer(columns::STOREY, |row| row.floor as u64 + 1)
}

/// Commanded and measured positions of the floors.
fn positions<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::COMMAND, |row| row.floors.command[row.floor]),
        Number(columns::DISPLACEMENT, |row| row.floors.measured[row.floor]),
    ]
}

/// The computed motion of the floors.
fn computed<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::COMPUTED, |row| row.floors.computed[row.floor]),
        Number(columns::VELOCITY, |row| row.floors.velocity[row.floor]),
        Number(columns::ACCELERATION, |row| {
            row.floors.acceleration[row.floor]
        }),
    ]
}

/// The shear of the storeys without P-Δ.
fn spring_shear<'a, S>() -> TableColumn<FloorRow<'a, S>> {
    Number(columns::SPRING_SHEAR, |row| row.spring_shear)
}

/// The restoring forces of the floors, and the drifts and shears of the storeys.
fn forces<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::RESTORING_FORCE, |row| {
            row.floors.restoring_force[row.floor]
        }),
        Number(columns::DRIFT, |row| row.drift),
        Number(columns::STOREY_SHEAR, |row| row.shear),
    ]
}

/// A row of a storey or an element.
pub(crate) trait OnTheRig {
    /// Command and measured displacement \[m\], and force \[N\] of its axis, in numbers of the rig; None for a computed one.
    fn on_the_rig(&self) -> Option<[f64; 3]>;
}

impl<S> OnTheRig for FloorRow<'_, S> {
    fn on_the_rig(&self) -> Option<[f64; 3]> {
        self.on_the_rig
    }
}

/// The axes, in numbers of the rig; empty for a computed storey or element.
pub(crate) fn on_the_rig<R: OnTheRig>() -> Vec<TableColumn<R>> {
    vec![
        Optional(columns::COMMAND_ON_THE_RIG, |row: &R| {
            row.on_the_rig().map(|[command, ..]| command)
        }),
        Optional(columns::DISPLACEMENT_ON_THE_RIG, |row| {
            row.on_the_rig().map(|[_, displacement, _]| displacement)
        }),
        Optional(columns::FORCE_ON_THE_RIG, |row| {
            row.on_the_rig().map(|[.., force]| force)
        }),
    ]
}

/// The numeric columns of a table of floors, also those of the rig.
pub(crate) fn columns<S>(columns: Vec<TableColumn<FloorRow<'_, S>>>) -> Vec<SchemaColumn> {
    numeric(&joined([columns, on_the_rig()]))
}

/// The tracking of the floors.
fn tracking<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::TRACKING_ENERGY_ERROR, |row| {
            row.floors.tracking[row.floor].energy_error
        }),
        Number(columns::TRACKING_INDICATOR, |row| {
            row.floors.tracking[row.floor].indicator
        }),
    ]
}

/// The table of a ground-motion test under this name.
pub(crate) fn table(name: String, history: &ShakeHistory, scaled: Option<Assemblies>) -> Table<'_> {
    let storeys = history
        .steps
        .first()
        .map_or(1, |step| step.floors.computed.len());
    Table::of_steps(name, history.steps.len(), storeys, move |range| {
        written_steps(shake(), &history.steps[range], scaled.as_ref())
    })
}

/// The columns of a ground-motion test; the energies are those of the whole frame.
pub(crate) fn shake<'a>() -> Vec<TableColumn<FloorRow<'a, ShakeStep>>> {
    let ground_acceleration = column("ground_acceleration_m_per_s2", Dimension::ACCELERATION);
    let step = vec![
        Integer(columns::STEP, |row: &FloorRow<'a, ShakeStep>| row.step.step),
        storey(),
        Number(columns::TIME, |row| row.floors.time),
        Number(columns::WALL_TIME, |row| row.step.wall_time),
        Number(ground_acceleration, |row| row.step.ground_acceleration),
    ];
    let energies = vec![
        Number(
            column("kinetic_energy_j", Dimension::ENERGY),
            |row: &FloorRow<'a, ShakeStep>| row.step.energies.kinetic,
        ),
        Number(columns::RESTORING_ENERGY, |row| row.step.energies.restoring),
        Number(columns::DAMPING_ENERGY, |row| row.step.energies.damping),
        Number(column("input_energy_j", Dimension::ENERGY), |row| {
            row.step.energies.input
        }),
        Number(columns::GRAVITY_ENERGY, |row| row.step.energies.gravity),
        Number(columns::ENERGY_ERROR, |row| row.step.energies.error),
    ];
    joined([
        step,
        positions(),
        computed(),
        forces(),
        vec![spring_shear()],
        energies,
        tracking(),
    ])
}

/// The columns of an impact on a storey: the striker, and the floors.
pub(crate) fn struck<'a>() -> Vec<TableColumn<FloorRow<'a, StruckStep<'a>>>> {
    let step = vec![
        Integer(columns::STEP, |row: &FloorRow<'a, StruckStep<'a>>| {
            row.step.impact.step
        }),
        storey(),
        Number(columns::TIME, |row| row.step.impact.time),
        Number(columns::WALL_TIME, |row| row.step.impact.wall_time),
        Text(columns::STATE, |row| row.step.impact.state.name()),
    ];
    let striker = vec![
        Number(
            columns::STOREY_ENERGY,
            |row: &FloorRow<'a, StruckStep<'a>>| row.step.floors.storey_energy[row.floor],
        ),
        Number(columns::CONTACT_FORCE, |row| row.step.impact.contact_force),
        Number(columns::STRIKER_DISPLACEMENT, |row| {
            row.step.impact.striker_displacement
        }),
        Number(columns::STRIKER_VELOCITY, |row| {
            row.step.impact.striker_velocity
        }),
        Number(columns::INDENTATION, |row| row.step.impact.indentation),
        Number(columns::STRIKER_ENERGY, |row| {
            row.step.impact.energies.striker
        }),
        Number(columns::STRUCTURE_ENERGY, |row| {
            row.step.impact.energies.structure
        }),
        Number(columns::RESTORING_ENERGY, |row| {
            row.step.impact.energies.restoring
        }),
        Number(columns::DAMPING_ENERGY, |row| {
            row.step.impact.energies.damping
        }),
        Number(columns::CONTACT_LOSS, |row| {
            row.step.impact.energies.contact_loss
        }),
        Number(columns::INDENTATION_ENERGY, |row| {
            row.step.impact.energies.indentation
        }),
        Number(columns::WEIGHT_WORK, |row| row.step.impact.energies.weight),
        Number(columns::GRAVITY_ENERGY, |row| {
            row.step.impact.energies.gravity
        }),
        Number(columns::ENERGY_ERROR, |row| row.step.impact.energies.error),
    ];
    joined([
        step,
        positions(),
        computed(),
        forces(),
        vec![spring_shear()],
        striker,
        tracking(),
    ])
}

/// The table of an impact on a storey.
pub(crate) fn storey_impact(
    steps: &[ImpactStep],
    floors: &[FloorStep],
    scaled: Option<&Assemblies>,
) -> Vec<Column> {
    let steps: Vec<StruckStep<'_>> = floors
        .iter()
        .zip(steps)
        .map(|(floors, impact)| StruckStep { impact, floors })
        .collect();
    let rows = rows(steps.iter().map(|step| (step.floors, step)), scaled);
    written_rows(struck(), &rows, scaled)
}

/// The columns of an unloading.
pub(crate) fn unloaded<'a>() -> Vec<TableColumn<FloorRow<'a, UnloadStep>>> {
    let step = vec![
        Integer(columns::STEP, |row: &FloorRow<'a, UnloadStep>| {
            row.step.step
        }),
        storey(),
        Number(columns::WALL_TIME, |row| row.step.wall_time),
    ];
    let tangents = vec![Optional(
        columns::TANGENT_STIFFNESS,
        |row: &FloorRow<'a, UnloadStep>| row.step.tangent_stiffness[row.floor],
    )];
    joined([step, positions(), forces(), tangents])
}

/// The table of an unloading; step 0 is its start.
pub(crate) fn unloading(steps: &[UnloadStep], scaled: Option<&Assemblies>) -> Vec<Column> {
    written_steps(unloaded(), steps, scaled)
}

/// An element of a frame of matrices at the end of a step.
pub(crate) struct ElementRow<'a> {
    step: u64,
    floors: FloorsAt<'a>,
    element: usize,
    /// Command and measured displacement \[m\], and force \[N\] of its axis.
    on_the_rig: Option<[f64; 3]>,
}

impl OnTheRig for ElementRow<'_> {
    fn on_the_rig(&self) -> Option<[f64; 3]> {
        self.on_the_rig
    }
}

/// The columns of the elements.
pub(crate) fn elements<'a>() -> Vec<TableColumn<ElementRow<'a>>> {
    let columns = vec![
        Integer(columns::STEP, |row: &ElementRow<'a>| row.step),
        Integer(columns::ELEMENT, |row| row.element as u64 + 1),
        Number(columns::TIME, |row| row.floors.time),
        Number(columns::COMMAND, |row| {
            row.floors.elements[row.element].target
        }),
        Number(columns::DEFORMATION, |row| {
            row.floors.elements[row.element].deformation
        }),
        Number(columns::RESTORING_FORCE, |row| {
            row.floors.elements[row.element].force
        }),
        Number(columns::TRACKING_ENERGY_ERROR, |row| {
            row.floors.tracking[row.element].energy_error
        }),
        Number(columns::TRACKING_INDICATOR, |row| {
            row.floors.tracking[row.element].indicator
        }),
    ];
    joined([columns, on_the_rig()])
}

/// The table of the elements of a frame of matrices; None without elements. `number` is the number of a step from its index.
pub(crate) fn of_elements<'a, S: Floors>(
    name: &str,
    steps: &'a [S],
    number: impl Fn(usize) -> u64 + 'a,
    assemblies: Option<Assemblies>,
) -> Option<Table<'a>> {
    let assemblies = assemblies?;
    let count = steps.first()?.elements().len();
    let rows = move |range: std::ops::Range<usize>| {
        let mut rows = Vec::with_capacity(count * range.len());
        for index in range {
            let step = &steps[index];
            let read = [step.measured(), step.restoring_force()];
            let on_the_rig = assemblies.of_members(
                assemblies.axes_of(step.command()),
                assemblies.axes_read(read, step.elements()),
            );
            let row = |(element, on_the_rig)| ElementRow {
                step: number(index),
                floors: step.at(),
                element,
                on_the_rig,
            };
            rows.extend(on_the_rig.into_iter().enumerate().map(row));
        }
        written(&elements(), &rows)
    };
    (count > 0).then(|| Table::of_steps(format!("{name}_elements"), steps.len(), count, rows))
}

fn joined<T, const N: usize>(parts: [Vec<TableColumn<T>>; N]) -> Vec<TableColumn<T>> {
    parts.into_iter().flatten().collect()
}
