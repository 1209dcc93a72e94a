//! The description of a virtual specimen: one text per restoring-force model, with its parameters. In: a model, and a function that
//! prints a number. Out: labelled strings, for the report and for `psd check --explain`.

use crate::report::number::percent;
use psd_physics::structure::assemblies::{Assemblies, on_the_rig};
use psd_physics::structure::beam::EquivalentMasses;
use psd_physics::structure::beam::first_mode_mass_factor;
use psd_physics::structure::portal::limit::mechanism_limit;
use psd_physics::structure::portal::mass::equivalent_masses;
use psd_plan::scaled::{at_scale, members, numbers_on_the_rig};
use psd_plan::schema::behaviours;
use psd_plan::{
    AxialAxis, Beam, Behaviour, Breaks, Deterioration, Ends, Frame, FrameMasses, Interval, Loads,
    Mechanism, Part, Pinching, Plan, Portal, Scale, Sections, Unloading,
};
use psd_text::suggest::with_article;
use psd_text::units::Dimension;
use psd_text::units::display::{significant, stated};

/// Prints a stated number, or one that follows from stated numbers.
pub type Printed<'s> = &'s dyn Fn(f64, Dimension) -> String;

/// The rows of a restoring-force model: its name and parameters, then derived values.
#[must_use]
pub fn rows(behaviour: &Behaviour, shown: Printed<'_>) -> Vec<(&'static str, String)> {
    let mut rows = vec![("virtual behaviour", words(behaviour, shown))];
    derived(behaviour, shown, &mut rows);
    if !behaviour.parts().is_empty()
        || matches!(
            behaviour,
            Behaviour::Table(_) | Behaviour::Multilinear { .. }
        )
    {
        rows.push((
            "initial stiffness",
            shown(behaviour.initial_stiffness(), Dimension::STIFFNESS),
        ));
    }
    if behaviour.capacity().is_finite() && !matches!(behaviour, Behaviour::Portal(_)) {
        rows.push((
            "largest force",
            shown(behaviour.capacity(), Dimension::FORCE),
        ));
    }
    rows
}

/// The storeys that are tested, and those that are computed. None if the whole frame is one specimen on the rig at full scale.
#[must_use]
pub fn substructures(frame: &Frame) -> Option<String> {
    let assemblies = Assemblies::of(frame)?;
    let specimens = assemblies.specimens();
    let scales: Vec<Scale> = frame.members().map(|member| member.part.scale()).collect();
    let scale = |specimen: &[usize]| at_scale(&scales[specimen[0]]);
    let storeys = |of: &[usize]| members(frame, of);
    let tested = match &specimens[..] {
        [] => "nothing is tested".to_owned(),
        [one] => format!("{} tested{}", storeys(one), scale(one)),
        several => {
            let several: Vec<String> = several
                .iter()
                .map(|one| storeys(one) + &scale(one))
                .collect();
            format!("{} tested, each a specimen", several.join(" / "))
        }
    };
    let computed = assemblies.computed();
    let matrix = frame
        .has_elements()
        .then(|| "the stiffness matrix".to_owned());
    let computed = (!computed.is_empty()).then(|| storeys(&computed));
    let computed: Vec<String> = matrix.into_iter().chain(computed).collect();
    Some(if computed.is_empty() {
        tested
    } else {
        format!("{tested}; {} computed", computed.join(" and "))
    })
}

/// A storey of a drawing.
pub struct DrawnStorey {
    /// From 1.
    pub number: usize,
    /// The axis that moves its floor, from 1; None for a computed storey.
    pub axis: Option<usize>,
    /// `tested at scale 0.5, on the strong floor`, or `computed`.
    pub part: String,
    /// `600 kN/m`; of a specimen with another stiffness on the rig also that one.
    pub stiffness: String,
}

/// The storeys of a frame of which a part is computed, or a specimen has a scale, from the ground up; or its elements.
#[must_use]
pub fn drawn_storeys(frame: &Frame) -> Vec<DrawnStorey> {
    let stiffness = |value| stated(value, Dimension::STIFFNESS);
    let mut tested = on_the_rig(frame).zip(1..);
    let storeys = frame.members().zip(1..);
    let drawn = storeys.map(|(storey, number)| {
        let own = stiffness(storey.stiffness);
        let Part::Tested { scale, .. } = storey.part else {
            return DrawnStorey {
                number,
                axis: None,
                part: "computed".to_owned(),
                stiffness: own,
            };
        };
        let axis = tested.next();
        let stands = axis.as_ref().is_some_and(|((_, stands), _)| *stands);
        let base = if stands { ", on the strong floor" } else { "" };
        let loaded = frame.storeys.get(number - 1);
        let load = if loaded.is_some_and(|storey| storey.axial_load != 0.0) {
            ", under an axial load"
        } else {
            ""
        };
        let on_the_rig = stiffness(scale.stiffness_on_the_rig(storey.stiffness));
        DrawnStorey {
            number,
            axis: axis.map(|(_, axis)| axis),
            part: format!("tested{}{base}{load}", at_scale(&scale)),
            stiffness: if on_the_rig == own {
                own
            } else {
                format!("{own}; {on_the_rig} on the rig")
            },
        }
    });
    drawn.collect()
}

/// P/(K h) of each storey, from the ground up; None without weights on the floors.
#[must_use]
pub fn weights(frame: &Frame) -> Option<String> {
    let loads = frame.axial_loads().into_iter().zip(&frame.storeys);
    let coefficients: Vec<String> = loads
        .map(|(load, storey)| {
            let height = storey.height.unwrap_or(f64::INFINITY);
            percent(load / (storey.stiffness * height))
        })
        .collect();
    (!coefficients.is_empty())
        .then(|| format!("P/(K h) = {} from the ground up", coefficients.join(", ")))
}

/// `measured storey shear`; of a frame of which a part is computed `storey shear (storey 1 tested; storeys 2, 3 computed)`.
#[must_use]
pub fn measured(what: &str, frame: Option<&Frame>) -> String {
    match frame.and_then(substructures) {
        None => format!("measured {what}"),
        Some(parts) => format!("{what} ({parts})"),
    }
}

/// The assumptions of a test of which a part is computed, or a specimen has a scale.
#[must_use]
pub fn assumed(frame: &Frame) -> String {
    let has = |is: fn(&Part) -> bool| frame.members().any(|member| is(&member.part));
    let word = frame.word_for_a_member();
    let interface = if frame.has_elements() {
        "An element transmits one force alone: no rotation and no moment is imposed on a specimen. The stiffness matrix is computed: it is stated and was not measured."
    } else {
        "The substructures transmit shear alone: no rotation and no moment is imposed on a specimen."
    };
    let assumed = [
        (true, interface.to_owned()),
        (
            has(|part| *part == Part::Computed),
            format!("The models of computed {word}s are stated and were not measured."),
        ),
        (
            has(|part| part.scale().force != 1.0),
            format!(
                "A specimen at a scale behaves as its {word}: forces and displacements differ by the stated factors alone."
            ),
        ),
        (
            has(|part| part.scale().represents > 1.0),
            format!(
                "The equal parts of {} behave alike: one of them is on the rig.",
                with_article(word)
            ),
        ),
        (frame.has_axial_load(), AXIAL_LOAD_IN_THE_READING.to_owned()),
    ];
    let sentences = assumed.into_iter().filter(|(holds, _)| *holds);
    let sentences: Vec<String> = sentences.map(|(_, sentence)| sentence).collect();
    sentences.join(" ")
}

const AXIAL_LOAD_IN_THE_READING: &str = "The share of the P-Δ of an axial load that is in the lateral reading is stated and was not measured.";

/// An axial axis of the rig: the load that it holds, how, and the share of its P-Δ in the lateral reading.
#[must_use]
pub fn axial_axis(plan: &Plan, axis: &AxialAxis, band: Interval, shown: Printed<'_>) -> String {
    let loads = plan.procedures.iter();
    let mut loads = loads.filter_map(|procedure| procedure.kind.axial_load());
    let load = loads.find(|(storey, _)| *storey == axis.storey);
    let load = load.map_or_else(String::new, |(_, load)| {
        format!(", {}", shown(load, Dimension::FORCE))
    });
    format!(
        "storey {}{load} in force control ± {} at {}, between {} and {}; {} % of N u/h in the lateral reading",
        axis.storey + 1,
        shown(axis.tolerance, Dimension::FORCE),
        shown(axis.rate, Dimension::FORCE_RATE),
        shown(band.low, Dimension::LENGTH),
        shown(band.high, Dimension::LENGTH),
        significant(100.0 * axis.p_delta, 3),
    )
}

/// The numbers of the report of a test of which a specimen has a scale. None for any other test. A procedure that tests the specimen
/// alone, without the structure, has the numbers of the rig.
#[must_use]
pub fn numbers(plan: &Plan, frame: &Frame) -> Option<String> {
    let on_the_rig = numbers_on_the_rig(frame)?;
    let procedures = plan.procedures.iter();
    let names: Vec<String> = procedures
        .filter(|procedure| procedure.kind.tests_the_specimen_alone())
        .map(|procedure| format!("{} ({})", procedure.name, procedure.kind.keyword()))
        .collect();
    let except = if names.is_empty() {
        "; ".to_owned()
    } else {
        format!(", except those of {}; these, ", names.join(", "))
    };
    Some(format!(
        "results and requirements are those of the prototype{except}limits, calibrations and the run log are those of the rig ({on_the_rig})"
    ))
}

/// A restoring-force model with its parameters as one string.
#[must_use]
pub fn words(behaviour: &Behaviour, shown: Printed<'_>) -> String {
    use Dimension as Of;
    let list = |name: &str, values: &[(&str, f64, Dimension)]| {
        let values: Vec<String> = values
            .iter()
            .map(|(name, value, dimension)| format!(", {name} {}", shown(*value, *dimension)))
            .collect();
        format!("{name}{}", values.concat())
    };
    let joined = |parts: &[Behaviour], word: &str| {
        let parts: Vec<String> = parts
            .iter()
            .map(|part| format!("[{}]", words(part, shown)))
            .collect();
        parts.join(word)
    };
    match behaviour {
        Behaviour::Bilinear {
            stiffness,
            yield_force,
            post_yield_ratio,
        } => list(
            "bilinear",
            &[
                ("stiffness", *stiffness, Of::STIFFNESS),
                ("yield force", *yield_force, Of::FORCE),
                ("post-yield stiffness ratio", *post_yield_ratio, Of::NUMBER),
            ],
        ),
        Behaviour::DeterioratingBilinear {
            stiffness,
            yield_force,
            post_yield_ratio,
            deterioration,
        } => {
            let plain = Behaviour::Bilinear {
                stiffness: *stiffness,
                yield_force: *yield_force,
                post_yield_ratio: *post_yield_ratio,
            };
            words(&plain, shown)
                + &deteriorating(*deterioration, yield_force * yield_force / stiffness, shown)
        }
        Behaviour::Multilinear { corners } => {
            let corners: Vec<String> = corners
                .iter()
                .map(|[x, force]| {
                    format!("{} at {}", shown(*force, Of::FORCE), shown(*x, Of::LENGTH))
                })
                .collect();
            format!(
                "multilinear, kinematic hardening, backbone points {}",
                corners.join(", ")
            )
        }
        Behaviour::BoucWen {
            stiffness,
            yield_force,
            post_yield_ratio,
            sharpness,
            beta,
        } => list(
            "Bouc–Wen",
            &[
                ("stiffness", *stiffness, Of::STIFFNESS),
                ("yield force", *yield_force, Of::FORCE),
                ("post-yield stiffness ratio", *post_yield_ratio, Of::NUMBER),
                ("n", *sharpness, Of::NUMBER),
                ("β", *beta, Of::NUMBER),
                ("γ", 1.0 - beta, Of::NUMBER),
            ],
        ),
        Behaviour::Pinching(pinching) => {
            let model = list(
                "pinching",
                &[
                    ("stiffness", pinching.stiffness, Of::STIFFNESS),
                    ("yield force", pinching.yield_force, Of::FORCE),
                    (
                        "post-yield stiffness ratio",
                        pinching.post_yield_ratio,
                        Of::NUMBER,
                    ),
                    ("force factor", pinching.force_factor, Of::NUMBER),
                    (
                        "displacement factor",
                        pinching.displacement_factor,
                        Of::NUMBER,
                    ),
                    (
                        "unloading exponent",
                        pinching.unloading_exponent,
                        Of::NUMBER,
                    ),
                ],
            );
            let unit = pinching.yield_force * pinching.yield_force / pinching.stiffness;
            model
                + &capped(pinching, shown)
                + &pinching
                    .deterioration
                    .map_or_else(String::new, |lost| deteriorating(lost, unit, shown))
        }
        Behaviour::Table(table) => {
            let ends = [table.points.first(), table.points.last()]
                .map(|point| point.map_or(0.0, |[x, _]| *x));
            let unloading = match table.unloading {
                Unloading::InitialStiffness => "unloading parallel to its steepest segment",
                Unloading::AlongTheCurve => "unloading along the curve",
            };
            let scale = if table.scale == 1.0 {
                String::new()
            } else {
                format!(", forces multiplied by {:.4}", table.scale)
            };
            let (low, high) = (shown(ends[0], Of::LENGTH), shown(ends[1], Of::LENGTH));
            format!(
                "table {}, {} points over {low} to {high}, {unloading}{scale}",
                table.file,
                table.points.len()
            )
        }
        Behaviour::Fracture { of, at } => {
            let at = match at {
                Breaks::Displacement(bound) => shown(*bound, Of::LENGTH),
                Breaks::Force(bound) => shown(*bound, Of::FORCE),
            };
            format!("[{}], fractures at {at}", words(of, shown))
        }
        Behaviour::Series(parts) => format!("in series: {}", joined(parts, " + ")),
        Behaviour::Parallel(parts) => format!("in parallel: {}", joined(parts, " + ")),
        Behaviour::Rate {
            of,
            reference_velocity,
            exponent,
        } => {
            let (velocity, exponent) = (
                shown(*reference_velocity, Of::VELOCITY),
                shown(*exponent, Of::NUMBER),
            );
            format!(
                "[{}], measured force multiplied by 1 + (v/{velocity})^{exponent} in motion",
                words(of, shown)
            )
        }
        Behaviour::Maxwell {
            of,
            stiffness,
            time_constant,
        } => {
            let (stiffness, tau) = (
                shown(*stiffness, Of::STIFFNESS),
                shown(*time_constant, Of::TIME),
            );
            format!(
                "[{}], in parallel with {stiffness} that relaxes with a time constant of {tau}",
                words(of, shown)
            )
        }
        Behaviour::Logarithmic {
            of,
            share,
            reference_time,
            longest,
        } => {
            let share = shown(*share, Of::NUMBER);
            let [time, longest] = [*reference_time, *longest].map(|time| shown(time, Of::TIME));
            format!(
                "[{}], of which the fraction {share}·ln(1 + t/{time}) relaxes, up to {longest}",
                words(of, shown)
            )
        }
        Behaviour::Beam(beam) => beam_words(beam, shown),
        Behaviour::Portal(portal) => portal_words(portal, shown),
        numbers => numbers
            .numbers()
            .map_or_else(String::new, |(word, numbers)| {
                let labels = numbers.iter().map(|(name, _)| name.replace('_', " "));
                let labels: Vec<String> = labels.collect();
                let values: Vec<_> = (labels.iter().zip(&numbers))
                    .map(|(label, (name, value))| {
                        (label.as_str(), *value, behaviours::dimension(word, name))
                    })
                    .collect();
                list(word, &values)
            }),
    }
}

fn capped(pinching: &Pinching, shown: Printed<'_>) -> String {
    pinching.capping.map_or_else(String::new, |capping| {
        let displacement = shown(capping.displacement, Dimension::LENGTH);
        let [slope, residual] =
            [capping.slope, capping.residual].map(|number| shown(number, Dimension::NUMBER));
        format!(
            ", softening from {displacement} with {slope} of the initial stiffness to {residual} of the strength"
        )
    })
}

/// Cyclic deterioration, mode by mode; `unit` is `F_y` `x_y` \[J\].
fn deteriorating(lost: Deterioration, unit: f64, shown: Printed<'_>) -> String {
    let residual = shown(lost.residual, Dimension::NUMBER);
    let modes = [
        (
            format!("cyclic deterioration: strength, down to {residual} of it"),
            lost.strength,
        ),
        ("post-capping strength".to_owned(), lost.capping),
        ("unloading stiffness".to_owned(), lost.unloading),
        ("reloading stiffness".to_owned(), lost.reloading),
    ];
    let active = modes
        .into_iter()
        .filter(|(_, capacity)| capacity.is_finite())
        .map(|(words, capacity)| {
            format!(
                ", {words} with {}",
                shown(capacity * unit, Dimension::ENERGY)
            )
        });
    format!(
        "{}, exponent {}",
        active.collect::<String>(),
        shown(lost.exponent, Dimension::NUMBER)
    )
}

fn beam_words(beam: &Beam, shown: Printed<'_>) -> String {
    let shear = beam.shear.map_or_else(String::new, |shear| {
        format!(", shear stiffness {}", shown(shear, Dimension::FORCE))
    });
    let at = beam.at.map_or_else(String::new, |at| {
        format!(", struck at {}", shown(at, Dimension::LENGTH))
    });
    format!(
        "beam, {}, length {}, modulus {}, second moment {}{shear}{at}: stiffness {}",
        support(beam.ends, shown),
        shown(beam.length, Dimension::LENGTH),
        shown(beam.youngs_modulus, Dimension::PRESSURE),
        shown(beam.second_moment, Dimension::SECOND_MOMENT),
        shown(beam.stiffness, Dimension::STIFFNESS)
    )
}

fn support(ends: Ends, shown: Printed<'_>) -> String {
    match ends {
        Ends::Cantilever => "cantilever".to_owned(),
        Ends::SimplySupported => "simply supported".to_owned(),
        Ends::BuiltIn => "built in".to_owned(),
        Ends::PartlyBuiltIn {
            rotational_stiffness,
        } => {
            let stiffness = shown(rotational_stiffness, Dimension::ENERGY).replace('J', "N·m");
            format!("partly built in ({stiffness} per radian)")
        }
    }
}

fn portal_words(portal: &Portal, shown: Printed<'_>) -> String {
    let beam_and_columns = |sections: Sections, unit: &str| {
        let one = |value: f64| shown(value, Dimension::ENERGY).replace('J', unit);
        if sections.are_same() {
            one(sections.beam)
        } else {
            format!(
                "{} of the beam and {} of the columns",
                one(sections.beam),
                one(sections.column)
            )
        }
    };
    // N·m² is not among the dimensions: printed as an energy, with its unit replaced.
    let section = portal
        .bending_stiffness
        .map_or_else(String::new, |bending| {
            format!(", EI {}", beam_and_columns(bending, "N·m²"))
        });
    let masses = portal
        .masses
        .map_or_else(String::new, |masses| frame_words(masses, shown));
    let loads = match portal.loads {
        Loads::Sway => "sway load".to_owned(),
        Loads::Beam => "load at midspan".to_owned(),
        Loads::Combined {
            beam_load,
            sway_load,
        } => format!(
            "loads in the ratio {} at midspan to {} sideways",
            shown(beam_load, Dimension::FORCE),
            shown(sway_load, Dimension::FORCE)
        ),
    };
    format!(
        "portal, fixed feet, span {}, height {}, plastic moment {}{section}{masses}, {loads}: stiffness {}",
        shown(portal.span, Dimension::LENGTH),
        shown(portal.height, Dimension::LENGTH),
        beam_and_columns(portal.plastic_moment, "N·m"),
        shown(portal.stiffness, Dimension::STIFFNESS)
    )
}

fn frame_words(masses: FrameMasses, shown: Printed<'_>) -> String {
    let FrameMasses {
        per_length,
        midspan,
        corner,
    } = masses;
    let one = |value: f64| shown(value, Dimension::MASS_PER_LENGTH);
    let members = match (per_length.beam > 0.0, per_length.are_same()) {
        (false, _) => String::new(),
        (true, true) => format!(", mass {}", one(per_length.beam)),
        (true, false) => format!(
            ", mass {} of the beam and {} of the columns",
            one(per_length.beam),
            one(per_length.column)
        ),
    };
    let lump = |mass: f64, position: &str| {
        if mass > 0.0 {
            format!(", {} {position}", shown(mass, Dimension::MASS))
        } else {
            String::new()
        }
    };
    members + &lump(midspan, "at midspan") + &lump(corner, "at each corner")
}

/// Equivalent masses of a frame, each with its shape function and its fraction of the total mass.
fn portal_masses(
    masses: EquivalentMasses,
    shown: Printed<'_>,
    rows: &mut Vec<(&'static str, String)>,
) {
    let all = shown(masses.whole, Dimension::MASS);
    let equivalent = |mass: f64, shape: &str| {
        format!(
            "{} ({:.4} of the frame's {all}, {shape})",
            shown(mass, Dimension::MASS),
            mass / masses.whole
        )
    };
    rows.push((
        "elastic equivalent mass",
        equivalent(masses.elastic, "static deflection as the shape"),
    ));
    rows.extend(masses.plastic.map(|plastic| {
        (
            "plastic equivalent mass",
            equivalent(plastic, "the mechanism as the shape"),
        )
    }));
    rows.push((
        "lumped equivalent mass",
        equivalent(
            masses.lumped,
            "half of each member at its ends, as in Melo et al. 2006, Fig. 5",
        ),
    ));
}

/// Values derived from a geometry: the mass of a beam in its first mode, mechanism and masses of a portal.
fn derived(behaviour: &Behaviour, shown: Printed<'_>, rows: &mut Vec<(&'static str, String)>) {
    match behaviour {
        Behaviour::Beam(beam) => {
            let factor = first_mode_mass_factor(beam);
            let text = match beam.own_mass {
                Some(own) if beam.at.is_some() => format!(
                    "{} ({factor:.4} qAL, static deflection as the shape)",
                    shown(factor * own, Dimension::MASS)
                ),
                None if beam.at.is_some() => format!("{factor:.4} of the beam's mass qAL"),
                Some(own) => format!(
                    "{} ({factor:.4} qAL, static deflection as the shape); Melo et al. 2006 use qAL/2, {}",
                    shown(factor * own, Dimension::MASS),
                    shown(own / 2.0, Dimension::MASS)
                ),
                None => format!("{factor:.4} of the beam's mass qAL; Melo et al. 2006 use a half"),
            };
            rows.push(("first-mode equivalent mass", text));
        }
        Behaviour::Portal(portal) => {
            let mechanism = portal.mechanism();
            rows.push((
                "mechanism",
                format!("{}: {}", mechanism.name(), mechanism.hinges()),
            ));
            let loads = Mechanism::ALL
                .into_iter()
                .filter(|mechanism| portal.collapse_load(*mechanism).is_finite());
            let loads: Vec<String> = loads
                .map(|mechanism| {
                    format!(
                        "{} {}",
                        mechanism.name(),
                        shown(portal.collapse_load(mechanism), Dimension::FORCE)
                    )
                })
                .collect();
            rows.push(("collapse loads", loads.join(", ")));
            rows.push(("capacity", shown(portal.capacity(), Dimension::FORCE)));
            rows.push((
                "yields at",
                shown(portal.capacity() / portal.stiffness, Dimension::LENGTH),
            ));
            if let Some(masses) = equivalent_masses(portal) {
                portal_masses(masses, shown, rows);
            }
            if let Some(most) = mechanism_limit(portal).filter(|most| most.is_finite()) {
                rows.push(("follows its mechanism up to", shown(most, Dimension::FORCE)));
            }
        }
        _ => behaviour
            .parts()
            .iter()
            .for_each(|part| derived(part, shown, rows)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use psd_plan::Storey;

    #[test]
    fn a_caption_calls_no_computed_force_measured() {
        let storey = || Storey::new(1.0, 1e5, Behaviour::Elastic { stiffness: 1e5 });
        let whole = Frame::of_storeys(vec![storey(), storey()]);
        let hybrid = whole.with(|storeys| storeys[1].part = Part::Computed);
        assert_eq!(measured("shear", None), "measured shear");
        assert_eq!(measured("shear", Some(&whole)), "measured shear");
        assert_eq!(
            measured("shear", Some(&hybrid)),
            "shear (storey 1 tested; storey 2 computed)"
        );
    }
}
