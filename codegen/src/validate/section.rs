//! Materials and cross-sections of beams.

use super::Check;
use crate::chain::{Moduli, Value};
use crate::diagnostic::{Span, rule, suggest};
use crate::expand::section::{CrossSection, Shape};
use crate::spec::{Either, Material, Section, Spanned};

/// An isotropic elastic material.
#[derive(Clone, Debug)]
pub(super) struct Elastic {
    /// Young's modulus, Pa.
    pub youngs: Value,
    /// Shear modulus, Pa.
    pub shear: Value,
    /// Density, kg/m³.
    pub density: Value,
    /// Yield stress, Pa.
    pub yield_stress: Option<Value>,
}

impl<'a> Check<'a> {
    /// A material given in place, or by its name.
    pub(super) fn material(&mut self, given: &'a Spanned<Either<String, Material>>) -> Option<Elastic> {
        let name = match given.value.as_ref()? {
            Either::Full(material) => return Some(self.elastic(material)),
            Either::Short(name) => name,
        };
        let known = self.materials.get(name.as_str()).cloned();
        if known.is_none() && !self.unknown.materials {
            let help = suggest(name, self.materials.keys().copied());
            self.report(rule::unknown_material(given.span, name, help));
        }
        known
    }

    /// The numbers of a material.
    pub(super) fn elastic(&mut self, material: &Material) -> Elastic {
        Elastic {
            youngs: self.number(&material.youngs_modulus, "Young's modulus `E`"),
            shear: self.number(&material.shear_modulus, "the shear modulus `G`"),
            density: self.number(&material.density, "`density`"),
            yield_stress: material.yield_stress.as_ref().map(|given| self.number(given, "`yield_stress`")),
        }
    }

    /// A cross-section by its shape or its numbers.
    pub(super) fn shape(&mut self, section: &Spanned<Section>) -> Option<Shape> {
        Some(match section.value.as_ref()? {
            Section::Box { height, width, thickness } => {
                let size = [self.number(height, "`height`"), self.number(width, "`width`")];
                let wall = self.number(thickness, "`thickness`");
                self.wall(thickness.span, &wall, size.iter());
                let [height, width] = size;
                Shape::Box([height, width, wall])
            }
            Section::WeldedBox { height, width, flange, web } => {
                let size = [self.number(height, "`height`"), self.number(width, "`width`")];
                let plates = [self.number(flange, "`flange`"), self.number(web, "`web`")];
                self.wall(flange.span, &plates[0], [&size[0]].into_iter());
                self.wall(web.span, &plates[1], [&size[1]].into_iter());
                let ([height, width], [flange, web]) = (size, plates);
                Shape::WeldedBox([height, width, flange, web])
            }
            Section::Tube { diameter, thickness } => {
                let size = self.number(diameter, "`diameter`");
                let wall = self.number(thickness, "`thickness`");
                self.wall(thickness.span, &wall, [&size].into_iter());
                Shape::Tube([size, wall])
            }
            Section::Solid { height, width } => {
                let sides = [(height, "`height`"), (width, "`width`")].map(|(side, key)| {
                    let value = self.number(side, key);
                    if value.as_constant().is_none() {
                        self.report(rule::live_side(side.span, key));
                    }
                    value.as_constant().unwrap_or(f64::NAN)
                });
                Shape::Solid(sides)
            }
            Section::Circle { diameter } => Shape::Circle(self.number(diameter, "`diameter`")),
            Section::Numbers { area, jy, jz, jo, moduli } => {
                let area = self.number(area, "`area`");
                let moduli = moduli.as_ref().and_then(|given| given.value.as_ref()).map(|given| Moduli {
                    area: area.clone(),
                    bending: [self.number(&given.wy, "`Wy`"), self.number(&given.wz, "`Wz`")],
                    torsion: self.number(&given.wt, "`Wt`"),
                    shear: [self.number(&given.ay, "`Ay`"), self.number(&given.az, "`Az`")],
                    has_corners: true,
                });
                Shape::Numbers(Box::new(CrossSection {
                    area,
                    jy: self.number(jy, "`Jy`"),
                    jz: self.number(jz, "`Jz`"),
                    jo: self.number(jo, "`Jo`"),
                    moduli,
                    outline: None,
                }))
            }
        })
    }

    /// Checks that walls leave a hollow.
    fn wall<'v>(&mut self, span: Span, thickness: &Value, sizes: impl Iterator<Item = &'v Value>) {
        let sizes: Vec<&Value> = sizes.collect();
        let smallest = sizes.iter().map(|size| self.now(size)).fold(f64::INFINITY, f64::min);
        let now = self.now(thickness);
        if 2.0 * now >= smallest && smallest > 0.0 {
            self.report(rule::wall(span, now, smallest));
        }
        for size in sizes {
            self.keep_below(&(2.0 * thickness.clone()), size, &rule::wall(span, now, smallest));
        }
    }
}
