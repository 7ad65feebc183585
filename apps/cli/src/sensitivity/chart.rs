//! The chart of what moves what: for every output a bar per number, to the right where it grows.

use crane_page::tables::Cell;
use plotters::{
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

use super::{Changes, tables::readable};
use crate::{
    figures::{Area, BLUE, Drawn, FONT, PIXEL, SPACE, VERMILLION, finished, font, wrapped},
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

/// Letters of a name that fit.
const LETTERS: usize = 60;
/// A smaller change, relative to the output, has no bar.
pub const NOTHING: f64 = 5e-4;
/// Lines of the scale to each side.
const TICKS: f64 = 4.0;
/// Colour of its lines.
const LINES: RGBColor = RGBColor(221, 221, 221);

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
pub fn chart(changes: &Changes, change: f64) -> Outcome<String> {
    let has_change = |index: &&usize| changes.order.iter().any(|&place| changes.relative(place, **index).is_some());
    let (mut blocks, mut still) = (Vec::new(), Vec::new());
    for &index in changes.shown.iter().filter(has_change) {
        match block(changes, index) {
            Some(block) => blocks.push(block),
            None => still.push(changes.found.outputs[index].name.as_str()),
        }
    }
    if blocks.is_empty() {
        return Err(Problem::usage(
            format!(
                "there is nothing to draw: no output that is shown changes by {} % of itself or more",
                100.0 * NOTHING
            ),
            "ask for forces, stresses, tipping or frequencies with `--of`, or for another `--change`",
        ));
    }
    let shares = blocks.iter().flat_map(|block| &block.bars).map(|(_, share, _)| share.abs());
    let greatest = shares.fold(f64::MIN_POSITIVE, f64::max);
    let still = if still.is_empty() {
        Vec::new()
    } else {
        wrapped(&format!("Less than {} %: {}", 100.0 * NOTHING, still.join(", ")), 2 * LETTERS)
    };
    let rows: usize = blocks.iter().map(|block| block.bars.len() + 2).sum::<usize>() + still.len();
    let height = ROW * (4 + i32::try_from(rows).unwrap_or(0));
    let size = (WIDTH.unsigned_abs(), height.unsigned_abs());
    let mut text = String::new();
    let title = format!("{}: changes with {:+} % of each number", changes.crane, 100.0 * change);
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        let drawn = (|| {
            area.fill(&WHITE)?;
            write(&area, &title, (SPACE.cast_signed(), ROW), 1.2 * FONT, HPos::Left)?;
            let end = height - ROW * i32::try_from(still.len() + 1).unwrap_or(0);
            scale(&area, greatest, [3 * ROW, end])?;
            let mut y = 3 * ROW;
            for block in &blocks {
                draw(&area, block, greatest, &mut y)?;
            }
            for line in &still {
                write(&area, line, (SPACE.cast_signed(), y), 0.87 * FONT, HPos::Left)?;
                y += ROW;
            }
            area.present()
        })();
        drawn.map_err(|error| Problem::failed(format!("cannot draw the chart: {error}"), ""))?;
    }
    Ok(finished(&text, size, &[title]))
}

/// The bars of an output; `None` where nothing moves it.
fn block(changes: &Changes, index: usize) -> Option<Block> {
    let output = &changes.found.outputs[index];
    let (scale, unit) = readable(output.unit, output.group);
    let place = if output.place.is_empty() { String::new() } else { format!(" – {}", output.place) };
    let mut bars: Vec<(String, f64, String)> = changes
        .order
        .iter()
        .filter_map(|&place| {
            let share = changes.relative(place, index).filter(|share| share.abs() >= NOTHING)?;
            Some((abridged(&changes.numbers[place].label), share, change_text(share)))
        })
        .collect();
    bars.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    bars.truncate(MOST);
    let value = Cell::from(scale * changes.found.values[index]).short();
    let title = format!("{}  {value} {unit}{place}", output.name);
    (!bars.is_empty()).then_some(Block { title, bars })
}

/// A relative change as people read it.
pub fn change_text(share: f64) -> String {
    format!("{:+.1} %", 100.0 * share).replace('-', "−")
}

/// A name that fits: the end of a long one.
fn abridged(name: &str) -> String {
    let letters = name.chars().count();
    if letters <= LETTERS {
        name.to_owned()
    } else {
        format!("…{}", name.chars().skip(letters - LETTERS + 1).collect::<String>())
    }
}

/// Where a share of the largest change is drawn.
#[expect(clippy::cast_possible_truncation, reason = "a place in a picture")]
fn place_of(share: f64) -> i32 {
    let (left, right) = (NAMES, WIDTH - NUMBERS);
    i32::midpoint(left, right) + (f64::from(right - left) / 2.0 * share).round() as i32
}

/// The scale above the bars and its lines through them, from one height to another; `greatest`: the largest change.
fn scale<'a>(area: &Area<'a>, greatest: f64, [from, to]: [i32; 2]) -> Drawn<'a> {
    let magnitude = 10.0_f64.powf((greatest / TICKS).log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * magnitude);
    let step = step.into_iter().find(|step| greatest / step <= TICKS).unwrap_or(greatest);
    write(
        area,
        "change of the output, relative to it",
        (NAMES - SPACE.cast_signed(), from - ROW / 2),
        0.87 * FONT,
        HPos::Right,
    )?;
    let most = (greatest / step).floor();
    let mut count = -most;
    while count <= most {
        let x = place_of(count * step / greatest);
        let number = format!("{} %", Cell::from(100.0 * count * step).short()).replace('-', "−");
        write(area, &number, (x, from - ROW / 2), 0.87 * FONT, HPos::Center)?;
        area.draw(&PathElement::new([(x, from), (x, to)], LINES.stroke_width(PIXEL)))?;
        count += 1.0;
    }
    Ok(())
}

/// Draws a block from y downwards; returns where the next one begins.
fn draw<'a>(area: &Area<'a>, block: &Block, greatest: f64, y: &mut i32) -> Drawn<'a> {
    write(area, &block.title, (SPACE.cast_signed(), *y + ROW / 2), FONT, HPos::Left)?;
    *y += ROW;
    let (right, middle) = (WIDTH - NUMBERS, place_of(0.0));
    for (name, share, number) in &block.bars {
        let centre = *y + ROW / 2;
        write(area, name, (NAMES - SPACE.cast_signed(), centre), 0.87 * FONT, HPos::Right)?;
        let end = place_of(share / greatest);
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
