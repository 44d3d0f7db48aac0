"""studies/eurosprinter, studies/twin_disc: fits to measurements, and what docs/measurements.md says of them."""

import re
import tomllib
from pathlib import Path

import eurosprinter
import fitting
import numpy as np
import pytest
import twin_disc

REPOSITORY = Path(__file__).resolve().parent.parent
PAGE = (REPOSITORY / "docs" / "measurements.md").read_text()
STALE = "run `make measurements-docs` and commit what it changes"


def shown(marker, row):
    """The cells of one row of a table of the page."""
    block = re.search(rf"<!-- {marker} -->\n(.*?)<!-- end of {marker} -->", PAGE, re.DOTALL)[1]
    (line,) = (line for line in block.splitlines() if line.startswith(f"| {row} |"))
    return [cell.strip() for cell in line.strip("|").split("|")]


# ---- Eurosprinter ---------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def locomotive():
    """Return the fit that the page chooses and the two that lack one of its halves."""
    names = (eurosprinter.CHOSEN, "heat, no layer", "constant friction, layer")
    return {name: eurosprinter.fitted(name) for name in names}


def test_deviation_at_a_bound():
    """A slope that goes to its bound 0 has the deviation of any other, though the curve has an error of a millionth."""
    x = np.linspace(0.0, 1.0, 9)
    start, bounds = {"height": 0.8, "slope": 0.3}, {"height": (0.0, 2.0), "slope": (0.0, 1.0)}
    found = fitting.fit(
        lambda height, slope: np.round(height + slope * x, 6), 1.0 - 0.1 * x, np.full(9, 0.05), start, bounds
    )
    assert found.values["slope"] < 1e-3
    by = np.column_stack([np.ones(9), x])
    expected = 0.05 * np.sqrt(np.diag(np.linalg.inv(by.T @ by)))
    # A millionth over the change of a parameter.
    assert list(found.deviations.values()) == pytest.approx(expected, rel=0.01)


def test_curvatures_have_the_axes_of_hertz():
    """A round contact has equal curvatures; CONTACT prints 0.2814 across for 0.8 along the rail and a/b = 0.5."""
    assert eurosprinter.curvature_ratio(1.0) == pytest.approx(1.0, rel=1e-9)
    assert 0.8 * eurosprinter.curvature_ratio(0.5) == pytest.approx(0.2814, abs=5e-5)
    # The component's contact has that ratio, to half a cell of the 24 by 15 along and across.
    outputs = ("contact_length", "contact_breadth")
    ((length,), (breadth,)) = fitting.steady_points(
        [0.1], 10.0, outputs, **eurosprinter.parameters(0.33), patch_nodes=48, patch_strips=31
    )
    assert length / breadth == pytest.approx(0.5, rel=0.02)


def test_heat_and_layer_meet_the_measured_curve(locomotive):
    """The misfit is that of the scatter: χ² below its degrees of freedom, and no point beyond two deviations."""
    found = locomotive[eurosprinter.CHOSEN]
    assert found.freedom == 11
    # 9.2; with 11 degrees of freedom less than 3 would say that the deviations are too large.
    assert 3.0 < found.chi_squared < 11.0
    assert np.abs(found.residuals).max() < 2.0


def test_neither_half_is_enough(locomotive):
    """Without the layer, or without the fall, χ² is more than three times as large: 34.2 and 40.9 against 9.2."""
    best = locomotive[eurosprinter.CHOSEN].chi_squared
    assert locomotive["heat, no layer"].chi_squared > 3.0 * best
    assert locomotive["constant friction, layer"].chi_squared > 3.0 * best


def test_slip_explains_the_fall_as_well_as_heat(locomotive):
    """The law of slip in place of the temperature: χ² differs by less than two parameters are worth by chance, 2.3."""
    creepages, values, deviation = eurosprinter.measured()
    held = eurosprinter.NO_HEAT | {"friction_slip_share": 0.0}
    start = {"friction_cold": 0.33, "layer": 0.16, "friction_slip_decay": 0.22}
    bounds = {key: eurosprinter.BOUNDS[key] for key in start}
    found = fitting.fit(lambda **now: eurosprinter.traction(creepages, **held, **now), values, deviation, start, bounds)
    assert abs(found.chi_squared - locomotive[eurosprinter.CHOSEN].chi_squared) < 2.3


def test_preset_is_what_the_fit_finds(locomotive):
    """The parameter set: what is fitted to a tenth of its deviation, the rest as the fit has held it."""
    found = locomotive[eurosprinter.CHOSEN]
    preset = tomllib.loads((REPOSITORY / "presets" / "eurosprinter.toml").read_text())["parameters"]
    used = eurosprinter.parameters(**eurosprinter.everything(eurosprinter.CHOSEN, found))
    left_out = {"normal_load", "friction_slip_share", "friction_slip_decay"}
    assert set(preset) == set(used) - left_out
    tenths = {
        "friction_cold": 0.1 * found.deviations["friction_cold"],
        "friction_hot": 0.1 * found.deviations["friction_cold"],
        "layer_compliance": 0.1 * found.deviations["layer"] * eurosprinter.LAYER,
    }
    for name, value in preset.items():
        # Else to the digits that are written.
        assert value == pytest.approx(used[name], rel=1e-5, abs=tenths.get(name, 0.0)), name


def test_page_shows_the_fit(locomotive):
    """The page's numbers of the chosen fit are those found now, to a unit of the last digit."""
    found = locomotive[eurosprinter.CHOSEN]
    cells = shown("fits of the Eurosprinter", eurosprinter.CHOSEN)
    numbers = [float(text) for text in re.findall(r"(?<![A-Za-z₀₃])\d+\.\d+", " ".join(cells))]
    expected = [*(of[key] for key in found.values for of in (found.values, found.deviations)), found.chi_squared]
    assert np.abs(np.subtract(numbers[:4], expected[:4])).max() < 1.5e-3, STALE
    assert abs(numbers[4] - expected[4]) < 0.15, STALE


def test_curve_of_contact():
    """Constant friction in full sliding: CONTACT's rise is 11 % above ours at all creepages; traction is the same."""
    table, ours = eurosprinter.beside_contact()
    ratio = table["rise constant"][2:] / ours["rise constant"][2:]
    assert ratio == pytest.approx(1.114, abs=0.005)
    # Its grid of 44 by 44 is 0.009 above the limit where the contact sticks in part.
    assert np.abs(table["traction constant"] - ours["traction constant"]).max() < 0.011


# ---- twin disc ------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def discs():
    """Return the fits of two laws of temperature, and the state of the first at the slips of the table."""
    fits = {name: twin_disc.fitted(name) for name in (twin_disc.CHOSEN, "default law, layer")}
    table = twin_disc.measured()
    state = twin_disc.points(table["slip"], twin_disc.FITS[twin_disc.CHOSEN][0], **fits[twin_disc.CHOSEN].values)
    return fits, table, state


def test_enlarged_contact_is_the_same_contact():
    """Twice as large once more, traction and temperatures stay: the way in which the discs fit into the component."""
    start_values = twin_disc.parameters("constant", 0.47, 0.0015) | {"wheel_heating": 1}
    doubled = dict(start_values)
    for name in ("wheel_radius", "thermal_diffusivity", "layer_compliance", "strip_half_length", "strip_height"):
        doubled[name] = 2.0 * doubled.get(name, 1.0)
    doubled["contact_width"] *= 0.5
    outputs = ("traction_coefficient", "peak_temperature", "peak_pressure", "friction_power")
    once, twice = (
        fitting.steady_points([0.005, 0.1], twin_disc.SPEED, outputs, **values) for values in (start_values, doubled)
    )
    once[1] -= twin_disc.AMBIENT
    twice[1] -= twin_disc.AMBIENT
    assert twice == pytest.approx(once, rel=1e-3)


def test_discs_have_their_pressure(discs):
    """1500 MPa after the source; Hertz's line contact of the discs with the component's steel has 1.0 % more."""
    modulus = 2.0 * 8.2e10 / (2.0 * (1.0 - 1.166e11 / (2.0 * (1.166e11 + 8.2e10))))
    hertz = np.sqrt(twin_disc.LOAD * modulus / (np.pi * twin_disc.DISC_WIDTH * 0.5 * twin_disc.DISC_RADIUS))
    assert discs[2]["peak_pressure"][0] == pytest.approx(hertz, rel=2e-3)
    assert hertz == pytest.approx(1500e6, rel=0.015)


def test_friction_does_not_fall_with_these_temperatures(discs):
    """The law of the flow stress meets the friction to 0.022, the default law misses it by three times that."""
    fits, _, _ = discs
    good, bad = (twin_disc.misfit(fits[name]) for name in (twin_disc.CHOSEN, "default law, layer"))
    assert good < 0.025
    assert bad > 3.0 * good
    for name in fits:
        cells = shown("fits of the twin disc", name)
        assert abs(float(cells[2]) - twin_disc.misfit(fits[name])) < 1.5e-3, STALE


def test_temperatures_of_the_discs(discs):
    """At the same heat: flash within 5 % where all slides, the bulk within half a kelvin in the long tests."""
    _, table, state = discs
    share = table["heat"] / state["friction_power"]
    slides = table["slip"] > 0.05
    flash = (state["flash"] * share / table["peak flash temperature"])[slides]
    assert flash == pytest.approx(1.0, abs=0.05)
    long = table["slip"] < 0.12
    bulk = (state["bulk"] - twin_disc.AMBIENT) * share + twin_disc.AMBIENT - 273.15
    assert np.abs(bulk - table["bulk temperature"])[long].max() < 0.5


def test_mild_wear_is_archards(discs):
    """With the coefficient of the mild branch the outputs are on it, and above the severe plateau beyond."""
    values = discs[0][twin_disc.CHOSEN].values
    coefficient = twin_disc.mild_coefficient(values["friction_cold"])
    assert coefficient == pytest.approx(3.1e-13, rel=0.02)
    loads, rates = twin_disc.wear([0.005, 0.01, 0.015, 0.1], coefficient, **values)
    assert np.all(loads[:3] < 10.4)
    # Where the contact sticks in part, slip and shear at a cell on the border differ: 0.3 % at a slip of 0.5 %.
    assert rates[:3] == pytest.approx(5.3 * loads[:3], rel=0.005)
    assert rates[3] > 5.0 * twin_disc.usfd(loads[3])
