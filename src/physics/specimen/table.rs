//! Measured force–displacement points. In: a displacement. Out: the force there, exact for a move of any length.

use super::{RestoringForce, SpecimenModel};

/// Measured points, from the smallest displacement to the largest, through the origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Name of the source of the points.
    pub file: String,
    /// Displacement \[m\], force \[N\].
    pub points: Vec<[f64; 2]>,
    pub unloading: Unloading,
    /// Factor of the forces of the source; 1 unless a measured stiffness replaces that of the table.
    pub scale: f64,
}

/// Unloading of a measured curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unloading {
    /// Parallel to the steepest segment of the table.
    InitialStiffness,
    /// Along the loading curve: elastic.
    AlongTheCurve,
}

impl Table {
    /// The steeper slope of the two segments at the origin \[N/m\]; with unloading parallel to the steepest segment, the slope of that.
    #[must_use]
    pub fn initial_stiffness(&self) -> f64 {
        match self.unloading {
            Unloading::InitialStiffness => self.steepest(|_| true),
            Unloading::AlongTheCurve => {
                self.steepest(|pair| pair[0][0] <= 0.0 && 0.0 <= pair[1][0])
            }
        }
    }

    /// Slope of the steepest segment in range \[N/m\].
    pub(super) fn steepest(&self, counts: impl Fn(&[[f64; 2]]) -> bool) -> f64 {
        let slope = |pair: &[[f64; 2]]| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        self.scale
            * self
                .points
                .windows(2)
                .filter(|pair| counts(pair))
                .map(slope)
                .fold(0.0, f64::max)
    }

    /// Force of the curve at `displacement` \[N\]; constant beyond its ends.
    #[must_use]
    pub fn force(&self, displacement: f64) -> f64 {
        let after = self.points.partition_point(|[x, _]| *x < displacement);
        let force = match (
            after
                .checked_sub(1)
                .and_then(|before| self.points.get(before)),
            self.points.get(after),
        ) {
            (Some([x, force]), Some([to_x, to_force])) => {
                force + (to_force - force) * ((displacement - x) / (to_x - x))
            }
            (Some([_, force]), None) | (None, Some([_, force])) => *force,
            (None, None) => 0.0,
        };
        self.scale * force
    }
}

/// The model of a table, by its unloading.
#[must_use]
pub fn model(table: &Table) -> SpecimenModel {
    match table.unloading {
        Unloading::InitialStiffness => {
            SpecimenModel::Plastic(Box::new(PlasticCurve::new(table.clone())))
        }
        Unloading::AlongTheCurve => SpecimenModel::AlongTheCurve(Box::new(AlongTheCurve {
            table: table.clone(),
        })),
    }
}

/// R = g(X), independent of the path: non-linear elastic.
#[derive(Clone, Debug, PartialEq)]
pub struct AlongTheCurve {
    table: Table,
}

impl RestoringForce for AlongTheCurve {
    fn move_to(&mut self, displacement: f64) -> f64 {
        self.table.force(displacement)
    }

    fn initial_stiffness(&self) -> f64 {
        self.table.initial_stiffness()
    }
}

/// R = K (X − p) with the steepest slope K of the table, between two strengths, one in each direction. On initial loading the strength is
/// the curve g itself, from its elastic strength on; on reloading it is the force of the peak so far, until the peak is reached again and
/// the curve continues. p moves only at a strength and in its direction, so that no energy is released that was not absorbed.
#[derive(Clone, Debug, PartialEq)]
pub struct PlasticCurve {
    table: Table,
    stiffness: f64,
    /// Peak displacements on the curve, forwards and backwards \[m\].
    farthest: [f64; 2],
    displacement: f64,
    force: f64,
}

impl PlasticCurve {
    /// Undamaged, at zero force.
    #[must_use]
    pub fn new(table: Table) -> Self {
        let stiffness = table.initial_stiffness();
        let elastic_to = |direction: f64| direction * elastic_to(&table, stiffness, direction);
        let farthest = [elastic_to(1.0), elastic_to(-1.0)];
        Self {
            table,
            stiffness,
            farthest,
            displacement: 0.0,
            force: 0.0,
        }
    }
}

/// κ, weight of the difference to the elastic line against the force of the curve: a segment steeper than κ/(1 + κ) = 99 % of the
/// steepest one is still elastic, so that no force of the initial loading differs from its curve by more than 1 % of the strength.
const KAPPA: f64 = 100.0;

/// Displacement at which the curve first reaches its elastic strength F_e = max(g − κ (K x − g)) in one direction \[m\]. The maximum of
/// continuous functions is continuous: similar points have similar strengths.
fn elastic_to(table: &Table, stiffness: f64, direction: f64) -> f64 {
    let mut curve: Vec<[f64; 2]> = table
        .points
        .iter()
        .map(|[x, force]| [x * direction, table.scale * force * direction])
        .filter(|[x, _]| *x > 0.0)
        .collect();
    curve.sort_by(|one, other| one[0].total_cmp(&other[0]));
    // Between two points it is straight: it is greatest at a point.
    let elastic = |[x, force]: &[f64; 2]| force - KAPPA * (stiffness * x - force).max(0.0);
    let strength = curve.iter().map(elastic).fold(0.0, f64::max);
    let mut before = [0.0, 0.0];
    for point in curve {
        if strength > 0.0 && point[1] >= strength * (1.0 - 1e-12) {
            let share = ((strength - before[1]) / (point[1] - before[1])).min(1.0);
            return if share >= 1.0 - 1e-12 {
                point[0]
            } else {
                before[0] + share * (point[0] - before[0])
            };
        }
        before = point;
    }
    0.0
}

impl RestoringForce for PlasticCurve {
    fn move_to(&mut self, displacement: f64) -> f64 {
        let trial = self.force + self.stiffness * (displacement - self.displacement);
        let [ahead, behind] = &mut self.farthest;
        // A strength is reached no later than before, so that the curve applies beyond it.
        self.force = if displacement > *ahead {
            *ahead = displacement;
            self.table.force(displacement)
        } else if displacement < *behind {
            *behind = displacement;
            self.table.force(displacement)
        } else {
            trial
                .min(self.table.force(*ahead))
                .max(self.table.force(*behind))
        };
        self.displacement = displacement;
        self.force
    }

    fn initial_stiffness(&self) -> f64 {
        self.stiffness
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::energy_along;
    use super::*;

    fn table(points: &[[f64; 2]], unloading: Unloading) -> Table {
        Table {
            file: "points.csv".to_owned(),
            points: points.to_vec(),
            unloading,
            scale: 1.0,
        }
    }

    /// 1000 N/mm to 1 kN, 500 N/mm to 2 kN, then it falls by 250 N/mm.
    const POINTS: [[f64; 2]; 7] = [
        [-0.005, -1500.0],
        [-0.003, -2000.0],
        [-0.001, -1000.0],
        [0.0, 0.0],
        [0.001, 1000.0],
        [0.003, 2000.0],
        [0.005, 1500.0],
    ];

    #[test]
    fn loading_is_the_table_and_unloading_is_parallel_to_its_steepest_stretch() {
        let mut model = PlasticCurve::new(table(&POINTS, Unloading::InitialStiffness));
        assert!((model.initial_stiffness() - 1e6).abs() < 1e-6);
        let path = [
            (0.0005, 500.0),
            (0.0020, 1500.0),
            (0.0010, 500.0),
            (0.0020, 1500.0),
            (0.0040, 1750.0),
            (0.0030, 750.0),
            // In the opposite direction it yields at the initial yield point, and deforms plastically to the initial position.
            (0.0010, -1000.0),
            (-0.0010, -1000.0),
            (-0.0020, -1500.0),
            // Forwards again at the force reached before, and then along the curve.
            (0.0020, 1750.0),
            (0.0040, 1750.0),
            (0.0050, 1500.0),
            (0.0090, 1500.0),
        ];
        for (displacement, force) in path {
            let found = model.move_to(displacement);
            assert!(
                (found - force).abs() < 1e-9,
                "{displacement} m: {found} N is not {force} N"
            );
        }
    }

    /// To 3 mm and back to zero force: the area under the curve minus the triangle of unloading.
    #[test]
    fn energy_of_one_cycle_out_and_back() {
        let mut model = PlasticCurve::new(table(&POINTS, Unloading::InitialStiffness));
        let absorbed = energy_along(&mut model, 0.0, &[0.003, 0.001], 1e-7);
        assert!((absorbed - (0.5 + 3.0 - 2.0)).abs() < 1e-6, "{absorbed} J");
        let mut elastic = AlongTheCurve {
            table: table(&POINTS, Unloading::AlongTheCurve),
        };
        let back = energy_along(&mut elastic, 0.0, &[0.005, -0.004, 0.0], 1e-7);
        assert!(back.abs() < 1e-6, "{back} J of the 6 J it took");
    }

    #[test]
    fn the_loops_depend_continuously_on_the_points() {
        let energy = |at_1_mm: f64| {
            let points = [
                [-0.010, -3500.0],
                [-0.004, -3000.0],
                [-0.002, -2000.0],
                [-0.001, -at_1_mm],
                [0.0, 0.0],
            ];
            let other = [
                [0.001, at_1_mm],
                [0.002, 2000.0],
                [0.004, 3000.0],
                [0.010, 3500.0],
            ];
            let mut model = PlasticCurve::new(table(
                &[&points[..], &other[..]].concat(),
                Unloading::InitialStiffness,
            ));
            energy_along(&mut model, 0.0, &[0.008, -0.008, 0.0], 1e-6)
        };
        let straight = energy(1000.0);
        for off in [-10.0, -1.0, -0.01, 0.01, 1.0, 10.0] {
            let apart = (energy(1000.0 + off) / straight - 1.0).abs();
            assert!(
                apart < 0.05 * f64::abs(off),
                "{off} N: {apart} of {straight} J"
            );
        }
    }

    #[test]
    fn a_toe_is_slack_after_it_was_closed() {
        let points = [
            [-0.002, -1000.0],
            [-0.001, 0.0],
            [0.0, 0.0],
            [0.001, 0.0],
            [0.002, 1000.0],
        ];
        let mut model = PlasticCurve::new(table(&points, Unloading::InitialStiffness));
        assert_eq!(model.move_to(0.001), 0.0);
        assert!((model.move_to(0.0015) - 500.0).abs() < 1e-9);
        assert!(model.move_to(0.001).abs() < 1e-9);
        assert!(model.move_to(-0.001).abs() < 1e-9);
        assert!((model.move_to(-0.002) + 1000.0).abs() < 1e-9);
    }
}
