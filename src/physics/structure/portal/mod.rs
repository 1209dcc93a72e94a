//! A portal frame by plastic hinges: fixed feet, a section of the beam and one of the columns, point loads at midspan and at the
//! beam's end. In: geometry, plastic moments, EI or a stiffness. Out: the mechanism that governs, its load, and the elastic stiffness.
//! Axial and shear strains are neglected, and so is the effect of axial force on the plastic moment. The moving mass is in [`mass`].

pub mod limit;
pub mod mass;

/// A portal frame and the loads on it (Melo et al. 2006, Fig. 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Portal {
    /// L \[m\]
    pub span: f64,
    /// h \[m\]
    pub height: f64,
    /// Mp \[N·m\]
    pub plastic_moment: Sections,
    /// EI \[N·m²\]; None if the stiffness is given.
    pub bending_stiffness: Option<Sections>,
    /// Load over its own displacement \[N/m\].
    pub stiffness: f64,
    pub loads: Loads,
    /// None if the plan states no masses.
    pub masses: Option<FrameMasses>,
}

/// The masses of a portal and of its loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameMasses {
    /// q·A \[kg/m\]
    pub per_length: Sections,
    /// At midspan \[kg\]
    pub midspan: f64,
    /// At each corner \[kg\]
    pub corner: f64,
}

/// A property of the beam and of either column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sections {
    pub beam: f64,
    pub column: f64,
}

impl Sections {
    /// One section throughout.
    #[must_use]
    pub const fn same(value: f64) -> Self {
        Self {
            beam: value,
            column: value,
        }
    }

    #[must_use]
    pub fn are_same(self) -> bool {
        self.beam == self.column
    }

    /// The value of a corner, where beam and column meet: the weaker one.
    #[must_use]
    pub const fn corner(self) -> f64 {
        self.beam.min(self.column)
    }
}

/// The loads on the frame. The load of the specimen is W + H in the given ratio. Its displacement is the one on which it does work:
/// (W·midspan deflection + H·sway)/(W + H).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Loads {
    /// H at the beam's level.
    Sway,
    /// W at midspan.
    Beam,
    /// W₀ and H₀ \[N\], growing together.
    Combined { beam_load: f64, sway_load: f64 },
}

/// The mechanisms by the positions of their hinges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mechanism {
    /// Both corners and midspan.
    Beam,
    /// Feet and heads of both columns.
    Sway,
    /// Both feet, midspan and the far corner.
    Combined,
}

impl Mechanism {
    pub const ALL: [Self; 3] = [Self::Beam, Self::Sway, Self::Combined];

    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Beam => "beam",
            Self::Sway => "sway",
            Self::Combined => "combined",
        }
    }

    /// The positions of its hinges.
    #[must_use]
    pub const fn hinges(self) -> &'static str {
        match self {
            Self::Beam => "hinges at both corners and midspan",
            Self::Sway => "hinges at both feet and both corners",
            Self::Combined => "hinges at both feet, midspan and the far corner",
        }
    }
}

impl Loads {
    /// W and H as fractions of W + H.
    #[must_use]
    pub fn shares(self) -> (f64, f64) {
        match self {
            Self::Sway => (0.0, 1.0),
            Self::Beam => (1.0, 0.0),
            Self::Combined {
                beam_load,
                sway_load,
            } => (
                beam_load / (beam_load + sway_load),
                sway_load / (beam_load + sway_load),
            ),
        }
    }
}

impl Portal {
    /// A portal of flexural rigidity `bending_stiffness` EI \[N·m²\].
    #[must_use]
    pub fn of_sections(
        span: f64,
        height: f64,
        plastic_moment: Sections,
        bending_stiffness: Sections,
        loads: Loads,
    ) -> Self {
        let each = elastic_stiffnesses(span, height, bending_stiffness);
        let (on_beam, on_sway) = loads.shares();
        // Neither load moves the point of the other (one is symmetric, the other antisymmetric): the flexibilities add with the squares
        // of the fractions.
        let stiffness = 1.0 / (on_beam * on_beam / each.beam + on_sway * on_sway / each.sway);
        Self {
            span,
            height,
            plastic_moment,
            bending_stiffness: Some(bending_stiffness),
            stiffness,
            loads,
            masses: None,
        }
    }

    /// The same portal with these masses.
    #[must_use]
    pub const fn with_masses(self, masses: Option<FrameMasses>) -> Self {
        Self { masses, ..self }
    }

    /// Load W + H at which the frame would collapse by one mechanism \[N\]; infinite if the loads do no work on it. Work of the loads =
    /// work of the hinges, for a rotation θ of a column or half-beam, with `M_b` of the beam, `M_c` of the columns and m the smaller of
    /// both at a corner: beam W·(L/2)θ = (m + 2M_b + m)θ; sway H·hθ = (2M_c + 2m)θ; combined W·(L/2)θ + H·hθ = (2M_c + 2M_b + 2m)θ. With
    /// one section 4Mp, 4Mp and 6Mp.
    #[must_use]
    pub fn collapse_load(&self, mechanism: Mechanism) -> f64 {
        let (beam, sway) = self.loads.shares();
        let (on_beam, on_sway) = (beam * self.span / 2.0, sway * self.height);
        let Sections { beam, column } = self.plastic_moment;
        let corner = self.plastic_moment.corner();
        let (hinges, work_travel) = match mechanism {
            Mechanism::Beam => (2.0 * (corner + beam), on_beam),
            Mechanism::Sway => (2.0 * (column + corner), on_sway),
            Mechanism::Combined => (2.0 * (column + beam + corner), on_beam + on_sway),
        };
        hinges / work_travel
    }

    /// The mechanism with the smallest load, which governs.
    #[must_use]
    pub fn mechanism(&self) -> Mechanism {
        let least = Mechanism::ALL
            .into_iter()
            .min_by(|a, b| self.collapse_load(*a).total_cmp(&self.collapse_load(*b)));
        least.unwrap_or(Mechanism::Combined)
    }

    /// Load W + H at which the frame collapses \[N\].
    #[must_use]
    pub fn capacity(&self) -> f64 {
        self.collapse_load(self.mechanism())
    }
}

/// Stiffness of each load over its own displacement \[N/m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticStiffnesses {
    /// W/δ
    pub beam: f64,
    /// H/Δ
    pub sway: f64,
}

/// By slope-deflection, k = (EI_b/L)/(EI_c/h).
///
/// Sway, joint rotations θ, column rotation ψ = Δ/h: joint 4θ − 6ψ + 6kθ = 0, so θ = 3ψ/(2 + 3k); shear
/// H·h = 2(EI_c/h)(12ψ − 6θ), so H/Δ = (24EI_c/h³)(6k + 1)/(6k + 4).
/// Midspan load, joint rotations ±θ: 4EI_cθ/h + 2EI_bθ/L = WL/8, and the midspan deflection WL³/192EI_b + θL/4 gives
/// W/δ = (192EI_b/L³)(k + 2)/(4k + 2).
#[must_use]
pub fn elastic_stiffnesses(
    span: f64,
    height: f64,
    bending_stiffness: Sections,
) -> ElasticStiffnesses {
    let Sections {
        beam: of_beam,
        column: of_columns,
    } = bending_stiffness;
    let k = of_beam / of_columns * (height / span);
    ElasticStiffnesses {
        beam: 192.0 * of_beam / span.powi(3) * (k + 2.0) / (4.0 * k + 2.0),
        sway: 24.0 * of_columns / height.powi(3) * (6.0 * k + 1.0) / (6.0 * k + 4.0),
    }
}
