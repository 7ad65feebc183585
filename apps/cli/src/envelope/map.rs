//! A quantity over two axes as coloured cells, with a scale.

use plotters::prelude::*;

use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::figures::{FONT, PIXEL, SPACE, draw_title, finished, folded, font, shade, tick, title_height};

/// Coloured cells.
#[derive(Clone)]
pub struct Map {
    /// Lines: what the colours show, with unit, and more about it.
    pub title: Vec<String>,
    /// Title and values of the horizontal axis, ascending or descending.
    pub x: (String, Vec<f64>),
    /// Title and values of the vertical axis.
    pub y: (String, Vec<f64>),
    /// Rows along x, one per value of y; NaN is left blank.
    pub cells: Vec<Vec<f64>>,
    /// What is written into the cells, in the same order: all of it, else its last word, else nothing, as there is room.
    pub words: Vec<Vec<String>>,
}

/// Size of the picture without its title.
const SIZE: (u32, u32) = (640 * PIXEL, 460 * PIXEL);
/// Width of a letter and height of a line in a cell.
const ROOM: (f64, f64) = (0.55 * FONT, 1.1 * FONT);
/// Width of the scale with its numbers.
const SCALE: u32 = 90 * PIXEL;
/// Steps of the scale.
const STEPS: i32 = 60;

/// The map as SVG.
pub fn svg(map: &Map) -> Result<String, String> {
    let mut text = String::new();
    let title = folded(&map.title, SIZE.0 - 2 * SPACE);
    let above = title_height(&title);
    let (width, height) = (SIZE.0, SIZE.1 + above);
    draw(map, &mut text, (&title, above)).map_err(|error| error.to_string())?;
    Ok(finished(&text, (width, height), &map.title))
}

fn draw(map: &Map, text: &mut String, title: (&[String], u32)) -> Result<(), Box<dyn std::error::Error>> {
    let numbers = || map.cells.iter().flatten().copied().filter(|number| number.is_finite());
    let (least, greatest) = (numbers().fold(f64::INFINITY, f64::min), numbers().fold(f64::NEG_INFINITY, f64::max));
    let (least, greatest) = if least < greatest { (least, greatest) } else { (least - 0.5, least + 0.5) };
    let colour = |number: f64| shade((number - least) / (greatest - least));
    let area = SVGBackend::with_string(text, (SIZE.0, SIZE.1 + title.1)).into_drawing_area();
    area.fill(&WHITE)?;
    let (top, rest) = area.split_vertically(title.1);
    draw_title(&top, title.0)?;
    let (left, right) = rest.split_horizontally(SIZE.0 - SCALE);

    let (x, y) = (borders(&map.x.1), borders(&map.y.1));
    let range = |borders: &[f64]| {
        let (from, to) = (borders[0], borders[borders.len() - 1]);
        from.min(to)..from.max(to)
    };
    let mut chart = ChartBuilder::on(&left)
        .margin(SPACE)
        .set_label_area_size(LabelAreaPosition::Left, 70 * PIXEL)
        .set_label_area_size(LabelAreaPosition::Bottom, 46 * PIXEL)
        .build_cartesian_2d(range(&x), range(&y))?;
    chart
        .configure_mesh()
        .disable_mesh()
        .axis_style(BLACK.stroke_width(PIXEL))
        .set_all_tick_mark_size(5 * PIXEL)
        .x_desc(&map.x.0)
        .y_desc(&map.y.0)
        .x_label_formatter(&|value| tick(*value))
        .y_label_formatter(&|value| tick(*value))
        .label_style(font(0.87 * FONT))
        .axis_desc_style(font(FONT))
        .draw()?;
    for (row, sides) in map.cells.iter().zip(y.windows(2)) {
        for (number, ends) in row.iter().zip(x.windows(2)).filter(|(number, _)| number.is_finite()) {
            let cell = [(ends[0], sides[0]), (ends[1], sides[1])];
            chart.draw_series([Rectangle::new(cell, colour(*number).filled())])?;
        }
    }
    let spacing = |count: usize, length: u32| f64::from(length) / count.max(1) as f64;
    let (width, height) = (SIZE.0 - SCALE - 70 * PIXEL, SIZE.1 - 46 * PIXEL);
    let fits = |part: fn(&str) -> &str| {
        let letters = map.words.iter().flatten().map(|word| part(word).chars().count()).max().unwrap_or(0);
        spacing(map.x.1.len(), width) >= letters as f64 * ROOM.0 && spacing(map.y.1.len(), height) >= ROOM.1
    };
    let parts: [fn(&str) -> &str; 2] = [|word| word, |word| word.rsplit(' ').next().unwrap_or(word)];
    if let Some(shown) = parts.into_iter().find(|part| fits(*part)) {
        for (words, (row, sides)) in map.words.iter().zip(map.cells.iter().zip(y.windows(2))) {
            for (word, (number, ends)) in words.iter().zip(row.iter().zip(x.windows(2))) {
                // Dark cells have white letters.
                let part = (number - least) / (greatest - least);
                let style = font(0.87 * FONT).color(if part < 0.6 { &WHITE } else { &BLACK });
                let middle = (0.5 * (ends[0] + ends[1]), 0.5 * (sides[0] + sides[1]));
                let style = style.pos(Pos::new(HPos::Center, VPos::Center));
                chart.draw_series([Text::new(shown(word).to_owned(), middle, style)])?;
            }
        }
    }

    let mut scale = ChartBuilder::on(&right)
        .margin(SPACE)
        .margin_bottom(SPACE + 46 * PIXEL)
        .set_label_area_size(LabelAreaPosition::Left, 55 * PIXEL)
        .build_cartesian_2d(0.0..1.0, least..greatest)?;
    scale
        .configure_mesh()
        .disable_mesh()
        .disable_x_axis()
        .axis_style(BLACK.stroke_width(PIXEL))
        .y_label_formatter(&|value| tick(*value))
        .label_style(font(0.87 * FONT))
        .draw()?;
    let step = (greatest - least) / f64::from(STEPS);
    let steps = (0..STEPS).map(|index| {
        let from = least + step * f64::from(index);
        Rectangle::new([(0.0, from), (1.0, from + step)], colour(from + 0.5 * step).filled())
    });
    scale.draw_series(steps)?;
    area.present()?;
    drop((chart, scale, left, right));
    Ok(())
}

/// Where the cells of some values begin and end: half-way to their neighbours.
fn borders(values: &[f64]) -> Vec<f64> {
    let middles = values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let (first, last) = (values[0], values[values.len() - 1]);
    let (before, after) = match values {
        [.., other, _] => (0.5 * (values[1] - first), 0.5 * (last - other)),
        _ => (0.5, 0.5),
    };
    [first - before].into_iter().chain(middles).chain([last + after]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_meet_half_way() {
        assert_eq!(borders(&[1.0, 2.0, 4.0]), [0.5, 1.5, 3.0, 5.0]);
    }

    #[test]
    fn a_map_has_a_cell_per_number_and_a_scale() {
        let map = Map {
            title: vec!["load [kg]".to_owned()],
            x: ("slew [°]".to_owned(), vec![0.0, 90.0, 180.0]),
            y: ("boom [°]".to_owned(), vec![0.0, 30.0]),
            cells: vec![vec![1.0, 2.0, 3.0], vec![4.0, f64::NAN, 6.0]],
            words: vec![vec!["T".to_owned(); 3], vec!["U".to_owned(); 3]],
        };
        let picture = svg(&map).unwrap();
        assert!(picture.contains("load [kg]") && picture.contains("slew [°]"));
        assert_eq!((picture.matches("\nT\n").count(), picture.matches("\nU\n").count()), (3, 3));
        // With less room the letter is left of a load and its letter.
        let crowded = |count: usize| {
            let word = vec!["1890 T".to_owned(); count];
            let values: Vec<f64> = (0..count).map(|index| index as f64).collect();
            let (x, cells) = (("slew [°]".to_owned(), values.clone()), vec![values; 2]);
            let picture = svg(&Map { x, cells, words: vec![word; 2], ..map.clone() }).unwrap();
            ["\n1890 T\n", "\nT\n"].map(|text| picture.matches(text).count())
        };
        assert_eq!([crowded(4), crowded(13), crowded(200)], [[8, 0], [0, 26], [0, 0]]);
        // Background, five cells and the scale.
        assert!(picture.matches("<rect").count() >= 5 + 60, "{}", picture.matches("<rect").count());
    }
}
