//! Figures as SVG: panels of curves with labelled axes and one legend, in colours that colour-blind readers can distinguish.

use crane_codegen::exchange::xml::escaped;
use plotters::{
    coord::Shift,
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

/// M. Okabe, K. Ito, Color Universal Design, 2008.
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
/// See [`BLUE`].
pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
/// See [`BLUE`].
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
/// See [`BLUE`].
pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
/// See [`BLUE`].
pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
/// See [`BLUE`].
pub const SKY: RGBColor = RGBColor(86, 180, 233);
/// For what lies behind other curves.
pub const GREY: RGBColor = RGBColor(150, 150, 150);
/// Colours for curves in order.
pub const PALETTE: [RGBColor; 6] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY];

/// A colour between dark blue, at 0, and yellow, at 1: viridis, in which lightness grows evenly.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "parts of 256")]
pub fn shade(part: f64) -> RGBColor {
    const STOPS: [[f64; 3]; 5] =
        [[68.0, 1.0, 84.0], [59.0, 82.0, 139.0], [33.0, 145.0, 140.0], [94.0, 201.0, 98.0], [253.0, 231.0, 37.0]];
    let position = part.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let below = (position as usize).min(STOPS.len() - 2);
    let between = position - below as f64;
    let [red, green, blue] =
        [0, 1, 2].map(|of| (STOPS[below][of] + between * (STOPS[below + 1][of] - STOPS[below][of])).round() as u8);
    RGBColor(red, green, blue)
}

/// Units of the drawing per pixel: points are rounded to whole units, and this many keep curves smooth.
pub const PIXEL: u32 = 10;
/// Width of a panel.
const WIDTH: u32 = 440 * PIXEL;
/// Height of a panel.
const HEIGHT: u32 = 270 * PIXEL;
/// Height of a row of the legend.
const LEGEND: u32 = 26 * PIXEL;
/// Font size.
pub const FONT: f64 = 15.0 * PIXEL as f64;
/// Font size of the first line of a title.
const TITLE: f64 = 1.2 * FONT;
/// Font size of its other lines.
const SMALL: f64 = 0.8 * FONT;
/// Height of one of them.
const LINE: u32 = 18 * PIXEL;
/// Width of a curve.
const STROKE: u32 = 2 * PIXEL;
/// Radius of a dot.
const DOT: u32 = 3 * PIXEL;
/// Free space around a panel.
pub const SPACE: u32 = 12 * PIXEL;
/// Width of a letter relative to the font size: a generous estimate.
const LETTER: f64 = 0.56;
/// Part of the range that is left free around the curves.
const MARGIN: f64 = 0.06;
/// Space for tick labels and axis titles: left, bottom.
const AXES: (u32, u32) = (70 * PIXEL, 46 * PIXEL);

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line.
    Solid,
    /// A line that lies on top of others and lets them be seen.
    Dashed,
    /// Its points alone.
    Dots,
    /// Its points and a line through them.
    Both,
}

/// A curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name in the legend.
    pub label: String,
    /// Its colour.
    pub colour: RGBColor,
    /// How it is drawn.
    pub mark: Mark,
    /// Where it goes.
    pub points: Vec<(f64, f64)>,
}

/// Axes with curves.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Title of the horizontal axis, with unit.
    pub x: String,
    /// Title of the vertical axis, with unit.
    pub y: String,
    /// One metre along x is as long as one along y: for paths. Such a panel is twice as wide and high.
    pub equal: bool,
    /// Both axes are logarithmic; what is not above zero is left out.
    pub logarithmic: bool,
    /// Curves, in the order of the legend.
    pub curves: Vec<Curve>,
}

/// An SVG with the panels in rows of `columns`, below the legend of the first.
pub fn svg(panels: &[Panel], columns: usize) -> Result<String, String> {
    titled(&[], panels, columns)
}

/// As [`svg`], below lines of a title, the first of which is larger.
pub fn titled(title: &[String], panels: &[Panel], columns: usize) -> Result<String, String> {
    let columns = columns.clamp(1, panels.len().max(1));
    let rows = panels.len().div_ceil(columns);
    let scale = if panels.iter().any(|panel| panel.equal) { 2 } else { 1 };
    let count = |n: usize| u32::try_from(n).unwrap_or(1);
    let width = WIDTH * scale * count(columns);
    // Several curves with the same label share an entry.
    let mut legend: Vec<Curve> = Vec::new();
    for curve in panels.first().map_or(&[][..], |panel| &panel.curves) {
        if legend.iter().all(|known| known.label != curve.label) {
            legend.push(curve.clone());
        }
    }
    let legend = legend.as_slice();
    let legend_height = LEGEND * count(legend.len().div_ceil(entries_a_row(legend, width))) + SPACE / 2;
    let title = folded(title, width - 2 * SPACE);
    let title_height = title_height(&title);
    let height = HEIGHT * scale * count(rows) + legend_height + title_height;

    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        let drawn = (|| {
            area.fill(&WHITE)?;
            let (top, rest) = area.split_vertically(title_height);
            draw_title(&top, &title)?;
            let (top, rest) = rest.split_vertically(legend_height);
            draw_legend(&top, legend)?;
            for (panel, part) in panels.iter().zip(rest.split_evenly((rows, columns))) {
                draw_panel(&part, panel)?;
            }
            area.present()
        })();
        drawn.map_err(|error| error.to_string())?;
    }
    let axes = || panels.iter().map(|panel| format!("{} over {}", panel.y, panel.x)).collect::<Vec<_>>();
    Ok(finished(&text, (width, height), &if title.is_empty() { axes() } else { title }))
}

/// A drawing as a picture: as large as its pixels, while the drawing inside keeps its finer units; and with a title, which screen readers speak and
/// browsers show.
pub fn finished(drawing: &str, (width, height): (u32, u32), title: &[String]) -> String {
    let size = |width: u32, height: u32| format!("width=\"{width}\" height=\"{height}\"");
    let sized =
        drawing.replacen(&size(width, height), &format!("{} role=\"img\"", size(width / PIXEL, height / PIXEL)), 1);
    sized.replacen('>', &format!(">\n<title>{}</title>", escaped(&title.join("; "))), 1)
}

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub type Drawn<'a> = Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>>;

/// Black text of a size.
pub fn font(size: f64) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&BLACK)
}

/// Lines of a title, none longer than a width.
pub fn folded(title: &[String], width: u32) -> Vec<String> {
    let mut lines = Vec::new();
    for (index, text) in title.iter().enumerate() {
        let letter = LETTER * if index == 0 { TITLE } else { SMALL };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive number")]
        let most = (f64::from(width) / letter) as usize;
        lines.extend(wrapped(text, most.max(1)));
    }
    lines
}

/// Text in lines of at most `most` characters, if its words allow.
pub fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut().filter(|line| line.chars().count() + 1 + word.chars().count() <= most) {
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Height of the lines of a title.
pub fn title_height(lines: &[String]) -> u32 {
    let more = u32::try_from(lines.len().saturating_sub(1)).unwrap_or(0);
    if lines.is_empty() { 0 } else { LEGEND + LINE * more + SPACE / 2 }
}

/// Writes the lines of a title.
pub fn draw_title<'a>(area: &Area<'a>, lines: &[String]) -> Drawn<'a> {
    let below = i32::try_from(LINE).unwrap_or(0);
    let (x, mut y) = (i32::try_from(SPACE).unwrap_or(0), i32::try_from(LEGEND * 3 / 5).unwrap_or(0));
    for (index, line) in lines.iter().enumerate() {
        let style = font(if index == 0 { TITLE } else { SMALL }).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(line.clone(), (x, y), style))?;
        y += below;
    }
    Ok(())
}

/// Width of an entry of the legend.
fn entry_width(legend: &[Curve]) -> f64 {
    let letters = legend.iter().map(|curve| curve.label.chars().count()).max().unwrap_or(0);
    60.0 * f64::from(PIXEL) + letters as f64 * FONT * LETTER
}

fn entries_a_row(legend: &[Curve], width: u32) -> usize {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive number")]
    let entries = (f64::from(width) / entry_width(legend)) as usize;
    entries.max(1)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "places in a picture")]
fn draw_legend<'a>(area: &Area<'a>, legend: &[Curve]) -> Drawn<'a> {
    let (width, _) = area.dim_in_pixel();
    let a_row = entries_a_row(legend, width);
    let entry = entry_width(legend);
    for (index, curve) in legend.iter().enumerate() {
        let x = (f64::from(AXES.0) * 0.5 + entry * (index % a_row) as f64) as i32;
        let y = (f64::from(LEGEND) * (0.6 + (index / a_row) as f64)) as i32;
        let dashes: &[(i32, i32)] = match curve.mark {
            Mark::Solid | Mark::Both => &[(0, 32)],
            Mark::Dashed => &[(0, 8), (12, 20), (24, 32)],
            Mark::Dots => &[],
        };
        if matches!(curve.mark, Mark::Dots | Mark::Both) {
            area.draw(&Circle::new((x + 16 * PIXEL as i32, y), DOT, curve.colour.filled()))?;
        }
        for (from, to) in dashes.iter().map(|&(from, to)| (x + from * PIXEL as i32, x + to * PIXEL as i32)) {
            area.draw(&PathElement::new([(from, y), (to, y)], curve.colour.stroke_width(STROKE)))?;
        }
        let style = font(FONT).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(curve.label.clone(), (x + 42 * PIXEL as i32, y), style))?;
    }
    Ok(())
}

fn draw_panel<'a>(area: &Area<'a>, panel: &Panel) -> Drawn<'a> {
    let scaled = |&(x, y): &(f64, f64)| if panel.logarithmic { (x.log10(), y.log10()) } else { (x, y) };
    let points = || panel.curves.iter().flat_map(|curve| &curve.points).map(scaled);
    let label = |value: &f64| if panel.logarithmic { power(*value) } else { tick(*value) };
    let mut x = padded(points().map(|point| point.0), if panel.equal || panel.logarithmic { MARGIN } else { 0.0 });
    let mut y = padded(points().map(|point| point.1), MARGIN);
    let (width, height) = area.dim_in_pixel();
    let inner = (f64::from(width - AXES.0 - 2 * SPACE), f64::from(height - AXES.1 - 2 * SPACE));
    if panel.equal {
        let metre = (inner.0 / (x.1 - x.0)).min(inner.1 / (y.1 - y.0));
        x = around(x, inner.0 / metre);
        y = around(y, inner.1 / metre);
    }
    let mut chart = ChartBuilder::on(area)
        .margin(SPACE)
        .set_label_area_size(LabelAreaPosition::Left, AXES.0)
        .set_label_area_size(LabelAreaPosition::Bottom, AXES.1)
        .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.12).stroke_width(PIXEL))
        .axis_style(BLACK.stroke_width(PIXEL))
        .set_all_tick_mark_size(5 * PIXEL)
        .x_desc(&panel.x)
        .y_desc(&panel.y)
        .x_labels(7)
        .y_labels(7)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .label_style(font(0.87 * FONT))
        .axis_desc_style(font(FONT))
        .draw()?;
    for curve in &panel.curves {
        let points = curve.points.iter().map(scaled).filter(|point| point.0.is_finite() && point.1.is_finite());
        let dots = |(x, y)| Circle::new((x, y), DOT, curve.colour.filled());
        if curve.mark == Mark::Both {
            chart.draw_series(points.clone().map(dots))?;
        }
        let style = curve.colour.stroke_width(STROKE);
        match curve.mark {
            Mark::Solid | Mark::Both => chart.draw_series(LineSeries::new(points, style))?,
            Mark::Dashed => chart.draw_series(DashedLineSeries::new(points, 7 * PIXEL, 5 * PIXEL, style))?,
            Mark::Dots => chart.draw_series(points.map(dots))?,
        };
    }
    Ok(())
}

/// Text at a tick of a logarithmic axis: 1e−4, and what lies between powers as a number.
fn power(exponent: f64) -> String {
    let text =
        if exponent == exponent.round() { format!("1e{exponent}") } else { format!("{:.1e}", 10_f64.powf(exponent)) };
    text.replace('-', "−")
}

/// Text at a tick: without the digits that rounding leaves.
pub fn tick(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.replace('-', "−") }
}

/// Range of finite values with a margin; of length 1 where all are equal.
fn padded(values: impl Iterator<Item = f64>, margin: f64) -> (f64, f64) {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        (0.0, 1.0)
    } else if high - low <= f64::EPSILON * low.abs().max(high.abs()) {
        (low - 0.5, low + 0.5)
    } else {
        let margin = margin * (high - low);
        (low - margin, high + margin)
    }
}

/// A range of this length about the middle of another.
fn around(range: (f64, f64), length: f64) -> (f64, f64) {
    let middle = 0.5 * (range.0 + range.1);
    (middle - 0.5 * length, middle + 0.5 * length)
}
