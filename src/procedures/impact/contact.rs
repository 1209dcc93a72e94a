//! The contact law of an impact, in a plan and in a report. In: the field `contact` of an impact. Out: the law with formulas, then with
//! numbers, and the part of a report that depends on it. It knows no law: the words are in `plan::procedures::impact::block`, the laws in
//! `physics::contact`.

use crate::report::number;
use crate::run::inputs::Inputs;
use crate::run::stop::Stop;
use psd_language::check::checker::Checker;
use psd_physics::contact::{ContactLaw, ContactSpring};
use psd_plan::Contact;
use psd_plan::formula::Formula;
use psd_plan::procedures::impact::block as schema;
use psd_plan::schema::ResultKind;
use psd_text::units::Dimension;

/// The contact law that a block specifies.
pub(crate) fn check(checker: &mut Checker, block: usize) -> Option<Contact> {
    let Some((entry, _)) = checker.field(block, schema::CONTACT.name) else {
        return Some(Contact::Rigid);
    };
    let context = checker.context_of(block, entry);
    let chosen = checker.choice(block, schema::CONTACT.name)?;
    let (mut numbers, mut is_faulty) = (Vec::new(), false);
    for field in chosen.variant.arguments {
        if field.default_number().is_none() && chosen.span(field.name).is_none() {
            continue;
        }
        match checker.argument(&chosen, field.name, context) {
            Some(number) => numbers.push((field.name, number)),
            None => is_faulty = true,
        }
    }
    if is_faulty {
        return None;
    }
    Contact::of_numbers(chosen.variant.name, |argument| {
        let index = numbers.iter().position(|(name, _)| *name == argument)?;
        Some(numbers.swap_remove(index).1)
    })
}

/// The contact law with its numbers, each in the range of its argument.
pub(crate) fn with_numbers(contact: &Contact, inputs: &mut Inputs<'_>) -> Result<ContactLaw, Stop> {
    let mut numbers = Vec::new();
    for number in contact.numbers() {
        let field = schema::contact_number(contact.name(), number.argument);
        let value = inputs.named(number.input, number.value, field)?;
        numbers.push((number.argument, value));
    }
    let law = ContactLaw::of_numbers(contact.name(), |argument| {
        let named = numbers.iter().find(|(name, _)| *name == argument);
        named.map(|(_, value)| *value)
    });
    Ok(law.expect("a law has the numbers of its declaration"))
}

/// The formulas of its numbers.
pub(crate) fn formulas(contact: &Contact) -> Vec<&Formula> {
    let numbers = contact.numbers().into_iter();
    numbers.map(|number| number.value).collect()
}

/// The spring of a law of finite stiffness.
pub(crate) fn spring(law: ContactLaw) -> Option<ContactSpring> {
    law.spring().map(|spring| ContactSpring {
        stiffness: *spring.stiffness,
        exponent: spring.exponent,
    })
}

/// The results of the law that a reader looks for first, where a table prints them: its largest contact force and the permanent
/// indentation.
pub(crate) fn headline(contact: &Contact) -> Vec<&'static str> {
    let unprinted = unprinted(contact);
    [schema::MAX_CONTACT_FORCE, schema::INDENTATION]
        .map(|kind| kind.name)
        .into_iter()
        .filter(|name| !unprinted.contains(name))
        .collect()
}

/// The results that no table prints: those that depend on the time step, an indentation that the law does not have, a restitution that
/// the plan states.
pub(crate) fn unprinted(contact: &Contact) -> Vec<&'static str> {
    let is_unprinted = |kind: &&ResultKind| {
        let is = |kinds: &[ResultKind]| kinds.iter().any(|other| other.name == kind.name);
        (kind.grows_as_inverse_step && contact.is_impulsive())
            || (!contact.indents() && is(&[schema::INDENTATION, schema::INDENTATION_ENERGY]))
            || (contact.states_restitution() && is(&[schema::RESTITUTION]))
    };
    let results = schema::RESULTS.iter().filter(is_unprinted);
    results.map(|kind| kind.name).collect()
}

/// The name of the energy that the contact took: a spring stores it, every other law loses it.
pub(crate) fn energy(contact: &Contact) -> &'static str {
    if contact.spring().is_none() {
        "lost in the contact"
    } else if contact.is_lossless(|number| number.constant() == Some(0.0)) {
        "stored in the contact"
    } else {
        "stored and lost in the contact"
    }
}

/// The sentence of a report on the contact force of the law, if it needs one.
pub(crate) fn note(contact: &Contact) -> Option<&'static str> {
    contact.is_rigid().then_some(
        "Under the rigid law the contact force is inversely proportional to the time step. Only the impulse is a \
         property of the impact.",
    )
}

/// The restitution that the law implies as the time step goes to zero, from the masses of striker and structure \[kg\].
pub(crate) fn implied_restitution(contact: &Contact, striker: f64, mass: f64) -> Option<String> {
    contact.is_rigid().then(|| {
        let restitution = number::text(striker / (striker + 2.0 * mass), Dimension::NUMBER);
        format!("a coefficient of restitution e = Ms/(Ms + 2M) = {restitution}")
    })
}

/// The energy that the contact took, as it is summed over the steps: from the forces at their ends, or within them.
pub(crate) const fn work(contact: &Contact) -> &'static str {
    if contact.needs_tangent() {
        "contact, ∫F d(Xs − X) within each step"
    } else {
        "contact, Σ F₁ΔXs − ½(F₀ + F₁)ΔX of each step"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A surface is indented above the largest force of its law. A spring without such a force has an indentation of 0 by definition.
    #[test]
    fn an_indentation_is_printed_where_it_can_occur() {
        let number = Formula::Constant;
        let hertz = |force_limit: Option<f64>| Contact::Hertz {
            stiffness: number(1e9),
            loss: number(0.0),
            force_limit: force_limit.map(number),
        };
        let limit = Contact::Limit {
            force: number(1500.0),
        };
        for (law, indents) in [
            (hertz(None), false),
            (hertz(Some(900.0)), true),
            (limit, true),
            (Contact::Rigid, false),
        ] {
            let name = schema::INDENTATION.name;
            assert_eq!(headline(&law).contains(&name), indents, "{law:?}");
            assert_eq!(unprinted(&law).contains(&name), !indents, "{law:?}");
        }
    }
}
