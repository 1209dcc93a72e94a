//! Completion: what can be written at a cursor, the most likely first. In: a position. Out: items, in order.

use std::fmt::Write as _;
use std::path::Path;

use gen_lsp_types as lsp;
use psd_plan::schema::sections::SECTIONS;
use psd_plan::schema::{
    self, BLOCKS, BlockKind, CONSTANTS, FUNCTIONS, Field, FieldType, ITEM_WORDS, Kind, Naming,
    Presence, ResultKind, Variant,
};
use psd_plan::{FigureKind, ProcedureBlock};
use psd_text::units::Dimension;

use super::{View, describe, markdown};
use crate::cursor::{Cursor, Inside, Place, Value, is_in_plan, plan_text};
use crate::documents::beside;
use crate::occurrences::{Meaning, Symbol, SymbolKind};
use crate::units;

/// The items, from the most likely one.
struct Items<'v, 's> {
    view: &'v View<'s>,
    /// What they replace.
    range: lsp::Range,
    list: Vec<lsp::CompletionItem>,
}

pub fn completion(view: &View<'_>, params: &lsp::CompletionParams) -> lsp::CompletionList {
    let offset = view
        .text()
        .offset(params.text_document_position_params.position);
    let text = view.text().as_str();
    let mut list = Vec::new();
    if is_in_plan(view.name(), text, offset) {
        let plan = plan_text(view.name(), text);
        let cursor = Cursor::of(&plan, offset);
        let mut items = Items {
            view,
            range: view.range(cursor.prefix.clone()),
            list: Vec::new(),
        };
        items.add_place(&cursor, offset);
        list = items.list;
    }
    // A space opens the list only where a value or a unit is wanted.
    let context = params.context.as_ref();
    let by = context.and_then(|context| context.trigger_character.as_deref());
    if by == Some(" ")
        && list
            .first()
            .is_some_and(|first| first.kind == Some(lsp::CompletionItemKind::Keyword))
    {
        list.clear();
    }
    lsp::CompletionList {
        is_incomplete: false,
        item_defaults: None,
        apply_kind: None,
        items: list,
    }
}

impl<'v> Items<'v, '_> {
    fn add_place(&mut self, cursor: &Cursor<'_>, offset: usize) {
        match &cursor.place {
            Place::Nothing => {}
            Place::Item(words) => self.items(words),
            Place::Key(inside) => self.keys(inside),
            Place::Value(value) => self.value(value, offset),
            Place::Unit(value) => self.units(value),
            Place::Member { owner, value } => self.members(owner, value),
            Place::Text(value) => self.texts(value),
        }
    }

    fn add(&mut self, label: &str, kind: lsp::CompletionItemKind, detail: &str, doc: &str) {
        self.push(label, label, kind, (detail, doc));
    }

    /// Adds an item that writes another text than its label; placeholders are `${1:text}`.
    fn push(
        &mut self,
        label: &str,
        snippet: &str,
        kind: lsp::CompletionItemKind,
        about: (&str, &str),
    ) {
        let is_snippet = snippet.contains("${");
        let (detail, doc) = about;
        let new_text = if is_snippet && !self.view.snippets {
            without_placeholders(snippet)
        } else {
            snippet.to_owned()
        };
        if self.list.iter().any(|item| item.label == label) {
            return;
        }
        let edit = lsp::TextEdit {
            range: self.range,
            new_text,
        };
        self.list.push(lsp::CompletionItem {
            label: label.to_owned(),
            kind: Some(kind),
            detail: (!detail.is_empty()).then(|| detail.to_owned()),
            documentation: (!doc.is_empty()).then(|| markdown(doc.to_owned()).into()),
            sort_text: Some(format!("{:04}", self.list.len())),
            insert_text_format: (is_snippet && self.view.snippets)
                .then_some(lsp::InsertTextFormat::Snippet),
            text_edit: Some(edit.into()),
            ..lsp::CompletionItem::default()
        });
    }

    /// The start of an item: blocks with their required fields, and the other items.
    fn items(&mut self, words: &[&str]) {
        // A library has declarations only, and a block without a name is there once.
        let once = |kind: &&&BlockKind| {
            !matches!(kind.naming, Naming::Unnamed | Naming::Titled)
                || !self.view.analysis.trees.iter().flat_map(|tree| &tree.items).any(|item| {
                    matches!(&item.kind, psd_language::syntax::ast::ItemKind::Block(block)
                        if block.words.first().map(|word| word.node.as_str()) == Some(kind.keyword[0]))
                })
        };
        let kinds: Vec<&&BlockKind> = BLOCKS.iter().filter(once).collect();
        for kind in kinds {
            if kind.keyword.len() > words.len() && kind.keyword.starts_with(words) {
                let label = kind.keyword[words.len()..].join(" ");
                let snippet = self.block(kind);
                let snippet = snippet
                    .strip_prefix(&words.join(" "))
                    .unwrap_or(&snippet)
                    .trim_start();
                self.push(
                    &label,
                    snippet,
                    lsp::CompletionItemKind::Keyword,
                    (kind.doc, &describe::block(kind)),
                );
            }
        }
        if words.is_empty() {
            for (word, snippet) in ITEM_WORDS.iter().zip([
                "use \"${1:lib/file.psd}\"",
                "param ${1:name} = ${2:1 m/s} between ${3:0.5 m/s .. 3 m/s}",
                "let ${1:name} = ${2:value}",
                "require \"${1:name}\" ${2:condition}",
            ]) {
                self.push(word, snippet, lsp::CompletionItemKind::Keyword, ("", ""));
            }
        }
    }

    /// A block with its required fields.
    fn block(&self, kind: &BlockKind) -> String {
        let number = std::cell::Cell::new(0);
        let placeholder = |text: &str| {
            number.set(number.get() + 1);
            format!("${{{}:{text}}}", number.get())
        };
        let mut snippet = describe::head(kind, &placeholder);
        let required = kind
            .fields
            .iter()
            .filter(|field| field.presence == Presence::Required);
        for field in required {
            let value = placeholder(&self.example(field));
            let _ = write!(snippet, "\n  {} = {value}", field.name);
        }
        snippet.push_str(if snippet.contains('\n') {
            "\n}"
        } else {
            "\n  ${0}\n}"
        });
        snippet
    }

    /// The value of a field in its example; the only block of a kind where the field names one.
    fn example(&self, field: &Field) -> String {
        if let FieldType::Reference(kind) = field.ty {
            let mut named = self.of_kind(kind);
            if let (Some(only), None) = (named.next(), named.next()) {
                return only.name.clone();
            }
        }
        let example = field
            .example
            .split_once('=')
            .map_or("", |(_, value)| value.trim());
        example.to_owned()
    }

    fn symbols(&self) -> impl Iterator<Item = &'v Symbol> + use<'v> {
        self.view.analysis.occurrences.symbols.iter()
    }

    fn of_kind(&self, kind: Kind) -> impl Iterator<Item = &'v Symbol> + use<'v> {
        self.symbols()
            .filter(move |symbol| symbol.kind == SymbolKind::Block(kind))
    }

    /// The fields that a block does not state, the required ones first.
    fn keys(&mut self, inside: &Inside<'_>) {
        let Some(kind) = inside.kind else { return };
        let mut stated = inside.keys.iter().filter_map(|key| kind.field(key));
        let is_frame = stated.any(|field| field.of_frames);
        let rank = |field: &Field| match field.presence {
            Presence::Required => 0,
            Presence::RequiredOn(..) => 1,
            _ if field.advanced => 4,
            _ if field.of_frames && !is_frame || field.real_rig_only => 3,
            _ => 2,
        };
        let mut fields: Vec<&Field> = kind
            .fields
            .iter()
            .filter(|field| !inside.keys.contains(&field.name))
            .collect();
        fields.sort_by_key(|field| rank(field));
        for field in fields {
            let example = self.example(field);
            let value = if example.is_empty() {
                String::new()
            } else {
                format!("${{1:{example}}}")
            };
            let snippet = format!("{} = {value}", field.name);
            self.push(
                field.name,
                &snippet,
                lsp::CompletionItemKind::Field,
                (&describe::short(field), &describe::field(field)),
            );
        }
    }

    fn variants(&mut self, variants: &[Variant]) {
        for variant in variants {
            let required: Vec<String> = variant
                .arguments
                .iter()
                .filter(|argument| argument.presence == Presence::Required)
                .enumerate()
                .map(|(at, argument)| {
                    let example = argument
                        .example
                        .split_once(':')
                        .map_or("", |(_, value)| value.trim());
                    format!("{}: ${{{}:{example}}}", argument.name, at + 1)
                })
                .collect();
            let snippet = match (required.is_empty(), variant.arguments.is_empty()) {
                (_, true) => variant.name.to_owned(),
                (true, false) => format!("{}(${{1:}})", variant.name),
                (false, false) => format!("{}({})", variant.name, required.join(", ")),
            };
            self.push(
                variant.name,
                &snippet,
                lsp::CompletionItemKind::EnumMember,
                (variant.doc, &describe::variant(variant)),
            );
        }
    }

    fn value(&mut self, value: &Value<'_>, offset: usize) {
        if value.is_complete {
            return self.operators(value);
        }
        if let Some(call) = &value.call
            && let Some(variant) = call.variant
            && call.argument.is_none()
        {
            let open = variant
                .arguments
                .iter()
                .filter(|argument| !call.named.contains(&argument.name));
            let mut open: Vec<&Field> = open.collect();
            open.sort_by_key(|argument| argument.presence != Presence::Required);
            for argument in open {
                let example = argument
                    .example
                    .split_once(':')
                    .map_or("", |(_, value)| value.trim());
                let snippet = format!("{}: ${{1:{example}}}", argument.name);
                self.push(
                    argument.name,
                    &snippet,
                    lsp::CompletionItemKind::Property,
                    (&describe::short(argument), &describe::field(argument)),
                );
            }
        }
        let Some(field) = value.field else {
            return self.numbers(value, None, offset);
        };
        match field.ty {
            FieldType::Choice(_) | FieldType::Choices(_) | FieldType::Inner | FieldType::Inners => {
                self.variants(value.variants);
                if field.name == schema::methods::TIME_STEP.name {
                    self.numbers(value, Some(Dimension::TIME), offset);
                }
            }
            FieldType::QuantityOr(dimension, _) => {
                self.variants(value.variants);
                self.numbers(value, Some(dimension), offset);
            }
            FieldType::Reference(kind) => {
                for symbol in self.of_kind(kind) {
                    self.add(
                        &symbol.name,
                        lsp::CompletionItemKind::Variable,
                        &schema::block(kind).words(),
                        "",
                    );
                }
            }
            FieldType::Quantity(dimension)
            | FieldType::Quantities(dimension)
            | FieldType::Bounds { dimension, .. }
            | FieldType::Interval(dimension) => self.numbers(value, Some(dimension), offset),
            FieldType::Count => self.numbers(value, Some(Dimension::NUMBER), offset),
            FieldType::Figures => self.figures(value),
            FieldType::ResultName
            | FieldType::ResultNames
            | FieldType::Formula
            | FieldType::ColumnName => {
                self.procedures(None);
                if matches!(field.ty, FieldType::Formula) {
                    self.numbers(value, None, offset);
                }
            }
            FieldType::Condition => {
                let impact = schema::block(Kind::Procedure(ProcedureBlock::Impact));
                self.results(impact.results);
                self.numbers(value, None, offset);
            }
            FieldType::Inputs(variants) => {
                if value.compared.is_empty() {
                    self.inputs();
                } else {
                    self.variants(variants);
                }
            }
            FieldType::Intensity
            | FieldType::InputName
            | FieldType::OfInput
            | FieldType::RangeOfInput => self.inputs(),
            FieldType::RequirementName => {
                for symbol in self
                    .symbols()
                    .filter(|symbol| symbol.kind == SymbolKind::Requirement)
                {
                    self.add(
                        &format!("\"{}\"", symbol.name),
                        lsp::CompletionItemKind::Reference,
                        "requirement",
                        "",
                    );
                }
            }
            FieldType::Text | FieldType::Texts | FieldType::Tolerance => {}
        }
    }

    /// The inputs that a study can change.
    fn inputs(&mut self) {
        for symbol in self
            .symbols()
            .filter(|symbol| symbol.kind == SymbolKind::Param)
        {
            self.add(&symbol.name, lsp::CompletionItemKind::Variable, "param", "");
        }
        self.blocks(|kind| !kind.is_procedure());
    }

    fn blocks(&mut self, wanted: impl Fn(&BlockKind) -> bool) {
        for symbol in self.symbols() {
            if let SymbolKind::Block(kind) = symbol.kind {
                let kind = schema::block(kind);
                if wanted(kind) {
                    self.add(
                        &symbol.name,
                        lsp::CompletionItemKind::Variable,
                        &kind.words(),
                        "",
                    );
                }
            }
        }
    }

    /// Procedures, those alone that begin before an offset of this file.
    fn procedures(&mut self, before: Option<usize>) {
        let file = self.view.file;
        for symbol in self.symbols() {
            let is_earlier = before
                .is_none_or(|offset| symbol.item.file != file || symbol.item.range().end <= offset);
            if let SymbolKind::Block(kind) = symbol.kind
                && schema::block(kind).is_procedure()
                && is_earlier
            {
                self.add(
                    &symbol.name,
                    lsp::CompletionItemKind::Variable,
                    &schema::block(kind).words(),
                    "",
                );
            }
        }
    }

    /// Names of numbers: those of the wanted dimension first.
    fn numbers(&mut self, value: &Value<'_>, dimension: Option<Dimension>, offset: usize) {
        let in_block = value.block.as_ref();
        let is_before_run = value.word == "let" || value.word == "param";
        if value.word == "require" {
            self.procedures(None);
        }
        if value.word == schema::methods::TIME_STEP.name {
            self.add(
                "critical",
                lsp::CompletionItemKind::EnumMember,
                "critical time step",
                "",
            );
        }
        let loader = |file: &str| self.view.load(file);
        let values = self.view.analysis.evaluate(&loader, |checker| {
            let mut found = Vec::new();
            for index in 0..checker.scope.values.len() {
                let declared = &checker.scope.values[index];
                // A value does not name itself.
                let own = declared.value.span.range();
                if own.start <= offset
                    && offset <= own.end
                    && declared.value.span.file == self.view.file
                {
                    continue;
                }
                let (name, keyword) = (declared.name.node.clone(), declared.keyword);
                let typed = checker.declared_value(index, declared.name.span);
                found.push((name, keyword, typed));
            }
            Some(found)
        });
        let mut values = values.unwrap_or_default();
        let fits = |found: Dimension| dimension.is_none_or(|wanted| found == wanted);
        values
            .sort_by_key(|(_, _, typed)| !typed.as_ref().is_none_or(|typed| fits(typed.dimension)));
        for (name, keyword, typed) in values {
            let detail = typed.as_ref().map_or_else(String::new, super::hover::shown);
            self.add(
                &name,
                lsp::CompletionItemKind::Variable,
                &format!("{keyword} {detail}"),
                "",
            );
        }
        if let Some(inside) = in_block {
            if inside.kind.is_some_and(BlockKind::is_procedure) {
                self.procedures(Some(inside.start));
            }
            let kind = inside.kind;
            let siblings = inside.keys.iter().filter(|key| **key != value.word);
            for key in siblings {
                let field = kind.and_then(|kind| kind.field(key));
                if let Some(field) = field.filter(|field| field.ty.is_numeric()) {
                    self.add(
                        key,
                        lsp::CompletionItemKind::Property,
                        &describe::short(field),
                        "",
                    );
                }
            }
        }
        if !is_before_run || in_block.is_some() {
            self.blocks(|kind| !kind.is_procedure() && !kind.exports.is_empty());
        } else {
            self.blocks(|kind| !kind.exports.is_empty());
        }
        for (name, _, doc) in CONSTANTS {
            self.push(name, name, lsp::CompletionItemKind::Constant, ("", doc));
        }
        for shape in SECTIONS {
            self.push(
                shape.name,
                &format!("{}(${{1:}})", shape.name),
                lsp::CompletionItemKind::Function,
                ("section", shape.doc),
            );
        }
        for function in FUNCTIONS {
            self.push(
                function.name,
                &format!("{}(${{1:}})", function.name),
                lsp::CompletionItemKind::Function,
                ("", function.doc),
            );
        }
    }

    fn figures(&mut self, value: &Value<'_>) {
        if value.call.is_some() {
            return self.procedures(None);
        }
        for figure in FigureKind::ALL {
            let name = figure.name();
            self.push(
                name,
                &format!("{name}(${{1:}})"),
                lsp::CompletionItemKind::Function,
                ("figure", ""),
            );
        }
    }

    /// What follows a value.
    fn operators(&mut self, value: &Value<'_>) {
        let words: &[&str] = match (value.word, value.field.map(|field| field.ty)) {
            ("require", _) | (_, Some(FieldType::Condition)) => {
                &["<=", "<", ">=", ">", "within", "and"]
            }
            ("param", _) => &["between"],
            (_, Some(FieldType::Inputs(_))) => &["~"],
            (_, Some(FieldType::Intensity)) => &["in"],
            _ => return,
        };
        for word in words {
            self.add(word, lsp::CompletionItemKind::Operator, "", "");
        }
    }

    /// The units of the dimension that is wanted, else of all usual ones.
    fn units(&mut self, value: &Value<'_>) {
        let dimension = match value.field.map(|field| field.ty) {
            Some(FieldType::Count) => return,
            Some(_) => value.field.and_then(Field::dimension),
            None => None,
        };
        let dimension = dimension.or_else(|| self.compared(value));
        let list = match dimension {
            Some(dimension) => units::units_of(dimension),
            None => [
                Dimension::LENGTH,
                Dimension::FORCE,
                Dimension::MASS,
                Dimension::TIME,
                Dimension::VELOCITY,
                Dimension::STIFFNESS,
                Dimension::ENERGY,
                Dimension::NUMBER,
                Dimension::ACCELERATION,
                Dimension::DAMPING,
                Dimension::PRESSURE,
                Dimension::AREA,
                Dimension::SECOND_MOMENT,
            ]
            .into_iter()
            .flat_map(|dimension| units::units_of(dimension).into_iter().take(6))
            .collect(),
        };
        for unit in list {
            let of = psd_text::units::unit::parse(&unit).map(|unit| unit.dimension.describe());
            self.add(
                &unit,
                lsp::CompletionItemKind::Unit,
                &of.unwrap_or_default(),
                "",
            );
        }
        if matches!(
            value.field.map(|field| field.ty),
            Some(FieldType::Quantities(_))
        ) {
            self.add(
                "step",
                lsp::CompletionItemKind::Operator,
                "step of a range",
                "",
            );
        }
        if value.word == "param" {
            self.add(
                "between",
                lsp::CompletionItemKind::Operator,
                "allowed range",
                "",
            );
        }
        if value.word == "require" {
            self.add("and", lsp::CompletionItemKind::Operator, "", "");
            self.add("of", lsp::CompletionItemKind::Operator, "", "");
        }
    }

    /// The dimension of the value with which a number is compared.
    fn compared(&self, value: &Value<'_>) -> Option<Dimension> {
        let (first, rest) = value.compared.split_first()?;
        let analysis = &self.view.analysis;
        let symbol = analysis
            .occurrences
            .symbols
            .iter()
            .position(|symbol| symbol.name == *first);
        let Some(symbol) = symbol else {
            let impact = schema::block(Kind::Procedure(ProcedureBlock::Impact));
            return impact.result(first).map(|result| result.dimension);
        };
        match (analysis.symbol(symbol).kind, rest.first()) {
            (SymbolKind::Block(kind), Some(member)) => {
                let kind = schema::block(kind);
                let result = kind.result(member).or_else(|| kind.export(member));
                let field = || kind.field(member).and_then(Field::dimension);
                result.map(|result| result.dimension).or_else(field)
            }
            (SymbolKind::Let | SymbolKind::Param, _) => {
                let loader = |file: &str| self.view.load(file);
                let typed = analysis.value_of(&loader, Meaning::Symbol(symbol));
                typed.map(|typed| typed.dimension)
            }
            _ => None,
        }
    }

    fn results(&mut self, results: &[ResultKind]) {
        for result in results {
            let text = describe::result(result);
            self.add(
                result.name,
                lsp::CompletionItemKind::Property,
                result.doc,
                &text,
            );
        }
    }

    fn members(&mut self, owner: &[&str], value: &Value<'_>) {
        let symbol = owner.first().and_then(|first| {
            self.symbols()
                .find(|symbol| symbol.name == *first && symbol.kind != SymbolKind::Requirement)
        });
        let Some(SymbolKind::Block(kind)) = symbol.map(|symbol| symbol.kind) else {
            return;
        };
        let kind = schema::block(kind);
        match owner {
            [_] if kind.kind == Kind::Study => {
                self.push(
                    "probability",
                    "probability(fails: \"${1:requirement}\")",
                    lsp::CompletionItemKind::Method,
                    ("", ""),
                );
            }
            [_] => {
                // A result with the dimension of what is compared comes first.
                let wanted = value.field.and_then(Field::dimension);
                let fits =
                    |result: &&ResultKind| wanted.is_some_and(|wanted| wanted == result.dimension);
                let all = || kind.results.iter().chain(kind.exports);
                for result in all().filter(fits).chain(all()) {
                    let text = describe::result(result);
                    self.add(
                        result.name,
                        lsp::CompletionItemKind::Property,
                        result.doc,
                        &text,
                    );
                }
                if !kind.is_procedure() {
                    for field in kind.fields.iter().filter(|field| field.ty.is_numeric()) {
                        self.add(
                            field.name,
                            lsp::CompletionItemKind::Field,
                            &describe::short(field),
                            &describe::field(field),
                        );
                    }
                }
            }
            [_, member] if kind.result(member).is_some_and(|result| result.measured) => {
                self.add(
                    "u",
                    lsp::CompletionItemKind::Property,
                    "standard uncertainty",
                    "",
                );
            }
            _ => {}
        }
    }

    /// Inside of a string: the files beside the plan, or the names of requirements.
    fn texts(&mut self, value: &Value<'_>) {
        let names_requirement = matches!(
            value.field.map(|field| field.ty),
            Some(FieldType::RequirementName)
        ) || value
            .call
            .as_ref()
            .is_some_and(|call| call.name == "probability");
        if names_requirement {
            for symbol in self
                .symbols()
                .filter(|symbol| symbol.kind == SymbolKind::Requirement)
            {
                self.add(
                    &symbol.name,
                    lsp::CompletionItemKind::Reference,
                    "requirement",
                    "",
                );
            }
        } else if value.word == "use" {
            let folder = beside(&self.view.plan, "");
            let known = self
                .view
                .documents
                .known()
                .filter(|key| *key != self.view.key());
            let files: Vec<String> = known
                .filter_map(|key| Some(key.strip_prefix(&folder)?.to_owned()))
                .collect();
            let is_plan = |file: &&String| {
                Path::new(file)
                    .extension()
                    .is_some_and(|ending| ending == "psd")
            };
            for file in files.iter().filter(is_plan) {
                self.add(file, lsp::CompletionItemKind::File, "", "");
            }
        }
    }
}

/// A snippet as plain text: each placeholder by its text.
fn without_placeholders(snippet: &str) -> String {
    let mut text = String::new();
    let mut rest = snippet;
    while let Some((before, after)) = rest.split_once("${") {
        text.push_str(before);
        let (inside, after) = after.split_once('}').unwrap_or((after, ""));
        text.push_str(inside.split_once(':').map_or("", |(_, shown)| shown));
        rest = after;
    }
    text + rest
}
