//! Tests of the syntax: text in, tree and errors out.

pub mod corpus;
mod faulty;
mod sound;

use super::{
    ast::{Argument, Ast, Block, Expr, ExprKind, ItemKind},
    parse,
};
use psd_text::diagnostic::{Code, Diagnostic};
use psd_text::source::Sources;

pub const IMPACT: &str = include_str!("../samples/impact.psd");
pub const QUAKE: &str = include_str!("../samples/quake.psd");

/// Tree, errors and sources of one text.
pub fn read(text: &str) -> (Ast, Vec<Diagnostic>, Sources) {
    let mut sources = Sources::default();
    let file = sources.add("test.psd", text);
    let (ast, errors) = parse(&sources, file);
    (ast, errors, sources)
}

/// The tree of a valid text.
pub fn sound(text: &str) -> (Ast, Sources) {
    let (ast, errors, sources) = read(text);
    assert!(errors.is_empty(), "{text}\n{errors:#?}");
    (ast, sources)
}

/// Code and text under the first label of each error.
pub fn errors(text: &str) -> Vec<(Code, String)> {
    let (_, errors, sources) = read(text);
    errors
        .iter()
        .map(|error| (error.code, sources.text(error.span().unwrap()).to_owned()))
        .collect()
}

/// The value of the single field in a block: `expression("1 + 2")`.
pub fn expression(text: &str) -> (Expr, Sources) {
    let (ast, sources) = sound(&format!("b {{\n  x = {text}\n}}\n"));
    let value = block(&ast, 0).fields[0].value.clone();
    (value, sources)
}

pub fn block(ast: &Ast, index: usize) -> &Block {
    match &ast.items[index].kind {
        ItemKind::Block(block) => block,
        other => panic!("not a block: {other:?}"),
    }
}

/// An expression as nested lists, to compare structure.
pub fn shape(expr: &Expr) -> String {
    let unit = |unit: &Option<super::ast::UnitToken>| {
        unit.as_ref()
            .map_or(String::new(), |unit| format!(" {}", unit.node))
    };
    let all = |items: &[Expr]| items.iter().map(shape).collect::<Vec<_>>().join(", ");
    match &expr.kind {
        ExprKind::Number {
            text, unit: token, ..
        } => format!("{text}{}", unit(token)),
        ExprKind::Text(text) => format!("{text:?}"),
        ExprKind::Name(name) => name.clone(),
        ExprKind::List { items, unit: token } => format!("[{}]{}", all(items), unit(token)),
        ExprKind::Range { start, end, step } => {
            let step = step
                .as_ref()
                .map_or(String::new(), |step| format!(" step {}", shape(step)));
            format!("({} .. {}{step})", shape(start), shape(end))
        }
        ExprKind::Call { name, arguments } => {
            format!("{}({})", name.node, shape_of_arguments(arguments))
        }
        ExprKind::Member {
            base,
            name,
            arguments,
        } => {
            let arguments = shape_of_arguments(arguments);
            format!("({} . {}({arguments}))", shape(base), name.node)
        }
        ExprKind::Stepped { input, values } => format!("({} in {})", shape(input), shape(values)),
        ExprKind::Field { base, name } => format!("({} . {})", shape(base), name.node),
        ExprKind::Index { base, index } => format!("({} @ {})", shape(base), shape(index)),
        ExprKind::Negate(value) => format!("(- {})", shape(value)),
        ExprKind::Binary { .. } => shape_of_operators(expr),
        ExprKind::Within {
            value,
            tolerance,
            target,
        } => {
            format!(
                "({} within {} of {})",
                shape(value),
                shape(tolerance),
                shape(target)
            )
        }
        ExprKind::Parenthesised(inner) => format!("<{}>", shape(inner)),
        ExprKind::Faulty => "?".to_owned(),
    }
}

/// A loop over the left operands: a sum of a thousand terms does not need a thousand stack frames.
fn shape_of_operators(expr: &Expr) -> String {
    let mut rest = Vec::new();
    let mut first = expr;
    while let ExprKind::Binary {
        operator,
        left,
        right,
    } = &first.kind
    {
        rest.push(format!(" {} {})", operator.node.symbol(), shape(right)));
        first = left;
    }
    let open = "(".repeat(rest.len());
    rest.push(format!("{open}{}", shape(first)));
    rest.into_iter().rev().collect()
}

fn shape_of_arguments(arguments: &[Argument]) -> String {
    let arguments: Vec<String> = arguments
        .iter()
        .map(|argument| {
            let name = argument
                .name
                .as_ref()
                .map_or(String::new(), |name| format!("{}: ", name.node));
            format!("{name}{}", shape(&argument.value))
        })
        .collect();
    arguments.join(", ")
}

/// The whole tree as text without spans.
pub fn outline(ast: &Ast) -> String {
    let mut text = String::new();
    for item in &ast.items {
        let line = match &item.kind {
            ItemKind::Use { path } => format!("use {:?}", path.node),
            ItemKind::Let { name, value } => format!("let {} = {}", name.node, shape(value)),
            ItemKind::Param {
                name,
                value,
                bounds,
            } => {
                let bounds = bounds.as_ref().map_or(String::new(), |bounds| {
                    format!(" between {}", shape(bounds))
                });
                format!("param {} = {}{bounds}", name.node, shape(value))
            }
            ItemKind::Require { label, condition } => {
                format!("require {:?} {}", label.node, shape(condition))
            }
            ItemKind::Block(block) => {
                let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
                let title = block
                    .title
                    .as_ref()
                    .map_or(String::new(), |title| format!(" {:?}", title.node));
                let fields = block
                    .fields
                    .iter()
                    .map(|field| format!("\n  {} = {}", field.key.node, shape(&field.value)));
                format!("{}{title}{}", words.join(" "), fields.collect::<String>())
            }
        };
        text.push_str(&line);
        text.push('\n');
    }
    text
}
