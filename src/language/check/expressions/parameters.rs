//! `let` and `param`: their values, and what `--set` makes of a parameter.

use std::collections::BTreeMap;

use crate::language::check::checker::{Checker, Place, Reads, Shape, Typed};
use crate::language::check::messages::{names, types, values};
use crate::language::syntax;
use crate::language::syntax::ast::{Ast, Expr, ItemKind};
use crate::plan::{Interval, Parameter};
use crate::text::diagnostic::Diagnostic;
use crate::text::source::Sources;

/// Reads the values of `--set`, each as a file of its own, so that a fault in it can be shown. Later ones win.
pub fn read_settings(
    sources: &mut Sources,
    asts: &[Ast],
    settings: &[(String, String)],
    faults: &mut Vec<Diagnostic>,
) -> BTreeMap<String, Expr> {
    let known: Vec<&str> = asts
        .iter()
        .flat_map(|ast| &ast.items)
        .filter_map(|item| {
            if let ItemKind::Param { name, .. } = &item.kind {
                Some(name.node.as_str())
            } else {
                None
            }
        })
        .collect();
    let last: BTreeMap<&str, &str> = settings
        .iter()
        .map(|(name, value)| (name.as_str(), value.as_str()))
        .collect();
    let mut read = BTreeMap::new();
    for (name, value) in last {
        if !known.contains(&name) {
            faults.push(names::unknown_parameter(name, &known));
            continue;
        }
        let file = sources.add(format!("--set {name}"), format!("param {name} = {value}"));
        let (ast, found) = syntax::parse(sources, file);
        let broken = !found.is_empty();
        faults.extend(found);
        match ast.items.into_iter().next().map(|item| item.kind) {
            Some(ItemKind::Param {
                value,
                bounds: None,
                ..
            }) if is_one_line(&sources.file(file).text) => {
                read.insert(name.to_owned(), value);
            }
            _ if broken => {}
            _ => faults.push(names::setting_is_no_value(
                name,
                file,
                sources.file(file).text.len(),
            )),
        }
    }
    read
}

/// A value is one line.
fn is_one_line(text: &str) -> bool {
    !text.contains(['\n', '\r'])
}

impl<'a> Checker<'a> {
    /// The value of a declaration; of a parameter, the one that was set.
    pub fn value_of_declaration(&mut self, index: usize) -> Option<Typed> {
        let declared = &self.scope.values[index];
        if declared.keyword == "let" {
            let place = Place {
                entry: None,
                reads: Reads::All,
                critical: false,
            };
            return self.value(declared.value, place);
        }
        let place = Place {
            entry: None,
            reads: Reads::Nothing("a parameter"),
            critical: false,
        };
        let own = self.single(declared.value, place);
        let bounds = declared
            .bounds
            .map(|bounds| self.bounds_of_parameter(bounds, place, own.as_ref()));
        let own = own?;
        let bounds = match bounds {
            Some(bounds) => bounds?,
            None => Interval::ALL,
        };
        let value = own.constant()?;
        if !bounds.contains(value) {
            let span = declared.value.span;
            return self.fail(values::parameter_out_of_bounds(
                &declared.name.node,
                self.text(span),
                span,
                bounds,
                own.dimension,
            ));
        }
        let Some(written) = declared.setting else {
            return Some(own);
        };
        let set = self.single(written, place)?;
        let set = self.expect(set, own.dimension, &declared.name.node, written)?;
        let value = set.constant()?;
        if !bounds.contains(value) {
            let at = declared
                .bounds
                .map_or(declared.value.span, |bounds| bounds.span);
            return self.fail(values::setting_out_of_range(
                &declared.name.node,
                self.text(written.span),
                written.span,
                bounds,
                own.dimension,
                at,
            ));
        }
        Some(set)
    }

    fn bounds_of_parameter(
        &mut self,
        written: &'a Expr,
        place: Place,
        own: Option<&Typed>,
    ) -> Option<Interval> {
        let (interval, dimension) = self.interval(written, place)?;
        if let Some(own) = own
            && own.dimension != dimension
        {
            return self.fail(types::mismatched(
                "between",
                own,
                &Typed::number(own.formula.clone(), dimension, written.span),
            ));
        }
        Some(interval)
    }

    /// The parameters of the run, in the order declared.
    pub fn parameters(&mut self) -> Vec<Parameter> {
        let mut parameters = Vec::new();
        for index in 0..self.scope.values.len() {
            let declared = &self.scope.values[index];
            let was_used = self.used.contains(&index);
            let typed = self.declared_value(index, declared.name.span);
            if !was_used {
                self.used.remove(&index);
            }
            if let ("param", Some(typed)) = (declared.keyword, typed)
                && let (Shape::Number, Some(value)) = (typed.shape, typed.constant())
            {
                let set = declared.setting.is_some();
                parameters.push(Parameter {
                    name: declared.name.node.clone(),
                    value,
                    dimension: typed.dimension,
                    set,
                });
            }
        }
        parameters
    }
}
