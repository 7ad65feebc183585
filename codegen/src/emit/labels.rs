//! Names of the slots of results and of the stored constants, for comments and fields.

use std::collections::HashMap;

use crate::chain::{BodyId, Chain, Cut, Drive, Force, Load, Section, Side};
use crate::lower::LoweredProgram;
use crate::program::{Count, Extent, Function, FunctionId, Shape};
use crate::symbolic::ExprId;

use super::shape::{field_of, row_of_triangle};

/// Names that come from the chain.
pub struct Labels<'a> {
    chain: &'a Chain,
    constants: HashMap<ExprId, String>,
}

impl<'a> Labels<'a> {
    pub fn new(chain: &'a Chain, lowered: &LoweredProgram) -> Self {
        let mut constants: HashMap<ExprId, String> = HashMap::new();
        for (index, &id) in lowered.constants.stored.iter().enumerate() {
            constants.insert(id, format!("c{:03}", index + 1));
        }
        Labels { chain, constants }
    }

    /// Field of a stored constant.
    pub fn constant(&self, id: ExprId) -> String {
        self.constants[&id].clone()
    }

    /// Description of the group of results that starts at a slot.
    pub fn label(&self, function: &Function, slot: usize) -> Option<String> {
        let chain = self.chain;
        let coordinate = |i: usize| chain.coordinates[i].name.as_str();
        match &function.shape {
            Shape::Scalar | Shape::Factors(_) => None,
            Shape::Base => {
                let coordinates = chain.base.iter().flatten().map(|id| coordinate(id.0));
                coordinates.skip(row_of_triangle(6, slot).0).map(|name| format!("Row of {name}")).next()
            }
            Shape::Vector(_) => Some(coordinate(slot).to_owned()),
            Shape::MassAndBias(n) => Some(match slot.checked_sub(n * (n + 1) / 2) {
                Some(row) => format!("Bias of {}", coordinate(row)),
                None => format!("Row of {}", coordinate(row_of_triangle(*n, slot).0)),
            }),
            Shape::Columns { n, .. } => Some(match slot.checked_sub(12 * n) {
                Some(row) => format!("Bias of {}", coordinate(row)),
                None => ["Axes", "Linear momenta", "Angular momenta", "Offsets to the next point"][slot / (3 * n)]
                    .to_owned(),
            }),
            Shape::Tangent { .. } => Some("Factors of the tangent stiffness".to_owned()),
            Shape::Symmetric(n) => Some(format!("Row of {}", coordinate(row_of_triangle(*n, slot).0))),
            // Of the coordinates that rigid drives prescribe.
            Shape::Pairs(_) if function.id.extent() == Extent::Other => {
                chain.rigid_drives().nth(slot / 2).map(|drive| coordinate(drive.coordinate.0).to_owned())
            }
            Shape::Vectors(count) | Shape::Pairs(count) | Shape::Rows { count, .. } | Shape::Structs(_, count) => {
                let Extent::List(_, of) = function.id.extent() else { return None };
                self.part(of, slot / (function.shape.len() / count))
            }
            Shape::Transforms { counts, .. } => Some(self.transform(function.id, counts, slot / 12)),
            Shape::TransformFactors { degrees, rotations, .. } => {
                let axes = 3 * rotations.len();
                if slot < axes {
                    return Some("Axes of rotation".into());
                }
                if slot >= axes + 12 * degrees.iter().sum::<usize>() {
                    return Some("Curvatures".into());
                }
                Some(self.transform(FunctionId::TransformDerivatives, degrees, (slot - axes) / 12))
            }
            Shape::Record(_, fields) => {
                let (index, rest) = field_of(fields, slot);
                let (name, shape) = &fields[index];
                let Shape::Symmetric(n) = shape else { return Some((*name).to_owned()) };
                let row = coordinate(row_of_triangle(*n, rest).0);
                Some(format!("{}, row of {row}", capitalised(name)))
            }
        }
    }

    /// Name of one of the parts that a list counts.
    fn part(&self, of: Count, index: usize) -> Option<String> {
        let chain = self.chain;
        let coordinate = |i: usize| chain.coordinates[i].name.clone();
        match of {
            Count::Points => Some(chain.points[index].name.clone()),
            Count::Supports => Some(chain.supports[index].name.clone()),
            Count::Cylinders => Some(chain.cylinders[index].name.clone()),
            Count::Connectors => Some(chain.connectors()[index].name.clone()),
            Count::Drives => Some(coordinate(chain.drives[index].coordinate.0)),
            Count::Coordinates => Some(coordinate(index)),
            Count::LoopEquations => chain.loop_equations().nth(index),
            Count::DrivePieces => {
                let of = |drive: &'a Drive| std::iter::repeat_n(drive.coordinate.0, drive.pieces().len());
                chain.drives.iter().flat_map(of).nth(index).map(coordinate)
            }
            Count::LoadPieces => {
                let of = |load: &'a Load| std::iter::repeat_n(&load.name, load.pieces());
                chain.loads.iter().flat_map(of).nth(index).cloned()
            }
            Count::WinchPieces => {
                let of = |connector: &'a Force| std::iter::repeat_n(&connector.name, connector.pieces());
                chain.connectors().iter().flat_map(of).nth(index).cloned()
            }
            Count::Attachments => {
                let connectors = chain.connectors().iter();
                let points = connectors.flat_map(|own| std::iter::repeat_n(&own.name, own.strain.points().len()));
                let ends = chain.loop_joints.iter().flat_map(|joint| [&joint.name; 2]);
                points.chain(ends).nth(index).cloned()
            }
            Count::Sections => {
                let mut sections = chain.beams.iter().flat_map(|beam| &beam.sections);
                sections.nth(index).map(|section| self.section(section))
            }
            Count::Cuts => Some(match &chain.cuts()[index] {
                Cut::Ground => "Ground".to_owned(),
                Cut::Joint(body) => format!("Joint of {}", chain.bodies[body.0].link),
                Cut::Body(body) => format!("Before {}", chain.bodies[body.0].name),
                Cut::Inside(beam, section) => self.section(&chain.beams[*beam].sections[*section]),
            }),
            Count::CylinderCuts | Count::ConnectorCuts | Count::LoopCuts => {
                let (first, cuts) = (of.factors()[0], chain.count(Count::Cuts));
                let name = self.part(first, index / cuts).unwrap_or_default();
                Some(format!("{name} – {}", self.part(Count::Cuts, index % cuts)?))
            }
            Count::LoopRows => {
                let (equations, n) = (chain.count(Count::LoopEquations), chain.coordinates.len());
                let first = 1 + equations.div_ceil(n);
                let of = |row: usize| self.part(Count::LoopEquations, row % equations).unwrap_or_default();
                Some(match index {
                    0 => "Accelerations of the open chain".to_owned(),
                    _ if index < first => "J̇ q̇".to_owned(),
                    _ if index < first + equations => format!("J, {}", of(index - first)),
                    _ => format!("A⁻¹ Jᵀ, {}", of(index - first)),
                })
            }
            Count::PointAxes => self.part(Count::Points, index / 3),
            Count::SupportAxes => self.part(Count::Supports, index / 3),
            Count::ResidualFactors => {
                const VECTORS: [&str; 20] = [
                    "ω",
                    "υ",
                    "ω̇",
                    "υ̇",
                    "V, angular",
                    "V, linear",
                    "V̇ − γ, angular",
                    "V̇ − γ, linear",
                    "Added to ω̈",
                    "Added to ϋ",
                    "First moments",
                    "Inertia, x",
                    "Inertia, y",
                    "Inertia, z",
                    "tr(G) 1 − G, x",
                    "tr(G) 1 − G, y",
                    "tr(G) 1 − G, z",
                    "Momentum",
                    "Force",
                    "Moment",
                ];
                let axis = ["x", "y", "z"][index % 3];
                Some(match VECTORS.get(index / 3) {
                    Some(vector) => format!("{vector}, {axis}"),
                    None if index == 60 => "Mass".to_owned(),
                    None => "Diagonal".to_owned(),
                })
            }
            Count::MassFactors => {
                const VECTORS: [&str; 4] = ["Axis", "Force over D", "Moment over D", "Offset"];
                let axis = ["x", "y", "z"][index % 3];
                Some(VECTORS.get(index / 3).map_or("1/D".to_owned(), |vector| format!("{vector}, {axis}")))
            }
            Count::ResidualRows => self.part(Count::Coordinates, index % chain.coordinates.len()),
            Count::Bodies | Count::Derivatives | Count::SecondDerivatives | Count::Axes | Count::PosesAndRates => None,
        }
    }

    fn section(&self, section: &Section) -> String {
        let body = &self.chain.bodies[section.body.0].name;
        let side = match section.side {
            Side::Before => "before",
            Side::Both => "at",
            Side::After => "after",
        };
        if section.begins_element() { format!("Before {body}") } else { format!("{body}, {side} {}", section.at) }
    }

    fn transform(&self, function: FunctionId, counts: &[usize], mut matrix: usize) -> String {
        let mut body = 0;
        while matrix >= counts[body] {
            matrix -= counts[body];
            body += 1;
        }
        let name = &self.chain.bodies[body].name;
        let moving = self.chain.coordinates_of(BodyId(body));
        let coordinate = |i: usize| &self.chain.coordinates[moving[i].0].name;
        match function {
            FunctionId::TransformDerivatives => format!("∂T({name})/∂{}", coordinate(matrix)),
            FunctionId::TransformSecondDerivatives => {
                let (m, n) = row_of_triangle(moving.len(), matrix);
                format!("∂²T({name})/∂{}∂{}", coordinate(m), coordinate(n))
            }
            _ => format!("T({name})"),
        }
    }
}

fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}
