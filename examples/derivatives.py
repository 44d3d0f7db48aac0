"""Derivatives and saved states: the wheel speed at which the contact pulls with a given force, by Newton's method.

    python examples/derivatives.py      (with the package: `make wheel`, `pip install dist/wheelrail-*linux*.whl`)

Each iteration repeats the same step from the same state: a master that iterates does just this.
"""

import wheelrail

STEP, WANTED = 1e-2, 3e3  # s, N

wheel_speed = 20.0 / 0.46  # rad/s, of a wheel that rolls
rolling = {"vehicle_speed": 20.0, "wheel_speed": wheel_speed, "normal_load": 70e3}
with wheelrail.Instance(slip_source="vehicle_speed", **rolling).start() as contact:
    before = contact.save()
    for iteration in range(1, 21):
        contact.restore(before)
        contact.set(wheel_speed=wheel_speed)
        contact.step(STEP)
        (force,) = contact.get("traction_force")
        print(f"{iteration}: {wheel_speed:.9f} rad/s, {force:.6f} N")
        if abs(force - WANTED) < 1e-6 * WANTED:
            break
        (slope,) = contact.derivative(["traction_force"], "wheel_speed")
        wheel_speed += (WANTED - force) / slope
