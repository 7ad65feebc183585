//! A quantity over two axes as coloured cells, with a scale.

use plotters::prelude::*;

use crate::figures::{FONT, PIXEL, SPACE, font, shade, tick};

/// Coloured cells.
pub struct Map {
    /// What the colours show, with unit.
    pub title: String,
    /// Title and values of the horizontal axis, ascending or descending.
    pub x: (String, Vec<f64>),
    /// Title and values of the vertical axis.
    pub y: (String, Vec<f64>),
    /// Rows along x, one per value of y; NaN is left blank.
    pub cells: Vec<Vec<f64>>,
}

/// Size of the picture.
const SIZE: (u32, u32) = (640 * PIXEL, 460 * PIXEL);
/// Width of the scale with its numbers.
const SCALE: u32 = 90 * PIXEL;
/// Steps of the scale.
const STEPS: i32 = 60;

/// The map as SVG.
pub fn svg(map: &Map) -> Result<String, String> {
    let mut text = String::new();
    draw(map, &mut text).map_err(|error| error.to_string())?;
    let size = |(width, height): (u32, u32)| format!("width=\"{width}\" height=\"{height}\"");
    Ok(text.replacen(&size(SIZE), &size((SIZE.0 / PIXEL, SIZE.1 / PIXEL)), 1))
}

fn draw(map: &Map, text: &mut String) -> Result<(), Box<dyn std::error::Error>> {
    let numbers = || map.cells.iter().flatten().copied().filter(|number| number.is_finite());
    let (least, greatest) = (numbers().fold(f64::INFINITY, f64::min), numbers().fold(f64::NEG_INFINITY, f64::max));
    let (least, greatest) = if least < greatest { (least, greatest) } else { (least - 0.5, least + 0.5) };
    let colour = |number: f64| shade((number - least) / (greatest - least));
    let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let titled = area.margin(SPACE, 0, 0, 0).titled(&map.title, font(FONT))?;
    let (left, right) = titled.split_horizontally(SIZE.0 - SCALE);

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
    let steps = (0..STEPS).map(|place| {
        let from = least + step * f64::from(place);
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
            title: "load [kg]".to_owned(),
            x: ("slew [°]".to_owned(), vec![0.0, 90.0, 180.0]),
            y: ("boom [°]".to_owned(), vec![0.0, 30.0]),
            cells: vec![vec![1.0, 2.0, 3.0], vec![4.0, f64::NAN, 6.0]],
        };
        let picture = svg(&map).unwrap();
        assert!(picture.contains("load [kg]") && picture.contains("slew [°]"));
        // Background, five cells and the scale.
        assert!(picture.matches("<rect").count() >= 5 + 60, "{}", picture.matches("<rect").count());
    }
}
