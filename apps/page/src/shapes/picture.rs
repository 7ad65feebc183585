//! Shapes as picture elements: in perspective, nearest first, each triangle in one tone, on ground with a grid.

use nalgebra::{Matrix3, Vector3};

use super::{Figure, Owner};

/// Half the angle of view, as its tangent: that of the page.
const SLOPE: f64 = 0.305_730_681;
/// Room around the crane, relative to what it occupies.
const ROOM: f64 = 1.06;
/// Samples across a picture element.
const SAMPLES: usize = 2;
/// Rows of the picture that are in memory as samples.
const BAND: usize = 64;
/// The direction of the corner from which the page shows a crane first.
const CORNER: [f64; 3] = [-1.0, -1.25, 0.62];
/// Where the sun is; shadows fall on the ground alone.
const SUN: [f64; 3] = [-0.9, -0.7, 1.6];
/// Colours of the sky, the ground and its grid, and the tone of a shadow.
const SKY: [f64; 3] = [238.0, 242.0, 246.0];
const FLOOR: [f64; 3] = [222.0, 226.0, 229.0];
const GRID: [f64; 3] = [176.0, 184.0, 191.0];
const SHADE: f64 = 0.82;
/// Tone of a surface that is seen from its edge.
const EDGE: f64 = 0.42;
/// Width of a line of the grid, relative to its squares.
const LINE: f64 = 0.02;

/// From where a crane is seen, and the size of its picture.
#[derive(Clone, Copy, Debug)]
pub struct View {
    width: usize,
    height: usize,
    azimuth: f64,
    elevation: f64,
}

impl View {
    /// Largest width and height of a picture, picture elements.
    pub const MOST: usize = 4096;

    /// A view of a picture with these sides from `azimuth`, about z from x on, and `elevation` above the ground, rad; from the page's corner where
    /// they are not given.
    ///
    /// # Errors
    /// The picture is too large or has no size, or an angle is not a finite number.
    pub fn new(sides: [i64; 2], azimuth: Option<f64>, elevation: Option<f64>) -> Result<Self, String> {
        let (most, [x, y, z]) = (Self::MOST, CORNER);
        let side = |side: i64| usize::try_from(side).ok().filter(|side| (1..=most).contains(side));
        let [Some(width), Some(height)] = sides.map(side) else {
            let [width, height] = sides;
            return Err(format!("a picture of {width} × {height}: write 1 to {most} picture elements for both sides"));
        };
        let azimuth = azimuth.unwrap_or_else(|| y.atan2(x));
        let elevation = elevation.unwrap_or_else(|| z.atan2(x.hypot(y)));
        if !azimuth.is_finite() || !elevation.is_finite() {
            return Err(format!("a view from azimuth {azimuth}, elevation {elevation}: write finite numbers, rad"));
        }
        Ok(Self { width, height, azimuth, elevation })
    }

    /// Width and height of the picture.
    pub fn sides(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// Directions to the right, up and towards the camera, as rows.
    fn directions(&self) -> Matrix3<f64> {
        let ((sin, cos), (up, out)) = (self.azimuth.sin_cos(), self.elevation.sin_cos());
        let (right, towards) = (Vector3::new(-sin, cos, 0.0), Vector3::new(out * cos, out * sin, up));
        Matrix3::from_rows(&[right.transpose(), towards.cross(&right).transpose(), towards.transpose()])
    }
}

/// A triangle as the camera sees it: across and up in samples, and the reciprocal of the distance, m⁻¹.
struct Triangle {
    corners: [Vector3<f64>; 3],
    colour: [u8; 3],
}

/// A camera that sees all of a crane.
struct Camera {
    /// Directions to the right, up and towards the camera, as rows.
    turn: Matrix3<f64>,
    place: Vector3<f64>,
    /// Distance of the picture from the camera, and its middle, samples.
    focus: f64,
    middle: [f64; 2],
    /// Nothing nearer is drawn, m.
    near: f64,
}

impl Camera {
    /// As near as shows all corners.
    fn new(view: &View, corners: &[Vector3<f64>]) -> Self {
        let turn = view.directions();
        let seen: Vec<Vector3<f64>> = corners.iter().map(|corner| turn * corner).collect();
        let [low, high] = range(&seen);
        let size = (high - low).norm().max(1e-9);
        let centre = (low + high) / 2.0;
        let sides = [view.width, view.height].map(|side| (SAMPLES * side) as f64);
        let least = sides[0].min(sides[1]);
        let off = |corner: &Vector3<f64>| [0, 1].map(|axis| (corner[axis] - centre[axis]).abs() * least / sides[axis]);
        let distance = seen.iter().map(|corner| corner.z + ROOM * off(corner).into_iter().fold(0.0, f64::max) / SLOPE);
        let distance = distance.fold(f64::NEG_INFINITY, f64::max) + 0.02 * size;
        let position = turn.transpose() * Vector3::new(centre.x, centre.y, distance);
        Self {
            turn,
            place: position,
            focus: least / 2.0 / SLOPE,
            middle: sides.map(|side| side / 2.0),
            near: 0.01 * size,
        }
    }

    /// A place as [`Triangle`] has it, unless it is too near or behind the camera.
    fn see(&self, position: &Vector3<f64>) -> Option<Vector3<f64>> {
        let seen = self.turn * (position - self.place);
        let near = 1.0 / -seen.z;
        (-seen.z >= self.near).then(|| {
            Vector3::new(self.middle[0] + self.focus * seen.x * near, self.middle[1] - self.focus * seen.y * near, near)
        })
    }
}

pub(super) fn range(places: &[Vector3<f64>]) -> [Vector3<f64>; 2] {
    let ends = [Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)];
    places.iter().fold(ends, |[low, high], position| [low.inf(position), high.sup(position)])
}

/// The picture of a figure, red, green and blue of each picture element, row by row from the top; `shown`: places that are to be in it, too, m.
pub fn draw(figure: &Figure, view: &View, shown: &[Vector3<f64>]) -> Vec<u8> {
    let corners = figure.all_corners();
    let camera = Camera::new(view, &[&corners, shown].concat());
    let ground = Ground::new(figure.ground, range(&corners));
    let sees_ground = camera.place.z > ground.level;
    let (mut shadows, mut triangles) = (Vec::new(), Vec::new());
    // From beside the camera, so that faces differ.
    let light = (camera.turn.transpose() * Vector3::new(-0.3, 0.45, 1.0)).normalize();
    for shape in &figure.shapes {
        let corners = figure.corners(shape);
        for triangle in &shape.mesh.triangles {
            let places = triangle.map(|corner| corners[corner]);
            let [a, b, c] = places;
            let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
            let tone = EDGE + (1.0 - EDGE) * normal.dot(&light).abs();
            triangles.extend(seen(&camera, places, shape.paint.colour.map(|channel| byte(f64::from(channel) * tone))));
            if sees_ground && shape.owner != Owner::Ground {
                let fallen =
                    places.map(|position| position - Vector3::from(SUN) * ((position.z - ground.level) / SUN[2]));
                shadows.extend(seen(&camera, fallen, [0; 3]));
            }
        }
    }
    let band = |first: usize| {
        let rows = BAND.min(view.height - first);
        let mut band = Band::new(SAMPLES * first, SAMPLES * rows, SAMPLES * view.width);
        if sees_ground {
            band.lay(&camera, &ground, &shadows);
        }
        for triangle in &triangles {
            band.fill(triangle);
        }
        band.reduced()
    };
    (0..view.height).step_by(BAND).flat_map(band).collect()
}

fn seen(camera: &Camera, [a, b, c]: [Vector3<f64>; 3], colour: [u8; 3]) -> Option<Triangle> {
    Some(Triangle { corners: [camera.see(&a)?, camera.see(&b)?, camera.see(&c)?], colour })
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast limits it to what a byte can hold")]
fn byte(value: f64) -> u8 {
    (value + 0.5) as u8
}

/// Level ground under a crane.
struct Ground {
    level: f64,
    /// Size and middle of the crane, m.
    size: f64,
    centre: Vector3<f64>,
    /// Side of a square of the grid, m.
    square: f64,
}

impl Ground {
    fn new(level: f64, [low, high]: [Vector3<f64>; 2]) -> Self {
        let size = (high - low).norm().max(1e-9);
        Self { level, size, centre: (low + high) / 2.0, square: 10_f64.powf((size / 12.0).log10().round()) }
    }

    /// Its colours where a ray from the camera meets it, in the sun and in shadow; those of the sky if it does not. `across`: width of a picture
    /// element at a distance of 1 m, m.
    fn colours(&self, camera: &Camera, ray: &Vector3<f64>, across: f64) -> [[u8; 3]; 2] {
        let way = (self.level - camera.place.z) / ray.z;
        if ray.z >= 0.0 || !way.is_finite() {
            return [SKY.map(byte); 2];
        }
        let position = camera.place + way * ray;
        let (width, blur) = (LINE * self.square, way * ray.norm_squared() * across / -ray.z);
        // Distance of the nearest line; far away, the grid becomes a tone.
        let off = |x: f64| (x / self.square - (x / self.square).round()).abs() * self.square;
        let covered = (f64::midpoint(width, blur) - off(position.x).min(off(position.y))) / blur.max(1e-12);
        let line = covered.clamp(0.0, (width / blur.max(1e-12)).min(1.0));
        let haze = (((position - self.centre).norm() / self.size - 0.8) / 3.0).clamp(0.0, 1.0);
        let mut colours = [[0; 3]; 2];
        for (colour, shade) in colours.iter_mut().zip([1.0, SHADE]) {
            for channel in 0..3 {
                let own = shade * (FLOOR[channel] + line * (GRID[channel] - FLOOR[channel]));
                colour[channel] = byte(own + haze * (SKY[channel] - own));
            }
        }
        colours
    }
}

/// Some rows of samples.
struct Band {
    first: usize,
    width: usize,
    colours: Vec<[u8; 3]>,
    /// Reciprocals of the distances, m⁻¹; 0 behind everything.
    near: Vec<f64>,
}

impl Band {
    fn new(first: usize, rows: usize, width: usize) -> Self {
        let count = rows * width;
        Self { first, width, colours: vec![SKY.map(byte); count], near: vec![0.0; count] }
    }

    /// Lays the ground behind everything, with shadows on it.
    fn lay(&mut self, camera: &Camera, ground: &Ground, shadows: &[Triangle]) {
        for shadow in shadows {
            self.fill(shadow);
        }
        let across = SAMPLES as f64 / camera.focus;
        for element in 0..self.near.len() / SAMPLES.pow(2) {
            let (row, column) = (element / (self.width / SAMPLES), element % (self.width / SAMPLES));
            let middle = |sample: usize| (sample + SAMPLES / 2) as f64;
            let (right, down) = (middle(SAMPLES * column), middle(self.first + SAMPLES * row));
            let ray = Vector3::new(right - camera.middle[0], camera.middle[1] - down, -camera.focus) / camera.focus;
            let [sun, shade] = ground.colours(camera, &(camera.turn.transpose() * ray), across);
            for index in self.samples_of(row, column) {
                let shadowed = std::mem::take(&mut self.near[index]) > 0.0;
                self.colours[index] = if shadowed { shade } else { sun };
            }
        }
    }

    /// Draws a triangle where nothing is nearer.
    fn fill(&mut self, Triangle { corners: [a, b, c], colour }: &Triangle) {
        let edge = |from: &Vector3<f64>, to: &Vector3<f64>, x: f64, y: f64| {
            (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x)
        };
        let area = edge(a, b, c.x, c.y);
        let rows = self.near.len() / self.width;
        let [x, y] = [0, 1].map(|axis| [a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis])]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        for row in samples(y, self.first, rows) {
            let up = (self.first + row) as f64 + 0.5;
            // Shares of the corners in the middle of the first sample, and how they change from one to the next.
            let share =
                |from: &Vector3<f64>, to: &Vector3<f64>| [edge(from, to, 0.5, up) / area, (from.y - to.y) / area];
            let ([p, p_step], [r, r_step], [s, s_step]) = (share(b, c), share(c, a), share(a, b));
            for column in samples(x, 0, self.width) {
                let x = column as f64;
                let (p, r, s) = (p + x * p_step, r + x * r_step, s + x * s_step);
                let near = p * a.z + r * b.z + s * c.z;
                let index = row * self.width + column;
                if p >= 0.0 && r >= 0.0 && s >= 0.0 && near > self.near[index] {
                    (self.near[index], self.colours[index]) = (near, *colour);
                }
            }
        }
    }

    /// Indices of the samples of a picture element.
    fn samples_of(&self, row: usize, column: usize) -> impl Iterator<Item = usize> + use<> {
        let first = SAMPLES * (row * self.width + column);
        let width = self.width;
        (0..SAMPLES.pow(2)).map(move |sample| first + sample / SAMPLES * width + sample % SAMPLES)
    }

    /// The picture elements: means of their samples.
    fn reduced(&self) -> Vec<u8> {
        let (rows, columns) = (self.near.len() / self.width / SAMPLES, self.width / SAMPLES);
        let mut elements = vec![0; 3 * rows * columns];
        for (element, mean) in elements.chunks_exact_mut(3).enumerate() {
            let mut sum = [0; 3];
            for index in self.samples_of(element / columns, element % columns) {
                for (sum, channel) in sum.iter_mut().zip(self.colours[index]) {
                    *sum += usize::from(channel);
                }
            }
            for (mean, sum) in mean.iter_mut().zip(sum) {
                *mean = byte(sum as f64 / SAMPLES.pow(2) as f64);
            }
        }
        elements
    }
}

/// The samples whose middles lie within a range, from `first` on, of `count`.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "limited to the picture")]
fn samples([least, most]: [f64; 2], first: usize, count: usize) -> std::ops::Range<usize> {
    let limited = |end: f64| (end - first as f64).clamp(0.0, count as f64) as usize;
    limited((least - 0.5).ceil())..limited((most + 0.5).floor())
}
