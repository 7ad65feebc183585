//! Shapes of results, in counts of a crane's parts.

/// A number of parts of a crane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names of the parts")]
pub enum Count {
    Bodies,
    Points,
    Supports,
    Drives,
    Cylinders,
    Connectors,
    Sections,
    Cuts,
    Coordinates,
    /// Equations of joints that close loops.
    LoopEquations,
    /// Rows that close loops in the dynamics: accelerations, J̇ q̇ in as many rows as it fills, and two rows for each equation.
    LoopRows,
    /// Intervals in which the drives move smoothly.
    DrivePieces,
    /// Intervals in which the loads change smoothly.
    LoadPieces,
    /// Intervals in which the winches move smoothly.
    WinchPieces,
    /// Points of connectors and ends of joints that close loops.
    Attachments,
    /// Cuts, for each cylinder.
    CylinderCuts,
    /// Cuts, for each connector.
    ConnectorCuts,
    /// Cuts, for each equation of a loop joint.
    LoopCuts,
    /// Coordinates that move each body, body by body.
    Derivatives,
    /// Pairs of coordinates that move each body.
    SecondDerivatives,
    /// Axes of the world: x, y, z.
    Axes,
    /// Coordinates of the points of interest in the world.
    PointAxes,
    /// Elongations of the supports along the world's axes.
    SupportAxes,
    /// What the derivatives of a residual are with respect to: poses and rates.
    PosesAndRates,
    /// Entries of a residual, for poses and for rates.
    ResidualRows,
    /// Numbers of each coordinate that derivatives of a residual are products of.
    ResidualFactors,
    /// Numbers of each coordinate of which the inverse mass matrix is a product.
    MassFactors,
}

impl Count {
    /// Its name in the table.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Count::Bodies => "bodies",
            Count::Points => "points",
            Count::Supports => "supports",
            Count::Drives => "drives",
            Count::Cylinders => "cylinders",
            Count::Connectors => "connectors",
            Count::Sections => "sections",
            Count::Cuts => "cuts",
            Count::Coordinates => "n",
            Count::LoopEquations => "loop_equations",
            Count::LoopRows => "loop_rows",
            Count::DrivePieces => "drive_pieces",
            Count::LoadPieces => "load_pieces",
            Count::WinchPieces => "winch_pieces",
            Count::Attachments => "attachments",
            Count::CylinderCuts => "cylinder_cuts",
            Count::ConnectorCuts => "connector_cuts",
            Count::LoopCuts => "loop_cuts",
            Count::Derivatives => "derivatives",
            Count::SecondDerivatives => "second_derivatives",
            Count::Axes => "3",
            Count::PointAxes => "point_axes",
            Count::SupportAxes => "support_axes",
            Count::PosesAndRates => "2",
            Count::ResidualRows => "residual_rows",
            Count::ResidualFactors => "residual_factors",
            Count::MassFactors => "mass_factors",
        }
    }

    /// The number of [`ResidualFactors`](Self::ResidualFactors): twenty vectors, a mass, and five diagonals.
    pub const RESIDUAL_FACTORS: usize = 3 * 20 + 1 + 5;

    /// The number of [`MassFactors`](Self::MassFactors): four vectors, and a reciprocal.
    pub const MASS_FACTORS: usize = 3 * 4 + 1;

    /// The number of [`LoopRows`](Self::LoopRows) of so many equations and n coordinates.
    #[must_use]
    pub const fn loop_rows(equations: usize, n: usize) -> usize {
        if equations == 0 { 0 } else { 1 + equations.div_ceil(n) + 2 * equations }
    }

    /// The counts whose product it is.
    #[must_use]
    pub const fn factors(self) -> &'static [Count] {
        match self {
            Count::CylinderCuts => &[Count::Cylinders, Count::Cuts],
            Count::ConnectorCuts => &[Count::Connectors, Count::Cuts],
            Count::LoopCuts => &[Count::LoopEquations, Count::Cuts],
            Count::PointAxes => &[Count::Points, Count::Axes],
            Count::SupportAxes => &[Count::Supports, Count::Axes],
            Count::ResidualRows => &[Count::PosesAndRates, Count::Coordinates],
            _ => &[],
        }
    }
}

/// An item of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Item {
    /// Three numbers.
    Vector,
    /// Two numbers.
    Pair,
    /// A number per coordinate.
    Row,
    /// The force of a connector and its derivatives.
    Tension,
    /// A force and a moment.
    Wrench,
    /// What the stresses of a section follow from.
    Moduli,
    /// A homogeneous matrix.
    Transform,
}

impl Item {
    /// How many numbers it has; of a row, one per coordinate.
    #[must_use]
    pub const fn numbers(self) -> usize {
        match self.shape(1) {
            [Some(rows), Some(columns)] => rows * columns,
            [Some(rows), None] => rows,
            [None, _] => 1,
        }
    }

    /// Extent of each index, for n coordinates.
    const fn shape(self, n: usize) -> [Option<usize>; 2] {
        match self {
            Item::Vector | Item::Tension => [Some(3), None],
            Item::Pair => [Some(2), None],
            Item::Row => [Some(n), None],
            Item::Wrench => [Some(6), None],
            Item::Moduli => [Some(8), None],
            Item::Transform => [Some(4), Some(4)],
        }
    }
}

/// Shape of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Extent {
    /// One number.
    Number,
    /// A number per coordinate.
    Vector,
    /// A symmetric matrix over all coordinates.
    Matrix,
    /// A symmetric matrix over the base's six coordinates.
    Base,
    /// A list.
    List(Item, Count),
    /// Another, written by hand where it is needed.
    Other,
}

impl Extent {
    /// Extent of each index, for n coordinates and counts of other parts; that of [`Other`](Self::Other) is unknown.
    pub fn shape(self, n: usize, count: impl Fn(Count) -> usize) -> impl Iterator<Item = usize> {
        let extents = match self {
            Extent::Number | Extent::Other => [None; 4],
            Extent::Vector => [Some(n), None, None, None],
            Extent::Matrix => [Some(n), Some(n), None, None],
            Extent::Base => [Some(6), Some(6), None, None],
            Extent::List(item, of) => {
                let [first, second] = match *of.factors() {
                    [first, second] => [Some(count(first)), Some(count(second))],
                    _ => [Some(count(of)), None],
                };
                let [third, fourth] = item.shape(n);
                [first, second, third, fourth]
            }
        };
        extents.into_iter().flatten()
    }
}
