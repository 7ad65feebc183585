//! The pictures in README.md: made by the built program, and compared with what it would make.
//!
//! The picture of the report is compared by the words of the page, in a file beside it: pixels depend on the browser and its fonts.

use std::fs;

use crate::{report, step, workspace};

/// The path of the load: the picture in README.md, and what the default run writes.
const PATH: [&str; 2] = ["docs/images/load_path.svg", "out/comparison_path.svg"];
/// The report: the page of the default run, its picture in README.md, and what the page says.
const REPORT: [&str; 3] = ["out/report.html", "docs/images/report.png", "docs/images/report.txt"];
/// Rounding of another processor, in units of the drawing, of which a pixel has ten: at most half a pixel.
const ROUNDING: f64 = 5.0;

/// Makes the pictures again from the results of the default run.
pub fn make_pictures() -> Result<(), String> {
    let [picture, made] = PATH;
    let root = workspace::root();
    fs::copy(root.join(made), root.join(picture)).map_err(|error| format!("{made}: {error}"))?;
    step::run_to_end(report::command_in_folder("node").arg("picture.js").args(REPORT.map(|file| root.join(file))))
}

/// Checks that the pictures are those of the results of the default run.
pub fn check_pictures() -> Result<(), String> {
    let [picture, made] = PATH;
    compare_drawings(&workspace::read_file(picture)?, &workspace::read_file(made)?)
        .map_err(|problem| format!("{picture} is not {made}: {problem}; cargo xtask pictures"))?;
    let files = REPORT.map(|file| workspace::root().join(file));
    step::run_to_end(report::command_in_folder("node").args(["picture.js", "--check"]).args(files))
}

/// Compares two drawings (SVG): their words, and the number, the extent and the ends of their lines.
fn compare_drawings(one: &str, other: &str) -> Result<(), String> {
    if words(one) != words(other) {
        return Err("other words".into());
    }
    let lines = [one, other].map(|text| lines(text).collect::<Vec<_>>());
    if lines[0].len() != lines[1].len() {
        return Err(format!("{} lines instead of {}", lines[0].len(), lines[1].len()));
    }
    let apart = |(a, b): &(&[f64; 8], &[f64; 8])| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > ROUNDING);
    match lines[0].iter().zip(&lines[1]).position(|pair| apart(&pair)) {
        Some(index) => Err(format!("line {index}: {:?} instead of {:?}", lines[0][index], lines[1][index])),
        None => Ok(()),
    }
}

/// The texts of a drawing, which stand on lines of their own.
fn words(drawing: &str) -> Vec<&str> {
    drawing.lines().filter(|line| !line.starts_with('<')).collect()
}

/// Smallest and largest coordinates, first and last point of each polyline.
fn lines(drawing: &str) -> impl Iterator<Item = [f64; 8]> {
    let points = drawing.split(" points=\"").skip(1).filter_map(|rest| rest.split('"').next());
    points.filter_map(|points| {
        let numbers: Vec<f64> = points.split([' ', ',']).filter_map(|number| number.parse().ok()).collect();
        let range = |first: usize| {
            let along = numbers.iter().skip(first).step_by(2);
            along.fold([f64::MAX, f64::MIN], |[least, most], x| [least.min(*x), most.max(*x)])
        };
        let ([left, right], [top, bottom]) = (range(0), range(1));
        let ([x, y, ..], [.., end_x, end_y]) = (&numbers[..], &numbers[..]) else { return None };
        Some([left, right, top, bottom, *x, *y, *end_x, *end_y])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawings_differ_by_words_and_lines() {
        let drawing = |word: &str, points: &str| {
            format!("<polyline fill=\"none\" points=\"{points}\"/>\n<text>\n{word}\n</text>\n")
        };
        let one = drawing("log", "0,0 100,50 200,0 ");
        assert_eq!(compare_drawings(&one, &drawing("log", "0,0 50,25 101,49 200,0 ")), Ok(()));
        for other in [
            drawing("load", "0,0 100,50 200,0 "),
            drawing("log", "0,0 100,60 200,0 "),
            drawing("log", "0,0 100,50 200,9 "),
        ] {
            assert!(compare_drawings(&one, &other).is_err(), "{other}");
        }
        assert!(compare_drawings(&one, &(one.clone() + "<polyline points=\"1,1 2,2\"/>")).is_err());
    }
}
