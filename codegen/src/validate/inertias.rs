//! Whether inertias are physically possible. Of bodies that are rigidly connected only the sum matters, and that of bodies that never move
//! enters nothing.

use std::collections::BTreeSet;

use super::Check;
use super::limits::positive_margin;
use crate::chain::{self, Body, BodyId, Frame, Inertia, Relation, Step, Value};
use crate::diagnostic::{Mistake, Span, rule};
use crate::expand::inertia::{self, Tensor};
use crate::spec::About;

/// Published inertias are measured or rounded: they may violate the triangle inequality by this fraction.
const SLIGHT: f64 = 0.25;
/// Rounding of inertias in a spec that is not worth a warning: moments below zero by this fraction of the largest count as zero.
const WRITTEN: f64 = 1e-6;
/// Rounding of the moments about the centre of mass of a sum, as a fraction of those about the origin: about ten rounding errors.
const OF_A_SUM: f64 = 1e-15;

/// Mass, centre of mass and inertia of a body as written.
pub(super) struct Lump {
    /// Its pseudo-inertia about the origin of the frame.
    pub(super) inertia: Inertia,
    /// Its centre of mass, m.
    pub(super) com: [Value; 3],
    /// Whether it is possible; `None` for a point mass and after a mistake.
    pub(super) judgement: Option<Judgement>,
}

/// Whether an inertia is possible on its own.
#[derive(Debug)]
pub(super) struct Judgement {
    span: Span,
    subject: String,
    /// Whether some of its numbers are live.
    live: bool,
    /// What has to hold whenever live numbers are set.
    relations: Vec<Relation>,
    /// What is wrong with it.
    broken: Option<Broken>,
    /// A slip that would explain it, as a sentence.
    slip: Option<String>,
}

/// A rule that an inertia breaks.
#[derive(Debug)]
enum Broken {
    /// Its smallest principal moment is below zero, kg m².
    NotPositive(f64),
    /// Its largest principal moment exceeds the sum of the other two, kg m².
    Triangle(f64, f64),
    /// By so little that measuring may be the reason.
    Slightly(f64, f64),
}

impl Broken {
    /// What is wrong with a tensor about the centre of mass, of which numbers below `rounding` are not known.
    fn by(tensor: [f64; 6], rounding: f64) -> Option<Self> {
        let [smallest, middle, largest] = inertia::principal_moments(tensor);
        let others = smallest + middle;
        if smallest < -WRITTEN * largest.abs() - rounding {
            Some(Broken::NotPositive(smallest))
        } else if largest > others * (1.0 + SLIGHT) + rounding {
            Some(Broken::Triangle(largest, others))
        } else if largest > others * (1.0 + WRITTEN) + rounding {
            Some(Broken::Slightly(largest, others))
        } else {
            None
        }
    }

    /// The mistake, or the warning.
    fn mistake(&self, span: Span, subject: &str, slip: Option<&str>) -> Mistake {
        match *self {
            Broken::NotPositive(smallest) => {
                let help = slip.unwrap_or("check signs, products and `about`");
                rule::not_positive_definite(span, subject, rounded(smallest), help)
            }
            Broken::Triangle(largest, others) => {
                let help =
                    slip.unwrap_or("no principal moment about the centre of mass may exceed the sum of the other two");
                rule::triangle(span, subject, rounded(largest), rounded(others), help)
            }
            Broken::Slightly(largest, others) => {
                rule::slight_triangle(span, subject, rounded(largest), rounded(others))
            }
        }
    }
}

impl Check<'_> {
    /// Judges an inertia on its own.
    pub(super) fn judge(
        &mut self,
        mass: &Value,
        com: &[Value; 3],
        given: &Tensor,
        about: About,
        span: Span,
        subject: String,
    ) -> Option<Judgement> {
        let tensor = match about {
            About::Com => given.clone(),
            About::Origin => inertia::tensor_at_com(mass, com, given),
        };
        let numbers = tensor.each_ref().map(|element| self.now(element));
        if !numbers.iter().all(|element| element.is_finite()) {
            return None;
        }
        let [smallest, middle, largest] = inertia::principal_moments(numbers);
        let mut relations = Vec::new();
        for (margins, broken) in [
            (inertia::definite_margin(&tensor, -WRITTEN), Broken::NotPositive(smallest)),
            (inertia::triangle_margin(&tensor, SLIGHT), Broken::Triangle(largest, smallest + middle)),
        ] {
            let broken = broken.mistake(span, &subject, None);
            relations.extend(inertia::leading_minors(margins).into_iter().filter_map(|m| positive_margin(m, &broken)));
        }
        let broken = Broken::by(numbers, 0.0);
        let written = given.each_ref().map(|element| self.now(element));
        let beyond = matches!(broken, Some(Broken::NotPositive(_) | Broken::Triangle(..)));
        let (m, c) = (self.now(mass), com.each_ref().map(|x| self.now(x)));
        let slip = if beyond { likely_slip(m, c, written, about) } else { None };
        let live = tensor.iter().any(|element| element.as_constant().is_none());
        Some(Judgement { span, subject, live, relations, broken, slip })
    }

    /// Reports an inertia that is judged on its own.
    pub(super) fn accept(&mut self, judgement: Judgement) {
        self.relations.extend(judgement.relations);
        if let Some(broken) = judgement.broken {
            let mistake = broken.mistake(judgement.span, &judgement.subject, judgement.slip.as_deref());
            self.report_broken(&broken, mistake);
        }
    }

    fn report_broken(&mut self, broken: &Broken, mistake: Mistake) {
        match broken {
            Broken::Slightly(..) => self.warnings.push(mistake),
            _ => self.report(mistake),
        }
    }

    /// Reports inertias that are not possible, also not together with what is rigidly connected to them.
    ///
    /// Tensors that are possible form a convex cone, also about the centre of mass of a sum: whatever is possible on its own stays so
    /// in a sum. A live number is judged on its own, because the sum would have to be judged whenever it is set.
    pub(super) fn possible_inertias(&mut self) {
        let groups = self.rigid_groups();
        let mut told = BTreeSet::new();
        for (BodyId(body), judgement) in std::mem::take(&mut self.judgements) {
            let Some(Some((root, _))) = groups.get(body) else { continue };
            let members = || {
                let all = self.bodies.iter().zip(&groups);
                all.filter_map(|(body, group)| {
                    let (_, frame) = group.as_ref().filter(|(own, _)| own == root)?;
                    Some((body, body.inertia.as_ref()?, frame))
                })
            };
            let alone = members().map(|(body, ..)| body.parts.len().max(1)).sum::<usize>() == 1;
            if alone || judgement.live || judgement.broken.is_none() {
                self.accept(judgement);
                continue;
            }
            self.relations.extend(judgement.relations);
            let sum = members().fold([0.0; 10], |sum, (_, inertia, frame)| {
                let moved = in_outer_frame(inertia, frame, &self.defaults);
                std::array::from_fn(|k| sum[k] + moved[k])
            });
            let Some(broken) = of_sum(sum) else { continue };
            if told.insert(*root) {
                let subject = format!("{}, with all that is rigidly connected to it,", judgement.subject);
                let mistake = broken.mistake(judgement.span, &subject, judgement.slip.as_deref());
                self.report_broken(&broken, mistake);
            }
        }
    }

    /// For each body, the first of those that are rigidly connected to it, and its pose in the frame of that one; `None` if it never
    /// moves. A live pose is not rigid: it may be set.
    fn rigid_groups(&self) -> Vec<Option<(usize, Frame)>> {
        let mut groups: Vec<Option<(usize, Frame)>> = Vec::with_capacity(self.bodies.len());
        for (index, Body { parent, path, .. }) in self.bodies.iter().enumerate() {
            let carrier = parent.and_then(|BodyId(parent)| groups[parent]);
            let moves = path.iter().any(|step| !step.coordinates().is_empty());
            let group = match carrier {
                _ if moves => Some((index, Frame::WORLD)),
                None => None,
                Some((root, frame)) => {
                    let placed = path.iter().try_fold(frame, after_constant);
                    Some(placed.map_or((index, Frame::WORLD), |frame| (root, frame)))
                }
            };
            groups.push(group);
        }
        groups
    }
}

/// A frame after a step of constants.
fn after_constant(frame: Frame, step: &Step) -> Option<Frame> {
    match step {
        Step::Translate([x, y, z]) => {
            let by = [x.as_constant()?, y.as_constant()?, z.as_constant()?];
            Some(Frame { origin: frame.transform_point(by), ..frame })
        }
        Step::Rotate { axis, sin, cos } => Some(frame.rotated(*axis, sin.as_constant()?, cos.as_constant()?)),
        Step::Move(_) | Step::RotationVector(_) => None,
    }
}

/// Mass, static moments and second moments in an outer frame: `m`, `R f + m p`, `R S Rᵀ + p (R f)ᵀ + (R f) pᵀ + m p pᵀ`.
fn in_outer_frame(inertia: &chain::Inertia, frame: &Frame, parameters: &[f64]) -> [f64; 10] {
    let m = inertia.mass.at(parameters);
    let f = frame.direction(inertia.first.each_ref().map(|v| v.at(parameters)));
    let [xx, yy, zz, xy, xz, yz] = inertia.second.each_ref().map(|v| v.at(parameters));
    // R S, row by row of Sᵀ = S, then (R S) Rᵀ.
    let half = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|column| frame.direction(column));
    let second = [0, 1, 2].map(|row| frame.direction(half.map(|column| column[row])));
    let p = frame.origin;
    let moved = |i: usize, j: usize| second[i][j] + p[i] * f[j] + f[i] * p[j] + m * p[i] * p[j];
    let [x, y, z] = [0, 1, 2].map(|i| f[i] + m * p[i]);
    [m, x, y, z, moved(0, 0), moved(1, 1), moved(2, 2), moved(0, 1), moved(0, 2), moved(1, 2)]
}

/// What is wrong with mass, static moments and second moments.
fn of_sum([m, x, y, z, xx, yy, zz, xy, xz, yz]: [f64; 10]) -> Option<Broken> {
    let central = |second: f64, a: f64, b: f64| if m > 0.0 { second - a * b / m } else { second };
    let (a, b, c) = (central(xx, x, x), central(yy, y, y), central(zz, z, z));
    let tensor = [b + c, a + c, a + b, -central(xy, x, y), -central(xz, x, z), -central(yz, y, z)];
    // After a mistake in a number, it is not judged.
    if !tensor.iter().all(|element| element.is_finite()) {
        return None;
    }
    Broken::by(tensor, OF_A_SUM * (xx.abs() + yy.abs() + zz.abs()))
}

/// The one slip that makes an inertia possible, as a sentence: a sign, the reference point, a power of ten, or the order of numbers.
fn likely_slip(mass: f64, com: [f64; 3], written: [f64; 6], about: About) -> Option<String> {
    const KEYS: [&str; 6] = ["Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz"];
    let shifted = |tensor: [f64; 6]| {
        let values = inertia::tensor_at_com(&mass.into(), &com.map(Into::into), &tensor.map(Into::into));
        values.map(|value| value.as_constant().unwrap_or(f64::NAN))
    };
    let at_com = |tensor: [f64; 6]| if about == About::Origin { shifted(tensor) } else { tensor };
    let possible = |tensor: [f64; 6]| Broken::by(tensor, 0.0).is_none();
    let changed = |k: usize, factor: f64| {
        let mut tensor = written;
        tensor[k] *= factor;
        possible(at_com(tensor))
    };
    let only = |candidates: Vec<String>| match <[String; 1]>::try_from(candidates) {
        Ok([one]) => Some(one),
        Err(_) => None,
    };
    let negative = (0..3).filter(|k| written[*k] < 0.0 && changed(*k, -1.0));
    let sign = negative.map(|k| format!("with the other sign of `{}` it would be possible", KEYS[k])).collect();
    let product = || {
        let wrong = (3..6).filter(|k| written[*k] != 0.0 && changed(*k, -1.0));
        wrong.map(|k| format!("with the other sign of `{}` it would be possible", KEYS[k])).collect()
    };
    // The other way round never explains it: what is possible about the centre of mass is also possible about the origin.
    let reference = || {
        (about == About::Origin && possible(written)).then(|| {
            "as an inertia about the centre of mass it would be possible: leave out `about: origin`".to_owned()
        })
    };
    let power = || {
        (1..=3).find_map(|digits| {
            let factors = [10_f64.powi(digits), 10_f64.powi(-digits)];
            let all = (0..6).flat_map(|k| factors.map(|factor| (k, factor)));
            let right = all.filter(|(k, factor)| written[*k] != 0.0 && changed(*k, *factor));
            let told: Vec<String> = right
                .map(|(k, factor)| {
                    let [text, better] = [written[k], written[k] * factor].map(rounded);
                    format!("with `{}` {better} instead of {text} kg m² it would be possible: a power of ten", KEYS[k])
                })
                .collect();
            // Of several, none is likely; of higher powers, even less.
            (!told.is_empty()).then(|| only(told))
        })?
    };
    let order = || {
        let [a, b, c, d, e, f] = written;
        // As URDF lists them.
        possible(at_com([a, d, f, b, c, e])).then(|| {
            "in the order Ixx, Ixy, Ixz, Iyy, Iyz, Izz of these numbers it would be possible: check the axes".to_owned()
        })
    };
    only(sign).or_else(reference).or_else(|| only(product())).or_else(power).or_else(order)
}

/// A number as a person would write it, to six digits.
pub(super) fn rounded(number: f64) -> String {
    let number: f64 = format!("{number:.5e}").parse().unwrap_or(number);
    let plain = number == 0.0 || (1e-4..1e7).contains(&number.abs());
    if plain { number.to_string() } else { format!("{number:e}") }
}
