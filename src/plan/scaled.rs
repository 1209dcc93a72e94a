//! Specimens that are on the rig at a scale, or as one of several equal parts: the words beside their numbers. In: a frame.
//! Out: words.

use crate::{Frame, Plan, Scale};
use psd_physics::structure::assemblies::Assemblies;
use psd_text::units::Dimension;
use psd_text::units::display::plain;

/// `storey 1`, or `storeys 1, 2`, from indices; `element 1` for an element of a frame of matrices.
#[must_use]
pub fn members(frame: &Frame, storeys: &[usize]) -> String {
    let numbers: Vec<String> = storeys
        .iter()
        .map(|storey| (storey + 1).to_string())
        .collect();
    let word = frame.word_for_a_member();
    let plural = if storeys.len() == 1 { "" } else { "s" };
    format!("{word}{plural} {}", numbers.join(", "))
}

/// ` at scale 0.5, one of 2 equal parts`; empty if the specimen is the storey itself.
#[must_use]
pub fn at_scale(scale: &Scale) -> String {
    let number = |value: f64| plain(value, Dimension::NUMBER, 4);
    let Scale {
        displacement,
        force,
        represents,
    } = *scale;
    let is_of_lengths = (force - displacement * displacement).abs() <= 1e-9 * force;
    let scale = match (is_of_lengths, displacement == 1.0) {
        (true, true) => String::new(),
        (true, false) => format!(" at scale {}", number(displacement)),
        (false, _) => format!(
            " at scale {} of displacements and {} of forces",
            number(displacement),
            number(force)
        ),
    };
    let parts = if represents > 1.0 {
        format!(", one of {} equal parts", number(represents))
    } else {
        String::new()
    };
    scale + &parts
}

/// The scale of every specimen on the rig that is not its storeys themselves, from the ground up: `storey 1 at scale 0.5, one of 2 equal
/// parts`. None without one: the numbers of the rig are then those of the prototype.
#[must_use]
pub fn specimens_at_scale(frame: &Frame) -> Option<String> {
    let specimen = |(of, scale): (String, Scale)| of + &at_scale(&scale);
    let specimens: Vec<String> = scaled(frame).into_iter().map(specimen).collect();
    (!specimens.is_empty()).then(|| specimens.join("; "))
}

/// The numbers of the rig beside those of the prototype: `storey 1: 0.5 × drift, 0.125 × shear`. None if they are the same.
#[must_use]
pub fn numbers_on_the_rig(frame: &Frame) -> Option<String> {
    let number = |value: f64| plain(value, Dimension::NUMBER, 4);
    let specimen = |(of, scale): (String, Scale)| {
        let (drift, shear) = (number(scale.displacement), number(1.0 / scale.forces()));
        let [of_drift, of_shear] = if frame.has_elements() {
            ["deformation", "force"]
        } else {
            ["drift", "shear"]
        };
        format!("{of}: {drift} × {of_drift}, {shear} × {of_shear}")
    };
    let specimens: Vec<String> = scaled(frame).into_iter().map(specimen).collect();
    (!specimens.is_empty()).then(|| specimens.join("; "))
}

/// The storeys of each specimen at a scale, with the scale.
fn scaled(frame: &Frame) -> Vec<(String, Scale)> {
    let assemblies = Assemblies::of(frame);
    let specimens = assemblies.map_or_else(Vec::new, |assemblies| assemblies.specimens());
    let scales: Vec<Scale> = frame.members().map(|member| member.part.scale()).collect();
    let specimens = specimens
        .into_iter()
        .map(|of| (members(frame, &of), scales[of[0]]));
    specimens
        .filter(|(_, scale)| *scale != Scale::FULL)
        .collect()
}

impl Plan {
    /// [`specimens_at_scale`] of the frame on the rig.
    #[must_use]
    pub fn specimens_at_scale(&self) -> Option<String> {
        self.frame_on_the_rig().and_then(specimens_at_scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Behaviour, Part, Storey};

    #[test]
    fn a_specimen_is_described_by_its_scale_and_its_number_of_equal_parts() {
        let scaled = |displacement, force, represents| Part::Tested {
            apart: false,
            scale: Scale {
                displacement,
                force,
                represents,
            },
        };
        let frame = |part| {
            let storey = |part| Storey {
                part,
                ..Storey::new(1.0, 1.0, Behaviour::Elastic { stiffness: 1.0 })
            };
            Frame::of_storeys(vec![storey(part), storey(Part::Computed)])
        };
        let described = |part| specimens_at_scale(&frame(part));
        assert_eq!(described(Part::TESTED), None);
        let (length, third) = (0.4, 1.0 / 3.0);
        for (part, wanted) in [
            (
                scaled(0.5, 0.25, 2.0),
                "storey 1 at scale 0.5, one of 2 equal parts",
            ),
            (
                scaled(length, length * length, 1.0),
                "storey 1 at scale 0.4",
            ),
            (
                scaled(third, third * third, 1.0),
                "storey 1 at scale 0.3333",
            ),
            (
                scaled(0.5, 0.3, 1.0),
                "storey 1 at scale 0.5 of displacements and 0.3 of forces",
            ),
            (scaled(1.0, 1.0, 2.0), "storey 1, one of 2 equal parts"),
        ] {
            assert_eq!(described(part).as_deref(), Some(wanted));
        }
        assert_eq!(
            numbers_on_the_rig(&frame(scaled(0.5, 0.25, 2.0))).as_deref(),
            Some("storey 1: 0.5 × drift, 0.125 × shear")
        );
    }
}
