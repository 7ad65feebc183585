//! What a link looks like.

use super::{AxisName, Constant, Many, Number, Spanned, Turn, Vector};
use crate::node::FromNode;

/// A form of a link in pictures and exported files, without any effect on its motion: `box`, `cylinder`, `capsule` or `mesh`.
#[derive(Clone, Debug, FromNode)]
pub enum Shape {
    /// A box.
    Box(BoxShape),
    /// A cylinder.
    Cylinder(RoundShape),
    /// A cylinder with half balls at its ends.
    Capsule(RoundShape),
    /// A surface in a file.
    Mesh(MeshShape),
}

/// A box.
#[derive(Clone, Debug, FromNode)]
pub struct BoxShape {
    /// Its sides along x, y, z.
    #[key(unit = "m", limit = Positive)]
    pub size: Spanned<Vector>,
    /// Its middle in the frame of the link (for a beam: undeformed). Default `[0, 0, 0]`.
    #[key(unit = "m")]
    pub at: Option<Spanned<Vector>>,
    /// Its rotation in the frame of the link, as that of a `transform`. Default none.
    pub rotation: Option<Spanned<Many<Turn>>>,
}

/// A cylinder or a capsule.
#[derive(Clone, Debug, FromNode)]
pub struct RoundShape {
    /// Diameter.
    #[key(unit = "m", limit = Positive)]
    pub diameter: Spanned<Number>,
    /// Length along its axis; of a capsule between the middles of its half balls, 0 for a ball.
    #[key(unit = "m", limit = NotNegative)]
    pub length: Spanned<Number>,
    /// Its axis, as turned by `rotation`. Default z.
    pub axis: Option<Spanned<AxisName>>,
    /// Its middle in the frame of the link (for a beam: undeformed). Default `[0, 0, 0]`.
    #[key(unit = "m")]
    pub at: Option<Spanned<Vector>>,
    /// Its rotation in the frame of the link, as that of a `transform`. Default none.
    pub rotation: Option<Spanned<Many<Turn>>>,
}

/// A surface of triangles, which is drawn if its file is there, and which exported files name.
#[derive(Clone, Debug, FromNode)]
pub struct MeshShape {
    /// The STL or OBJ file, from the folder of the spec, as exported files are to name it.
    pub file: Spanned<String>,
    /// Factor of its coordinates, such as 0.001 for a file in mm. Default 1.
    #[key(unit = "1", limit = Positive)]
    pub scale: Option<Spanned<Constant>>,
    /// The place of its origin in the frame of the link (for a beam: undeformed). Default `[0, 0, 0]`.
    #[key(unit = "m")]
    pub at: Option<Spanned<Vector>>,
    /// Its rotation in the frame of the link, as that of a `transform`. Default none.
    pub rotation: Option<Spanned<Many<Turn>>>,
}
