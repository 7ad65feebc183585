//! Beams: flexible links of rigid finite elements.

use crate::node::{Content, Definition, Form, FromNode, Reader, Unread};

use super::{Angle, Either, Inertia, Number, SlidesIn, Spanned, Vector};

/// A beam along x of its link: `sections`, `material` and `section`, or `elements` and `springs` one by one.
#[derive(Clone, Debug, FromNode)]
pub struct Beam {
    /// Length, m.
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
    /// Additional distributed mass, kg/m, with the section's radii of gyration. Default 0.
    pub extra_mass: Option<Spanned<Number>>,
    /// Factor by which stresses must stay below the material's `yield_stress`. Default 1.5.
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
    /// Length, m.
    pub length: Spanned<Number>,
    /// Cross-section; for a tapered part, that at its beginning.
    pub section: Spanned<Section>,
    /// Cross-section of a tapered part at its end, of the same shape. Default: the part is not tapered.
    pub to: Option<Spanned<Section>>,
}

/// Angles between the beginning and the tip of a curved beam at rest, an arc.
#[derive(Clone, Debug, FromNode)]
pub struct Bend {
    /// About z: curved in the x–y plane, rad.
    pub psi: Option<Spanned<Angle>>,
    /// About y: curved in the x–z plane, rad.
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
    /// Young's modulus, Pa.
    #[key("E")]
    pub youngs_modulus: Spanned<Number>,
    /// Shear modulus, Pa.
    #[key("G")]
    pub shear_modulus: Spanned<Number>,
    /// Density, kg/m³.
    pub density: Spanned<Number>,
    /// Yield stress, Pa. Default none: no utilisation is computed.
    pub yield_stress: Option<Spanned<Number>>,
}

/// Cross-section of a beam: height along y, width along z.
#[derive(Clone, Debug, FromNode)]
pub enum Section {
    /// Hollow rectangle with walls of one thickness.
    Box {
        /// Outer height along y, m.
        height: Spanned<Number>,
        /// Outer width along z, m.
        width: Spanned<Number>,
        /// Thickness of the walls, m.
        thickness: Spanned<Number>,
    },
    /// Hollow rectangle of plates, whose flanges and webs differ in thickness.
    WeldedBox {
        /// Outer height along y, m.
        height: Spanned<Number>,
        /// Outer width along z, m.
        width: Spanned<Number>,
        /// Thickness of the plates above and below, m.
        flange: Spanned<Number>,
        /// Thickness of the plates at the sides, m.
        web: Spanned<Number>,
    },
    /// Hollow circle.
    Tube {
        /// Outer diameter, m.
        diameter: Spanned<Number>,
        /// Thickness of the wall, m.
        thickness: Spanned<Number>,
    },
    /// Solid rectangle.
    Solid {
        /// Height along y, m.
        height: Spanned<Number>,
        /// Width along z, m.
        width: Spanned<Number>,
    },
    /// Solid circle.
    Circle {
        /// Diameter, m.
        diameter: Spanned<Number>,
    },
    /// Any section, given by its properties.
    Numbers {
        /// Area, m².
        area: Spanned<Number>,
        /// Second moment of area ∫ z² dA, for bending in the x–z plane, m⁴.
        #[key("Jy")]
        jy: Spanned<Number>,
        /// Second moment of area ∫ y² dA, for bending in the x–y plane, m⁴.
        #[key("Jz")]
        jz: Spanned<Number>,
        /// Torsion constant, m⁴.
        #[key("Jo")]
        jo: Spanned<Number>,
        /// Moduli for stresses. Default none: no stresses are computed.
        moduli: Option<Box<Spanned<Moduli>>>,
    },
}

/// Moduli of a section that is given by its properties.
#[derive(Clone, Debug, FromNode)]
pub struct Moduli {
    /// Section modulus for bending about y, m³.
    #[key("Wy")]
    pub wy: Spanned<Number>,
    /// Section modulus for bending about z, m³.
    #[key("Wz")]
    pub wz: Spanned<Number>,
    /// Section modulus for torsion, m³.
    #[key("Wt")]
    pub wt: Spanned<Number>,
    /// Shear area along y, m²: the force divided by the maximum shear stress.
    #[key("Ay")]
    pub ay: Spanned<Number>,
    /// Shear area along z, m².
    #[key("Az")]
    pub az: Spanned<Number>,
}

/// Damping of the springs of a beam, exactly one of these.
#[derive(Clone, Debug, FromNode)]
pub enum BeamDamping {
    /// Kelvin–Voigt: damping = beta × stiffness, s; one number, or one per direction.
    Beta(Spanned<Either<Number, Directions>>),
    /// Damping of each spring, N m s/rad.
    Coefficients(Directions),
}

/// One number per direction of a spring.
#[derive(Clone, Debug, FromNode)]
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
    /// Length along x, m.
    pub length: Spanned<Number>,
    /// Mass, kg.
    pub mass: Spanned<Number>,
    /// Centre of mass in the element's frame, whose origin is at its start, m.
    pub com: Spanned<Vector>,
    /// Inertia.
    pub inertia: Spanned<Inertia>,
}

/// A spring between two rigid elements.
#[derive(Clone, Debug, FromNode)]
pub struct Spring {
    /// Stiffness, N m/rad.
    pub stiffness: Spanned<Directions>,
    /// Damping, N m s/rad. Default none.
    pub damping: Option<Spanned<Directions>>,
}
