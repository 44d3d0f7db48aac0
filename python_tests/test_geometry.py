"""Profiles and the contact geometry from Python: the command line's results as tables and a picture."""

import re
import sys
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail as package  # noqa: E402

# The fixture that says, with a reason, where the command line is not built.
pytestmark = pytest.mark.usefixtures("wheelrail")


def test_profiles_that_are_built_in():
    """A rail's highest point and a wheel's running circle are the origins, and curvatures those of the drawings."""
    rail, wheel = package.Profile("60E1"), package.Profile("S1002")
    assert (rail.body, wheel.body, wheel.source) == ("rail", "wheel", "EN 13715")
    assert {"S1002", "60E1", "cone40"} <= set(package.Profile.built_in())
    assert rail.points["z"].max() == pytest.approx(0.0, abs=1e-12)
    crown = rail.points.loc[rail.points["y"].abs().idxmin()]
    assert crown["curvature"] == pytest.approx(-1 / 0.3, rel=1e-6)
    assert np.interp(0.0, wheel.points["y"], wheel.points["z"]) == pytest.approx(0.0, abs=1e-7)
    assert rail.points.attrs["units"]["curvature"] == "1/m"
    assert "60E1" in repr(rail)


def test_points_and_files(tmp_path):
    """Points give the profile that they are of, files what was written, and errors the words of the command."""
    exact = package.Profile("S1002").points
    profile = package.Profile.from_points(exact["y"], exact["z"], body="wheel", smoothing=1e-3)
    at = np.linspace(-0.02, 0.05, 100)
    np.testing.assert_allclose(
        np.interp(at, profile.points["y"], profile.points["z"]), np.interp(at, exact["y"], exact["z"]), atol=1e-6
    )
    profile.write(tmp_path / "wheel.whl")
    again = package.Profile(tmp_path / "wheel.whl")
    assert again.body == "wheel"
    assert "y to the field side by its shape" in again.source
    with pytest.raises(ValueError, match="did you mean 60E1"):
        package.Profile("61E1")
    with pytest.raises(ValueError, match="no rail"):
        package.Profile.from_points(exact["y"], exact["z"], body="rail")


def test_a_profile_at_arc_lengths():
    """Points at their arc lengths, the circle between them, straight lines beyond the ends; a number, a list, none."""
    rail = package.Profile("60E1")
    points, arcs = rail.points, rail.points["arc_length"].to_numpy()
    found = rail.at(arcs)
    np.testing.assert_array_equal(found.place, points[["y", "z"]].to_numpy())
    np.testing.assert_array_equal(found.curvature, points["curvature"].to_numpy())
    np.testing.assert_allclose(found.tangent[:, 1] / found.tangent[:, 0], np.tan(points["inclination"]), rtol=1e-12)
    # More than one call of the command, on the crown of 300 mm.
    crown = rail.at(np.linspace(-5e-3, 5e-3, 2500) + arcs[-1] / 2)
    y, z = crown.place.T
    np.testing.assert_allclose(np.hypot(y, z + 0.3), 0.3, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(crown.tangent[:, 1], -y / 0.3, rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(crown.curvature, -1 / 0.3, rtol=1e-6)
    before, after = rail.at(-0.01), rail.at(arcs[-1] + 0.01)
    np.testing.assert_allclose(before.place, found.place[0] - 0.01 * found.tangent[0], atol=1e-12)
    np.testing.assert_allclose(after.place, found.place[-1] + 0.01 * found.tangent[-1], atol=1e-12)
    assert (before.place.shape, before.tangent.shape, before.curvature.shape) == ((2,), (2,), ())
    assert float(before.curvature) == 0.0
    assert rail.at([]).place.shape == (0, 2)
    worn = package.Profile("S1002").worn_by([0.09, 0.1, 0.11], [0.0, 1e-3, 0.0])
    np.testing.assert_allclose(worn.at(worn.points["arc_length"]).place, worn.points[["y", "z"]], atol=1e-8)
    with pytest.raises(ValueError, match=r"arc\[1\] = inf: a finite number is needed"):
        rail.at([0.0, np.inf])


def test_a_profile_is_smoothed_after_it_was_read():
    """A wave of 1 µm and 2 mm on the tread, smoothed with 4 mm: 1/17 of it is left; a rail's is left as it was by 0."""
    wheel = package.Profile("S1002")
    waved = wheel.points["z"] + 1e-6 * np.sin(2 * np.pi * wheel.points["y"] / 2e-3)
    smooth = package.Profile.from_points(wheel.points["y"], waved, body="wheel").smoothed(4e-3)
    assert (smooth.name, smooth.body, smooth.source) == ("points", "wheel", "given points")
    at = np.linspace(0.0, 0.02, 401)
    over = [np.interp(at, profile.points["y"], profile.points["z"]) for profile in (smooth, wheel)]
    # A tenth for the spline and for the straight lines between the points of the data frames, 0.25 mm apart.
    assert np.ptp(over[0] - over[1]) / 2e-6 == pytest.approx(1 / 17, rel=0.1)
    rail = package.Profile("60E1")
    # Its curvature jumps where radii meet, at one place of the points; smoothed, it passes on over some millimetres.
    jumps = [profile.points["curvature"].diff().abs().max() for profile in (rail, rail.smoothed(1e-2))]
    assert jumps[0] > 40.0
    assert jumps[1] < jumps[0] / 4
    same = rail.smoothed(0.0)
    assert same.points is not rail.points
    pd.testing.assert_frame_equal(same.points, rail.points)
    with pytest.raises(ValueError, match=r"smoothing = -0\.001"):
        rail.smoothed(-1e-3)
    with pytest.raises(TypeError, match="smoothing = None: a number is needed"):
        rail.smoothed(None)


def test_what_is_refused_names_what_was_given(tmp_path, monkeypatch):
    """Words of the package, of no library below it; what the user gave, and no file that was made for the command."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wheel.csv").write_text("y,z\n")
    (tmp_path / "my_rail.prr").write_text("no profile\n")
    wheel, rail = package.Profile("S1002"), package.Profile("60E1", inclination=0.025)
    points = package.Profile.from_points(rail.points["y"], rail.points["z"], body="rail")
    assert repr(points) == "<Profile points: rail, given points>"
    through, profile = package.Profile.from_points, package.Profile
    for call, words in [
        (lambda: through([0, 1, 2], [0, 1], body="rail"), "y has 3 values and z 2: as many of each are needed"),
        (lambda: through([0, 1, np.nan], [0, 1, 2], body="rail"), r"y\[2\] = nan: a finite number is needed"),
        (lambda: through(["a"], [0], body="rail"), "y: a list of numbers is needed"),
        (lambda: through([0, 1, 2], [0, 1, 2], body="rail"), "^points: too few points, 3: at least 5 show a rail"),
        (lambda: through(range(6), range(6), body="rail"), "^points: this is no rail"),
        (lambda: through([0, 1], [0, 1], body="rial"), "body = 'rial': choose one of rail, wheel; did you mean rail"),
        (lambda: wheel.worn_by([0.1, 0.11], [0, 1e-3, 0]), "depth has 3 values and arc_length 2: one for each place"),
        (lambda: wheel.worn_by([[0.1]], 0.0), "arc_length has 2 dimensions: a list of numbers is needed"),
        (lambda: wheel.worn_by([0.1, 0.2], [0.0, np.inf]), r"depth\[1\] = inf: a finite number is needed"),
        (lambda: profile("S1002", body="weel"), "body = 'weel': choose one of rail, wheel; did you mean wheel"),
        (lambda: profile("wheel.csv", unit="ft"), "unit = 'ft': choose one of m, mm, in"),
        (lambda: profile("wheel.csv", part=0), "part = 0: 1 or more is needed"),
        (lambda: profile("wheel.csv", smoothing=np.inf), "smoothing = inf: a finite number is needed"),
        (lambda: rail.measures(), "^60E1 is the profile of a rail; a wheel is needed"),
        (lambda: points.measures(), "^points is the profile of a rail; a wheel is needed"),
        (lambda: wheel.worn_against(rail), "^60E1 is the profile of a rail; a wheel is needed"),
        (lambda: package.contact_geometry(points, points), "^points is the profile of a rail; a wheel is needed"),
        # A file of the user's keeps its name, however the files are called that are made for the command.
        (lambda: package.contact_geometry(rail, "my_rail.prr"), "^my_rail.prr"),
        (lambda: rail.write("60E1.whl"), "^60E1.whl: a file of this ending holds a wheel"),
    ]:
        with pytest.raises(ValueError, match=words):
            call()
    for number in (lambda: profile("wheel.csv", part=1.5), lambda: package.contact_geometry(step="a")):
        with pytest.raises(TypeError, match="number is needed"):
            number()


def test_files_that_cannot_be_opened(tmp_path, monkeypatch):
    """Errors of the system are those of Python, with the file; nothing is said of the profile beside."""
    monkeypatch.chdir(tmp_path)
    wheel = package.Profile("S1002")
    for call in (
        lambda: wheel.write("nodir/x.prw"),
        lambda: package.Profile("nodir/x.prw"),
        lambda: wheel.worn_against("nodir/x.prw"),
        lambda: package.contact_geometry("60E1", "nodir/x.prw"),
    ):
        with pytest.raises(FileNotFoundError, match=r"^\[Errno 2\] No such file or directory: 'nodir/x.prw'$"):
            call()
    for call in (lambda: wheel.write(tmp_path), lambda: package.Profile(tmp_path)):
        with pytest.raises(IsADirectoryError, match=str(tmp_path)):
            call()
    wheel.write("x.prw")
    wheel.write("x.prw")
    assert package.Profile("x.prw").worn_area(wheel) == pytest.approx(0.0, abs=1e-11)


def test_a_wheel_wears_and_is_measured(tmp_path):
    """Flange of S1002 as EN 13715 has it; a hollow of its tread and a thinner flange, in measures, area and file."""
    new = package.Profile("S1002")
    measures = new.measures()
    assert measures.flange_height == pytest.approx(28e-3, abs=1e-9)
    assert measures.flange_thickness == pytest.approx(32.5e-3, abs=1e-6)
    assert measures.flange_gradient == pytest.approx(10.794e-3, abs=1e-6)
    assert measures.hollow_depth == 0.0
    far = new.measures(flange_back_position=0.0722)
    assert far.flange_thickness == pytest.approx(34.7e-3, abs=1e-6)
    assert far.flange_height == measures.flange_height
    with pytest.raises(ValueError, match=r"flange_back_position = 0\.3: allowed is 0\.01 to 0\.2 m"):
        new.measures(flange_back_position=0.3)
    with pytest.raises(TypeError, match="flange_back_position = 'a': a number is needed"):
        new.measures(flange_back_position="a")
    # 2 mm on the running circle, over 20 mm on either side.
    middle = np.interp(0.0, new.points["y"], new.points["arc_length"])
    over = np.linspace(-20e-3, 20e-3, 401)
    depth = 2e-3 * (1 - (over / 20e-3) ** 2) ** 2
    worn = new.worn_by(middle + over, depth)
    assert (worn.name, worn.source) == ("S1002", "EN 13715, worn")
    assert worn.measures().flange_height == pytest.approx(30e-3, abs=2e-6)
    wear = worn.worn_against(new)
    assert wear.tread_depth == pytest.approx(2e-3, abs=2e-6)
    assert wear.largest_depth == pytest.approx(2e-3, abs=2e-6)
    assert abs(wear.largest_depth_position) < 0.3e-3
    # The area of what the normals pass, with the curvature towards the material.
    curvature = np.interp(middle + over, new.points["arc_length"], new.points["curvature"])
    area = np.trapezoid(depth - curvature * depth**2 / 2, over)
    assert worn.worn_area("S1002") == pytest.approx(area, rel=2e-4)
    again = worn.worn_by(middle + over, depth)
    assert again.source == "EN 13715, worn"
    assert again.worn_area(new) == pytest.approx(2 * wear.worn_area, rel=1e-2)
    worn.write(tmp_path / "worn.prw")
    assert package.Profile(tmp_path / "worn.prw").worn_area(worn) == pytest.approx(0.0, abs=1e-11)
    same = new.worn_by(0.01, 0.0)
    assert same.source == "EN 13715"
    np.testing.assert_array_equal(same.points["z"], new.points["z"])
    for call, words in [
        (lambda: package.Profile("60E1").measures(), "a wheel is needed"),
        (lambda: package.Profile("cone20").measures(), "no flange of 12 mm"),
        (lambda: new.worn_against("60E1"), "a wheel is needed"),
        (lambda: new.worn_by([0.02, 0.01], 1e-3), "must ascend"),
        (lambda: new.worn_by(0.01, 13e-3), "where its radius is"),
    ]:
        with pytest.raises(ValueError, match=words):
            call()


def test_contact_geometry_is_a_table():
    """A profile of one's own, inclined and smoothed, gives what the names give."""
    named = package.contact_geometry("60E1", "S1002", lateral=(-4e-3, 4e-3), step=5e-4)
    own = package.contact_geometry(
        package.Profile("60E1", inclination=0.025), "S1002", lateral=(-4e-3, 4e-3), step=5e-4, rail_inclination=0.0
    )
    assert named.attrs["units"]["left_on_rail"] == "m"
    assert named.attrs["conicity"] == pytest.approx(0.177, abs=2e-3)
    assert own.attrs["conicity"] == pytest.approx(named.attrs["conicity"], rel=0.02)
    pd.testing.assert_series_equal(named["rolling_radius_difference"], own["rolling_radius_difference"], atol=2e-5)
    assert any(abs(jump["lateral_displacement"]) < 1e-3 for jump in named.attrs["jumps"])
    level = package.contact_geometry("60E1", "S1002", lateral=(-4e-3, 4e-3), step=5e-4, level=True)
    assert (level["roll_angle"] == 0.0).all()
    assert 0.9 < level.attrs["conicity"] / named.attrs["conicity"] < 1.0
    for wrong, words in [({"gauge": 5.0}, "gauge = 5"), ({"wheel": "60E1"}, "a wheel is needed")]:
        with pytest.raises(ValueError, match=words):
            package.contact_geometry(**wrong)
    with pytest.raises(TypeError, match="no dimension height"):
        package.contact_geometry(height=1.0)
    for lateral in (5e-3, (1e-3,), (0.0, 1e-3, 2e-3)):
        with pytest.raises(TypeError, match=f"^lateral = {re.escape(repr(lateral))}: two numbers are needed"):
            package.contact_geometry(lateral=lateral)


def test_noise_is_warned_of():
    """Contacts of a profile with noise come with a warning that has its name; of a smooth one there is none."""
    points = package.Profile("S1002").points
    noise = np.random.default_rng(3).uniform(-0.03e-3, 0.03e-3, (2, len(points)))
    rough = package.Profile.from_points(points["y"] + noise[0], points["z"] + noise[1], body="wheel")
    noisy = re.escape("its direction turns to and fro, as noise does, which smoothing takes off (smoothing=…)")
    with pytest.warns(UserWarning, match=f"^points: {noisy}; the contacts jump with it"):
        package.contact_geometry("60E1", rough, step=4e-3)
    rougher = package.Profile.from_points(points["y"] + 10 * noise[0], points["z"] + 10 * noise[1], body="wheel")
    with pytest.raises(ValueError, match=f"^points: .*; {noisy}$"):
        package.contact_geometry("60E1", rougher, step=4e-3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        package.contact_geometry("60E1", rough.smoothed(2e-3), step=4e-3)


def test_the_picture_has_profiles_and_curves():
    """Two panels of profiles where outlines were asked for, and three of curves."""
    table = package.contact_geometry(step=5e-4, outlines_at=3e-3)
    assert len(package.plots.contact_geometry(table).axes) == 5
    del table.attrs["outlines"]
    assert len(package.plots.contact_geometry(table, title="S1002 on 60E1").axes) == 3
    with pytest.raises(ValueError, match="rolling_radius_difference"):
        package.plots.contact_geometry(pd.DataFrame({"lateral_displacement": [0.0]}))
