"""A vehicle of one's own, step by step: a braked wheel with its share of the vehicle, on a rail that gets slippery.

    python examples/vehicle.py          (with the package: `make wheel`, `pip install dist/wheelrail-*linux*.whl`)

    J dω/dt = torque of the contact - torque of the brake           m dV/dt = force of the contact

A brake that is released where the wheel falls behind is all the slide protection there is.
"""

import wheelrail

RADIUS, INERTIA, MASS, STEP = 0.46, 60.0, 6000.0, 1e-3  # m, kg m2, kg, s
BRAKE, SLIDES = 3000.0, 0.05  # N m; creepage at which the brake is released

speed, turning, way = 15.0, 15.0 / RADIUS, 0.0  # m/s, rad/s, m
inputs = {"vehicle_speed": speed, "wheel_speed": turning, "normal_load": 9.81 * MASS}
with wheelrail.Instance(slip_source="vehicle_speed", **inputs).start() as contact:
    releases, braking, force = 0, True, 0.0
    while way < 60.0:
        contact.set(vehicle_speed=speed, wheel_speed=turning, friction_scale=0.15 if 20.0 < way < 30.0 else 1.0)
        contact.step(STEP)
        force, torque = contact.get("traction_force", "friction_torque")
        behind = 1.0 - turning * RADIUS / speed
        if braking and behind > SLIDES:
            releases += 1
        # Braked again when the wheel has nearly caught up.
        braking = behind < (SLIDES if braking else 0.2 * SLIDES)
        turning += STEP * (torque - (BRAKE if braking else 0.0)) / INERTIA
        speed += STEP * force / MASS
        way += STEP * speed
    (worn,) = contact.get("worn_volume")
print(f"{speed:.2f} m/s after {way:.0f} m, braked by {-force / 1e3:.2f} kN, the brake released {releases} times")
print(f"worn {1e9 * worn:.2f} mm³")
