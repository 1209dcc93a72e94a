//! The fonts of the PDF, all part of the program. Out: each font, parsed once; `text::glyphs` lists their characters. No font of the
//! machine is used, so that the same report is bit-identical everywhere.

use std::sync::LazyLock;

use typst::foundations::Bytes;
use typst::text::{Font, FontBook};
use typst::utils::LazyHash;

/// Families of the letters of a figure that is a file. In the PDF a figure has the letters of the page.
pub(crate) const FIGURE_FAMILIES: &str = "DejaVu Sans, Verdana, sans-serif";
/// Families of the letters of the page, in the order in which a letter is looked for; the template names the same.
pub(crate) const PAGE_FAMILIES: &str = "Libertinus Serif, DejaVu Sans";
/// Size of the page's letters over that of a figure's, at which capitals are equally high: 1493/2048 em in DejaVu Sans, 0.647 em in
/// Libertinus Serif. Words are then no wider.
pub(crate) const PAGE_OVER_FIGURE: f64 = 1493.0 / 2048.0 / 0.647;

/// The two fonts of the figures; the report uses them for letters that its text font lacks.
pub(crate) static SANS: &[u8] = include_bytes!("DejaVuSans.ttf");
pub(crate) static SANS_BOLD: &[u8] = include_bytes!("DejaVuSans-Bold.ttf");
/// The fonts of the template.
static OF_THE_PAGE: [&[u8]; 4] = [
    include_bytes!("LibertinusSerif-Regular.otf"),
    include_bytes!("LibertinusSerif-Bold.otf"),
    include_bytes!("LibertinusSerif-Italic.otf"),
    include_bytes!("DejaVuSansMono.ttf"),
];

pub(super) struct Fonts {
    fonts: Vec<Font>,
    book: LazyHash<FontBook>,
}

/// Parsed when the first PDF is made.
pub(super) static FONTS: LazyLock<Fonts> = LazyLock::new(|| {
    let fonts: Vec<Font> = [SANS, SANS_BOLD]
        .into_iter()
        .chain(OF_THE_PAGE)
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
    fn the_list_of_glyphs_is_that_of_the_fonts() {
        let plain = |font: &Font| {
            font.clone().instantiate(
                FontVariant::default(),
                Abs::pt(10.0),
                &FontVariations::default(),
            )
        };
        let instances: Vec<FontInstance> = FONTS.fonts.iter().map(plain).collect();
        // The font has a shape for the character, not only an entry of its table.
        let shape = |font: &FontInstance, c: char| {
            font.ttf().glyph_index(c).is_some_and(|glyph| glyph.0 != 0)
        };
        let differ =
            |c: &char| psd_text::glyphs::has(*c) != instances.iter().any(|font| shape(font, *c));
        let differing: Vec<char> = ('\u{80}'..='\u{1ffff}').filter(differ).take(20).collect();
        assert!(differing.is_empty(), "{differing:?}");
    }
}
