"""Linear theory of rolling contact: Hertz's ellipse, and Kalker's coefficients from his published table."""

import numpy as np

# Kalker (1990), Three-Dimensional Elastic Bodies in Rolling Contact, table E3: C11, C22, C23 and C33 at a/b, semi-axis
# along the rail to that across, for Poisson's ratios of 0.25 and 0.5.
RATIOS = np.array([0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1 / 0.9, 1 / 0.8, 1 / 0.7, 1 / 0.6, 2.0])
POISSON = (0.25, 0.5)
TABLE = np.array(
    [
        [
            [3.62, 3.72, 3.81, 3.91, 4.01, 4.12, 4.22, 4.36, 4.54, 4.78, 5.10],
            [3.01, 3.14, 3.28, 3.41, 3.54, 3.67, 3.81, 3.99, 4.21, 4.50, 4.90],
            [0.929, 1.03, 1.14, 1.25, 1.36, 1.47, 1.57, 1.75, 1.95, 2.23, 2.62],
            [1.93, 1.68, 1.50, 1.37, 1.27, 1.19, 1.11, 1.04, 0.965, 0.892, 0.819],
        ],
        [
            [4.83, 4.91, 4.97, 5.05, 5.12, 5.20, 5.30, 5.42, 5.58, 5.80, 6.11],
            [3.14, 3.31, 3.48, 3.65, 3.82, 3.98, 4.16, 4.39, 4.67, 5.04, 5.56],
            [1.07, 1.18, 1.29, 1.40, 1.51, 1.63, 1.77, 1.94, 2.18, 2.50, 2.96],
            [2.22, 1.86, 1.60, 1.42, 1.27, 1.16, 1.06, 0.954, 0.852, 0.751, 0.650],
        ],
    ]
)


def coefficients(ratio, poisson):
    """C11, C22, C23 and C33 at a/b: linear in the logarithm of the ratio and in Poisson's ratio."""
    if not RATIOS[0] <= ratio <= RATIOS[-1] or not POISSON[0] <= poisson <= POISSON[1]:
        raise ValueError(f"a/b = {ratio:g}, Poisson's ratio {poisson:g}: not in the table")
    share = (poisson - POISSON[0]) / (POISSON[1] - POISSON[0])
    rows = (1.0 - share) * TABLE[0] + share * TABLE[1]
    return np.array([np.interp(np.log(ratio), np.log(RATIOS), row) for row in rows])


def elliptic(modulus_squared):
    """Complete elliptic integrals K and E, by the arithmetic-geometric mean."""
    a, b, sum_of_squares, power = 1.0, np.sqrt(1.0 - modulus_squared), 0.5 * modulus_squared, 0.5
    while abs(a - b) > 1e-15:
        a, b, difference = 0.5 * (a + b), np.sqrt(a * b), 0.5 * (a - b)
        power *= 2.0
        sum_of_squares += power * difference**2
    complete = 0.5 * np.pi / a
    return complete, complete * (1.0 - sum_of_squares)


def ellipse(load, along, across, shear_modulus, poisson):
    """Semi-axes a along and b across the rail for two bodies of one material with a gap along x² + across y².

    Johnson (1985), Contact Mechanics, section 4.2, where a is the longer one: its gap coefficient is the smaller one.
    """
    flat, sharp = min(along, across), max(along, across)
    low, high = 1e-6, 1.0 - 1e-6
    for _ in range(60):
        axes = 0.5 * (low + high)
        first, second = elliptic(1.0 - axes**2)
        # The ratio of the gap coefficients falls as the ellipse gets rounder.
        flatter = (second / axes**2 - first) / (first - second) > sharp / flat
        low, high = (axes, high) if flatter else (low, axes)
    modulus = shear_modulus / (1.0 - poisson)  # E*: 1/E* = 2 (1 - ν²)/E
    longer = np.cbrt(1.5 * load * (first - second) / (np.pi * flat * (1.0 - axes**2) * modulus))
    return (longer, axes * longer) if along <= across else (axes * longer, longer)
