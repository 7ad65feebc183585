//! Beams as rigid finite elements.

use super::inertia::{about_com, sum};
use super::section::{CrossSection, Shape};
use crate::chain::{Axis, Division, Inertia, Moduli, Outline, Step, Stretch, Value};

/// An angle that changes no rotation, and whose square is not 0 even in single precision, rad.
const NO_ANGLE: f64 = 1e-18;

/// A rigid finite element.
#[derive(Clone, Debug)]
pub(crate) struct RigidElement {
    /// Length along x, m.
    pub length: Value,
    /// Pseudo-inertia about its start.
    pub inertia: Inertia,
}

/// Spring and damper between two elements, about z (ψ), y (θ), x (φ).
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    /// Stiffness, N m/rad.
    pub stiffness: [Value; 3],
    /// Damping, N m s/rad.
    pub damping: [Value; 3],
    /// Rotation of a curved beam at rest by half the angle of a section, as steps: once before the spring and once after it.
    pub half_bend: Vec<Step>,
}

/// A beam of rigid elements with a joint between neighbours.
#[derive(Clone, Debug)]
pub(crate) struct DividedBeam {
    /// Elements, from the start to the tip.
    pub elements: Vec<RigidElement>,
    /// Joints, one fewer than elements.
    pub joints: Vec<Joint>,
    /// The sections, of a beam that is not given element by element.
    pub division: Division,
}

/// Places that are closer to each other, or to an end, than this share of an equal section end one section, not two: shorter sections are stiffer than
/// steps of explicit methods bear.
const NEAR: f64 = 0.1;
/// A stretch is longer than another one if it is so by this fraction, because both are rounded numbers.
const LONGER: f64 = 1e-9;

/// Divides a beam into sections. One ends at every station, a place where something acts: on the border between two sections, a force or a couple
/// bends every spring by its true moment, within a section it would not. Between two stations sections are equal, and as near in length to those of a
/// beam without stations as a whole number of them allows; if they are fewer than `count`, the longest ones are divided. `now` gives the numbers with
/// default parameters.
pub(crate) fn division(
    length: &Value,
    count: usize,
    mut stations: Vec<Value>,
    now: impl Fn(&Value) -> f64,
) -> Division {
    if count == 0 {
        return Division::default();
    }
    stations.sort_by(|a, b| now(a).total_cmp(&now(b)));
    let whole = now(length);
    let mut begins = vec![Value::ZERO];
    for station in stations {
        let x = now(&station);
        let apart = |end: f64| (x - end).abs() > NEAR * whole / count as f64;
        if begins.last().is_some_and(|last| apart(now(last))) && apart(whole) && (0.0..whole).contains(&x) {
            begins.push(station);
        }
    }
    let ends: Vec<Value> = begins.iter().skip(1).cloned().chain([length.clone()]).collect();
    let lengths: Vec<f64> = begins.iter().zip(&ends).map(|(begin, end)| now(end) - now(begin)).collect();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most `count`
    let equal = |length: &f64| ((count as f64 * length / whole).round() as usize).max(1);
    let mut counts: Vec<usize> = lengths.iter().map(equal).collect();
    for _ in counts.iter().sum()..count {
        let section = |stretch: usize| lengths[stretch] / counts[stretch] as f64;
        let longest = (1..lengths.len())
            .fold(0, |best, stretch| if section(stretch) > section(best) * (1.0 + LONGER) { stretch } else { best });
        counts[longest] += 1;
    }
    let stretch = |((begin, end), sections): ((Value, Value), usize)| {
        let section = (end - begin.clone()) / (sections as f64).into();
        Stretch { sections, section, begin }
    };
    Division { stretches: begins.into_iter().zip(ends).zip(counts).map(stretch).collect() }
}

/// Lengths of the elements of a beam, [Urbaś 2016, section 2.2]: a spring is in the middle of each section, so that the elements of n sections of
/// length `d = l/n` are `d/2, d, …, d, d/2` long, and one between two sections half of each. Without sections it is one element.
pub(crate) fn element_lengths(length: &Value, division: &Division) -> Vec<Value> {
    let sections: Vec<&Value> = division.each().map(|(_, section)| section).collect();
    let (Some(first), Some(last)) = (sections.first(), sections.last()) else { return vec![length.clone()] };
    let half = |section: &Value| 0.5 * section.clone();
    let between = sections.windows(2).map(|pair| match pair {
        [one, other] if one == other => (*one).clone(),
        pair => half(pair[0]) + half(pair[1]),
    });
    [half(first)].into_iter().chain(between).chain([half(last)]).collect()
}

/// The rotation by the vector (0, θ, ψ), as steps: `Ry(θ)` or `Rz(ψ)` if only one angle is given, otherwise
/// `Rx(α) Ry(√(θ² + ψ²)) Rx(−α)`, `α = atan2(ψ, θ)`.
pub(crate) fn rotation_across(theta: Value, psi: Value) -> Vec<Step> {
    let about = |axis, angle: Value| {
        let (sin, cos) = angle.sin_cos();
        Step::Rotate { axis, sin, cos }
    };
    if psi.is_zero() || theta.is_zero() {
        let angles = [(Axis::Y, theta), (Axis::Z, psi)];
        return angles
            .into_iter()
            .filter(|(_, angle)| !angle.is_zero())
            .map(|(axis, angle)| about(axis, angle))
            .collect();
    }
    // Live angles may both be 0: then any direction will do.
    let theta = theta + NO_ANGLE.into();
    let angle = (theta.clone() * theta.clone() + psi.clone() * psi.clone()).sqrt();
    let (sin, cos) = (psi / angle.clone(), theta / angle.clone());
    vec![
        Step::Rotate { axis: Axis::X, sin: sin.clone(), cos: cos.clone() },
        about(Axis::Y, angle),
        Step::Rotate { axis: Axis::X, sin: -sin, cos },
    ]
}

/// A prismatic element of length ℓ with line density μ, kg/m:
/// `m = μℓ`, `I_x = m(J_y+J_z)/A`, `I_y = m(ℓ²/12 + J_y/A)`, `I_z = m(ℓ²/12 + J_z/A)`, centre of mass at ℓ/2.
pub(crate) fn prismatic(length: Value, line_density: &Value, section: &CrossSection) -> RigidElement {
    let mass = line_density.clone() * length.clone();
    // Squares of the section's radii of gyration.
    let iy2 = section.jy.clone() / section.area.clone();
    let iz2 = section.jz.clone() / section.area.clone();
    let slender = length.clone() * length.clone() / 12.0.into();
    let tensor = [
        mass.clone() * (iy2.clone() + iz2.clone()),
        mass.clone() * (slender.clone() + iy2),
        mass.clone() * (slender + iz2),
        Value::ZERO,
        Value::ZERO,
        Value::ZERO,
    ];
    let com = [0.5 * length.clone(), Value::ZERO, Value::ZERO];
    RigidElement { inertia: about_com(mass, &com, &tensor), length }
}

/// Stiffness of the spring of a section of length d, [Urbaś 2016, Eqs. (14)–(15)]:
/// `s_ψ = E J_z/d`, `s_θ = E J_y/d`, `s_φ = G J_o/d`, N m/rad.
pub(crate) fn stiffness(youngs: &Value, shear: &Value, section: &CrossSection, d: &Value) -> [Value; 3] {
    let spring = |modulus: &Value, moment: &Value| modulus.clone() * moment.clone() / d.clone();
    [spring(youngs, &section.jz), spring(youngs, &section.jy), spring(shear, &section.jo)]
}

/// A part of a beam with its own section.
#[derive(Clone, Debug)]
pub(crate) struct TaperedPart {
    /// Length, m.
    pub length: f64,
    /// The section at its beginning.
    pub from: Shape,
    /// The section at its end, if it is tapered.
    pub to: Option<Shape>,
}

/// The positive nodes of the ten-point Gauss formula on (−1, 1), and their weights. The stiffness of a box that tapers to half of its
/// size over one section is exact to 1e-12.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// Lengths that differ by less than this are the same, m: rounding of sums of decimals.
const SAME: f64 = 1e-9;

/// The portion of one part between two places of a beam of parts.
struct Piece<'a> {
    part: &'a TaperedPart,
    /// Beginning and end, m from the beginning of the beam.
    ends: [f64; 2],
    /// Beginning of the part, m.
    begin: f64,
}

impl Piece<'_> {
    fn length(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }

    /// The section at a place.
    fn section(&self, x: f64) -> CrossSection {
        let share = (x - self.begin) / self.part.length;
        let tapered = self.part.to.as_ref().and_then(|to| self.part.from.between(to, share));
        tapered.unwrap_or_else(|| self.part.from.clone()).section()
    }

    /// Places and lengths of thin slices that represent it in integrals; for a prismatic piece, its middle and its full length.
    fn slices(&self) -> Vec<(f64, f64)> {
        let (middle, half) = (0.5 * (self.ends[0] + self.ends[1]), 0.5 * self.length());
        if self.part.to.is_none() {
            return vec![(middle, self.length())];
        }
        let both = |(abscissa, weight): (f64, f64)| {
            [-abscissa, abscissa].map(|abscissa| (middle + half * abscissa, half * weight))
        };
        GAUSS.into_iter().flat_map(both).collect()
    }
}

/// The pieces between two places, from consecutive parts.
fn pieces(parts: &[TaperedPart], [from, to]: [f64; 2]) -> Vec<Piece<'_>> {
    let mut begin = 0.0;
    let mut pieces = Vec::new();
    for (index, part) in parts.iter().enumerate() {
        // The last part is extended, so that rounding leaves no gap behind it.
        let end = if index + 1 == parts.len() { f64::INFINITY } else { begin + part.length };
        let ends = [f64::max(from, begin), f64::min(to, end)];
        if ends[1] - ends[0] > SAME {
            pieces.push(Piece { part, ends, begin });
        }
        begin += part.length;
    }
    pieces
}

/// The sections of a beam of parts just before and just after a place; at its ends, both are the same.
fn sections_at(parts: &[TaperedPart], x: f64) -> [Option<CrossSection>; 2] {
    let length: f64 = parts.iter().map(|part| part.length).sum();
    let beside = |ends: [f64; 2]| pieces(parts, ends).first().map(|piece| piece.section(x));
    let (before, after) = (beside([x - 2.0 * SAME, x]), beside([x, x + 2.0 * SAME]));
    if x > length - SAME { [before.clone(), before] } else { [before.or(after.clone()), after] }
}

/// What a beam of equal sections consists of along its length.
#[derive(Clone, Debug)]
pub(crate) enum Distribution {
    /// The same everywhere.
    Prismatic {
        /// kg/m
        line_density: Value,
        /// Its section.
        section: Box<CrossSection>,
    },
    /// Parts end to end.
    Parts {
        /// From the beginning to the end.
        parts: Vec<TaperedPart>,
        /// kg/m³
        density: Value,
        /// Mass besides that of the material, kg/m.
        extra: Value,
    },
}

impl Distribution {
    /// Places at which the section or its taper changes, m from the beginning of the beam, without the ends.
    pub(crate) fn steps(&self) -> Vec<f64> {
        let Distribution::Parts { parts, .. } = self else { return Vec::new() };
        let mut end = 0.0;
        let ends = parts.iter().map(|part| {
            end += part.length;
            end
        });
        ends.take(parts.len() - 1).collect()
    }

    /// Moduli of the sections just before and just after a place.
    pub(crate) fn moduli(&self, x: f64) -> [Option<Moduli>; 2] {
        match self {
            Distribution::Prismatic { section, .. } => [section.moduli.clone(), section.moduli.clone()],
            Distribution::Parts { parts, .. } => sections_at(parts, x).map(|section| section?.moduli),
        }
    }

    /// Pseudo-inertia, about the beginning of an element, of its part beyond a distance from there. `start` is the beginning of the
    /// element in the beam; `now` gives the lengths of a beam of parts.
    pub(crate) fn beyond(&self, [start, length, distance]: [&Value; 3], now: impl Fn(&Value) -> f64) -> Inertia {
        let rest = match self {
            Distribution::Prismatic { line_density, section } => {
                prismatic(length.clone() - distance.clone(), line_density, section)
            }
            Distribution::Parts { parts, density, extra } => {
                let start = now(start);
                element_of_parts(parts, [start + now(distance), start + now(length)], density, extra)
            }
        };
        moved(rest.inertia, distance)
    }
}

/// The element of a beam of parts between two places: mass `∫ μ dx`, and moments of inertia likewise.
pub(crate) fn element_of_parts(parts: &[TaperedPart], ends: [f64; 2], density: &Value, extra: &Value) -> RigidElement {
    let mut inertia: Option<Inertia> = None;
    for piece in pieces(parts, ends) {
        for (x, length) in piece.slices() {
            let section = piece.section(x);
            let line_density = density.clone() * section.area.clone() + extra.clone();
            // The slices of a tapered piece are thin; a prismatic piece keeps its full length.
            let of_sections = if piece.part.to.is_none() {
                prismatic(length.into(), &line_density, &section).inertia
            } else {
                disc(line_density * length.into(), &section)
            };
            let at = if piece.part.to.is_none() { piece.ends[0] } else { x } - ends[0];
            let of_sections = moved(of_sections, &at.into());
            inertia = Some(match inertia {
                None => of_sections,
                Some(inertia) => sum(inertia, of_sections),
            });
        }
    }
    let nothing =
        || about_com(Value::ZERO, &[Value::ZERO, Value::ZERO, Value::ZERO], &std::array::from_fn(|_| Value::ZERO));
    RigidElement { length: (ends[1] - ends[0]).into(), inertia: inertia.unwrap_or_else(nothing) }
}

/// A thin slice at the origin.
fn disc(mass: Value, section: &CrossSection) -> Inertia {
    let [about_y, about_z] =
        [&section.jy, &section.jz].map(|second| mass.clone() * second.clone() / section.area.clone());
    let tensor = [about_y.clone() + about_z.clone(), about_y, about_z, Value::ZERO, Value::ZERO, Value::ZERO];
    about_com(mass, &[Value::ZERO, Value::ZERO, Value::ZERO], &tensor)
}

/// Pseudo-inertia of a body that is moved by `a` along x: `∫ (x + a)² dm` and so on.
fn moved(inertia: Inertia, a: &Value) -> Inertia {
    if a.is_zero() {
        return inertia;
    }
    let Inertia { mass, first: [x, y, z], second: [xx, yy, zz, xy, xz, yz] } = inertia;
    let by = |moment: &Value| a.clone() * moment.clone();
    let second = [xx + 2.0 * by(&x) + a.clone() * by(&mass), yy, zz, xy + by(&y), xz + by(&z), yz];
    Inertia { first: [x + by(&mass), y, z], mass, second }
}

/// Stiffness of the spring of a section of a beam of parts: `1/s = ∫ dx/(E J)`, the angle between its ends per unit
/// moment.
pub(crate) fn stiffness_of_parts(parts: &[TaperedPart], ends: [f64; 2], youngs: &Value, shear: &Value) -> [Value; 3] {
    let mut compliance = [Value::ZERO, Value::ZERO, Value::ZERO];
    for piece in pieces(parts, ends) {
        for (x, length) in piece.slices() {
            let each = stiffness(youngs, shear, &piece.section(x), &length.into());
            for (sum, stiffness) in compliance.iter_mut().zip(each) {
                *sum = sum.clone() + Value::ONE / stiffness;
            }
        }
    }
    compliance.map(|compliance| Value::ONE / compliance)
}

/// Outlines along a beam of parts.
pub(crate) fn outlines_of_parts(parts: &[TaperedPart]) -> Vec<(Value, Outline)> {
    let mut begin = 0.0;
    let mut outlines = Vec::new();
    for part in parts {
        let ends = [(begin, &part.from), (begin + part.length, part.to.as_ref().unwrap_or(&part.from))];
        let outline = |(x, shape): (f64, &Shape)| Some((Value::from(x), shape.section().outline?));
        outlines.extend(ends.into_iter().filter_map(outline));
        begin += part.length;
    }
    outlines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expand::section::hollow_rectangle;

    fn boom() -> CrossSection {
        hollow_rectangle(&0.25.into(), &0.2.into(), &0.008.into())
    }

    /// Lengths of the elements of a beam of 3.5 m on which something acts at these places.
    fn elements(sections: usize, stations: &[f64]) -> Vec<f64> {
        let stations = stations.iter().map(|x| Value::from(*x)).collect();
        let division = division(&3.5.into(), sections, stations, |value| value.at(&[]));
        element_lengths(&3.5.into(), &division).iter().map(|length| length.at(&[])).collect()
    }

    #[test]
    fn sections_end_where_something_acts() {
        // At 1 m: of four sections, three are behind it. Springs are in the middles: at 0.5 m and at 1 + 2.5/6 (1, 3, 5) m.
        let behind = 2.5 / 3.0;
        let expected = [0.5, 0.5 + 0.5 * behind, behind, behind, 0.5 * behind];
        assert_eq!(elements(4, &[1.0]), expected);
        // The same place twice, the ends, and places beyond them do not count.
        assert_eq!(elements(4, &[1.0, 3.5, 1.00001, -0.5, 0.0, 7.0]), expected);
        // Two places need three sections.
        assert_eq!(elements(1, &[2.5, 0.5]), [0.25, 1.25, 1.5, 0.5]);
        // Short ones are in addition to those of the rest, but places too near to each other or to an end share a border; where rounding leaves too few,
        // the longest are divided.
        assert_eq!(elements(2, &[0.4, 0.2]), [0.1, 0.2, 0.1 + 0.5 * 1.55, 1.55, 0.5 * 1.55]);
        assert_eq!(elements(2, &[0.4, 0.3, 0.1]), [0.15, 0.15 + 0.5 * 1.6, 1.6, 0.5 * 1.6]);
        assert_eq!(elements(5, &[0.98, 1.96, 2.94]), [0.245, 0.49, 0.735, 0.98, 0.77, 0.28]);
        assert_eq!(elements(0, &[1.0]), [3.5]);
    }

    #[test]
    fn elements_of_the_reference_boom() {
        let lengths = elements(4, &[]);
        assert_eq!(lengths, [0.4375, 0.875, 0.875, 0.875, 0.4375]);
        assert_eq!(elements(1, &[]), [1.75, 1.75]);

        let line_density = Value::from(7850.0) * boom().area + 62.0896.into();
        let mass: f64 =
            lengths.iter().map(|l| prismatic((*l).into(), &line_density, &boom()).inertia.mass.at(&[])).sum();
        // 116.6 kg/m over 3.5 m, to all given digits.
        assert!((mass - 408.1).abs() < 1e-9, "{mass}");
    }

    #[test]
    fn springs_of_the_reference_boom() {
        let springs = stiffness(&2.1e11.into(), &8.1e10.into(), &boom(), &0.875.into());
        // The section's moments are known to four digits.
        for (spring, expected) in springs.iter().zip([1.5348e7, 1.0846e7, 7.3678e6]) {
            assert!((spring.at(&[]) / expected - 1.0).abs() < 2e-4, "{spring:?} {expected}");
        }
    }

    #[test]
    fn halves_have_the_pseudo_inertia_of_the_whole() {
        // Two halves end to end are the whole beam: ∫x² = m l²/3 however it is divided.
        let density = Value::from(100.0);
        let whole = prismatic(2.0.into(), &density, &boom()).inertia;
        let half = prismatic(1.0.into(), &density, &boom()).inertia;
        let [m, mx, mxx] = [&half.mass, &half.first[0], &half.second[0]].map(|v| v.at(&[]));
        let moved = mxx + 2.0 * mx + m;
        assert!((whole.second[0].at(&[]) - (mxx + moved)).abs() < 1e-12 * moved);
        assert!((whole.second[1].at(&[]) - 2.0 * half.second[1].at(&[])).abs() < 1e-14);
    }
}
