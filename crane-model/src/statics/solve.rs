//! Static equilibrium: Newton's method, and continuation if it fails.

use nalgebra::DVector;

use super::{
    Equilibrium, Iteration, Settings, Status, continuation, equations::Equations, newton,
    residual_scale::ResidualScale, tangent::Tangent, tipped::with_tipped_status,
};
use crate::{
    CoordinateKind, Part,
    dyn_crane::{AnyCrane, CraneRef},
    feet::Feet,
};

/// The search for an equilibrium of a crane: `∂E_p/∂q = 0`, Eq. (23) with `q̇ = q̈ = 0`.
///
/// This is the one entry of the solver, for cranes of a size in their type and of any size. Each part of the problem has a default:
///
/// | part | default |
/// |---|---|
/// | [`at_time`](Self::at_time): time of drives, loads and winches | t = 0 |
/// | [`holding`](Self::holding): positions of the drives | those of their motions |
/// | [`from`](Self::from): pose at which the search starts | [`dyn DynCrane::guess`](trait.DynCrane.html#method.guess) |
/// | [`settings`](Self::settings): when it stops | [`Settings::default`] |
#[must_use = "it is solved by `solve`"]
pub struct Problem<'a> {
    crane: CraneRef<'a>,
    t: f64,
    positions: Option<&'a [f64]>,
    from: Option<&'a [f64]>,
    settings: Settings,
}

impl<'a> Problem<'a> {
    /// The crane with its drives, loads and winches where they are at t = 0.
    pub fn new<Size, C: AnyCrane<'a, Size>>(crane: C) -> Self {
        const { Part::Statics.require(C::PARTS) }
        Self { crane: crane.on_slices(), t: 0.0, positions: None, from: None, settings: Settings::default() }
    }

    /// With the drives, loads and winches where they are at time `t`, s: where the crane would rest if its motion stopped.
    pub fn at_time(self, t: f64) -> Self {
        Self { t, ..self }
    }

    /// With the drives at these positions, one per drive, m and rad, instead of those of their motions.
    pub fn holding(self, positions: &'a [f64]) -> Self {
        Self { positions: Some(positions), ..self }
    }

    /// Starting from the pose `q`, m and rad. For poses during a manoeuvre, start each from the previous one.
    pub fn from(self, q: &'a [f64]) -> Self {
        Self { from: Some(q), ..self }
    }

    /// With these settings.
    pub fn settings(self, settings: &Settings) -> Self {
        Self { settings: *settings, ..self }
    }

    /// The pose at which the search starts unless one is given, m and rad.
    pub fn guess(&self) -> Vec<f64> {
        self.crane.guess()
    }

    /// Solves it.
    ///
    /// Newton–Raphson on `r(q) = ∂E_p/∂q` with `K = ∂²E_p/∂q²`: `q ← q − α K⁻¹ r`, α = 1, halved until the residual falls.
    /// The residual is measured as `‖r/scale‖`, the scale of a translation being the largest force that any translation
    /// balances at the guess, that of a rotation the largest moment: N and N m become comparable. Any equilibrium is found,
    /// stable or not; the tangent stiffness there decides which.
    ///
    /// If that fails, or leads from a stable guess to an unstable pose, steps that hardly move in soft directions are tried; then the load is applied in steps, starting at the guess, and
    /// [`Equilibrium::load_steps`] is their number. Springs hold the crane at the guess and are removed as its load is applied:
    ///
    /// ```text
    /// H(q, λ) = λ r(q) + (1 − λ) S (q − q₀) = 0,   λ from 0 to 1
    /// ```
    ///
    /// This path does not end before λ = 1 if the potential energy grows with the distance from the guess, so that it reaches an equilibrium
    /// for almost every guess. It is followed by arclength, since λ may decrease along it. With loops it lies on φ(q) = 0, and H is restricted to
    /// the motions that leave them closed.
    /// S. N. Chow, J. Mallet-Paret, J. A. Yorke, Finding zeroes of maps, Math. Comp. 32 (1978) 887; H. B. Keller, Numerical
    /// solution of bifurcation and nonlinear eigenvalue problems, in Applications of Bifurcation Theory, Academic Press 1977.
    ///
    /// If feet lift and no pose is stable, the status names the supports over which the crane tips.
    ///
    /// # Panics
    /// If the pose or the positions are not as many numbers as the crane has coordinates or drives.
    pub fn solve(&self) -> Equilibrium {
        let guess;
        let from = if let Some(q) = self.from {
            q
        } else {
            guess = self.crane.guess();
            &guess
        };
        let equilibrium = search(&mut self.equations(), from, &self.settings);
        with_tipped_status(&*self.crane, self.t, from, equilibrium, &|| self.standing_from(from))
    }

    /// The pose at rest with the base held where it is in the pose `from`: what the moments about tipping lines follow from, if the crane has no pose on its
    /// feet. `from` itself, if none is found.
    pub(super) fn standing_from(&self, from: &[f64]) -> Vec<f64> {
        let equilibrium = search(&mut self.equations().with_held_base(), from, &self.settings);
        if equilibrium.is_stable() { equilibrium.q } else { from.to_vec() }
    }

    /// `ln det K` at the pose `q`, in equilibrium or not, of the factors of Cholesky, which are a tenth of the work of a Newton step; `None` if a direction has a
    /// negative stiffness, and −∞ if one has none.
    pub(super) fn stiffness_at(&self, q: &[f64]) -> Option<f64> {
        let mut equations = self.equations();
        let mut pose = DVector::from_column_slice(q);
        equations.prescribe(pose.as_mut_slice());
        if !equations.begin(&mut pose) {
            return None;
        }
        let (stiffness, description) = (equations.stiffness(&pose), self.crane.description());
        match stiffness.clone().cholesky() {
            Some(factors) => Some(factors.ln_determinant()),
            None => Tangent::new(&stiffness, description)
                .filter(|tangent| !tangent.has_negative_direction(description))
                .map(|_| f64::NEG_INFINITY),
        }
    }

    fn equations(&self) -> Equations<'_> {
        let crane = &*self.crane;
        match self.positions {
            Some(positions) => Equations::holding(crane, self.t, positions),
            None => Equations::at(crane, self.t),
        }
    }
}

/// The solution from the pose `q`, with the exact positions of rigid drives: the steps change them only by rounding.
fn search(equations: &mut Equations<'_>, q: &[f64], settings: &Settings) -> Equilibrium {
    let mut start = DVector::from_column_slice(q);
    equations.prescribe(start.as_mut_slice());
    if !equations.begin(&mut start) {
        let history = vec![Iteration { residual: f64::INFINITY, fraction: 0.0 }];
        return Equilibrium { status: Status::NotConverged, q: start.as_slice().to_vec(), history, load_steps: None };
    }
    let mut equilibrium = search_from(equations, &start, settings);
    let is_found = matches!(equilibrium.status, Status::Converged | Status::Unstable { .. });
    if is_found && newton::is_hidden(equations, &equilibrium) {
        equilibrium.status = Status::NotConverged;
    }
    equations.prescribe(&mut equilibrium.q);
    with_sliding_status(equations, equilibrium)
}

/// Newton's method, with bold and with cautious steps, then continuation.
fn search_from(equations: &Equations<'_>, start: &DVector<f64>, settings: &Settings) -> Equilibrium {
    let scale = ResidualScale::at(equations, start);
    let iterate = |q: &DVector<f64>, limits| newton::iterate(equations, q.clone(), settings, &scale, limits);
    let first = iterate(start, newton::BOLD);
    if settings.load_steps == 0 || !missed(equations, start, settings, &first) {
        return first;
    }
    let second = iterate(start, newton::CAUTIOUS);
    if second.is_stable() {
        return second;
    }
    let mut load_steps = 0;
    let mut arrive = |mut q: DVector<f64>, steps: usize| {
        load_steps = steps;
        if !equations.close(&mut q) {
            return None;
        }
        let mut ends = [newton::BOLD, newton::CAUTIOUS].into_iter().map(|limits| iterate(&q, limits));
        ends.find(|end| end.status == Status::Converged)
    };
    let found = continuation::follow(equations, start, settings.load_steps, &scale, &mut arrive);
    found.map_or(first, |equilibrium| Equilibrium { load_steps: Some(load_steps), ..equilibrium })
}

/// A search that ended where every foot on the ground slides ended for that reason.
fn with_sliding_status(equations: &Equations<'_>, equilibrium: Equilibrium) -> Equilibrium {
    let description = equations.crane.description();
    if equilibrium.is_stable() || !description.has_feet() {
        return equilibrium;
    }
    let feet = Feet::at_rest(equations.crane, &equilibrium.q);
    let pressing: Vec<_> = feet.utilisations_on_the_ground().collect();
    if pressing.is_empty() || pressing.iter().any(|(_, utilisation)| *utilisation < 1.0) {
        return equilibrium;
    }
    let name = |(foot, _): &(usize, f64)| description.supports[*foot].name.clone();
    Equilibrium { status: Status::Slides { feet: pressing.iter().map(name).collect() }, ..equilibrium }
}

/// Rotation by which an equilibrium may differ from the guess and still be the intended one, rad.
const MEANT: f64 = 0.5;

/// Whether there may be a stable equilibrium that Newton's method did not find: no equilibrium was found, or an unstable one
/// far from the guess, from a guess that is stable itself, or of a crane on feet.
fn missed(equations: &Equations<'_>, start: &DVector<f64>, settings: &Settings, equilibrium: &Equilibrium) -> bool {
    let description = equations.crane.description();
    let meant = || {
        let kinds = description.coordinates.iter().map(|coordinate| coordinate.kind);
        let turned = kinds.zip(start.iter().zip(&equilibrium.q)).filter(|(kind, _)| *kind == CoordinateKind::Rotation);
        turned.map(|(_, (from, to))| (to - from).abs()).fold(0.0, f64::max) < MEANT
    };
    let stable = || {
        Tangent::new(&equations.stiffness(start), description)
            .is_some_and(|tangent| tangent.status(description) == Status::Converged)
    };
    match equilibrium.status {
        Status::Converged | Status::TipsOver { .. } | Status::Floats | Status::Overflow => false,
        // Also reported for poses where no step helps; at an equilibrium it is exact.
        Status::Singular { .. } => !equilibrium.at_rest(settings),
        Status::NotConverged | Status::Slides { .. } => true,
        // A crane that has tipped half off its feet may balance there, besides standing on them.
        Status::Unstable { .. } => !meant() || stable() || description.supports.iter().any(|support| support.one_sided),
    }
}
