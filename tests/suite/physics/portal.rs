//! Portals with plastic hinges. Each mechanism is compared with its closed form on both sides of every switch. A second test takes the
//! minimum over all statically admissible states (the lower bound theorem, by enumeration). A third test analyses a frame hinge by hinge.
//! The last two share no code with the product.

use nalgebra::{DMatrix, DVector};
use psd_plan::{Loads, Mechanism, Portal, Sections};

const SPAN: f64 = 4.0;
const HEIGHT: f64 = 3.0;
const MOMENT: f64 = 20e3;
const BENDING: f64 = 1.6e6;

fn portal(loads: Loads) -> Portal {
    Portal::of_sections(
        SPAN,
        HEIGHT,
        Sections::same(MOMENT),
        Sections::same(BENDING),
        loads,
    )
}

fn combined(beam_load: f64, sway_load: f64) -> Portal {
    portal(Loads::Combined {
        beam_load,
        sway_load,
    })
}

/// Beam 8Mp/L, sway 4Mp/h; combined λ(W₀L/2 + H₀h) = 6Mp.
#[test]
fn collapse_loads_in_closed_form() {
    let near = |found: f64, by_hand: f64| {
        assert!(
            (found / by_hand - 1.0).abs() < 1e-12,
            "{found} N is not {by_hand} N"
        );
    };
    near(portal(Loads::Beam).capacity(), 8.0 * MOMENT / SPAN);
    near(portal(Loads::Sway).capacity(), 4.0 * MOMENT / HEIGHT);
    assert_eq!(portal(Loads::Beam).mechanism(), Mechanism::Beam);
    assert_eq!(portal(Loads::Sway).mechanism(), Mechanism::Sway);
    assert!(
        portal(Loads::Sway)
            .collapse_load(Mechanism::Beam)
            .is_infinite()
    );
    assert!(
        portal(Loads::Beam)
            .collapse_load(Mechanism::Sway)
            .is_infinite()
    );
    let frame = combined(10e3, 10e3);
    near(
        frame.capacity() / 20e3,
        6.0 * MOMENT / (10e3 * SPAN / 2.0 + 10e3 * HEIGHT),
    );
    assert_eq!(frame.mechanism(), Mechanism::Combined);
}

/// Beam and combined mechanisms form together at W₀L/2 = 2H₀h, sway and combined at H₀h = 2·W₀L/2. The reasons: 4/(H h) = 6/(WL/2 + Hh)
/// if WL/2 = Hh/2, and 4/(WL/2) = 6/(WL/2 + Hh) if Hh = WL/4.
#[test]
fn the_mechanism_changes_where_two_loads_are_equal() {
    let beam_load = 10e3;
    let work = beam_load * SPAN / 2.0;
    for (switch, below, above) in [
        (0.5 * work / HEIGHT, Mechanism::Beam, Mechanism::Combined),
        (2.0 * work / HEIGHT, Mechanism::Combined, Mechanism::Sway),
    ] {
        let (under, over) = (
            combined(beam_load, switch * 0.999),
            combined(beam_load, switch * 1.001),
        );
        assert_eq!((under.mechanism(), over.mechanism()), (below, above));
        let at = combined(beam_load, switch);
        assert!((at.collapse_load(below) / at.collapse_load(above) - 1.0).abs() < 1e-12);
    }
}

/// Plastic moment at feet A, E, corners B, D and midspan C: a corner yields in the weaker of both.
fn strengths(sections: Sections) -> [f64; 5] {
    let corner = if sections.beam < sections.column {
        sections.beam
    } else {
        sections.column
    };
    [
        sections.column,
        corner,
        sections.beam,
        corner,
        sections.column,
    ]
}

/// With `M_b` and `M_c`, and m the smaller one: beam W·L/2 = 2(m + M_b), sway H·h = 2(M_c + m). Combined: W·L/2 + H·h = 2(M_c + M_b + m).
/// Beam and combined thus form together at `H·h = W·L/2 · M_c/(m + M_b)`. Both loads of a pair are compared on either side of their switch,
/// for stout columns and for weak ones.
#[test]
fn different_sections_in_closed_form_on_both_sides_of_each_switch() {
    let beam_load = 10e3;
    let work = beam_load * SPAN / 2.0;
    for (beam, column) in [(20e3, 34e3), (20e3, 12e3)] {
        let corner = f64::min(beam, column);
        let moment = Sections { beam, column };
        let frame = |sway_load| {
            Portal::of_sections(
                SPAN,
                HEIGHT,
                moment,
                Sections::same(BENDING),
                Loads::Combined {
                    beam_load,
                    sway_load,
                },
            )
        };
        // First pair: (m + M_b)/w = (M_c + M_b + m)/(w + s), s = w·M_c/(m + M_b).
        // Second pair: (M_c + m)/s = (M_c + M_b + m)/(w + s), s = w (M_c + m)/M_b.
        let switches = [
            (
                work * column / (corner + beam) / HEIGHT,
                Mechanism::Beam,
                Mechanism::Combined,
            ),
            (
                work * (column + corner) / beam / HEIGHT,
                Mechanism::Combined,
                Mechanism::Sway,
            ),
        ];
        for (switch, below, above) in switches {
            assert_eq!(
                (
                    frame(switch * 0.999).mechanism(),
                    frame(switch * 1.001).mechanism()
                ),
                (below, above),
                "{beam}, {column}"
            );
            let by_hand = |mechanism, sway_load: f64| {
                let (on_beam, on_sway) = (work, sway_load * HEIGHT);
                let factor = match mechanism {
                    Mechanism::Beam => 2.0 * (corner + beam) / on_beam,
                    Mechanism::Sway => 2.0 * (column + corner) / on_sway,
                    Mechanism::Combined => 2.0 * (column + beam + corner) / (on_beam + on_sway),
                };
                factor * (beam_load + sway_load)
            };
            for (sway_load, mechanism) in [(switch * 0.999, below), (switch * 1.001, above)] {
                let (found, by_hand) = (frame(sway_load).capacity(), by_hand(mechanism, sway_load));
                assert!(
                    (found / by_hand - 1.0).abs() < 1e-12,
                    "{mechanism:?}: {found} N is not {by_hand} N"
                );
            }
        }
    }
}

/// Largest λ with |M| ≤ Mp at feet A, E, corners B, D and midspan C, and equilibrium. Beam: −M_B + 2M_C − M_D = W₀L/2·λ; sway: −M_A + M_B
/// − M_D + M_E = H₀h·λ. A vertex has four of the moments at ±Mp: all are tried.
fn by_lower_bound(sections: Sections, beam_load: f64, sway_load: f64) -> f64 {
    let strong = strengths(sections);
    let beam = [0.0, -1.0, 2.0, -1.0, 0.0];
    let sway = [-1.0, 1.0, 0.0, -1.0, 1.0];
    let works = [beam_load * SPAN / 2.0, sway_load * HEIGHT];
    let mut best: f64 = 0.0;
    for free in 0..5 {
        for signs in 0..16_u32 {
            let mut moments = [0.0; 5];
            for (bit, section) in (0..5).filter(|section| *section != free).enumerate() {
                moments[section] = if signs >> bit & 1 == 1 {
                    strong[section]
                } else {
                    -strong[section]
                };
            }
            let known = |row: [f64; 5]| {
                row.iter()
                    .zip(moments)
                    .map(|(factor, moment)| factor * moment)
                    .sum::<f64>()
            };
            // row·M_free − work·λ = −known, two equations.
            let determinant = beam[free] * -works[1] + works[0] * sway[free];
            if determinant.abs() < 1e-9 {
                continue;
            }
            let moment = (known(beam) * works[1] - works[0] * known(sway)) / determinant;
            let load = (beam[free] * -known(sway) + known(beam) * sway[free]) / determinant;
            if moment.abs() <= strong[free] * (1.0 + 1e-12) {
                best = best.max(load);
            }
        }
    }
    best
}

/// A plane frame of A (foot), B (corner), C (midspan), D (corner), E (foot). It has four almost inextensible members, with a hinge at
/// every section whose moment reached Mp.
struct Frame {
    /// Hinged end of each member: near, far.
    hinged: [[bool; 2]; 4],
    bending: Sections,
}

/// Members as near node, far node, along x or y, length.
const MEMBERS: [(usize, usize, bool, f64); 4] = [
    (0, 1, false, HEIGHT),
    (1, 2, true, SPAN / 2.0),
    (2, 3, true, SPAN / 2.0),
    (4, 3, false, HEIGHT),
];
/// Member and end that represent each section A to E.
const SECTIONS: [(usize, usize); 5] = [(0, 0), (0, 1), (1, 1), (2, 1), (3, 0)];
/// EA over EI: axial strain is negligible.
const STRETCH: f64 = 1e7;

impl Frame {
    /// Stiffness of a member in the plane: (along, across, turn) at near and far end, released by condensation.
    fn member(&self, index: usize) -> DMatrix<f64> {
        let (_, _, level, length) = MEMBERS[index];
        let bending = if level {
            self.bending.beam
        } else {
            self.bending.column
        };
        let (shear, couple, turn) = (
            12.0 * bending / length.powi(3),
            6.0 * bending / length.powi(2),
            bending / length,
        );
        let axial = STRETCH * BENDING / length;
        #[rustfmt::skip]
        let mut local = DMatrix::from_row_slice(6, 6, &[
            axial, 0.0, 0.0, -axial, 0.0, 0.0,
            0.0, shear, couple, 0.0, -shear, couple,
            0.0, couple, 4.0 * turn, 0.0, -couple, 2.0 * turn,
            -axial, 0.0, 0.0, axial, 0.0, 0.0,
            0.0, -shear, -couple, 0.0, shear, -couple,
            0.0, couple, 2.0 * turn, 0.0, -couple, 4.0 * turn,
        ]);
        for (end, direction) in [(0, 2), (1, 5)] {
            if self.hinged[index][end] {
                let column = local.column(direction).clone_owned();
                let pivot = column[direction];
                if pivot.abs() > 1e-9 * turn {
                    local -= &column * column.transpose() / pivot;
                }
            }
        }
        local
    }

    /// Displacements (x, y, turn of each node) and moments of the sections under W at C and H at B.
    fn solve(&self, beam_load: f64, sway_load: f64) -> Option<(DVector<f64>, [f64; 5])> {
        let mut whole = DMatrix::<f64>::zeros(15, 15);
        let degrees_of = |index: usize| {
            let (near, far, level, _) = MEMBERS[index];
            // Local (along, across) in global (x, y): a beam (x, y), a column (y, −x).
            let of = |node: usize| {
                if level {
                    [(3 * node, 1.0), (3 * node + 1, 1.0)]
                } else {
                    [(3 * node + 1, 1.0), (3 * node, -1.0)]
                }
            };
            let [a, b] = of(near);
            let [c, d] = of(far);
            [a, b, (3 * near + 2, 1.0), c, d, (3 * far + 2, 1.0)]
        };
        for index in 0..4 {
            let (local, degrees) = (self.member(index), degrees_of(index));
            for (row, (global_row, row_sign)) in degrees.iter().enumerate() {
                for (column, (global_column, column_sign)) in degrees.iter().enumerate() {
                    whole[(*global_row, *global_column)] +=
                        row_sign * column_sign * local[(row, column)];
                }
            }
        }
        let free: Vec<usize> = (3..12).collect();
        let mut loads = DVector::<f64>::zeros(9);
        loads[0] = sway_load;
        loads[4] = -beam_load;
        let reduced = DMatrix::from_fn(9, 9, |row, column| whole[(free[row], free[column])]);
        // A node with hinges on all members rotates freely: it is fixed, because it carries no moment.
        let reduced = DMatrix::from_fn(9, 9, |row, column| {
            reduced[(row, column)]
                + if row == column && reduced[(row, row)].abs() < 1e-3 {
                    1.0
                } else {
                    0.0
                }
        });
        let found = reduced.lu().solve(&loads)?;
        let mut all = DVector::<f64>::zeros(15);
        free.iter()
            .enumerate()
            .for_each(|(index, global)| all[*global] = found[index]);
        let moments = SECTIONS.map(|(member, end)| {
            let moved = DVector::from_iterator(
                6,
                degrees_of(member)
                    .iter()
                    .map(|(global, sign)| sign * all[*global]),
            );
            (self.member(member) * moved)[if end == 0 { 2 } else { 5 }]
        });
        Some((all, moments))
    }
}

/// Load factor at which the frame becomes a mechanism, one hinge after the other; and W·δ + H·Δ of the elastic frame.
fn hinge_by_hinge(
    moment: Sections,
    bending: Sections,
    beam_load: f64,
    sway_load: f64,
) -> (f64, f64) {
    let strong = strengths(moment);
    let mut frame = Frame {
        hinged: [[false; 2]; 4],
        bending,
    };
    let (mut factor, mut moments) = (0.0, [0.0; 5]);
    let mut elastic: Option<f64> = None;
    loop {
        let Some((moved, gained)) = frame.solve(beam_load, sway_load) else {
            return (factor, elastic.unwrap_or(0.0));
        };
        let work = sway_load * moved[3] - beam_load * moved[7];
        let first = *elastic.get_or_insert(work);
        if work.abs() > 1e4 * first {
            return (factor, first);
        }
        let room = |section: usize| {
            let (member, end) = SECTIONS[section];
            let rate: f64 = gained[section];
            if frame.hinged[member][end] || rate.abs() < 1e-9 {
                return f64::INFINITY;
            }
            (strong[section] * rate.signum() - moments[section]) / rate
        };
        let next = (0..5)
            .min_by(|a, b| room(*a).total_cmp(&room(*b)))
            .expect("five sections");
        let step = room(next);
        factor += step;
        for (moment, rate) in moments.iter_mut().zip(gained) {
            *moment += step * rate;
        }
        let (member, end) = SECTIONS[next];
        frame.hinged[member][end] = true;
    }
}

/// From nearly no sway to nearly no beam load, through both switches.
#[test]
fn two_other_methods_find_the_same_collapse_and_the_same_stiffness() {
    let (one, other) = (Sections::same(MOMENT), Sections::same(BENDING));
    let stout_columns = Sections {
        beam: MOMENT,
        column: 1.7 * MOMENT,
    };
    let weak_columns = Sections {
        beam: MOMENT,
        column: 0.6 * MOMENT,
    };
    let stiff_beam = Sections {
        beam: 2.5 * BENDING,
        column: BENDING,
    };
    let soft_beam = Sections {
        beam: 0.4 * BENDING,
        column: BENDING,
    };
    let frames = [
        (one, other),
        (stout_columns, soft_beam),
        (weak_columns, stiff_beam),
        (weak_columns, other),
    ];
    let shares = [
        0.02, 0.1, 0.2, 0.24, 0.26, 0.3, 0.4, 0.5, 0.55, 0.57, 0.6, 0.75, 0.9, 0.99,
    ];
    for ((moment, bending), share) in frames
        .into_iter()
        .flat_map(|frame| shares.map(|share| (frame, share)))
    {
        let (beam_load, sway_load) = (10e3 * (1.0 - share), 10e3 * share);
        let frame = Portal::of_sections(
            SPAN,
            HEIGHT,
            moment,
            bending,
            Loads::Combined {
                beam_load,
                sway_load,
            },
        );
        let lower = by_lower_bound(moment, beam_load, sway_load);
        let (hinges, work) = hinge_by_hinge(moment, bending, beam_load, sway_load);
        let factor = frame.capacity() / 10e3;
        assert!(
            (lower / factor - 1.0).abs() < 1e-9,
            "share {share}: {lower} by the lower bound, {factor}"
        );
        assert!(
            (hinges / factor - 1.0).abs() < 1e-6,
            "share {share}: {hinges} hinge by hinge, {factor}"
        );
        // P = W + H, X = (W δ + H Δ)/P, so that K = P²/(W δ + H Δ).
        let stiffness = 1e8 / work;
        assert!(
            (frame.stiffness / stiffness - 1.0).abs() < 1e-5,
            "share {share}: {} N/m is not {stiffness} N/m",
            frame.stiffness
        );
    }
}

/// A stiff beam fixes the heads of the columns: 24EI/h³. A slender one leaves two cantilevers: 6EI/h³. A beam between stout columns is
/// built in, between slender ones simply supported: 192 and 48 EI/L³.
#[test]
fn slope_deflection_has_its_limits() {
    let (moment, bending) = (Sections::same(MOMENT), Sections::same(BENDING));
    let sway = |span| {
        Portal::of_sections(span, 3.0, moment, bending, Loads::Sway).stiffness * 27.0 / BENDING
    };
    assert!((sway(1e-6) - 24.0).abs() < 1e-4 && (sway(1e7) - 6.0).abs() < 1e-4);
    let beam = |height| {
        Portal::of_sections(4.0, height, moment, bending, Loads::Beam).stiffness * 64.0 / BENDING
    };
    assert!((beam(1e-6) - 192.0).abs() < 1e-3 && (beam(1e8) - 48.0).abs() < 1e-4);
}
