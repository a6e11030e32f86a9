"""Coefficients of the float functions in `src/functions.rs`, and their greatest errors in single precision.

    python fit.py

erf(x) ~ x P(x^2) / Q(x^2) on [0, 4], by least squares with the denominator's last value as weight (Sanathanan and
Koerner 1963) on Chebyshev points; 2^f on [-1/2, 1/2] by least squares. Needs numpy and scipy.
"""

import numpy as np
from scipy.special import erf

LIMIT = 3.92


def fit_erf(numerator=6, denominator=4, points=4000, rounds=30):
    x = LIMIT * (1 - np.cos(np.linspace(0, np.pi, points + 1)[1:])) / 2
    u, y = x**2, erf(x)
    weight = np.ones_like(x)
    spread = np.ones_like(x)
    for _ in range(rounds):
        columns = [x * u**k for k in range(numerator + 1)] + [-y * u**k for k in range(1, denominator + 1)]
        matrix = np.array(columns).T * (spread * weight)[:, None]
        scale = np.linalg.norm(matrix, axis=0)
        solution = np.linalg.lstsq(matrix / scale, y * spread * weight, rcond=None)[0] / scale
        p, q = solution[: numerator + 1], np.concatenate([[1.0], solution[numerator + 1 :]])
        weight = 1 / np.polyval(q[::-1], u)
        # Lawson's step: weigh up where the error is great, towards the least greatest error.
        error = np.abs(x * np.polyval(p[::-1], u) * weight - y)
        spread *= np.sqrt(error / error.mean() + 0.1)
        spread /= spread.mean()
    return p, q


def horner(coefficients, x):
    result = np.full_like(x, np.float32(coefficients[-1]))
    for c in coefficients[-2::-1]:
        result = result * x + np.float32(c)
    return result


p, q = fit_erf()
x = np.linspace(-6, 6, 2_000_001).astype(np.float32)
c = np.clip(x, np.float32(-LIMIT), np.float32(LIMIT))
approximate = c * horner(p, c * c) / horner(q, c * c)
print("P", [float(f"{v:.9e}") for v in p])
print("Q", [float(f"{v:.9e}") for v in q])
print("greatest error of erf", np.abs(approximate - erf(x.astype(float))).max())

f = (1 - np.cos(np.linspace(0, np.pi, 2001))) / 2 - 0.5
powers = np.polynomial.polynomial.polyfit(f, 2.0**f, 6)
g = np.linspace(-0.5, 0.5, 1_000_001).astype(np.float32)
print("2^f", [float(f"{v:.9e}") for v in powers])
print("greatest relative error of 2^f", np.abs(horner(powers, g) / 2.0 ** g.astype(float) - 1).max())
