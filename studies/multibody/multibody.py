"""A braked bogie in Exudyn on an uneven track, the component as the contact of its wheels at each integration step.

    .venv/bin/python studies multibody          (after `make couplings-set-up`; or `make coupling-multibody`)

In the plane of travel: a share of the car body on the secondary suspension, a bogie frame that bounces and pitches, two
wheelsets in the primary suspension, and under each a piece of track that yields. The rails are uneven and have a dipped
joint. Vertically, wheel and rail meet in the component's own law of load against penetration. Lengthwise, each wheelset
has an instance of the component: load, wheel speed and vehicle speed go in at the beginning of each integration step;
traction and friction torque come back and are held over the step. docs/couplings/multibody.md.
"""

import exudyn
import matplotlib.pyplot as plt
import numpy as np
from exudyn.itemInterface import (
    CartesianSpringDamper,
    CoordinateSpringDamper,
    LoadCoordinate,
    MarkerBodyPosition,
    MarkerNodeCoordinate,
    Node1D,
    NodePoint2D,
    NodePointGround,
    NodeRigidBody2D,
    ObjectMass1D,
    ObjectMassPoint2D,
    ObjectRigidBody2D,
)
from helpers import BLACK, BLUE, FMU, ORANGE, RED, RESULTS, WHEEL_RADIUS, Instance, save, show, write_csv
from matplotlib.animation import PillowWriter

GRAVITY = 9.81
SPEED = 25.0  # m/s at the start
STEP = 2e-4  # s
STOP = 2.4  # s
WHEELS = 2  # on an axle
# A passenger vehicle with the order of magnitude of the Manchester benchmark's vehicle 1; one bogie and half a body.
BODY_MASS, FRAME_MASS, WHEELSET_MASS = 16000.0, 2615.0, 1813.0  # kg
FRAME_INERTIA, WHEELSET_INERTIA = 1476.0, 112.0  # kg.m2, about the lateral axis
HALF_WHEELBASE = 1.28  # m
# Both sides together: stiffness [N/m] and damping [N.s/m], along and vertically.
PRIMARY = ((6.2e7, 1.0e5), (2.44e6, 8.0e3))
SECONDARY = ((5.0e6, 2.5e4), (8.6e5, 4.0e4))
TRACK_MASS, TRACK_STIFFNESS, TRACK_DAMPING = 600.0, 1.4e8, 2.0e5  # under an axle, both rails
BRAKE_TORQUE, BRAKE_START, BRAKE_RAMP = 19e3, 0.3, 0.4  # N.m on an axle, s, s
SLIDE_START, SLIDE_END = 0.01, 0.05  # 1: creepages between which the slide protection lets go of a brake
JOINT, DIP, DIP_LENGTH = 32.0, 2.5e-3, 0.5  # m: place, depth and length of the dipped joint
STATIC_LOAD = GRAVITY * (BODY_MASS + FRAME_MASS + 2 * WHEELSET_MASS) / 4  # N, of a wheel
CONTACT = {"slip_source": 2, "largest_load": 160e3, "contact_nodes": 81}
OUTPUTS = ("traction_force", "friction_torque", "peak_temperature", "friction_coefficient", "slip_creepage")
OUTPUTS += ("wear_depth", "worn_volume", "friction_energy")


# ---- the track ------------------------------------------------------------------------------------------------------


class Track:
    """Height of the rails: harmonics of the spectrum of the ORE (B 176, high disturbance), and the dipped joint.

    One-sided spectral density over the angular wavenumber k [rad/m]: S = A c² / ((k² + r²)(k² + c²)).
    """

    ROUGHNESS, CUT_OFF, LONGEST = 1.08e-6, 0.8246, 0.0206  # A [rad.m], c [rad/m], r [rad/m]

    def __init__(self, joint=JOINT):
        """Harmonics with wavelengths from 0.8 to 40 m, with random phases from a fixed seed."""
        edges = 2.0 * np.pi / np.geomspace(40.0, 0.8, 161)
        self.wavenumber = np.sqrt(edges[1:] * edges[:-1])
        squared = self.wavenumber**2
        density = self.ROUGHNESS * self.CUT_OFF**2 / ((squared + self.LONGEST**2) * (squared + self.CUT_OFF**2))
        self.amplitude = np.sqrt(2.0 * density * np.diff(edges))
        self.phase = np.random.default_rng(20).uniform(0.0, 2.0 * np.pi, len(density))
        self.joint = joint

    def height(self, place):
        """Height at a place [m]; even at the start, where it begins over 8 m."""
        place = np.asarray(place, float)
        uneven = np.cos(np.multiply.outer(place, self.wavenumber) + self.phase) @ self.amplitude
        begin = np.clip((place - HALF_WHEELBASE) / 8.0, 0.0, 1.0)
        begin = begin * begin * (3.0 - 2.0 * begin)
        # The tip of the dip is round over 2 cm.
        dip = DIP * np.exp(-np.sqrt((place - self.joint) ** 2 + 0.02**2) / DIP_LENGTH)
        return begin * uneven - dip


def load_law():
    """Load against penetration, from the component itself: steady rolling at loads up to the largest."""
    loads = np.linspace(1e3, CONTACT["largest_load"], 80)
    contact = Instance(FMU, "load", **CONTACT).start()
    penetrations = []
    for load in loads:
        contact.set(normal_load=load)
        contact.step(5.0)
        contact.step(5.0)
        penetrations += contact.get("penetration")
    contact.close()
    return np.concatenate([[0.0], penetrations]), np.concatenate([[0.0], loads])


# ---- the vehicle ----------------------------------------------------------------------------------------------------


class Bogie:
    """The multibody model, and the component's instances at its wheelsets.

    Coordinates are x along the track and y upward, from the static state; a wheel that rolls forward turns clockwise.
    """

    def __init__(self, track, step=STEP, initial_speed=SPEED):
        """Build the model in its static state, moving at the initial speed."""
        self.track, self.step_size = track, step
        self.law = load_law()
        self.static_penetration = np.interp(STATIC_LOAD, self.law[1], self.law[0])
        self.rows, self.time = [], 0.0
        container = exudyn.SystemContainer()
        self.mbs = container.AddSystem()
        self.container = container
        speed = [initial_speed, 0.0]
        self.frame = self.mbs.AddNode(NodeRigidBody2D(initialVelocities=[*speed, 0.0]))
        frame = self.mbs.AddObject(ObjectRigidBody2D(mass=FRAME_MASS, inertia=FRAME_INERTIA, nodeNumber=self.frame))
        self.body = self.mbs.AddNode(NodePoint2D(initialVelocities=speed))
        body = self.mbs.AddObject(ObjectMassPoint2D(mass=BODY_MASS, nodeNumber=self.body))
        self.hang(frame, 0.0, body, SECONDARY, BODY_MASS)
        self.weigh(self.frame, FRAME_MASS)
        self.weigh(self.body, BODY_MASS)
        ground = self.mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=self.mbs.AddNode(NodePointGround()), coordinate=0))
        self.axles = [self.axle(place, frame, ground, initial_speed) for place in (HALF_WHEELBASE, -HALF_WHEELBASE)]
        self.brake_reaction = self.load(self.frame, 2)
        self.mbs.SetPreStepUserFunction(self.exchange)
        self.mbs.Assemble()

    def load(self, node, coordinate, value=0.0):
        """A force or torque on a coordinate of a node."""
        marker = self.mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        return self.mbs.AddLoad(LoadCoordinate(markerNumber=marker, load=value))

    def weigh(self, node, mass):
        """The weight of a body."""
        self.load(node, 1, -mass * GRAVITY)

    def hang(self, lower, place, upper, suspension, mass_carried, upper_place=0.0):
        """A suspension between two bodies; its springs carry the mass above in the static state."""
        (along, along_damping), (vertical, damping) = suspension
        markers = [
            self.mbs.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=[at, 0, 0]))
            for body, at in ((lower, place), (upper, upper_place))
        ]
        self.mbs.AddObject(
            CartesianSpringDamper(
                markerNumbers=markers,
                stiffness=[along, vertical, 0],
                damping=[along_damping, damping, 0],
                offset=[0, mass_carried * GRAVITY / vertical, 0],
            )
        )

    def axle(self, place, frame, ground, speed):
        """A wheelset in the primary suspension, its track, and its contact."""
        spin = speed / WHEEL_RADIUS
        node = self.mbs.AddNode(
            NodeRigidBody2D(referenceCoordinates=[place, 0, 0], initialVelocities=[speed, 0, -spin])
        )
        wheelset = self.mbs.AddObject(ObjectRigidBody2D(mass=WHEELSET_MASS, inertia=WHEELSET_INERTIA, nodeNumber=node))
        self.weigh(node, WHEELSET_MASS)
        self.hang(wheelset, 0.0, frame, PRIMARY, 0.5 * (BODY_MASS + FRAME_MASS), place)
        rail = self.mbs.AddNode(Node1D())
        self.mbs.AddObject(ObjectMass1D(mass=TRACK_MASS, nodeNumber=rail))
        rail_marker = self.mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=rail, coordinate=0))
        wheel_marker = self.mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=1))
        carried = WHEELS * STATIC_LOAD / TRACK_STIFFNESS
        self.mbs.AddObject(
            CoordinateSpringDamper(
                markerNumbers=[ground, rail_marker],
                stiffness=TRACK_STIFFNESS,
                damping=TRACK_DAMPING,
                offset=carried,
            )
        )
        axle = Axle(self, place, speed, spin)
        self.mbs.AddObject(
            CoordinateSpringDamper(markerNumbers=[rail_marker, wheel_marker], springForceUserFunction=axle.push)
        )
        axle.node, axle.rail = node, rail
        axle.traction, axle.torque = self.load(node, 0), self.load(node, 2)
        return axle

    def exchange(self, mbs, _time):
        """Before each integration step: to the contacts and back."""
        braking = BRAKE_TORQUE * min(max((self.time - BRAKE_START) / BRAKE_RAMP, 0.0), 1.0)
        row = [self.time]
        for axle in self.axles:
            row += axle.exchange(mbs, self.step_size, braking)
        # What slows the wheels down tilts the frame.
        mbs.SetLoadParameter(self.brake_reaction, "load", -sum(axle.braking for axle in self.axles))
        frame, body = (
            mbs.GetNodeOutput(node, exudyn.OutputVariableType.Coordinates) for node in (self.frame, self.body)
        )
        velocity = mbs.GetNodeOutput(self.frame, exudyn.OutputVariableType.Coordinates_t)
        body_velocity = mbs.GetNodeOutput(self.body, exudyn.OutputVariableType.Coordinates_t)
        self.rows.append((*row, velocity[0], body_velocity[0], frame[0], frame[1], frame[2], body[1]))
        self.time += self.step_size
        if len(self.rows) % 200 == 0:
            show(min(self.time / self.stop, 1.0), "bogie")
        return True

    def run(self, stop):
        """Integrate to the stop time, by generalised alpha; return the table of all steps."""
        self.stop = stop
        settings = exudyn.SimulationSettings()
        settings.timeIntegration.numberOfSteps = round(stop / self.step_size)
        settings.timeIntegration.endTime = stop
        settings.timeIntegration.verboseMode = 0
        settings.timeIntegration.generalizedAlpha.spectralRadius = 0.8
        settings.timeIntegration.newton.useModifiedNewton = True
        settings.solution.file.write = False
        # Quiet: it would remark on the memory that user functions take at each step.
        exudyn.config.printToConsole = False
        done = self.mbs.SolveDynamic(settings)
        exudyn.config.printToConsole = True
        if not done:
            raise RuntimeError(f"the multibody solver stopped at {self.time:g} s")
        names = [f"{name}_{axle}" for axle in ("front", "rear") for name in Axle.COLUMNS]
        names = ["time", *names, "frame_speed", "body_speed", "x", "bounce", "pitch", "body_bounce"]
        for axle in self.axles:
            axle.contact.close()
        return np.array(self.rows, dtype=[(name, float) for name in names])


class Axle:
    """What a wheelset needs to meet the rails."""

    COLUMNS = ("place", "height", "turned", "rail", "spin", "speed", "load", "brake", *OUTPUTS)

    def __init__(self, bogie, place, speed, spin):
        """An instance of the component for both its wheels, rolling freely under the static load."""
        self.bogie = bogie
        self.reference = self.place = place
        self.speed, self.since, self.braking = speed, 0.0, 0.0
        self.contact = Instance(FMU, "axle", **CONTACT)
        self.contact.set(normal_load=STATIC_LOAD, vehicle_speed=speed, wheel_speed=spin)
        self.contact.start()

    def penetration(self, moved, time):
        """How deep the wheel is in the rail, by which it has moved up relative to it."""
        place = self.place + self.speed * (time - self.since)
        return self.bogie.static_penetration - moved + self.bogie.track.height(place)

    def push(self, _mbs, time, _item, moved, _velocity, _stiffness, _damping, _offset):
        """The vertical force of both wheels; negative, as it pushes."""
        return -WHEELS * np.interp(self.penetration(moved, time), *self.bogie.law)

    def exchange(self, mbs, step, braking):
        """Give the contact load and speeds, step it, and put its traction and torque on the wheelset."""
        moved, height, angle = mbs.GetNodeOutput(self.node, exudyn.OutputVariableType.Coordinates)
        place = self.reference + moved
        speed, _, turning = mbs.GetNodeOutput(self.node, exudyn.OutputVariableType.Coordinates_t)
        rail = float(mbs.GetNodeOutput(self.rail, exudyn.OutputVariableType.Coordinates))
        self.place, self.speed, self.since = place, speed, self.bogie.time
        load = float(np.interp(self.penetration(height - rail, self.since), *self.bogie.law))
        self.contact.set(normal_load=load, vehicle_speed=float(speed), wheel_speed=float(-turning))
        self.contact.step(step)
        answers = self.contact.get(*OUTPUTS)
        traction, torque = answers[:2]
        mbs.SetLoadParameter(self.traction, "load", WHEELS * traction)
        slide = np.clip((-answers[OUTPUTS.index("slip_creepage")] - SLIDE_START) / (SLIDE_END - SLIDE_START), 0.0, 1.0)
        self.braking = braking * (1.0 - slide)
        mbs.SetLoadParameter(self.torque, "load", self.braking - WHEELS * torque)
        return [place, height, -angle, rail, -turning, speed, load, self.braking, *answers]


# ---- pictures -------------------------------------------------------------------------------------------------------

LARGER = 25.0  # vertical movements and the track, in the drawing of the vehicle
SIDES = {"front": BLUE, "rear": ORANGE}
HOT = plt.Normalize(20.0, 80.0)


def draw_vehicle(axes, row, track):
    """Draw the bogie from the side with the rail below it, movements and unevenness enlarged."""
    axes.clear()
    middle = row["x"]
    along = np.linspace(middle - 3.2, middle + 3.2, 500)
    axes.fill_between(along, LARGER * track.height(along), -0.6, color="#c8c8c8", linewidth=0)
    axes.plot(along, LARGER * track.height(along), color="#444444", linewidth=1.6)
    # The car body's lower edge, the secondary spring, the frame.
    body, frame = LARGER * row["body_bounce"], LARGER * row["bounce"]
    tilt = LARGER * row["pitch"]
    axes.add_patch(plt.Rectangle((middle - 3.0, 1.45 + body), 6.0, 0.35, color="#dbe5ee", ec="#7790a8"))
    draw_spring(axes, middle, 0.85 + frame, 1.45 + body, 0.22)
    ends = np.array([-1.75, 1.75])
    axes.plot(middle + ends, 0.75 + frame + tilt * ends, color="#445566", linewidth=7, solid_capstyle="round")
    for side, place in (("front", HALF_WHEELBASE), ("rear", -HALF_WHEELBASE)):
        x, y = row[f"place_{side}"], WHEEL_RADIUS + LARGER * row[f"height_{side}"]
        draw_spring(axes, x, y + 0.05, 0.70 + frame + tilt * place, 0.1)
        temperature = row[f"peak_temperature_{side}"] - 273.15
        axes.add_patch(plt.Circle((x, y), WHEEL_RADIUS, facecolor="white", edgecolor="#333333", linewidth=2))
        turned = -row[f"turned_{side}"]
        for spoke in turned + np.arange(3) * 2.0 * np.pi / 3.0:
            axes.plot([x, x + 0.42 * np.cos(spoke)], [y, y + 0.42 * np.sin(spoke)], color="#bbbbbb", linewidth=1)
        axes.plot(x, y - WHEEL_RADIUS, "o", color=plt.cm.plasma(HOT(temperature)), markersize=9, zorder=5)
        load, force = row[f"load_{side}"], row[f"traction_force_{side}"]
        arrow = {"arrowstyle": "-|>", "linewidth": 1.8}
        ground = y - WHEEL_RADIUS
        tail = ground - 0.3 * load / STATIC_LOAD
        axes.annotate("", (x, ground), (x, tail), arrowprops=arrow | {"color": BLACK}, annotation_clip=False)
        axes.annotate("", (x + force / 25e3, ground - 0.04), (x, ground - 0.04), arrowprops=arrow | {"color": RED})
        text = f"load {load / 1e3:.0f} kN\ntraction {force / 1e3:.0f} kN\n{temperature:.0f} °C"
        axes.annotate(text, (x + 0.55, 0.3), fontsize=8, va="center")
    axes.set(xlim=(middle - 3.2, middle + 3.2), ylim=(-0.6, 1.9), aspect="equal", xlabel="place along the track [m]")
    axes.grid(False)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.set_title(f"{row['time']:.2f} s, {3.6 * row['frame_speed']:.0f} km/h (heights × {LARGER:g})")


def draw_spring(axes, x, low, high, width):
    """A spring as a zigzag."""
    zigzag = np.array([0, 0, 1, -1, 1, -1, 1, -1, 0, 0]) * width
    axes.plot(x + zigzag, np.linspace(low, high, len(zigzag)), color="#777777", linewidth=1.1)


def strips(figure, result, track, shown=("load", "traction_force", "slip_creepage", "peak_temperature", "wear_depth")):
    """Panels over the place of each axle, below that of the rail's height; return them."""
    panels = figure.subplots(1 + len(shown), 1, sharex=True)
    along = np.linspace(0.0, result["place_front"][-1], 1500)
    panels[0].plot(along, 1e3 * track.height(along), color=BLACK, linewidth=1.0)
    rows = {
        "load": (1e-3, 0.0, "load of a\nwheel [kN]"),
        "traction_force": (1e-3, 0.0, "traction of a\nwheel [kN]"),
        "slip_creepage": (100.0, 0.0, "creepage [%]"),
        "peak_temperature": (1.0, -273.15, "peak temper-\nature [°C]"),
        "wear_depth": (1e9, 0.0, "wear left by\na wheel [nm]"),
    }
    for axes, name in zip(panels[1:], shown, strict=True):
        factor, shift, label = rows[name]
        for side, colour in SIDES.items():
            values = factor * result[f"{name}_{side}"] + shift
            axes.plot(result[f"place_{side}"], values, color=colour, linewidth=1.0, label=f"{side} axle")
        axes.set_ylabel(label)
    panels[0].set(ylabel="height of the\nrail [mm]")
    panels[0].annotate(
        "dipped joint", (track.joint, 1e3 * track.height(track.joint)), (14, -22), "data", "offset points"
    )
    panels[1].legend(loc="upper left", ncols=2, fontsize=8)
    panels[-1].set(xlabel="place along the track [m]", xlim=(0, along[-1]))
    figure.align_ylabels(panels)
    return panels


def draw(result, track):
    """Draw the vehicle when the rear wheels are hottest above what happened along the way."""
    figure = plt.figure(figsize=(9.0, 11.5), layout="constrained")
    top, bottom = figure.subfigures(2, 1, height_ratios=[1, 2.3])
    moment = np.argmax(result["peak_temperature_rear"])
    draw_vehicle(top.subplots(), result[moment], track)
    panels = strips(bottom, result, track)
    for axes in panels:
        axes.axvline(result["place_rear"][moment], color="#999999", linewidth=0.8, linestyle=":")
    save(figure, "multibody.png")


def animate(result, track, frames=90):
    """The vehicle and the strips as an animation, slowed down around the joint."""
    figure = plt.figure(figsize=(7.8, 8.0), layout="constrained", dpi=80)
    top, bottom = figure.subfigures(2, 1, height_ratios=[1, 1.6])
    vehicle = top.subplots()
    panels = strips(bottom, result, track, ("load", "traction_force", "peak_temperature"))
    lines = [axes.axvline(0.0, color="#888888", linewidth=0.8) for axes in panels]
    # Four times slower from 3 m before to 5 m behind the joint.
    front = result["place_front"]
    weight = np.where((front > track.joint - 3.0) & (front < track.joint + 5.0), 4.0, 1.0).cumsum()
    RESULTS.mkdir(exist_ok=True)
    path = RESULTS / "multibody.gif"
    writer = PillowWriter(fps=15)
    with writer.saving(figure, path, dpi=80):
        for number, share in enumerate(np.linspace(0.0, 1.0, frames)):
            row = result[np.searchsorted(weight, share * weight[-1])]
            draw_vehicle(vehicle, row, track)
            for line in lines:
                line.set_xdata([row["place_front"]] * 2)
            writer.grab_frame()
            show((number + 1) / frames, "animation")
    plt.close(figure)
    print(f"  wrote results/{path.name}")


def main():
    """Run, report, draw, write."""
    track = Track()
    result = Bogie(track).run(STOP)
    braking = result["time"] > BRAKE_START + BRAKE_RAMP
    print(f"  {SPEED:g} m/s to {result['frame_speed'][-1]:.2f} m/s in {STOP:g} s, {len(result)} steps")
    for side in SIDES:
        get = {name: result[f"{name}_{side}"] for name in Axle.COLUMNS}
        load, heat = get["load"], get["peak_temperature"] - 273.15
        print(f"  {side} wheels:")
        print(
            f"    load {load.min() / 1e3:.1f} to {load.max() / 1e3:.1f} kN, static {STATIC_LOAD / 1e3:.1f} kN", end=""
        )
        print(f", mean while braking {load[braking].mean() / 1e3:.1f} kN")
        print(f"    creepage to {100 * get['slip_creepage'].min():.2f} %, temperature to {heat.max():.1f} °C")
        print(f"    friction {get['friction_energy'][-1]:.0f} J, worn {1e9 * get['worn_volume'][-1]:.2f} mm³ a wheel")
    thinned = result[::10]
    write_csv("multibody.csv", {name: thinned[name] for name in thinned.dtype.names})
    draw(result, track)
    animate(result, track)


if __name__ == "__main__":
    main()
