//! Which files of data a plan names: texts that stand where the schema takes a file. In: a syntax tree. Out: the names and
//! their places. It opens none, and says nothing of what is wrong with the rest.

use crate::schema::{self, Field, FieldType, Variant};
use crate::source::Spanned;
use crate::syntax::ast::{Ast, Expr, ExprKind, ItemKind};

/// Every file of data that `ast` names, in the order written.
pub fn named(ast: &Ast) -> Vec<Spanned<String>> {
    let mut found = Vec::new();
    for item in &ast.items {
        let ItemKind::Block(block) = &item.kind else { continue };
        let words: Vec<&str> = block.words.iter().map(|word| word.node.as_str()).collect();
        let Some(kind) = schema::block_of_words(&words) else { continue };
        for entry in &block.fields {
            if let Some(field) = kind.field(&entry.key.node) {
                in_field(field, &entry.value, &mut found);
            }
        }
    }
    found
}

fn in_field(field: &'static Field, written: &Expr, found: &mut Vec<Spanned<String>>) {
    match (field.ty, &written.kind) {
        (FieldType::File, ExprKind::Text(name)) => found.push(Spanned::new(name.clone(), written.span)),
        (FieldType::Choice(variants) | FieldType::Choices(variants), _) => in_choice(variants, written, found),
        _ => {}
    }
}

fn in_choice(variants: &'static [Variant], written: &Expr, found: &mut Vec<Spanned<String>>) {
    match &written.kind {
        ExprKind::Parenthesised(inner) => in_choice(variants, inner, found),
        ExprKind::List { items, .. } => items.iter().for_each(|item| in_choice(variants, item, found)),
        ExprKind::Call { name, arguments } => {
            let Some(variant) = variants.iter().find(|variant| variant.name == name.node) else { return };
            for (index, argument) in arguments.iter().enumerate() {
                let field = match &argument.name {
                    Some(name) => variant.argument(&name.node),
                    None => variant.arguments.get(index).or(variant.arguments.last()),
                };
                match field {
                    Some(field) if matches!(field.ty, FieldType::Inner | FieldType::Inners) => {
                        in_choice(variants, &argument.value, found);
                    }
                    Some(field) => in_field(field, &argument.value, found),
                    None => {}
                }
            }
        }
        _ => {}
    }
}
