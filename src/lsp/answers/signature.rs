//! The arguments of a model or function while they are written. In: a position. Out: the call with its arguments.

use gen_lsp_types as lsp;
use psd_plan::schema::FUNCTIONS;

use super::{View, describe, markdown};
use crate::cursor::{Cursor, Place, is_in_plan, plan_text};
use crate::text::narrow;

pub fn signature(view: &View<'_>, params: &lsp::SignatureHelpParams) -> Option<lsp::SignatureHelp> {
    let offset = view
        .text()
        .offset(params.text_document_position_params.position);
    let text = view.text().as_str();
    if !is_in_plan(view.name(), text, offset) {
        return None;
    }
    let plan = plan_text(view.name(), text);
    let value = match Cursor::of(&plan, offset).place {
        Place::Value(value)
        | Place::Unit(value)
        | Place::Member { value, .. }
        | Place::Text(value) => value,
        Place::Nothing | Place::Item(_) | Place::Key(_) => return None,
    };
    let call = value.call?;
    let (label, doc, parameters, active) = if let Some(variant) = call.variant {
        let named = call.argument.and_then(|name| {
            variant
                .arguments
                .iter()
                .position(|argument| argument.name == name)
        });
        let parameters = variant
            .arguments
            .iter()
            .map(|argument| lsp::ParameterInformation {
                label: argument.name.to_owned().into(),
                documentation: Some(markdown(describe::field(argument)).into()),
            });
        let active = named.unwrap_or(call.index);
        (
            describe::call(variant),
            variant.doc,
            parameters.collect(),
            active,
        )
    } else {
        let function = FUNCTIONS
            .iter()
            .find(|function| function.name == call.name)?;
        let parameter = function.takes.arguments();
        let label = format!("{}({parameter})", function.name);
        let parameter = lsp::ParameterInformation {
            label: parameter.to_owned().into(),
            documentation: None,
        };
        (label, function.doc, vec![parameter], 0)
    };
    Some(lsp::SignatureHelp {
        signatures: vec![lsp::SignatureInformation {
            label,
            documentation: Some(markdown(doc.to_owned()).into()),
            parameters: Some(parameters),
            active_parameter: None,
        }],
        active_signature: Some(0),
        active_parameter: Some(narrow(active).into()),
    })
}
