//! The chart of what moves what: for every output a bar per number, to the right where it grows.

use crane_live::sensitivity::label;
use plotters::{
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

use super::{Changes, tables::readable};
use crate::{
    figures::{Area, BLUE, Drawn, FONT, PIXEL, SPACE, VERMILLION, font},
    problem::{Outcome, Problem},
};

/// Width of the picture, of its names and of its numbers.
const WIDTH: i32 = 900 * PIXEL.cast_signed();
const NAMES: i32 = 330 * PIXEL.cast_signed();
const NUMBERS: i32 = 170 * PIXEL.cast_signed();
/// Height of a bar with the space around it, and of the name of an output.
const ROW: i32 = 22 * PIXEL.cast_signed();
/// Numbers of an output that have bars.
const MOST: usize = 6;

/// The bars of an output.
struct Block {
    title: String,
    /// Name of the number, relative change, and the change as people read it.
    bars: Vec<(String, f64, String)>,
}

/// The chart as SVG; `change`: that of each number, relative to its value.
///
/// # Errors
/// Nothing that is shown has a relative change.
pub fn chart(changes: &Changes<'_>, change: f64) -> Outcome<String> {
    let blocks: Vec<Block> = changes.shown.iter().filter_map(|&index| block(changes, index)).collect();
    if blocks.is_empty() {
        return Err(Problem::usage(
            "there is nothing to draw: no output that is shown has a relative change",
            "ask for forces, stresses, tipping or frequencies with `--of`",
        ));
    }
    let shares = blocks.iter().flat_map(|block| &block.bars).map(|(_, share, _)| share.abs());
    let greatest = shares.fold(f64::MIN_POSITIVE, f64::max);
    let rows: usize = blocks.iter().map(|block| block.bars.len() + 2).sum();
    let height = ROW * (2 + i32::try_from(rows).unwrap_or(0));
    let size = (WIDTH.unsigned_abs(), height.unsigned_abs());
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        let drawn = (|| {
            area.fill(&WHITE)?;
            let title = format!("{}: changes with {:+} % of each number", changes.description.name, 100.0 * change);
            write(&area, &title, (SPACE.cast_signed(), ROW), 1.2 * FONT, HPos::Left)?;
            let mut y = 2 * ROW;
            for block in &blocks {
                draw(&area, block, greatest, &mut y)?;
            }
            area.present()
        })();
        drawn.map_err(|error| Problem::failed(format!("cannot draw the chart: {error}"), ""))?;
    }
    let given = |(width, height): (u32, u32)| format!("width=\"{width}\" height=\"{height}\"");
    Ok(text.replacen(&given(size), &given((size.0 / PIXEL, size.1 / PIXEL)), 1))
}

/// The bars of an output; `None` where nothing moves it.
fn block(changes: &Changes<'_>, index: usize) -> Option<Block> {
    let output = &changes.found.outputs[index];
    let (scale, unit) = readable(output.unit, output.group);
    let place = if output.place.is_empty() { String::new() } else { format!(" – {}", output.place) };
    let mut bars: Vec<(String, f64, String)> = changes
        .order
        .iter()
        .filter_map(|&place| {
            let share = changes.relative(place, index)?;
            let number = format!("{:+.1} %", 100.0 * share).replace('-', "−");
            Some((label(changes.info(place)).to_owned(), share, number))
        })
        .collect();
    bars.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    bars.truncate(MOST);
    let value = format!("{:.4}", scale * changes.found.values[index]);
    let value = value.trim_end_matches('0').trim_end_matches('.');
    let title = format!("{} {value} {unit}{place}", output.name);
    (!bars.is_empty()).then_some(Block { title, bars })
}

/// Draws a block from y downwards; returns where the next one begins.
fn draw<'a>(area: &Area<'a>, block: &Block, greatest: f64, y: &mut i32) -> Drawn<'a> {
    write(area, &block.title, (SPACE.cast_signed(), *y + ROW / 2), FONT, HPos::Left)?;
    *y += ROW;
    let (left, right) = (NAMES, WIDTH - NUMBERS);
    let middle = i32::midpoint(left, right);
    for (name, share, number) in &block.bars {
        let centre = *y + ROW / 2;
        write(area, name, (NAMES - SPACE.cast_signed(), centre), 0.87 * FONT, HPos::Right)?;
        #[expect(clippy::cast_possible_truncation, reason = "a place in a picture")]
        let end = middle + (f64::from(right - middle) * share / greatest).round() as i32;
        let colour = if *share < 0.0 { VERMILLION } else { BLUE };
        let (from, to) = (middle.min(end), middle.max(end));
        area.draw(&Rectangle::new([(from, *y + ROW / 6), (to, *y + ROW - ROW / 6)], colour.filled()))?;
        write(area, number, (right + SPACE.cast_signed(), centre), 0.87 * FONT, HPos::Left)?;
        *y += ROW;
    }
    area.draw(&PathElement::new(
        [(middle, *y - ROW * i32::try_from(block.bars.len()).unwrap_or(0)), (middle, *y)],
        BLACK.stroke_width(PIXEL),
    ))?;
    *y += ROW;
    Ok(())
}

fn write<'a>(area: &Area<'a>, text: &str, place: (i32, i32), size: f64, side: HPos) -> Drawn<'a> {
    area.draw(&Text::new(text.to_owned(), place, font(size).pos(Pos::new(side, VPos::Center))))
}
