//! The load up to which the mechanism of a portal is valid. It is compared with the closed form of single mechanisms, and with the
//! moments along the members. These are summed here from the inertia point by point. The sums share no code with the product.

use psd_physics::structure::portal::limit::mechanism_limit;
use psd_plan::{FrameMasses, Loads, Portal, Sections};

const SPAN: f64 = 4.0;
const HEIGHT: f64 = 3.0;

fn portal(strong: Sections, masses: FrameMasses, loads: Loads) -> Portal {
    Portal::of_sections(SPAN, HEIGHT, strong, Sections::same(1.6e6), loads)
        .with_masses(Some(masses))
}

fn limit(portal: &Portal) -> f64 {
    mechanism_limit(portal).expect("it is under one load and says what it weighs")
}

const BARE: FrameMasses = FrameMasses {
    per_length: Sections::same(12.0),
    midspan: 0.0,
    corner: 0.0,
};

/// One section without supported mass: three times the collapse load at midspan. Sideways it is three times that load and 12 Mp L/h² of
/// the beam's inertia.
#[test]
fn a_bare_frame_follows_three_times_its_collapse_load() {
    let strong = Sections::same(20e3);
    let struck = portal(strong, BARE, Loads::Beam);
    assert!((limit(&struck) / (3.0 * struck.capacity()) - 1.0).abs() < 1e-12);
    let swayed = portal(strong, BARE, Loads::Sway);
    let by_hand = 3.0 * swayed.capacity() + 12.0 * 20e3 * SPAN / (HEIGHT * HEIGHT);
    assert!((limit(&swayed) / by_hand - 1.0).abs() < 1e-12);
}

/// Without mass between the hinges, as in the paper's lumped frame, there is no limit. The same applies to two loads, and to a frame
/// without masses.
#[test]
fn lumped_frames_follow_any_load() {
    let strong = Sections::same(20e3);
    let lumped = FrameMasses {
        per_length: Sections::same(0.0),
        midspan: 20.0,
        corner: 10.0,
    };
    for loads in [Loads::Sway, Loads::Beam] {
        assert!(limit(&portal(strong, lumped, loads)).is_infinite());
    }
    let both = Loads::Combined {
        beam_load: 1.0,
        sway_load: 1.0,
    };
    assert_eq!(mechanism_limit(&portal(strong, BARE, both)), None);
    assert_eq!(
        mechanism_limit(&portal(strong, BARE, Loads::Beam).with_masses(None)),
        None
    );
}

/// Largest moment over the section capacity, between the hinges of the member that rotates under `load` \[N\], by sums over points. The
/// acceleration follows from the energies, then the moments from the inertia beyond each point.
fn worst(frame: &Portal, load: f64) -> f64 {
    const POINTS: usize = 4000;
    let masses = frame.masses.expect("it says what it weighs");
    let corner = frame.plastic_moment.beam.min(frame.plastic_moment.column);
    let sways = frame.loads == Loads::Sway;
    // The member that rotates: its length, mass per metre, moments at its pivot and at its end, and the other mass that moves with that
    // end.
    let (length, per_length, pivot, end, strong, carried) = if sways {
        let level = masses.per_length.beam * SPAN + masses.midspan + 2.0 * masses.corner;
        (
            HEIGHT,
            masses.per_length.column,
            frame.plastic_moment.column,
            corner,
            frame.plastic_moment.column,
            level / 2.0,
        )
    } else {
        let beam = frame.plastic_moment.beam;
        (
            SPAN / 2.0,
            masses.per_length.beam,
            corner,
            beam,
            beam,
            masses.midspan / 2.0,
        )
    };
    #[expect(clippy::cast_precision_loss, reason = "a few thousand")]
    let step = length / POINTS as f64;
    #[expect(clippy::cast_precision_loss, reason = "a few thousand")]
    let at = |point: usize| (point as f64 + 0.5) * step;
    let inertia = (0..POINTS)
        .map(|point| per_length * step * at(point) * at(point))
        .sum::<f64>()
        + carried * length * length;
    // Two such members share the load and rotate equally.
    let acceleration = (load / 2.0 * length - pivot - end) / inertia;
    // Force across the end of the member, minus the force carried there.
    let across = load / 2.0 - carried * length * acceleration;
    let mut worst: f64 = 0.0;
    for index in 0..POINTS {
        let here = at(index);
        let beyond = (index + 1..POINTS)
            .map(|point| per_length * step * at(point) * acceleration * (at(point) - here))
            .sum::<f64>();
        let moment = end - across * (length - here) + beyond;
        worst = worst.max(moment.abs() / strong);
    }
    worst
}

/// Just below the limit no section is overloaded, just above it one is: for stout columns and for weak ones, with lumped masses and
/// without.
#[test]
fn the_moments_along_the_members_agree() {
    let lumps = FrameMasses {
        per_length: Sections {
            beam: 9.0,
            column: 31.0,
        },
        midspan: 7.0,
        corner: 4.0,
    };
    for (beam, column) in [(20e3, 20e3), (20e3, 34e3), (20e3, 12e3)] {
        for masses in [BARE, lumps] {
            for loads in [Loads::Sway, Loads::Beam] {
                let frame = portal(Sections { beam, column }, masses, loads);
                let limit = limit(&frame);
                assert!(limit > frame.capacity());
                let (below, above) = (worst(&frame, 0.97 * limit), worst(&frame, 1.03 * limit));
                assert!(
                    below <= 1.0 + 1e-6 && above > 1.0 + 1e-6,
                    "{loads:?}, {beam} and {column}: {below}, {above}"
                );
            }
        }
    }
}
