"""Tables of inputs in other units and forms give the same result; files as spreadsheets write them are read."""

import datetime
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail  # noqa: E402
from wheelrail.units import heading, scales, spelling  # noqa: E402

TIMES = [0.0, 0.05, 0.05, 0.125]
LOADS = [60e3, 65e3, 70e3, 80e3]
OUTPUTS = ["traction_force", "peak_temperature", "wear_depth"]
# Heading, and its values times what, plus what, are the column of `IN_SI`.
IN_SI = {
    "time": TIMES,
    "creepage": [0.0, 0.01, 0.02, 0.02],
    "normal_load": LOADS,
    "wheel_speed": [20.0, 21.0, 22.0, 23.0],
    "ambient_temperature": [283.15, 293.15, 293.15, 303.15],
    "incoming_wear_depth": [0.0, 1e-6, 1e-6, 2e-6],
}
SHOWN = {
    "time [ms]": (1e3, 0.0),
    "creepage [%]": (1e2, 0.0),
    "normal_load [kN]": (1e-3, 0.0),
    "wheel_speed [rpm]": (30.0 / np.pi, 0.0),
    "ambient_temperature [°C]": (1.0, -273.15),
    "incoming_wear_depth [um]": (1e6, 0.0),
}


def shown():
    """Return the table in the units in which people write."""
    columns = zip(SHOWN.items(), IN_SI.values(), strict=True)
    return {name: factor * np.array(values) + offset for (name, (factor, offset)), values in columns}


def run(table, fmu, **values):
    """Simulate in few steps."""
    return wheelrail.simulate(table, step=0.01, outputs=OUTPUTS, fmu=fmu, **values)


@pytest.fixture(scope="module")
def expected(fmu):
    """Return the result of the table in SI units."""
    return run(IN_SI, fmu)


def written(folder, separator=",", before="", comma=False):
    """Return a file that has the table in shown units."""
    text = pd.DataFrame(shown()).to_csv(index=False, sep=separator, decimal="," if comma else ".")
    path = folder / "table.csv"
    path.write_bytes((before + text).encode())
    return path


def of_attrs():
    """Return a frame whose units are said beside it."""
    frame = pd.DataFrame({heading(name).name: values for name, values in shown().items()})
    frame.attrs["units"] = {heading(name).name: heading(name).unit for name in SHOWN}
    return frame


FORMS = {
    "mapping": lambda folder: shown(),
    "frame": lambda folder: pd.DataFrame(shown()),
    "index": lambda folder: pd.DataFrame(shown()).set_index("time [ms]"),
    "attrs": lambda folder: of_attrs(),
    "records": lambda folder: pd.DataFrame(shown()).to_records(index=False),
    "file": written,
    "text of a path": lambda folder: str(written(folder)),
    "file that is read": lambda folder: wheelrail.read_table(written(folder)),
    "mark and comments": lambda folder: written(folder, before="\ufeff# measured\n\n"),
    "semicolons": lambda folder: written(folder, ";"),
    "decimal commas": lambda folder: written(folder, ";", comma=True),
    "tabs": lambda folder: written(folder, "\t"),
    "carriage returns": lambda folder: written(folder, before="\r\n"),
    "objects": lambda folder: pd.DataFrame(shown()).astype(object),
    "types of pandas": lambda folder: pd.DataFrame(shown()).astype("Float64"),
    "short integers": lambda folder: {**shown(), "time [ms]": np.array([0, 50, 50, 125], dtype=np.int16)},
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
def test_units_are_converted(form, fmu, expected, tmp_path):
    """The result is that of SI units, to the round-off of the factors: the table's, a thousandth part of the step's."""
    result = run(FORMS[form](tmp_path), fmu)
    assert list(result) == list(expected)
    assert result.attrs == expected.attrs
    for name in expected:
        scale = np.abs(expected[name]).max()
        # Friction and wear follow the inputs with a gain of some ten; the inputs are off by round-off.
        assert np.allclose(result[name], expected[name], rtol=0.0, atol=1e-11 * scale), name


def test_prefixes_of_ten_are_exact(fmu):
    """60.032 kN are 60032 N to the last bit: a factor of 0.001 is not divided by."""
    loads = np.array([60.032, 60.035, 69.999])
    table = {"time": [0.0, 0.1, 0.2], "normal_load [kN]": loads}
    result = wheelrail.simulate(table, step=0.1, outputs="penetration", fmu=fmu)
    assert result["normal_load"].tolist() == (loads * 1e3).tolist()


def test_values_by_name_stay_in_si(fmu):
    """A load by name is in newtons, beside a table in other units."""
    result = wheelrail.simulate({"time [ms]": [0.0, 20.0]}, step=0.01, normal_load=70e3, outputs="penetration", fmu=fmu)
    assert result["normal_load"].tolist() == [70e3] * 3
    assert result["time"].tolist() == [0.0, 0.01, 0.02]


@pytest.mark.parametrize(
    "time",
    [
        pd.to_timedelta([0.0, 0.05, 0.05, 0.125], "s"),
        np.array([0, 50, 50, 125], dtype="timedelta64[ms]"),
        [datetime.timedelta(seconds=value) for value in TIMES],
        pd.Series(pd.to_timedelta(TIMES, "s")),
    ],
    ids=["index", "numpy", "objects", "series"],
)
def test_durations(time, fmu, expected):
    """Durations are seconds, whatever they count in, as a column and as an index."""
    pd.testing.assert_frame_equal(run(IN_SI | {"time": time}, fmu), expected)
    columns = {name: values for name, values in IN_SI.items() if name != "time"}
    pd.testing.assert_frame_equal(run(pd.DataFrame(columns, index=pd.Index(time, name="t")), fmu), expected)


def test_indices_that_are_times(fmu, expected):
    """An index called time, whole numbers too, and fractions without a name."""
    columns = {name: values for name, values in IN_SI.items() if name != "time"}
    pd.testing.assert_frame_equal(run(pd.DataFrame(columns, index=TIMES), fmu), expected)
    whole = pd.DataFrame({"creepage": [0.0, 0.01]}, index=pd.Index([0, 1], name="time"))
    result = wheelrail.simulate(whole, step=0.5, fmu=fmu, outputs="slip_creepage")
    assert result["time"].tolist() == [0.0, 0.5, 1.0]


def test_columns_that_say_nothing(fmu):
    """A column of another mode at its start value throughout passes: tables with one for every input are in use."""
    inputs = wheelrail.variables(fmu).query("kind == 'input'")["start"].astype(float)
    table = {"time": [0.0, 0.05], **{name: [value, value] for name, value in inputs.items()}}
    creeping = wheelrail.simulate(table | {"creepage": [0.0, 0.01]}, step=0.01, fmu=fmu, outputs=OUTPUTS)
    alone = wheelrail.simulate({"time": [0.0, 0.05], "creepage": [0.0, 0.01]}, step=0.01, fmu=fmu, outputs=OUTPUTS)
    pd.testing.assert_frame_equal(creeping[OUTPUTS], alone[OUTPUTS])
    # And by the tables that `make demo` writes.
    table |= {"vehicle_speed": [10.0, 12.0]}
    assert len(wheelrail.simulate(table, step=0.01, fmu=fmu, slip_source="vehicle_speed")) == 6


def test_presets(fmu):
    """A preset by its name, and what is given beside it goes before it."""
    table = {"time": [0.0, 0.2], "creepage": [0.0, 0.05]}

    def last(**values):
        return wheelrail.simulate(table, step=0.01, fmu=fmu, outputs="friction_coefficient", **values).iloc[-1, -1]

    assert last(preset="wet") == last(**wheelrail.preset("wet"))
    assert last(preset="wet", friction_cold=0.2) == last(**wheelrail.preset("wet") | {"friction_cold": 0.2})
    assert last(preset="wet", friction_cold=0.2) < last(preset="wet")
    curve = wheelrail.creep_curves("longitudinal", 0.02, fmu=fmu, preset="wet", friction_slip_share=1.0)
    assert curve["friction_coefficient"].iloc[0] == pytest.approx(wheelrail.preset("wet")["friction_cold"], rel=1e-3)


def test_one_name_stands_alone(fmu):
    """One output and one creepage, without a list around them."""
    result = wheelrail.simulate(stop_time=0.02, step=0.01, outputs="traction_force", fmu=fmu)
    assert list(result) == ["time", "traction_force"]
    twice = wheelrail.simulate(stop_time=0.02, step=0.01, outputs=["time", "traction_force"] * 2, fmu=fmu)
    pd.testing.assert_frame_equal(twice, result)
    curve = wheelrail.creep_curves("lateral", 0.01, outputs="lateral_force", fmu=fmu)
    assert len(curve) == 1
    pd.testing.assert_frame_equal(
        wheelrail.creep_curves("lateral", np.float64(0.01), outputs=["lateral_force"], fmu=fmu), curve
    )
    line = wheelrail.creep_curves(contact_model="line", creepages=[0.01], fmu=fmu)
    assert line["driven"].tolist() == ["longitudinal"]


def test_read_table(tmp_path):
    """Variables are converted, what the component does not know stays as it is; units are those of the values."""
    path = tmp_path / "measured.csv"
    path.write_text(
        "time [min],normal_load [kN],peak_temperature [degC],profile.pressure[1] [MPa],noise [dB],wind,remark\n"
        "1,60,100,700,60,1,dry\n2,70,200,800,61,,wet\n"
    )
    table = wheelrail.read_table(path)
    assert table.attrs["units"] == {
        "time": "s",
        "normal_load": "N",
        "peak_temperature": "K",
        "profile.pressure[1]": "Pa",
        "noise": "dB",
        "wind": "",
        "remark": "",
    }
    assert table["time"].tolist() == pytest.approx([60.0, 120.0], rel=1e-15)
    assert table["normal_load"].tolist() == [60e3, 70e3]
    assert table["peak_temperature"].tolist() == [373.15, 473.15]
    assert table["profile.pressure[1]"].tolist() == [700e6, 800e6]
    assert table["noise"].tolist() == [60, 61]
    assert table["remark"].tolist() == ["dry", "wet"]


def test_read_table_of_a_result(fmu, tmp_path):
    """A result that is written and read is the same, units too."""
    result = wheelrail.simulate(stop_time=0.02, step=0.01, fmu=fmu, creepage=0.01, outputs=["profile.pressure"])
    headings = [f"{name} [{unit}]" for name, unit in result.attrs["units"].items()]
    result.to_csv(tmp_path / "result.csv", index=False, header=headings)
    again = wheelrail.read_table(tmp_path / "result.csv")
    pd.testing.assert_frame_equal(again, result)
    assert again.attrs == result.attrs


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Nm", "N.m"),
        ("k N·m", "kN.m"),
        ("N⋅m", "N*m"),
        ("um", "µm"),
        ("\u03bcm", "\u00b5m"),
        ("°C", "degC"),
        ("°/s", "deg/s"),
        ("mm²", "mm^2"),
        ("m³ / s", "m3/s"),
        ("-", ""),
        ("1", "–"),
    ],
)
def test_spellings(one, other):
    """What is written in several ways is one unit."""
    assert spelling(one) == spelling(other)


def test_units_of_the_component(fmu):
    """Every display unit of the model description is allowed, and no two units of one quantity are spelled alike."""
    assert spelling("mN") != spelling("MN")
    of = scales(fmu)
    assert {"N", "kN"} <= set(of["N"])
    assert {spelling("°C"), "K"} == set(of["K"])
    for unit in wheelrail.variables(fmu)["unit"]:
        if unit:
            assert of[unit][spelling(unit)].factor == 1.0
