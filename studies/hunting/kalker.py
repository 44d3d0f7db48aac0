"""Linear theory of rolling contact: Hertz's ellipse, and Kalker's coefficients near the ratio of its axes here."""

import numpy as np

# J.J. Kalker (1990), Three-Dimensional Elastic Bodies in Rolling Contact, table E.3: the two rows on either side of the
# ellipse of running_wheelset.py, longer along the rail; the complete table is in src/verification/kalker.rs.
# The digits were typed from memory, without the book at hand, so they were compared with a solution of their own
# definition: full adhesion on the ellipse, constant tractions on 120 and 240 elements over each axis, referred to the
# area of those elements, extrapolated to infinitely many. All of C11, C22 and C23 here are within 0.3 % of that, C33
# within 0.7 %, where half a unit of the third digit is up to 0.5 %. What is interpolated for that ellipse: 0.6 %.
POISSON = np.array([0.0, 0.25, 0.5])
TABLE = {  # b/a: C11, C22, C23 and C33, each at these Poisson's ratios
    0.7: [[3.82, 4.54, 5.58], [3.82, 4.21, 4.67], [1.76, 1.95, 2.18], [1.05, 0.965, 0.852]],
    0.8: [[3.65, 4.36, 5.42], [3.65, 3.99, 4.39], [1.58, 1.75, 1.94], [1.10, 1.04, 0.954]],
}


def coefficients(ratio, poisson):
    """C11, C22, C23 and C33 at a/b: linear in b/a, and the parabola through the table's Poisson's ratios."""
    (low, below), (high, above) = TABLE.items()
    share = (1.0 / ratio - low) / (high - low)
    if not 0.0 <= share <= 1.0 or not POISSON[0] <= poisson <= POISSON[-1]:
        raise ValueError(f"a/b = {ratio:g}, Poisson's ratio {poisson:g}: not in these rows of the table")
    rows = (1.0 - share) * np.array(below) + share * np.array(above)
    return np.array([np.polyval(np.polyfit(POISSON, row, 2), poisson) for row in rows])


def elliptic(modulus_squared):
    """Complete elliptic integrals K and E, by the arithmetic-geometric mean."""
    a, b, sum_of_squares, power = 1.0, np.sqrt(1.0 - modulus_squared), 0.5 * modulus_squared, 0.5
    for _ in range(10):  # the digits double each time; a few are enough even for 1 - modulus² = 1e-12
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
