"""Coloured noise: what residuals that follow each other mean for the covariance of fitted numbers."""

import numpy as np

from .results import Array

# Greatest coefficient of prewhitening: nearer to 1 an estimate of the noise at low frequencies is lost.
GREATEST = 0.97


def coefficient(follows: float, values: int, numbers: int, total: int) -> float:
    """Coefficient ρ of noise rₜ = ρ rₜ₋₁ + eₜ from the correlation of successive residuals, which is less by about (2 ρ + k (1 + ρ))/n, since k numbers
    are fitted to n values (M. G. Kendall, Note on bias in the estimation of autocorrelation, Biometrika 41, 1954, for the mean).

    values: of this series; numbers, total: fitted numbers, and all values.
    """
    return min(follows + 2 * follows / values + numbers * (1 + follows) / total, GREATEST)


def score_covariance(jacobian: Array, residuals: Array, rho: float) -> Array:
    """(numbers, numbers): covariance of the scores Jᵀ r of a series in its order, where the r follow each other.

    Prewhitening (D. W. K. Andrews, J. C. Monahan, Econometrica 60, 1992) with eₜ = rₜ − ρ rₜ₋₁: Jᵀ r = Σ zₜ eₜ with zₜ = Jₜ + ρ zₜ₊₁. Then the
    estimate of Newey and West of the zₜ eₜ, whose weights 1 − l/(L + 1) are those of Bartlett's kernel (Econometrica 55, 1987).
    """
    innovations, z = residuals.copy(), jacobian.copy()
    innovations[1:] -= rho * residuals[:-1]
    for place in range(len(z) - 2, -1, -1):
        z[place] += rho * z[place + 1]
    scores = z * innovations[:, None]
    covariance = scores.T @ scores
    lags = _lags(scores[:, np.any(scores != 0.0, axis=0)])
    for lag in range(1, min(lags, len(scores) - 1) + 1):
        product = scores[lag:].T @ scores[:-lag]
        covariance += (1 - lag / (lags + 1)) * (product + product.T)
    return covariance


def _lags(scores: Array) -> int:
    """Lags of Bartlett's kernel, 1.1447 (α n)^⅓ with α of autoregressions of first order, each weighted by the inverse of its squared variance: D. W. K.
    Andrews, Econometrica 59, 1991, equations 6.2 and 6.4."""
    if scores.size == 0:
        return 0
    before, now = scores[:-1], scores[1:]
    rho = np.clip(np.sum(before * now, axis=0) / np.sum(scores**2, axis=0), -GREATEST, GREATEST)
    weights = (np.mean((now - rho * before) ** 2, axis=0) / np.mean(scores**2, axis=0)) ** 2
    alpha = np.sum(weights * 4 * rho**2 / ((1 - rho) ** 6 * (1 + rho) ** 2)) / np.sum(weights / (1 - rho) ** 4)
    return int(np.ceil(1.1447 * (alpha * len(scores)) ** (1 / 3)))
