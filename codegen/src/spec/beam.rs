//! Beams: flexible links of rigid finite elements.

use crate::node::{Content, Definition, Form, FromNode, Reader, Unread};

use super::{Angle, Either, Inertia, Number, SlidesIn, Spanned, Vector};

/// A beam along x of its link: `sections`, `material` and `section`, or `elements` and `springs` one by one.
#[derive(Clone, Debug, FromNode)]
pub struct Beam {
    /// Length.
    #[key(unit = "m", limit = Positive)]
    pub length: Spanned<Number>,
    /// Number of sections, an integer from 1 to 1000 (n springs between n + 1 rigid elements), or `rigid`. A section ends wherever something acts on
    /// the beam; between these places they are equal, and at least one.
    pub sections: Option<Spanned<Sections>>,
    /// Material: the name of an entry of `materials`, or a mapping of its properties.
    pub material: Option<Spanned<Either<String, Material>>>,
    /// Cross-section, exactly one shape.
    pub section: Option<Spanned<Section>>,
    /// Instead of `section`: parts with different sections, from the beginning to the tip.
    pub parts: Option<Spanned<Vec<Spanned<BeamPart>>>>,
    /// Curvature at rest. Default straight.
    pub bend: Option<Spanned<Bend>>,
    /// Additional distributed mass, with the section's radii of gyration. Default 0.
    #[key(unit = "kg/m", limit = NotNegative)]
    pub extra_mass: Option<Spanned<Number>>,
    /// Factor by which stresses must stay below the material's `yield_stress`. Default 1.5.
    #[key(unit = "1", limit = Positive, usual = 0.0..20.0)]
    pub safety_factor: Option<Spanned<Number>>,
    /// Damping of the springs. Default none.
    pub damping: Option<Spanned<BeamDamping>>,
    /// Rotation between two elements. Default `symmetric`.
    pub section_joint: Option<Spanned<SectionJoint>>,
    /// Rigid elements one by one, n + 1 of them.
    pub elements: Option<Spanned<Vec<Spanned<Element>>>>,
    /// Springs between the elements, n of them.
    pub springs: Option<Spanned<Vec<Spanned<Spring>>>>,
    /// The beam in which it slides, for a stage of a telescope. The joint of its link is then `{prismatic: {axis: x}}`.
    pub slides_in: Option<Spanned<SlidesIn>>,
}

/// Number of sections of a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sections {
    /// The number as written, checked later.
    Count(f64),
    /// No sections: the beam does not bend.
    Rigid,
}

impl FromNode for Sections {
    const FORM: Form = Form::Defined {
        definition: &Definition {
            name: "Sections",
            about: "",
            form: Form::AnyOf { forms: &[Form::Integer { least: 1, most: 1000 }, Form::Words { words: &["rigid"] }] },
        },
    };
    fn from_node(reader: Reader) -> Result<Self, Unread> {
        match reader.content()? {
            Content::Number(count) => Ok(Sections::Count(*count)),
            Content::Text(word) if word == "rigid" => Ok(Sections::Rigid),
            _ => Err(Unread::Expected("an integer from 1 to 1000, or `rigid`".into())),
        }
    }
}

/// A part of a beam with its own section.
#[derive(Clone, Debug, FromNode)]
pub struct BeamPart {
    /// Length.
    #[key(unit = "m", limit = Positive)]
    pub length: Spanned<Number>,
    /// Cross-section; for a tapered part, that at its beginning.
    pub section: Spanned<Section>,
    /// Cross-section of a tapered part at its end, of the same shape. Default: the part is not tapered.
    pub to: Option<Spanned<Section>>,
}

/// Angles between the beginning and the tip of a curved beam at rest, an arc.
#[derive(Clone, Debug, FromNode)]
#[key(unit = "rad")]
pub struct Bend {
    /// About z: curved in the x–y plane.
    pub psi: Option<Spanned<Angle>>,
    /// About y: curved in the x–z plane.
    pub theta: Option<Spanned<Angle>>,
}

/// Rotation between two rigid elements of a beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromNode)]
pub enum SectionJoint {
    /// By the rotation vector (phi, theta, psi), which treats both directions of bending equally.
    Symmetric,
    /// By successive rotations as in the paper: psi, theta, phi.
    Paper,
}

/// An isotropic elastic material.
#[derive(Clone, Debug, FromNode)]
pub struct Material {
    /// Young's modulus.
    #[key("E", unit = "Pa", limit = Positive)]
    pub youngs_modulus: Spanned<Number>,
    /// Shear modulus.
    #[key("G", unit = "Pa", limit = Positive)]
    pub shear_modulus: Spanned<Number>,
    /// Density.
    #[key(unit = "kg/m³", limit = Positive)]
    pub density: Spanned<Number>,
    /// Yield stress. Default none: no utilisation is computed.
    #[key(unit = "Pa", limit = Positive)]
    pub yield_stress: Option<Spanned<Number>>,
}

/// Cross-section of a beam: height along y, width along z.
#[derive(Clone, Debug, FromNode)]
#[key(unit = "m", limit = Positive)]
pub enum Section {
    /// Hollow rectangle with walls of one thickness.
    Box {
        /// Outer height along y.
        height: Spanned<Number>,
        /// Outer width along z.
        width: Spanned<Number>,
        /// Thickness of the walls.
        thickness: Spanned<Number>,
    },
    /// Hollow rectangle of plates, whose flanges and webs differ in thickness.
    WeldedBox {
        /// Outer height along y.
        height: Spanned<Number>,
        /// Outer width along z.
        width: Spanned<Number>,
        /// Thickness of the plates above and below.
        flange: Spanned<Number>,
        /// Thickness of the plates at the sides.
        web: Spanned<Number>,
    },
    /// Hollow circle.
    Tube {
        /// Outer diameter.
        diameter: Spanned<Number>,
        /// Thickness of the wall.
        thickness: Spanned<Number>,
    },
    /// Solid rectangle.
    Solid {
        /// Height along y.
        height: Spanned<Number>,
        /// Width along z.
        width: Spanned<Number>,
    },
    /// Solid circle.
    Circle {
        /// Diameter.
        diameter: Spanned<Number>,
    },
    /// Any section, given by its properties.
    Numbers {
        /// Area.
        #[key(unit = "m²", limit = Positive)]
        area: Spanned<Number>,
        /// Second moment of area ∫ z² dA, for bending in the x–z plane.
        #[key("Jy", unit = "m⁴", limit = Positive)]
        jy: Spanned<Number>,
        /// Second moment of area ∫ y² dA, for bending in the x–y plane.
        #[key("Jz", unit = "m⁴", limit = Positive)]
        jz: Spanned<Number>,
        /// Torsion constant.
        #[key("Jo", unit = "m⁴", limit = Positive)]
        jo: Spanned<Number>,
        /// Moduli for stresses. Default none: no stresses are computed.
        moduli: Option<Box<Spanned<Moduli>>>,
    },
}

/// Moduli of a section that is given by its properties.
#[derive(Clone, Debug, FromNode)]
pub struct Moduli {
    /// Section modulus for bending about y.
    #[key("Wy", unit = "m³", limit = Positive)]
    pub wy: Spanned<Number>,
    /// Section modulus for bending about z.
    #[key("Wz", unit = "m³", limit = Positive)]
    pub wz: Spanned<Number>,
    /// Section modulus for torsion.
    #[key("Wt", unit = "m³", limit = Positive)]
    pub wt: Spanned<Number>,
    /// Shear area along y: the force divided by the maximum shear stress.
    #[key("Ay", unit = "m²", limit = Positive)]
    pub ay: Spanned<Number>,
    /// Shear area along z.
    #[key("Az", unit = "m²", limit = Positive)]
    pub az: Spanned<Number>,
}

/// Damping of the springs of a beam, exactly one of these.
#[derive(Clone, Debug, FromNode)]
pub enum BeamDamping {
    /// Kelvin–Voigt: damping = beta × stiffness; one number, or one per direction.
    #[key(unit = "s", limit = NotNegative)]
    Beta(Spanned<Either<Number, Directions>>),
    /// Damping of each spring.
    #[key(unit = "N m s/rad", limit = NotNegative)]
    Coefficients(Directions),
}

/// One number per direction of a spring.
#[derive(Clone, Debug, FromNode)]
#[key(unit = "…")]
pub struct Directions {
    /// Bending in the x–y plane, about z.
    pub psi: Spanned<Number>,
    /// Bending in the x–z plane, about y.
    pub theta: Spanned<Number>,
    /// Torsion, about x.
    pub phi: Spanned<Number>,
}

/// A rigid element of a beam.
#[derive(Clone, Debug, FromNode)]
pub struct Element {
    /// Length along x.
    #[key(unit = "m", limit = Positive)]
    pub length: Spanned<Number>,
    /// Mass.
    #[key(unit = "kg", limit = Mass)]
    pub mass: Spanned<Number>,
    /// Centre of mass in the element's frame, whose origin is at its start.
    #[key(unit = "m")]
    pub com: Spanned<Vector>,
    /// Inertia.
    pub inertia: Spanned<Inertia>,
}

/// A spring between two rigid elements.
#[derive(Clone, Debug, FromNode)]
pub struct Spring {
    /// Stiffness.
    #[key(unit = "N m/rad", limit = NotNegative)]
    pub stiffness: Spanned<Directions>,
    /// Damping. Default none.
    #[key(unit = "N m s/rad", limit = NotNegative)]
    pub damping: Option<Spanned<Directions>>,
}
