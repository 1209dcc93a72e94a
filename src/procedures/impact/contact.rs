//! The contact laws in a plan and in a report, each in one arm of every match here. In: the field `contact` of an impact. Out: the law
//! with formulas, then with numbers, and its part of the report. The force of a law is computed in `physics::contact`.

use crate::language::check::checker::Checker;
use crate::physics::contact::ContactLaw;
use crate::physics::self_test::Part;
use crate::plan::Contact;
use crate::run::inputs::Inputs;
use crate::run::stop::Stop;
use crate::schema::procedures::impact as schema;
use crate::units::{Dimension, Exponent};

/// The contact law that a block specifies.
pub(crate) fn check(checker: &mut Checker, block: usize) -> Option<Contact> {
    let Some((entry, _)) = checker.field(block, schema::CONTACT.name) else {
        return Some(Contact::Rigid);
    };
    let displacement = checker.context_of(block, entry);
    let chosen = checker.choice(block, schema::CONTACT.name)?;
    Some(match chosen.variant.name {
        "limit" => Contact::Limit {
            force: checker.argument(&chosen, schema::LIMIT_FORCE.name, displacement)?,
        },
        "restitution" => Contact::Restitution {
            coefficient: checker.argument(&chosen, schema::COEFFICIENT.name, displacement)?,
        },
        "hertz" => {
            let stiffness = checker.argument(&chosen, schema::HERTZ_STIFFNESS.name, displacement);
            let loss = checker.argument(&chosen, schema::LOSS.name, displacement);
            let force_limit = match chosen.find(schema::FORCE_LIMIT.name) {
                Some((_, Some(_))) => checker
                    .argument(&chosen, schema::FORCE_LIMIT.name, displacement)
                    .map(Some),
                _ => Some(None),
            };
            Contact::Hertz {
                stiffness: stiffness?,
                loss: loss?,
                force_limit: force_limit?,
            }
        }
        _ => Contact::Rigid,
    })
}

/// The contact law with its numbers.
pub(crate) fn with_numbers(contact: &Contact, inputs: &mut Inputs<'_>) -> Result<ContactLaw, Stop> {
    Ok(match contact {
        Contact::Rigid => ContactLaw::Rigid,
        Contact::Limit { force } => ContactLaw::Limit {
            force: inputs.positive(schema::FORCE_LIMIT.name, force, Dimension::FORCE)?,
        },
        Contact::Restitution { coefficient } => {
            let coefficient = inputs.not_negative("restitution", coefficient, Dimension::NUMBER)?;
            if coefficient > 1.0 {
                return Err(Stop::bad_input(
                    "restitution",
                    coefficient,
                    Dimension::NUMBER,
                    "at most 1",
                ));
            }
            ContactLaw::Restitution { coefficient }
        }
        Contact::Hertz {
            stiffness,
            loss,
            force_limit,
        } => ContactLaw::Hertz {
            stiffness: inputs.positive(
                "contact_stiffness",
                stiffness,
                Dimension::HERTZ_STIFFNESS,
            )?,
            loss: inputs.not_negative(schema::LOSS.name, loss, SECONDS_PER_METRE)?,
            force_limit: match force_limit {
                Some(force) => {
                    Some(inputs.positive(schema::FORCE_LIMIT.name, force, Dimension::FORCE)?)
                }
                None => None,
            },
        },
    })
}

/// The dimension of the Hunt–Crossley loss factor.
const SECONDS_PER_METRE: Dimension = Dimension {
    length: Exponent::whole(-1),
    mass: Exponent::ZERO,
    time: Exponent::whole(1),
};

/// A contact law in a report.
pub(crate) struct Reported {
    /// Its name in a sentence.
    pub name: &'static str,
    /// Its results that a reader looks for first. The largest contact force is one of them where the law bounds it.
    pub headline: &'static [&'static str],
    /// Its results that no table prints: a peak force that depends on the time step, and an indentation that the law does not have.
    pub unprinted: &'static [&'static str],
    /// The name of the energy that the contact took: a spring stores it, every other law loses it.
    pub energy: &'static str,
    /// The parts of the self-test that cover it, on one degree of freedom and on a storey.
    pub self_tested: [Part; 2],
}

/// The part of a report that depends on the contact law.
pub(crate) fn reported(contact: &Contact) -> Reported {
    const LOST: &str = "lost in the contact";
    const INDENTATION: [&str; 2] = [schema::INDENTATION.name, schema::INDENTATION_ENERGY.name];
    const OF_AN_IMPULSE: &[&str] = &[
        schema::MAX_CONTACT_FORCE.name,
        INDENTATION[0],
        INDENTATION[1],
    ];
    /// The coefficient of restitution is an input of this law.
    const OF_A_STATED_RESTITUTION: &[&str] = &[
        schema::MAX_CONTACT_FORCE.name,
        INDENTATION[0],
        INDENTATION[1],
        schema::RESTITUTION.name,
    ];
    match contact {
        Contact::Rigid => Reported {
            name: "rigid",
            headline: &[],
            unprinted: OF_AN_IMPULSE,
            energy: LOST,
            self_tested: [Part::Rigid, Part::FrameRigid],
        },
        Contact::Limit { .. } => Reported {
            name: "rigid up to a limit force",
            headline: &[schema::MAX_CONTACT_FORCE.name],
            unprinted: &INDENTATION,
            energy: LOST,
            self_tested: [Part::Limit, Part::FrameLimit],
        },
        Contact::Restitution { .. } => Reported {
            name: "restitution",
            headline: &[],
            unprinted: OF_A_STATED_RESTITUTION,
            energy: LOST,
            self_tested: [Part::Restitution, Part::FrameRestitution],
        },
        Contact::Hertz {
            loss, force_limit, ..
        } => Reported {
            name: "Hertz",
            headline: &[schema::MAX_CONTACT_FORCE.name, schema::INDENTATION.name],
            unprinted: &[],
            energy: if force_limit.is_none() && loss.constant() == Some(0.0) {
                "stored in the contact"
            } else {
                "stored and lost in the contact"
            },
            self_tested: [Part::Hertz, Part::FrameHertz],
        },
    }
}
