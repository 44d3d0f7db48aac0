"""A wheelset and its contact as two FMUs, in three masters, and the balance of their energies.

    .venv/bin/python studies longitudinal       (after `make couplings-set-up`; or `make coupling-longitudinal`)

wheelset.py is the vehicle's side: traction, braking, a wet stretch of rail, wheel-slide protection. Both FMUs
are in one SSP file, which libcosim and ecos run; FMPy runs the same in a plain loop. docs/couplings/longitudinal.md.
"""

import argparse
import ctypes
import json
import os
import subprocess
import sys
import tempfile
import time
import zipfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from helpers import BLACK, BLUE, FMU, GREEN, ORANGE, RED, REPOSITORY, SKY, WHEEL_RADIUS, Instance, save, show, write_csv

WHEELSET = REPOSITORY / "target" / "Wheelset.fmu"
SSP = REPOSITORY / "target" / "longitudinal.ssp"
# An output of one side, and the input of the same name on the other side that it goes to.
TO_CONTACT = ("wheel_speed", "vehicle_speed", "normal_load", "friction_scale")
TO_WHEELSET = ("traction_force", "friction_torque")
CONTACT_PARAMETERS = {"slip_source": 2}  # motion from wheel speed and vehicle speed
WHEELSET_PARAMETERS = {}  # as studies/longitudinal/wheelset.py has them
RECORDED = {
    "wheelset": (*TO_CONTACT, "brake_pressure", "traction_work", "brake_work", "resistance_work", "kinetic_energy"),
    "contact": (
        *TO_WHEELSET,
        "slip_creepage",
        "peak_temperature",
        "friction_coefficient",
        "contact_offset",
        "friction_power",
        "friction_energy",
        "worn_volume",
    ),
}
COLUMNS = [f"{component}.{name}" for component, names in RECORDED.items() for name in names]
STEP = 2e-4  # s
STOP = 7.5  # s
WHEELS = 2
# A short manoeuvre, for the convergence: braking onto the wet stretch at once.
SHORT = {"traction_torque": 0.0, "brake_start": 0.05, "ramp": 0.2, "wet_start": 5.0, "wet_end": 100.0}
SHORT_STOP = 0.8  # s
STEPS = (4e-4, 2e-4, 1e-4)  # s


# ---- one SSP file ---------------------------------------------------------------------------------------------------


def write_ssp(path, contact=(), wheelset=()):
    """Both FMUs, their connections and their parameters as one System Structure and Parameterization package."""
    parameters = {"contact": CONTACT_PARAMETERS | dict(contact), "wheelset": WHEELSET_PARAMETERS | dict(wheelset)}
    sources = {"contact": FMU, "wheelset": WHEELSET}
    inputs = {"contact": TO_CONTACT, "wheelset": TO_WHEELSET}
    components = connections = ""
    for component, other in (("contact", "wheelset"), ("wheelset", "contact")):
        connectors = "".join(
            f'<ssd:Connector name="{name}" kind="{kind}"><ssc:Real/></ssd:Connector>'
            for kind, names in (("input", inputs[component]), ("output", inputs[other]))
            for name in names
        )
        values = "".join(
            f'<ssv:Parameter name="{name}"><ssv:{"Integer" if isinstance(value, int) else "Real"} value="{value!r}"/>'
            "</ssv:Parameter>"
            for name, value in parameters[component].items()
        )
        binding = (
            "<ssd:ParameterBindings><ssd:ParameterBinding><ssd:ParameterValues>"
            f'<ssv:ParameterSet version="1.0" name="start"><ssv:Parameters>{values}</ssv:Parameters></ssv:ParameterSet>'
            "</ssd:ParameterValues></ssd:ParameterBinding></ssd:ParameterBindings>"
        )
        components += (
            f'<ssd:Component name="{component}" type="application/x-fmu-sharedlibrary"'
            f' source="resources/{sources[component].name}"><ssd:Connectors>{connectors}</ssd:Connectors>'
            f"{binding if values else ''}</ssd:Component>"
        )
        connections += "".join(
            f'<ssd:Connection startElement="{other}" startConnector="{name}" endElement="{component}"'
            f' endConnector="{name}"/>'
            for name in inputs[component]
        )
    structure = (
        '<?xml version="1.0" encoding="UTF-8"?>'
        "<ssd:SystemStructureDescription"
        ' xmlns:ssc="http://ssp-standard.org/SSP1/SystemStructureCommon"'
        ' xmlns:ssd="http://ssp-standard.org/SSP1/SystemStructureDescription"'
        ' xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues"'
        ' name="longitudinal" version="1.0"><ssd:System name="longitudinal">'
        f"<ssd:Elements>{components}</ssd:Elements><ssd:Connections>{connections}</ssd:Connections>"
        '</ssd:System><ssd:DefaultExperiment startTime="0.0"/></ssd:SystemStructureDescription>'
    )
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("SystemStructure.ssd", structure)
        for source in sources.values():
            archive.write(source, f"resources/{source.name}")
    return path


# ---- three masters: each returns a table, a row per `every` steps ---------------------------------------------------


def table(rows):
    """Rows of (time, recorded values) with names."""
    return np.array([tuple(row) for row in rows], dtype=[(name, float) for name in ("time", *COLUMNS)])


def in_fmpy(step, stop, every=1, contact=(), wheelset=()):
    """Run a plain loop: both sides step with what the other had at the beginning of the step."""
    sides = {
        "contact": Instance(FMU, "contact", **(CONTACT_PARAMETERS | dict(contact))),
        "wheelset": Instance(WHEELSET, "wheelset", **(WHEELSET_PARAMETERS | dict(wheelset))),
    }

    def exchange():
        to_contact = sides["wheelset"].get(*TO_CONTACT)
        to_wheelset = sides["contact"].get(*TO_WHEELSET)
        sides["contact"].set(**dict(zip(TO_CONTACT, to_contact, strict=True)))
        sides["wheelset"].set(**dict(zip(TO_WHEELSET, to_wheelset, strict=True)))

    def row(time):
        return [time, *(value for name, names in RECORDED.items() for value in sides[name].get(*names))]

    # As many exchanges before the start as there are FMUs, so that start values reach everything that depends on them.
    for _ in sides:
        exchange()
    for side in sides.values():
        side.start()
    exchange()
    rows = [row(0.0)]
    for number in range(1, round(stop / step) + 1):
        for side in sides.values():
            side.step(step)
        exchange()
        if number % every == 0:
            rows.append(row(number * step))
    for side in sides.values():
        side.close()
    return table(rows)


def in_libcosim(step, stop, every=1, ssp=SSP):
    """The SSP file in libcosim's fixed-step algorithm."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.WARNING)
    # Its time is in whole nanoseconds.
    execution = CosimExecution.from_ssp_file(str(ssp), round(step * 1e9))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer=observer)
    places = []
    for component, names in RECORDED.items():
        index = execution.slave_index_from_instance_name(component)
        reference = {variable.name.decode(): variable.reference for variable in execution.slave_variables(index)}
        places.append((index, [reference[name] for name in names]))

    def row(time):
        return [time, *(value for index, names in places for value in observer.last_real_values(index, names))]

    rows = []
    for number in range(1, round(stop / step / every) + 1):
        execution.step(every)
        rows.append(row(number * every * step))
    return table(rows)


def in_ecos(step, stop, every=1, ssp=SSP):
    """The same SSP file in ecos' fixed-step algorithm."""
    load_tbb()
    from ecospy import EcosSimulation

    with EcosSimulation(ssp_path=str(ssp), step_size=step) as simulation:
        simulation.init(parameter_set="start")
        rows = []
        for number in range(1, round(stop / step / every) + 1):
            simulation.step(every)
            names = (name.replace(".", "::", 1) for name in COLUMNS)
            rows.append([number * every * step, *(simulation.get_real(name) for name in names)])
        simulation.terminate()
    return table(rows)


def load_tbb():
    """Load ecos' libtbb.so.12 from where tools/hosts.py put it, if the system has none."""
    for library in sorted((REPOSITORY / ".venv" / "tbb").rglob("libtbb*.so.*")):
        if library.name in ("libtbbmalloc.so.2", "libtbb.so.12"):
            ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)


MASTERS = {"FMPy": in_fmpy, "libcosim": in_libcosim, "ecos": in_ecos}


def in_own_process(master, step, stop, every=1, ssp=SSP):
    """Run a master in a process of its own, as two simulation libraries had better not share one."""
    options = json.dumps({"step": step, "stop": stop, "every": every} | ({} if master == "FMPy" else {"ssp": str(ssp)}))
    file = Path(ssp).with_suffix(f".{master}.npy")
    command = [sys.executable, REPOSITORY / "studies", "longitudinal", "--master", master, options, file]
    # ecos leaves what it has unpacked of an SSP file among the temporary files: they go with it.
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"TMPDIR": folder})
    if done.returncode != 0:
        raise RuntimeError(f"{master} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    result = np.load(file)
    file.unlink()
    return result


def disagreement(result, reference):
    """Largest difference of two masters over all recorded values, each relative to its largest magnitude."""
    common = reference[np.searchsorted(reference["time"], result["time"] - 1e-9)]
    return max(
        float(np.abs(result[name] - common[name]).max() / max(np.abs(reference[name]).max(), 1e-300))
        for name in COLUMNS
    )


# ---- the balance of energies ----------------------------------------------------------------------------------------


def balance(result):
    """Return work in, where it went, and what is missing, against time; a row for every step is needed.

    The contact hands out T and M = -(T r + N e): they take the power T (ω r - V) + N e ω out of the vehicle. The
    friction power is T (ω r - V) + N e V / r. What differs, N e (ω - V / r), is work of the offset pressure over the
    creep and counts as rolling loss, with the work of the running resistance. `missing` is what the books then lack.
    Of this, `bulge` is in the contact alone: the work that the pressure does on the thermal bulge and on the worn
    surface, which the friction power leaves out. The remainder, `coupling`, is due to the exchange at communication
    points.
    """
    get = {name.split(".")[1]: result[name] for name in COLUMNS}
    step = np.diff(result["time"])
    # What the contact hands out at the end of a step belongs to the speeds that it was given at the beginning.
    wheel_speed, vehicle_speed, load = (get[name][:-1] for name in ("wheel_speed", "vehicle_speed", "normal_load"))
    traction, offset = (get[name][1:] for name in ("traction_force", "contact_offset"))

    def total(power):
        return WHEELS * np.concatenate([[0.0], np.cumsum(step * power)])

    books = {
        "work": get["traction_work"] + get["brake_work"],
        "kinetic": get["kinetic_energy"] - get["kinetic_energy"][0],
        "friction": WHEELS * get["friction_energy"],
        "rolling": get["resistance_work"] + total(load * offset * (wheel_speed - vehicle_speed / WHEEL_RADIUS)),
    }
    books["missing"] = books["work"] - books["kinetic"] - books["friction"] - books["rolling"]
    slipping = traction * (wheel_speed * WHEEL_RADIUS - vehicle_speed)
    books["bulge"] = total(slipping + load * offset * vehicle_speed / WHEEL_RADIUS) - books["friction"]
    books["coupling"] = books["missing"] - books["bulge"]
    return books


def convergence():
    """Largest missing energy due to the coupling, for each of the steps."""
    lost = []
    for step in STEPS:
        lost.append(float(np.abs(balance(in_fmpy(step, SHORT_STOP, wheelset=SHORT))["coupling"]).max()))
        show(len(lost) / len(STEPS), "energy balance at smaller steps")
    return lost


# ---- the picture ----------------------------------------------------------------------------------------------------


def draw(result, books, lost):
    """Draw the manoeuvre on the left, its energies on the right."""
    figure = plt.figure(figsize=(11.0, 8.0), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=[1.25, 1])
    panels = left.subplots(5, 1, sharex=True)
    time = result["time"]
    wet = time[result["wheelset.friction_scale"] < 0.65]
    for axes in panels:
        axes.axvspan(wet[0], wet[-1], color="#e6f2fa", zorder=0)
    speeds, force, coefficient, creepage, temperature = panels
    speeds.plot(time, result["wheelset.vehicle_speed"], color=BLACK, label="vehicle")
    speeds.plot(time, WHEEL_RADIUS * result["wheelset.wheel_speed"], color=BLUE, label="wheel circumference")
    speeds.set(ylabel="speed [m/s]", title="Traction, braking and a wet stretch of rail", ylim=(None, 26))
    speeds.legend(loc="lower left")
    speeds.annotate("wet rail", (0.5 * (wet[0] + wet[-1]), 25.6), ha="center", va="top", color="#4a7fa5")
    force.plot(time, result["contact.traction_force"] / 1e3, color=BLACK)
    force.set_ylabel("traction force\non a wheel [kN]")
    coefficient.plot(time, result["contact.friction_coefficient"], color=BLUE, label="friction coefficient")
    used = np.abs(result["contact.traction_force"]) / result["wheelset.normal_load"]
    coefficient.plot(time, used, color=ORANGE, label="|traction force| / load")
    coefficient.plot(
        time, result["wheelset.brake_pressure"], color=GREEN, linewidth=1.0, label="brake pressure / largest"
    )
    coefficient.set(ylabel="ratio [1]", ylim=(0, 1.05))
    coefficient.legend(loc="upper left", fontsize=8)
    creepage.plot(time, 100 * result["contact.slip_creepage"], color=GREEN)
    creepage.set_yscale("symlog", linthresh=0.2, linscale=0.6)
    creepage.set(ylabel="creepage [%]", yticks=[0.1, -0.1, -1, -10], yticklabels=["0.1", "−0.1", "−1", "−10"])
    temperature.plot(time, result["contact.peak_temperature"] - 273.15, color=RED)
    temperature.set(ylabel="peak temperature\n[°C]", xlabel="time [s]", ylim=(0, None), xlim=(0, time[-1]))
    left.align_ylabels(panels)

    energy, losses, order = right.subplots(3, 1)
    energy.plot(time, books["work"] / 1e3, color=BLACK, label="work of the torques")
    energy.plot(time, books["kinetic"] / 1e3, color=BLUE, linestyle="--", label="change of kinetic energy")
    energy.set(ylabel="energy [kJ]", xlabel="time [s]", title="Where the work goes", xlim=(0, time[-1]))
    energy.legend(loc="lower left")
    losses.plot(time, books["friction"] / 1e3, color=RED, label="friction in both contacts")
    losses.plot(time, books["rolling"] / 1e3, color=GREEN, label="rolling loss")
    losses.plot(time, books["bulge"] / 1e3, color=SKY, label="thermal bulge and wear")
    losses.plot(time, books["coupling"] / 1e3, color=ORANGE, label="missing: the coupling")
    losses.set_yscale("symlog", linthresh=1e-2, linscale=0.4)
    losses.set(ylabel="energy [kJ]", xlabel="time [s]", xlim=(0, time[-1]), ylim=(-2e-2, 2e4))
    losses.set_yticks([-0.01, 0, 0.01, 0.1, 1, 10, 100], ["−0.01", "0", "0.01", "0.1", "1", "10", "100"])
    losses.legend(loc="upper left", ncols=2, fontsize=8)
    losses.minorticks_off()
    order.loglog(1e3 * np.array(STEPS), lost, color=ORANGE, marker="o", label="largest missing energy")
    first = lost[-1] * np.array(STEPS) / STEPS[-1]
    order.loglog(1e3 * np.array(STEPS), 0.8 * first, color="#777777", linestyle=":", label="order 1")
    order.set(xlabel="communication step [ms]", ylabel="energy [J]", title="Missing energy, braking onto the wet rail")
    order.set_xticks([1e3 * step for step in STEPS], [f"{1e3 * step:g}" for step in STEPS])
    order.set_yticks([2, 5, 10], ["2", "5", "10"])
    order.minorticks_off()
    order.legend()
    right.align_ylabels([energy, losses, order])
    save(figure, "longitudinal.png")


def main():
    """Run all three masters, compare, draw, write, report."""
    write_ssp(SSP)
    every = 25
    results = {}
    for master in MASTERS:
        began = time.time()
        # The balance needs every step.
        results[master] = in_own_process(master, STEP, STOP, 1 if master == "FMPy" else every)
        print(f"  {master}: {STOP:g} s in {round(STOP / STEP)} steps took {time.time() - began:.1f} s")
    result = results["FMPy"]
    for master in ("libcosim", "ecos"):
        print(f"  {master} differs from FMPy by {disagreement(results[master], result):.1e} of the largest value")
    books = balance(result)
    for name, values in books.items():
        print(f"  {name:9s} {values[-1] / 1e3:11.3f} kJ")
    lost = convergence()
    orders = np.log2(np.array(lost[:-1]) / np.array(lost[1:]))
    for step, energy in zip(STEPS, lost, strict=True):
        print(f"  step {1e3 * step:.2f} ms: up to {energy:.2f} J missing in the short manoeuvre")
    print(f"  observed orders: {', '.join(f'{order:.3f}' for order in orders)}")
    thinned = result[::every]
    write_csv("longitudinal.csv", {name: thinned[name] for name in thinned.dtype.names})
    draw(result, books, lost)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    # One master alone, its options as JSON, and the file for its table: in_own_process.
    parser.add_argument("--master", nargs=3, help=argparse.SUPPRESS)
    if chosen := parser.parse_args().master:
        np.save(chosen[2], MASTERS[chosen[0]](**json.loads(chosen[1])))
    else:
        main()
