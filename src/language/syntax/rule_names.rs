//! The name of each rule of the grammar in a message. The match is exhaustive, so that a new rule needs a name.

use super::grammar::Rule;

/// The name of `rule` in a message, or `None` if it carries no information (helpers of other rules).
#[must_use]
pub const fn human(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::file | Rule::item | Rule::item_alone => "an item",
        Rule::use_item | Rule::use_word => "`use`",
        Rule::param_item | Rule::param_word => "`param`",
        Rule::let_item | Rule::let_word => "`let`",
        Rule::require_item | Rule::require_word => "`require`",
        Rule::block => "a block",
        Rule::head | Rule::head_alone => "the name of a block",
        Rule::entry | Rule::entry_alone | Rule::key => "a field",
        Rule::expression
        | Rule::comparison
        | Rule::range
        | Rule::sum
        | Rule::operand
        | Rule::list
        | Rule::parenthesised
        | Rule::variable
        | Rule::number
        | Rule::negate
        | Rule::open_bracket
        | Rule::open_paren => "a value",
        Rule::argument | Rule::argument_name => "an argument",
        Rule::infix | Rule::compare | Rule::dots | Rule::and_word => "an operator",
        Rule::text => "a string in quotes",
        Rule::unit => "a unit",
        Rule::name | Rule::new_name | Rule::word => "a name",
        Rule::between_word => "`between`",
        Rule::of_word => "`of`",
        Rule::equals => "`=`",
        Rule::comma => "`,`",
        Rule::colon => "`:`",
        Rule::open_brace => "`{`",
        Rule::close_brace => "`}`",
        Rule::close_bracket => "`]`",
        Rule::close_paren => "`)`",
        Rule::end_of_line | Rule::newline | Rule::EOI => "the end of the line",
        Rule::within_word
        | Rule::in_word
        | Rule::step_word
        | Rule::gap
        | Rule::compared
        | Rule::limit
        | Rule::postfix
        | Rule::attached
        | Rule::joining
        | Rule::field
        | Rule::index
        | Rule::dot
        | Rule::arguments
        | Rule::any_word
        | Rule::free_word => return None,
    })
}

/// The expected tokens as a phrase, from the rules that were tried: `a value`, "`,` or `)`".
#[must_use]
pub fn expected(rules: &[Rule]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for name in rules.iter().filter_map(|rule| human(*rule)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    // If a value may start here, the other possibilities (a string, an argument's name) carry no information.
    if names.contains(&"a value") {
        names.retain(|name| !matches!(*name, "a string in quotes" | "an argument"));
    }
    // An operator may be `(` or `[` too, where a call or index could follow: that is not a new value.
    if names.contains(&"an operator") {
        names.retain(|name| *name != "a value");
    }
    // Tokens that continue a line come before those that end it.
    names.sort_by_key(|name| *name == "the end of the line");
    match names.split_last() {
        None => "something else".to_owned(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
    }
}
