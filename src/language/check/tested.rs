//! Which specimen a procedure tests: the one it names, else the only one declared. In: a block. Out: its specimen, or a fault.

use super::checker::Checker;
use super::messages::{names, whole as fault};
use super::scope::{DeclaredBlock, Meaning};
use crate::language::syntax::ast::ExprKind;
use crate::schema::{self, Kind};
use crate::text::diagnostic::Code;

impl Checker<'_> {
    /// The specimen of a procedure as its place in the plan.
    pub fn specimen_of(&mut self, block: usize) -> Option<usize> {
        self.specimen_block(block)
            .map(|specimen| self.scope.place_in_kind(specimen))
    }

    /// The specimen a procedure names, else the only one declared.
    pub fn specimen_block(&mut self, block: usize) -> Option<usize> {
        if self.given(block, "specimen").is_some() {
            return self.reference(block, "specimen", Kind::Specimen);
        }
        let mut declared = self.scope.of_kind(Kind::Specimen);
        match (declared.len(), declared.next()) {
            (1, Some((only, _))) => Some(only),
            (_, None) => {
                self.specimen_needed(block);
                None
            }
            (several, _) => {
                let head = self.scope.blocks[block].block.head;
                let named = |(_, specimen): (usize, &DeclaredBlock<'_>)| {
                    (
                        specimen.name.map(|name| name.node.clone()),
                        specimen.block.head,
                    )
                };
                let declared = self
                    .scope
                    .of_kind(Kind::Specimen)
                    .map(named)
                    .filter_map(|(name, head)| Some((name?, head)));
                let shown: Vec<_> = declared.take(fault::SHOWN).collect();
                self.fail(fault::several_specimens(head, &shown, several))
            }
        }
    }

    /// The same, where what is wrong with it is said by whoever reads the block.
    pub fn tested(&self, block: usize) -> Option<usize> {
        let mut declared = self.scope.of_kind(Kind::Specimen);
        let Some((_, written)) = self.given(block, "specimen") else {
            return declared
                .next()
                .filter(|_| declared.len() == 0)
                .map(|(only, _)| only);
        };
        let ExprKind::Name(name) = &written.value.kind else {
            return None;
        };
        match self.scope.meaning(name) {
            Some(Meaning::Block(index)) if self.scope.blocks[index].kind.kind == Kind::Specimen => {
                Some(index)
            }
            _ => None,
        }
    }

    /// Says once that nothing is there to be tested.
    pub fn specimen_needed(&mut self, block: usize) {
        let none = self.scope.of_kind(Kind::Specimen).next().is_none();
        // A block whose keyword is no word of the language may be the one that is missing.
        let said = self
            .faults
            .iter()
            .any(|fault| matches!(fault.code, Code::MissingBlock | Code::UnknownBlock));
        if none && !said && !self.names_lost && self.unread.is_empty() {
            let head = self.scope.blocks[block].block.head;
            self.faults
                .push(names::missing_block(schema::block(Kind::Specimen), head));
        }
    }
}
