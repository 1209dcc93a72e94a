//! Mass that moves with a portal. The elastic mass is compared with finite elements with lumped masses as the mesh is refined. As a
//! Rayleigh quotient it is compared with their first frequency. The mechanisms are compared with rigid bodies that rotate, point by
//! point. Both are compared with published factors of beams. The finite elements and the rigid bodies share no code with the product.

use nalgebra::{DMatrix, DVector};
use psd_physics::structure::beam::EquivalentMasses;
use psd_physics::structure::portal::mass::equivalent_masses;
use psd_plan::{FrameMasses, Loads, Mechanism, Portal, Sections};

const SPAN: f64 = 4.0;
const HEIGHT: f64 = 3.0;
const STRONG: Sections = Sections::same(20e3);

/// A frame with different values of all properties.
#[derive(Clone, Copy)]
struct Given {
    bending: Sections,
    masses: FrameMasses,
    loads: Loads,
}

impl Given {
    fn portal(self) -> Portal {
        Portal::of_sections(SPAN, HEIGHT, STRONG, self.bending, self.loads)
            .with_masses(Some(self.masses))
    }

    fn reduced(self) -> EquivalentMasses {
        equivalent_masses(&self.portal()).expect("it says what it weighs")
    }

    /// W and H of a load of 1 N.
    fn shares(self) -> (f64, f64) {
        match self.loads {
            Loads::Beam => (1.0, 0.0),
            Loads::Sway => (0.0, 1.0),
            Loads::Combined {
                beam_load,
                sway_load,
            } => (
                beam_load / (beam_load + sway_load),
                sway_load / (beam_load + sway_load),
            ),
        }
    }
}

fn givens() -> Vec<Given> {
    let one = FrameMasses {
        per_length: Sections::same(12.0),
        midspan: 0.0,
        corner: 0.0,
    };
    let loaded = FrameMasses {
        per_length: Sections {
            beam: 9.0,
            column: 31.0,
        },
        midspan: 7.0,
        corner: 4.0,
    };
    let frames = [
        (Sections::same(1.6e6), one),
        (
            Sections {
                beam: 4.0e6,
                column: 1.6e6,
            },
            loaded,
        ),
        (
            Sections {
                beam: 0.3e6,
                column: 1.6e6,
            },
            FrameMasses {
                midspan: 0.0,
                ..loaded
            },
        ),
    ];
    let loads = [
        Loads::Sway,
        Loads::Beam,
        Loads::Combined {
            beam_load: 10e3,
            sway_load: 2.5e3,
        },
    ];
    frames
        .into_iter()
        .flat_map(|(bending, masses)| {
            loads.map(|loads| Given {
                bending,
                masses,
                loads,
            })
        })
        .collect()
}

/// A plane frame of almost inextensible Bernoulli beams, `n` to each column and each half of the beam. The nodes run from foot to corner,
/// midspan, corner and foot. The masses are lumped at the nodes. Each node has (x, y, turn).
struct Mesh {
    stiffness: DMatrix<f64>,
    /// Mass in the directions x and y.
    masses: DVector<f64>,
    n: usize,
}

impl Mesh {
    fn of(given: Given, n: usize) -> Self {
        let nodes = 4 * n + 1;
        let mut stiffness = DMatrix::<f64>::zeros(3 * nodes, 3 * nodes);
        let mut masses = DVector::<f64>::zeros(3 * nodes);
        #[expect(clippy::cast_precision_loss, reason = "a few dozen")]
        let parts = n as f64;
        for element in 0..4 * n {
            // Up, along, along, down: (cosine, sine) of the direction, and the section.
            let (cosine, sine, length, bending, per_length) = match element / n {
                0 => (
                    0.0,
                    1.0,
                    HEIGHT / parts,
                    given.bending.column,
                    given.masses.per_length.column,
                ),
                3 => (
                    0.0,
                    -1.0,
                    HEIGHT / parts,
                    given.bending.column,
                    given.masses.per_length.column,
                ),
                _ => (
                    1.0,
                    0.0,
                    SPAN / 2.0 / parts,
                    given.bending.beam,
                    given.masses.per_length.beam,
                ),
            };
            let (stretch, shear) = (1e7 * bending / length, 12.0 * bending / length.powi(3));
            let (couple, turn) = (6.0 * bending / length.powi(2), bending / length);
            #[rustfmt::skip]
            let local = DMatrix::from_row_slice(6, 6, &[
                stretch, 0.0, 0.0, -stretch, 0.0, 0.0,
                0.0, shear, couple, 0.0, -shear, couple,
                0.0, couple, 4.0 * turn, 0.0, -couple, 2.0 * turn,
                -stretch, 0.0, 0.0, stretch, 0.0, 0.0,
                0.0, -shear, -couple, 0.0, shear, -couple,
                0.0, couple, 2.0 * turn, 0.0, -couple, 4.0 * turn,
            ]);
            let mut turned = DMatrix::<f64>::zeros(6, 6);
            for end in [0, 3] {
                turned[(end, end)] = cosine;
                turned[(end, end + 1)] = sine;
                turned[(end + 1, end)] = -sine;
                turned[(end + 1, end + 1)] = cosine;
                turned[(end + 2, end + 2)] = 1.0;
            }
            let element_stiffness = turned.transpose() * local * turned;
            let mut view = stiffness.view_mut((3 * element, 3 * element), (6, 6));
            view += element_stiffness;
            for node in [element, element + 1] {
                for direction in [0, 1] {
                    masses[3 * node + direction] += per_length * length / 2.0;
                }
            }
        }
        let mesh_masses = [
            (n, given.masses.corner),
            (2 * n, given.masses.midspan),
            (3 * n, given.masses.corner),
        ];
        for (node, mass) in mesh_masses {
            masses[3 * node] += mass;
            masses[3 * node + 1] += mass;
        }
        // The feet are built in.
        for foot in [0, 4 * n] {
            for direction in 0..3 {
                let index = 3 * foot + direction;
                stiffness.fill_row(index, 0.0);
                stiffness.fill_column(index, 0.0);
                stiffness[(index, index)] = 1.0;
                masses[index] = 0.0;
            }
        }
        Self {
            stiffness,
            masses,
            n,
        }
    }

    /// Degrees of freedom loaded by H, at the near corner, and W, at midspan.
    fn load(&self, given: Given) -> DVector<f64> {
        let (on_beam, on_sway) = given.shares();
        let mut load = DVector::zeros(self.masses.len());
        load[3 * self.n] = on_sway;
        load[6 * self.n + 1] = -on_beam;
        load
    }

    /// Mass at the position of a load of 1 N that has the kinetic energy of the frame deflected by it.
    fn equivalent_mass(&self, given: Given) -> f64 {
        let load = self.load(given);
        let shape = self.stiffness.clone().lu().solve(&load).expect("it stands");
        let work = load.dot(&shape);
        self.energy(&shape) / (work * work)
    }

    fn energy(&self, shape: &DVector<f64>) -> f64 {
        shape
            .iter()
            .zip(self.masses.iter())
            .map(|(moved, mass)| mass * moved * moved)
            .sum()
    }

    /// ω² of the first mode with the symmetry of the load, by inverse iteration; rounding would add modes of the other symmetry.
    fn first_mode(&self, given: Given) -> f64 {
        let parts = self.stiffness.clone().lu();
        let kind = if matches!(given.loads, Loads::Beam) {
            1.0
        } else {
            -1.0
        };
        let solved =
            |load: &DVector<f64>| self.of_kind(kind, &parts.solve(load).expect("it stands"));
        let mut shape = solved(&self.load(given));
        for _ in 0..20 {
            let next = solved(&shape.component_mul(&self.masses));
            shape = &next / self.energy(&next).sqrt();
        }
        shape.dot(&(&self.stiffness * &shape)) / self.energy(&shape)
    }

    /// The symmetric (1) or antisymmetric (−1) part of a shape.
    fn of_kind(&self, kind: f64, shape: &DVector<f64>) -> DVector<f64> {
        let mirrored = |index: usize| {
            let (node, direction) = (4 * self.n - index / 3, index % 3);
            let sign = if direction == 1 { kind } else { -kind };
            sign * shape[3 * node + direction]
        };
        DVector::from_fn(shape.len(), |index, _| {
            0.5 * (shape[index] + mirrored(index))
        })
    }
}

/// Lumping has an error with the square of the length of an element. For a frame that only deflects it has the fourth power. Halving the
/// length leaves at most a quarter of the difference from the closed form.
#[test]
fn the_elastic_mass_is_that_of_finite_elements_as_they_grow_small() {
    for given in givens() {
        let found = given.reduced().elastic;
        let errors = [4, 8, 16].map(|n| Mesh::of(given, n).equivalent_mass(given) / found - 1.0);
        let case = format!("{:?}, EI {:?}: {errors:?}", given.loads, given.bending);
        assert!(
            errors
                .windows(2)
                .all(|pair| pair[0] / pair[1] > 3.8 || pair[1].abs() < 2e-7),
            "{case}"
        );
        // Extrapolated without the errors of second and of fourth order (Romberg).
        let [coarse, fine] = [0, 1].map(|at| (4.0 * errors[at + 1] - errors[at]) / 3.0);
        assert!(((16.0 * fine - coarse) / 15.0).abs() < 2e-6, "{case}");
    }
}

/// The static deflection is an assumed shape: Rayleigh's quotient K/M is above ω² of the first mode with its symmetry. It is near it if
/// that mode is the frame's. Slender columns with three times the mass per metre of the beam have a lower mode of their own.
#[test]
fn stiffness_over_elastic_mass_is_just_above_the_first_frequency() {
    for given in givens()
        .into_iter()
        .filter(|given| !matches!(given.loads, Loads::Combined { .. }))
    {
        let [coarse, fine] = [8, 16].map(|n| Mesh::of(given, n).first_mode(given));
        let exact = (4.0 * fine - coarse) / 3.0;
        let above = given.portal().stiffness / given.reduced().elastic / exact - 1.0;
        let own_mode = matches!(given.loads, Loads::Beam) && !given.masses.per_length.are_same();
        let case = format!("{:?}, EI {:?}: {above}", given.loads, given.bending);
        assert!(above > -1e-5 && (own_mode || above < 0.05), "{case}");
    }
}

/// Kinetic energy of rigid links that rotate with 1 rad/s, by a sum over points. It is divided by half the square of the velocity of the
/// load point.
fn of_turning_links(given: Given, mechanism: Mechanism) -> f64 {
    const POINTS: u32 = 4000;
    let (turns, deflects) = (mechanism != Mechanism::Beam, mechanism != Mechanism::Sway);
    let sideways = if turns { HEIGHT } else { 0.0 };
    let masses = given.masses;
    let mut energy = 0.0;
    for point in 0..POINTS {
        let along = (f64::from(point) + 0.5) / f64::from(POINTS);
        let column = if turns { along * HEIGHT } else { 0.0 };
        energy += 2.0 * masses.per_length.column * HEIGHT / f64::from(POINTS) * column * column;
        let from_corner = (along * SPAN).min(SPAN - along * SPAN);
        let down = if deflects { from_corner } else { 0.0 };
        energy +=
            masses.per_length.beam * SPAN / f64::from(POINTS) * (down * down + sideways * sideways);
    }
    let down = if deflects { SPAN / 2.0 } else { 0.0 };
    energy += masses.midspan * (down * down + sideways * sideways)
        + 2.0 * masses.corner * sideways * sideways;
    let (on_beam, on_sway) = given.shares();
    let velocity = on_beam * down + on_sway * sideways;
    energy / (velocity * velocity)
}

/// The mass of a mechanism is exact: beam `m_b L/3`, sway `m_b L + 2 m_c h/3`. Lumped masses count with their velocities. The combined
/// mechanism has both parts.
#[test]
fn the_plastic_mass_is_that_of_links_that_turn() {
    for given in givens() {
        let Sections { beam, column } = given.masses.per_length;
        let governs = given.portal().mechanism();
        let found = given.reduced().plastic.expect("a portal has a mechanism");
        let by_points = of_turning_links(given, governs);
        assert!(
            (found / by_points - 1.0).abs() < 1e-7,
            "{governs:?}: {found} kg is not {by_points} kg"
        );
        let FrameMasses {
            midspan, corner, ..
        } = given.masses;
        let by_hand = match governs {
            Mechanism::Beam if given.shares().1 == 0.0 => beam * SPAN / 3.0 + midspan,
            Mechanism::Sway => beam * SPAN + 2.0 * column * HEIGHT / 3.0 + midspan + 2.0 * corner,
            _ => continue,
        };
        assert!(
            (found / by_hand - 1.0).abs() < 1e-12,
            "{governs:?}: {found} kg is not {by_hand} kg"
        );
    }
    // H·h between half and twice W·L/2: both mechanisms form.
    let both = Given {
        loads: Loads::Combined {
            beam_load: 10e3,
            sway_load: 10e3,
        },
        ..givens()[4]
    };
    assert_eq!(both.portal().mechanism(), Mechanism::Combined);
    let (found, by_points) = (
        both.reduced().plastic.unwrap_or_default(),
        of_turning_links(both, Mechanism::Combined),
    );
    assert!(
        (found / by_points - 1.0).abs() < 1e-7,
        "{found} kg is not {by_points} kg"
    );
}

/// A beam between columns that do not restrain its ends is simply supported. A point force on a distributed mass then has `K_M` = 0.49
/// while elastic and 0.33 when plastic, in full 17/35 and 1/3. Source: Biggs's factors, as tabulated at ingeania.com, SDOF Transformation
/// Factors, 3rd row. Between stout columns it is built in: 13/35. A swaying column without restraint of its head is a cantilever: 33/140.
#[test]
fn frames_that_are_beams_have_the_factors_of_beams() {
    let light = FrameMasses {
        per_length: Sections {
            beam: 10.0,
            column: 1e-9,
        },
        midspan: 0.0,
        corner: 0.0,
    };
    let beam = |column: f64| {
        let given = Given {
            bending: Sections { beam: 1e6, column },
            masses: light,
            loads: Loads::Beam,
        };
        let masses = given.reduced();
        [
            masses.elastic,
            masses.plastic.unwrap_or_default(),
            masses.lumped,
        ]
        .map(|mass| mass / (10.0 * SPAN))
    };
    let near = |found: f64, factor: f64| {
        assert!(
            (found / factor - 1.0).abs() < 1e-5,
            "{found} is not {factor}"
        );
    };
    let [elastic, plastic, lumped] = beam(1.0);
    assert_eq!(
        (format!("{elastic:.2}"), format!("{plastic:.2}")),
        ("0.49".to_owned(), "0.33".to_owned())
    );
    near(elastic, 17.0 / 35.0);
    near(plastic, 1.0 / 3.0);
    near(lumped, 0.5);
    near(beam(1e12)[0], 13.0 / 35.0);
    let heavy = FrameMasses {
        per_length: Sections {
            beam: 1e-9,
            column: 10.0,
        },
        midspan: 0.0,
        corner: 0.0,
    };
    let sway = |beam: f64| {
        let given = Given {
            bending: Sections { beam, column: 1e6 },
            masses: heavy,
            loads: Loads::Sway,
        };
        given.reduced().elastic / (2.0 * 10.0 * HEIGHT)
    };
    near(sway(1.0), 33.0 / 140.0);
    near(sway(1e12), 13.0 / 35.0);
}

/// Fig. 5 of the paper: a frame pushed sideways has the mass of its beam and of one column. A frame hit at midspan has half that of its
/// beam.
#[test]
fn lumped_masses_are_those_of_fig_5() {
    let masses = FrameMasses {
        per_length: Sections {
            beam: 9.0,
            column: 31.0,
        },
        midspan: 0.0,
        corner: 0.0,
    };
    let of = |loads| {
        Given {
            bending: Sections::same(1e6),
            masses,
            loads,
        }
        .reduced()
    };
    assert!((of(Loads::Sway).lumped - (9.0 * SPAN + 31.0 * HEIGHT)).abs() < 1e-10);
    assert!((of(Loads::Beam).lumped - 9.0 * SPAN / 2.0).abs() < 1e-10);
    assert!((of(Loads::Beam).whole - (9.0 * SPAN + 2.0 * 31.0 * HEIGHT)).abs() < 1e-10);
}

/// A frame whose stiffness was measured has one section throughout, and the corresponding deflected shape.
#[test]
fn a_stated_stiffness_has_the_shape_of_one_section() {
    for loads in [
        Loads::Sway,
        Loads::Beam,
        Loads::Combined {
            beam_load: 1.0,
            sway_load: 2.0,
        },
    ] {
        let masses = FrameMasses {
            per_length: Sections::same(12.0),
            midspan: 3.0,
            corner: 1.0,
        };
        let known = Given {
            bending: Sections::same(7e6),
            masses,
            loads,
        }
        .portal();
        let measured = Portal {
            bending_stiffness: None,
            stiffness: 1.0,
            ..known
        };
        let [known, measured] = [known, measured]
            .map(|portal| equivalent_masses(&portal).map_or(0.0, |masses| masses.elastic));
        assert!(
            (measured / known - 1.0).abs() < 1e-12,
            "{measured} kg is not {known} kg"
        );
    }
}
