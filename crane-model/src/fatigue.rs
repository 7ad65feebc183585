//! Fatigue of beams: cycles of stress, counted by the rainflow method, and the damage that they do.
//!
//! A history of stress is a sequence of peaks and valleys. A range that lies within a larger one is a closed cycle; it is counted and taken out. What
//! remains of a history that happens once are half cycles, of one that repeats there are only full ones. \[ASTM E1049-85, 5.4.4 and 5.4.5]
//!
//! With the detail category `Δσ_c`, the range that a part endures `2·10⁶` times, and the slope m of its curve of strength, cycles of the range `Δσ` end the
//! part after `N = 2·10⁶ (Δσ_c/Δσ)^m`. Damages add up, `D = Σ n/N` \[Palmgren 1924; Miner 1945]; at 1 the life is over. There is no limit
//! below which cycles do no harm. Those of several manoeuvres add up in the same way, at the same point of the contour.
//!
//! Cycles are those of one place of the steel. A pad slides along the beam, so that the sections before and after it are not such a place. There are places
//! over the way that it takes instead, whose stresses are interpolated between the sections around them at each instant.
//!
//! The stresses are nominal ones, of the section; what a notch or a weld makes of them is the category.

use std::ops::Range;

use crate::sections::{Place, carried, in_words, places};
use crate::{Description, SectionModuli, Wrench};

/// Cycles for which the range of a detail category is given.
pub const CYCLES_OF_A_CATEGORY: f64 = 2e6;

/// Categories below this, Pa, are most likely meant in megapascals.
pub const LEAST_LIKELY_CATEGORY: f64 = 1e5;

/// Points on the rim of a round section at which stresses are counted: the largest range is off by at most 0.1 %.
const POINTS_ON_A_RIM: usize = 72;

/// Places per section over the way of a pad.
const PER_SECTION: usize = 4;

/// A cycle of stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// Difference of its ends, Pa.
    pub range: f64,
    /// Mean of its ends, Pa.
    pub mean: f64,
    /// 1, or 0.5 for a half cycle.
    pub count: f64,
    /// Where its ends are in the history.
    pub ends: [usize; 2],
}

/// Indices of peaks and valleys, with the ends.
fn turning_points(history: &[f64]) -> Vec<usize> {
    let mut points: Vec<usize> = Vec::new();
    for (index, value) in history.iter().enumerate() {
        if points.last().is_some_and(|last| history[*last] == *value) {
            continue;
        }
        if let [.., before, last] = points[..]
            && (history[last] > history[before]) == (*value > history[last])
        {
            points.pop();
        }
        points.push(index);
    }
    points
}

/// The cycles of a history that happens once: full and half ones, in the order in which they close.
pub fn count_cycles(history: &[f64]) -> Vec<Cycle> {
    let order: Vec<usize> = (0..history.len()).collect();
    count_in_order(history, &order, false)
}

/// The cycles of a history that repeats, all full: it is turned so that it begins and ends with its highest peak. The way from its end back to its
/// beginning is a part of it.
pub fn count_repeating_cycles(history: &[f64]) -> Vec<Cycle> {
    let Some(highest) = (0..history.len()).max_by(|a, b| history[*a].total_cmp(&history[*b])) else {
        return Vec::new();
    };
    let order: Vec<usize> = (highest..history.len()).chain(0..=highest).collect();
    count_in_order(history, &order, true)
}

/// The cycles of a history in an order of its values. Of one that repeats, ranges that contain its beginning are full cycles, and nothing remains.
fn count_in_order(history: &[f64], order: &[usize], repeats: bool) -> Vec<Cycle> {
    let values: Vec<f64> = order.iter().map(|index| history[*index]).collect();
    let cycle = |count: f64, [a, b]: [usize; 2]| {
        let [one, other] = [values[a], values[b]];
        Cycle { range: (one - other).abs(), mean: 0.5 * (one + other), count, ends: [order[a], order[b]] }
    };
    let (mut cycles, mut open) = (Vec::new(), Vec::<usize>::new());
    for point in turning_points(&values) {
        open.push(point);
        while let [.., a, b, c] = open[..] {
            if (values[c] - values[b]).abs() < (values[b] - values[a]).abs() {
                break;
            }
            if open.len() == 3 && !repeats {
                cycles.push(cycle(0.5, [a, b]));
                open.remove(0);
            } else {
                cycles.push(cycle(1.0, [a, b]));
                open.truncate(open.len() - 3);
                open.push(c);
            }
        }
    }
    if !repeats {
        cycles.extend(open.windows(2).map(|ends| cycle(0.5, [ends[0], ends[1]])));
    }
    cycles
}

/// How much a part endures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detail {
    /// `Δσ_c`, Pa.
    pub category: f64,
    /// m.
    pub slope: f64,
}

impl Detail {
    /// `N` of a range, Pa.
    pub fn endured(&self, range: f64) -> f64 {
        CYCLES_OF_A_CATEGORY * (self.category / range).powf(self.slope)
    }

    /// `Σ n/N`.
    pub fn damage(&self, cycles: &[Cycle]) -> f64 {
        let damages =
            cycles.iter().filter(|cycle| cycle.range > 0.0).map(|cycle| cycle.count / self.endured(cycle.range));
        damages.fold(0.0, |sum, damage| sum + damage)
    }
}

/// `s_m = Σ (Δσ/Δσ_max)^m n / 2·10⁶` of cycles that repeat, `Δσ_max` the largest range: how much a history uses of what the part endures at its
/// largest range \[EN 13001-1, 4.4.4]. Zero without cycles. Each cycle stands behind the number of its repetitions.
pub fn history_parameter<'c>(cycles: impl Iterator<Item = (f64, &'c Cycle)> + Clone, slope: f64) -> f64 {
    let largest = cycles.clone().map(|(_, cycle)| cycle.range).fold(0.0, f64::max);
    if largest == 0.0 {
        return 0.0;
    }
    let sum: f64 = cycles.map(|(times, cycle)| times * cycle.count * (cycle.range / largest).powf(slope)).sum();
    sum / CYCLES_OF_A_CATEGORY
}

/// The range, Pa, of which one cycle does the damage of all of them: `(Σ n Δσ^m)^(1/m)`.
pub fn equivalent_range(cycles: &[Cycle], slope: f64) -> f64 {
    cycles.iter().map(|cycle| cycle.count * cycle.range.powf(slope)).sum::<f64>().powf(slope.recip())
}

/// The class S of a stress history parameter: S0 up to 1/128, and each class twice as far, up to S9 with 4; `None` beyond.
pub fn class(parameter: f64) -> Option<u8> {
    (0..=9).find(|class| parameter <= 2f64.powi(i32::from(*class) - 7))
}

/// Normal stresses at points of the contour of a section that transmits a wrench, Pa: at four corners, or around the rim of a round section. Empty
/// if the moduli are not known.
pub fn contour(moduli: &SectionModuli, Wrench { force, moment }: &Wrench) -> Vec<f64> {
    if moduli.area <= 0.0 {
        return Vec::new();
    }
    let axial = force.x / moduli.area;
    let (about_y, about_z) = (moment.y / moduli.bending_y, moment.z / moduli.bending_z);
    if moduli.corners > 0.5 {
        return [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)]
            .map(|(y, z)| axial + y * about_y + z * about_z)
            .into();
    }
    let angle = |point: usize| std::f64::consts::TAU * point as f64 / POINTS_ON_A_RIM as f64;
    (0..POINTS_ON_A_RIM).map(|point| axial + about_y * angle(point).sin() - about_z * angle(point).cos()).collect()
}

/// A manoeuvre that repeats.
#[derive(Clone, Debug)]
pub struct Manoeuvre<'a> {
    /// Moduli of the sections of beams.
    pub moduli: &'a [SectionModuli],
    /// `x` and `wrenches` at each instant, as [`places`] takes them.
    pub states: Vec<(&'a [f64], &'a [Wrench])>,
    /// How often it is repeated.
    pub repetitions: f64,
}

/// What one of several manoeuvres does to a place of a beam.
#[derive(Clone, Debug)]
pub struct DamagePart {
    /// How often the manoeuvre is repeated.
    pub repetitions: f64,
    /// Stresses at the point of the contour that suffers most, Pa.
    pub history: Vec<f64>,
    /// Their cycles, of one repetition.
    pub cycles: Vec<Cycle>,
    /// Damage by all repetitions.
    pub damage: f64,
}

/// What manoeuvres that repeat do to a place of a beam.
#[derive(Clone, Debug)]
pub struct Fatigue {
    /// The place, as it is first: a section, or what pads sweep, with the section before or after the pads and its own `x` and moduli.
    pub place: Place,
    /// By manoeuvre.
    pub parts: Vec<DamagePart>,
    /// Damage by all repetitions of all manoeuvres.
    pub damage: f64,
}

impl Fatigue {
    /// What is there, in words; empty where only an element begins.
    pub fn what(&self, description: &Description) -> String {
        let info = self.place.info(description);
        if info.slides { format!("swept by the {}", info.at) } else { info.location() }
    }

    /// Where it is, in words: the beam, the distance from its start, and what is there.
    pub fn location(&self, description: &Description) -> String {
        in_words(self.place.beam(description), Some(self.place.x), self.what(description))
    }

    /// How often all repetitions of all manoeuvres may be gone through until the damage is 1; `None` where there is none.
    pub fn life(&self) -> Option<f64> {
        (self.damage > 0.0).then(|| self.damage.recip())
    }

    /// All cycles, behind the index of their manoeuvre.
    pub fn cycles(&self) -> impl Iterator<Item = (usize, &Cycle)> + Clone {
        self.parts.iter().enumerate().flat_map(|(index, part)| part.cycles.iter().map(move |cycle| (index, cycle)))
    }

    /// The cycle of the largest range, behind the index of its manoeuvre.
    pub fn largest(&self) -> Option<(usize, &Cycle)> {
        self.cycles().max_by(|a, b| a.1.range.total_cmp(&b.1.range))
    }

    /// `s_m` of all of them, as [`history_parameter`].
    pub fn history_parameter(&self, slope: f64) -> f64 {
        history_parameter(self.cycles().map(|(index, cycle)| (self.parts[index].repetitions, cycle)), slope)
    }
}

/// What manoeuvres that repeat do to every place of a crane's beams whose moduli are known, each on its own: changes from one to another do not count.
/// The crane has the same places in all, and in all those that pads sweep in any of them. `detail`: of each beam by the name of its link.
pub fn of_manoeuvres(
    description: &Description,
    manoeuvres: &[Manoeuvre<'_>],
    detail: impl Fn(&str) -> Detail,
) -> Vec<Fatigue> {
    let beams = description.sections_of_beams();
    // By instant, the places of each beam.
    let in_order = |(x, wrenches): &(&[f64], &[Wrench])| {
        let all = places(description, x, wrenches);
        let of_beam = |beam: &Range<usize>| {
            all.iter().filter(|place| beam.contains(&place.section)).copied().collect::<Vec<Place>>()
        };
        beams.iter().map(of_beam).collect::<Vec<_>>()
    };
    let instants: Vec<Vec<Vec<Vec<Place>>>> =
        manoeuvres.iter().map(|manoeuvre| manoeuvre.states.iter().map(in_order).collect()).collect();
    let of_place = |beam: usize, place: &Place| {
        let of_manoeuvre = |(manoeuvre, instants): (&Manoeuvre<'_>, &Vec<Vec<Vec<Place>>>)| {
            let at = |now: &Vec<Vec<Place>>| {
                let now = at_instant(description, &now[beam], place);
                now.map_or_else(Vec::new, |now| contour(&now.section_moduli(manoeuvre.moduli), &now.wrench))
            };
            instants.iter().map(at).collect::<Vec<Vec<f64>>>()
        };
        let contours: Vec<Vec<Vec<f64>>> = manoeuvres.iter().zip(&instants).map(of_manoeuvre).collect();
        let detail = detail(place.beam(description));
        let of_point = |point: usize| {
            let of_manoeuvre = |(manoeuvre, contours): (&Manoeuvre<'_>, &Vec<Vec<f64>>)| {
                let history: Vec<f64> = contours.iter().map(|contour| contour[point]).collect();
                let (repetitions, cycles) = (manoeuvre.repetitions, count_repeating_cycles(&history));
                DamagePart { repetitions, damage: repetitions * detail.damage(&cycles), history, cycles }
            };
            let parts: Vec<DamagePart> = manoeuvres.iter().zip(&contours).map(of_manoeuvre).collect();
            Fatigue { place: *place, damage: parts.iter().map(|part| part.damage).sum(), parts }
        };
        let points = contours.iter().flatten().map(Vec::len).min().unwrap_or(0);
        (0..points).map(of_point).max_by(|a, b| a.damage.total_cmp(&b.damage))
    };
    let of_beam = |beam: usize| {
        let poses: Vec<&[Place]> = instants.iter().flatten().map(|now| now[beam].as_slice()).collect();
        let mut found: Vec<Fatigue> =
            places_of_steel(description, &poses).iter().filter_map(|place| of_place(beam, place)).collect();
        // From the beginning to the end. Just before and just after where a pad may be is one place: the side that suffers more.
        found.sort_by(|a, b| a.place.x.total_cmp(&b.place.x));
        found.dedup_by(|other, kept| {
            let [one, two] = [&*kept, &*other].map(|of| (of.place.x, of.place.info(description)));
            let is_one = one.1.slides && two.1.slides && one.0 == two.0 && one.1.at == two.1.at;
            if is_one && other.damage > kept.damage {
                std::mem::swap(other, kept);
            }
            is_one
        });
        found
    };
    (0..beams.len()).flat_map(of_beam).collect()
}

/// The places of the steel of a beam at which cycles are counted, from those in its poses: sections that do not slide, and, on both sides of what slides,
/// places over its way, its ends among them.
fn places_of_steel(description: &Description, poses: &[&[Place]]) -> Vec<Place> {
    let Some(first) = poses.first() else { return Vec::new() };
    let slides = |place: &&Place| place.info(description).slides;
    let fixed: Vec<Place> = first.iter().filter(|place| !slides(place)).copied().collect();
    let (Some(start), Some(end)) = (fixed.first(), fixed.last()) else { return fixed };
    let section = fixed.windows(2).map(|pair| pair[1].x - pair[0].x).fold(0.0, f64::max);
    let swept = first.iter().filter(slides).flat_map(|pad| {
        let positions = poses.iter().filter_map(|places| Some(of_section(places, pad.section)?.x));
        let [least, greatest] = positions
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, greatest], x| [least.min(x), greatest.max(x)])
            .map(|x| x.max(start.x).min(end.x));
        let is_within = |interval: &usize| *interval as f64 * section < PER_SECTION as f64 * (greatest - least);
        let intervals = (0..PER_SECTION * fixed.len()).take_while(is_within).count();
        let at = move |interval: usize| {
            let part = interval as f64 / intervals.max(1) as f64;
            at_instant(description, first, &Place { x: (1.0 - part) * least + part * greatest, ..*pad })
        };
        (0..=intervals).filter_map(at).collect::<Vec<_>>()
    });
    fixed.iter().copied().chain(swept).collect()
}

/// A place of the steel in a pose, of whose places along the beam it may be one.
fn at_instant(description: &Description, now: &[Place], place: &Place) -> Option<Place> {
    let info = place.info(description);
    if !info.slides {
        return of_section(now, place.section).copied();
    }
    let (wrench, moduli) = carried(description, now, place.x, info.side)?;
    Some(Place { wrench, moduli, ..*place })
}

fn of_section(places: &[Place], section: usize) -> Option<&Place> {
    places.iter().find(|place| place.section == section)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(cycles: &[Cycle]) -> Vec<(f64, f64)> {
        let mut ranges: Vec<f64> = cycles.iter().map(|cycle| cycle.range).collect();
        ranges.sort_by(f64::total_cmp);
        ranges.dedup();
        let count = |range: f64| cycles.iter().filter(|cycle| cycle.range == range).map(|cycle| cycle.count).sum();
        ranges.into_iter().map(|range| (range, count(range))).collect()
    }

    /// The example of ASTM E1049-85, Fig. 6.
    const EXAMPLE: [f64; 9] = [-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0];

    #[test]
    fn example_of_the_standard() {
        assert_eq!(counted(&count_cycles(&EXAMPLE)), [(3.0, 0.5), (4.0, 1.5), (6.0, 0.5), (8.0, 1.0), (9.0, 0.5)]);
    }

    /// The same history without end, by hand, from 5 on: −1 to 3 closes first, then −2 to 1, then 4 to −3, and 5 to −4 remains.
    #[test]
    fn a_history_that_repeats_has_full_cycles_only() {
        assert_eq!(counted(&count_repeating_cycles(&EXAMPLE)), [(3.0, 1.0), (4.0, 1.0), (7.0, 1.0), (9.0, 1.0)]);
        // Where it begins does not matter.
        for shift in 1..EXAMPLE.len() - 1 {
            let period = &EXAMPLE[..EXAMPLE.len() - 1];
            let turned: Vec<f64> = period[shift..].iter().chain(&period[..shift]).copied().collect();
            assert_eq!(
                counted(&count_repeating_cycles(&turned)),
                counted(&count_repeating_cycles(&EXAMPLE)),
                "{shift}"
            );
        }
    }

    /// A force of 40 kN on 0.002 m² and moments of 3 kN m about y on 1e-4 m³ and of 1 kN m about z on 5e-5 m³ make 20, 30 and 20 megapascals.
    #[test]
    fn corners_of_a_box_have_the_stresses_of_both_moments() {
        let moduli =
            SectionModuli { area: 2e-3, bending_y: 1e-4, bending_z: 5e-5, corners: 1.0, ..SectionModuli::ZERO };
        let wrench = Wrench { force: [4e4, 0.0, 0.0].into(), moment: [0.0, 3e3, 1e3].into() };
        let stresses = contour(&moduli, &wrench);
        for (value, expected) in stresses.iter().zip([70e6, 30e6, -30e6, 10e6]) {
            assert!((value - expected).abs() < 1e-6, "{stresses:?}");
        }
    }

    #[test]
    fn a_sine_is_one_cycle_per_period() {
        let history: Vec<f64> = (0..=400).map(|k| (std::f64::consts::TAU * f64::from(k) / 100.0).sin()).collect();
        let cycles = count_repeating_cycles(&history);
        assert_eq!(counted(&cycles), [(2.0, 4.0)]);
        // s = n/2·10⁶ exactly.
        assert_eq!(history_parameter(cycles.iter().map(|cycle| (1e5, cycle)), 3.0), 4e5 / 2e6);
        assert_eq!(class(0.2), Some(5));
    }

    #[test]
    fn life_of_a_notched_part_by_hand() {
        // 100 MPa on a category of 71 MPa: 2·10⁶ · 0.71³ cycles.
        let detail = Detail { category: 71e6, slope: 3.0 };
        assert!((detail.endured(100e6) - 715_822.0).abs() < 1e-6);
        let cycles = count_repeating_cycles(&[0.0, 100e6]);
        assert!((detail.damage(&cycles) * 715_822.0 - 1.0).abs() < 1e-12);
        // Half of the range does an eighth of the damage.
        let half = count_repeating_cycles(&[0.0, 50e6]);
        assert!((detail.damage(&cycles) / detail.damage(&half) - 8.0).abs() < 1e-12);
    }

    #[test]
    fn classes_double() {
        let expected =
            [(0.0, Some(0)), (1.0 / 128.0, Some(0)), (0.008, Some(1)), (0.12, Some(4)), (4.0, Some(9)), (4.1, None)];
        for (parameter, class_of_it) in expected {
            assert_eq!(class(parameter), class_of_it, "{parameter}");
        }
    }

    #[test]
    fn nothing_happens_to_what_is_constant() {
        assert_eq!(count_cycles(&[1.0; 5]), []);
        assert_eq!(count_repeating_cycles(&[1.0; 5]), []);
        assert_eq!(count_repeating_cycles(&[]), []);
        assert_eq!(history_parameter(std::iter::empty(), 3.0), 0.0);
    }
}
