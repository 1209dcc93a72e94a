//! The fonts of a paged report, all part of the program. Out: each parsed once; which characters they have is said in `legible`. No font of
//! the machine is looked for, so that the same report has the same bytes everywhere.

use std::sync::LazyLock;

use typst::foundations::Bytes;
use typst::text::{Font, FontBook};
use typst::utils::LazyHash;

/// The two fonts of the figures; letters that the text's own font lacks are set in them.
pub(crate) static SANS: &[u8] = include_bytes!("../fonts/DejaVuSans.ttf");
pub(crate) static SANS_BOLD: &[u8] = include_bytes!("../fonts/DejaVuSans-Bold.ttf");

pub(super) struct Fonts {
    fonts: Vec<Font>,
    book: LazyHash<FontBook>,
}

/// Parsed when a report is first set, and never by a command that sets none.
pub(super) static FONTS: LazyLock<Fonts> = LazyLock::new(|| {
    /// Of the fonts that come with typst those the template names: Libertinus Serif in three cuts, DejaVu Sans Mono.
    const NAMED: [usize; 4] = [0, 1, 2, 16];
    let theirs = typst_assets::fonts()
        .enumerate()
        .filter(|(place, _)| NAMED.contains(place))
        .map(|(_, font)| font);
    let fonts: Vec<Font> = [SANS, SANS_BOLD]
        .into_iter()
        .chain(theirs)
        .flat_map(|font| Font::iter(Bytes::new(font)))
        .collect();
    let book = LazyHash::new(FontBook::from_fonts(&fonts));
    Fonts { fonts, book }
});

impl Fonts {
    pub fn book(&self) -> &LazyHash<FontBook> {
        &self.book
    }

    pub fn get(&self, index: usize) -> Option<Font> {
        self.fonts.get(index).cloned()
    }
}

#[cfg(test)]
mod tests {
    use typst::layout::Abs;
    use typst::text::{FontInstance, FontVariant, FontVariations};

    use super::{FONTS, Font};

    #[test]
    fn the_families_of_the_template_are_here() {
        let families: Vec<String> = (0..6)
            .map(|index| {
                FONTS
                    .get(index)
                    .map_or_else(String::new, |font| font.info().family.clone())
            })
            .collect();
        let serif = "Libertinus Serif";
        assert_eq!(
            families,
            [
                "DejaVu Sans",
                "DejaVu Sans",
                serif,
                serif,
                serif,
                "DejaVu Sans Mono"
            ]
        );
    }

    #[test]
    fn what_is_called_legible_is_what_the_fonts_have() {
        let plain = |font: &Font| {
            font.clone().instantiate(
                FontVariant::default(),
                Abs::pt(10.0),
                &FontVariations::default(),
            )
        };
        let instances: Vec<FontInstance> = FONTS.fonts.iter().map(plain).collect();
        // A shape, not only a place in a table of places.
        let shape = |font: &FontInstance, c: char| {
            font.ttf().glyph_index(c).is_some_and(|glyph| glyph.0 != 0)
        };
        let differ =
            |c: &char| crate::text::glyphs::has(*c) != instances.iter().any(|font| shape(font, *c));
        let differing: Vec<char> = ('\u{80}'..='\u{1ffff}').filter(differ).take(20).collect();
        assert!(differing.is_empty(), "{differing:?}");
    }
}
