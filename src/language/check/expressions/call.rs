//! Functions: `abs(x)`, `max(a, b)`, `sqrt(area)`.

use crate::check::checker::{Checker, Context, Shape, Typed};
use crate::check::messages::{names, types as message};
use crate::syntax::ast::{Argument, Ident};
use psd_plan::formula::{Formula, Function};
use psd_plan::schema::{FUNCTIONS, FunctionKind};
use psd_text::source::Span;
use psd_text::units::{Dimension, Exponent};

impl<'a> Checker<'a> {
    pub fn call(
        &mut self,
        name: &Ident,
        arguments: &'a [Argument],
        span: Span,
        context: Context,
    ) -> Option<Typed> {
        let Some(kind) = FUNCTIONS.iter().find(|function| function.name == name.node) else {
            return self.fail(names::unknown_function(&name.node, name.span));
        };
        if let Some(named) = arguments.iter().find_map(|argument| argument.name.as_ref()) {
            return self.fail(names::function_argument_with_name(kind.name, named));
        }
        let checked: Vec<Option<Typed>> = arguments
            .iter()
            .map(|argument| self.value(&argument.value, context))
            .collect();
        let checked: Vec<Typed> = checked.into_iter().collect::<Option<_>>()?;
        let wrong_count = if kind.many {
            checked.is_empty()
        } else {
            checked.len() != 1
        };
        let Some(first) = checked.first().filter(|_| !wrong_count) else {
            return self.fail(names::function_arguments(kind, checked.len(), span));
        };
        if !kind.many && first.shape == Shape::List {
            return self.fail(message::list_for_number(first.span));
        }
        if let Some(other) = checked
            .iter()
            .find(|other| other.dimension != first.dimension)
        {
            return self.fail(message::mismatched(kind.name, first, other));
        }
        let dimension = self.result_dimension(kind, first, span)?;
        let bare = checked.iter().all(|argument| argument.bare);
        let parts = checked
            .into_iter()
            .map(|argument| argument.formula)
            .collect();
        Some(Typed {
            bare,
            ..Typed::number(Formula::Call(kind.function, parts), dimension, span)
        })
    }

    fn result_dimension(
        &mut self,
        kind: &FunctionKind,
        argument: &Typed,
        span: Span,
    ) -> Option<Dimension> {
        match kind.function {
            Function::Sqrt => {
                let root = Exponent::ratio(1, 2).and_then(|half| argument.dimension.to_power(half));
                if root.is_none() {
                    return self.fail(message::exponent_too_large(span));
                }
                root
            }
            Function::Sin | Function::Cos if argument.dimension != Dimension::NUMBER => {
                self.fail(message::angle_with_unit(kind.name, argument))
            }
            _ => Some(argument.dimension),
        }
    }
}
