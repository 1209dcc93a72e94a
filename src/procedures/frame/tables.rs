//! Tables of floors, one row per step and storey, and of elements. In: steps. Out: columns in SI. Quantities of the whole frame are the
//! same in every row of a step; the tracking energy is that of each floor. If a specimen on the rig has a scale, the numbers of each axis
//! are in columns beside those of the prototype.

use crate::report::tables::TableColumn::{self, Integer, Number, Optional};
use crate::report::tables::{Column, Table, numeric, written};
use psd_physics::structure::assemblies::Assemblies;
use psd_plan::record::{Floors, FloorsAt};
use psd_plan::schema::Column as SchemaColumn;
use psd_plan::schema::columns;

/// A storey at the end of a step.
pub(crate) struct FloorRow<'a, S> {
    pub step: &'a S,
    pub floors: FloorsAt<'a>,
    pub floor: usize,
    /// Of the storey; NaN, and not written, for a frame of matrices with elements.
    drift: f64,
    /// The same, net of P-Δ.
    shear: f64,
    spring_shear: f64,
    /// Command and measured displacement \[m\], and force \[N\] of the axis at the storey on the rig.
    on_the_rig: Option<[f64; 3]>,
}

/// The storeys of a step after each other, from the ground up; `scaled` if a specimen on the rig has a scale.
pub(crate) fn rows<'a, F: Floors + 'a, S>(
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
pub(crate) fn written_steps<'a, S: Floors>(
    columns: Vec<TableColumn<FloorRow<'a, S>>>,
    steps: &'a [S],
    scaled: Option<&Assemblies>,
) -> Vec<Column> {
    let rows = rows(steps.iter().map(|step| (step, step)), scaled);
    written_rows(columns, &rows, scaled)
}

/// The columns of these rows: those of P-Δ only if a floor has a weight, those of the rig only if a specimen has a scale, those of storeys
/// not for a frame of matrices with elements.
pub(crate) fn written_rows<'a, S>(
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
pub(crate) const fn storey<'a, S>() -> TableColumn<FloorRow<'a, S>> {
    Integer(columns::STOREY, |row| row.floor as u64 + 1)
}

/// Commanded and measured positions of the floors.
pub(crate) fn positions<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::COMMAND, |row| row.floors.command[row.floor]),
        Number(columns::DISPLACEMENT, |row| row.floors.measured[row.floor]),
    ]
}

/// The computed motion of the floors.
pub(crate) fn computed<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::COMPUTED, |row| row.floors.computed[row.floor]),
        Number(columns::VELOCITY, |row| row.floors.velocity[row.floor]),
        Number(columns::ACCELERATION, |row| {
            row.floors.acceleration[row.floor]
        }),
    ]
}

/// The shear of the storeys without P-Δ.
pub(crate) fn spring_shear<'a, S>() -> TableColumn<FloorRow<'a, S>> {
    Number(columns::SPRING_SHEAR, |row| row.spring_shear)
}

/// The restoring forces of the floors, and the drifts and shears of the storeys.
pub(crate) fn forces<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
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
pub(crate) fn tracking<'a, S>() -> Vec<TableColumn<FloorRow<'a, S>>> {
    vec![
        Number(columns::TRACKING_ENERGY_ERROR, |row| {
            row.floors.tracking[row.floor].energy_error
        }),
        Number(columns::TRACKING_INDICATOR, |row| {
            row.floors.tracking[row.floor].indicator
        }),
    ]
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

pub(crate) fn joined<T, const N: usize>(parts: [Vec<TableColumn<T>>; N]) -> Vec<TableColumn<T>> {
    parts.into_iter().flatten().collect()
}
