//! `#[derive(Violation)]`: the code, the message, the labels and the help of a violation, from attributes of its struct.
//!
//! ```text
//! #[derive(Violation)]
//! #[violation(E646, "`rate` requires `speed`")]
//! #[help("add a line such as `speed = {usual}`, or remove `rate`")]
//! struct RateWithoutSpeed<'a> {
//!     #[label("reads while moving")]
//!     rate: Span,
//!     #[label("`speed` is missing")]
//!     head: Span,
//!     usual: &'a str,
//! }
//! ```
//!
//! Each text is written as for `format!`, arguments included, with the fields as variables. The first label is where the error is.

use proc_macro2::TokenStream;
use quote::quote;
use syn::parse::{ParseStream, Parser};
use syn::{Attribute, Data, DeriveInput, Error, Fields, Path, Result, Token};

/// Implements the trait `Violation`.
#[proc_macro_derive(Violation, attributes(violation, label, help))]
pub fn violation(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = syn::parse_macro_input!(input as DeriveInput);
    expanded(&input)
        .unwrap_or_else(Error::into_compile_error)
        .into()
}

fn expanded(input: &DeriveInput) -> Result<TokenStream> {
    let name = &input.ident;
    let missing = |what| Error::new_spanned(name, what);
    let fields = match &input.data {
        Data::Struct(data) => match &data.fields {
            Fields::Named(fields) => &fields.named,
            _ => return Err(missing("a violation has named fields")),
        },
        _ => return Err(missing("a violation is a struct")),
    };
    let stated = attribute(&input.attrs, "violation")
        .ok_or_else(|| missing("write `#[violation(CODE, \"message\")]`"))?;
    let (code, message) = code_and_message.parse2(stated.meta.require_list()?.tokens.clone())?;
    let mut said = quote!();
    for field in fields {
        if let Some(label) = attribute(&field.attrs, "label") {
            let (at, text) = (&field.ident, &label.meta.require_list()?.tokens);
            said.extend(quote!(.at(#at, ::std::format_args!(#text).to_string())));
        }
    }
    if let Some(help) = attribute(&input.attrs, "help") {
        let text = &help.meta.require_list()?.tokens;
        said.extend(quote!(.help(::std::format_args!(#text).to_string())));
    }
    let fields = fields.iter().map(|field| &field.ident);
    let (generics, of, bounds) = input.generics.split_for_impl();
    Ok(quote! {
        #[automatically_derived]
        impl #generics ::psd_text::diagnostic::Violation for #name #of #bounds {
            const CODE: ::psd_text::diagnostic::Code = #code;

            fn diagnostic(self) -> ::psd_text::diagnostic::Diagnostic {
                let Self { #(#fields),* } = self;
                ::psd_text::diagnostic::Diagnostic::new(
                    <Self as ::psd_text::diagnostic::Violation>::CODE,
                    ::std::format_args!(#message).to_string(),
                )
                #said
            }
        }
    })
}

fn attribute<'a>(of: &'a [Attribute], name: &str) -> Option<&'a Attribute> {
    of.iter().find(|attribute| attribute.path().is_ident(name))
}

/// `E646, "`rate` requires `speed`"`
fn code_and_message(input: ParseStream<'_>) -> Result<(Path, TokenStream)> {
    let code = input.parse()?;
    input.parse::<Token![,]>()?;
    Ok((code, input.parse()?))
}
