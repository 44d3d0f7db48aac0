"""Write benches/rough_track.csv: a wheel on a rough track, 3 s in steps of 1 ms.

    .venv/bin/python tools/rough_track.py > benches/rough_track.csv

The vehicle accelerates from 20 to 70 m/s. Load, longitudinal and lateral creepage and spin vary as noise between 0.5
and 60 Hz: sums of cosines 0.5 Hz apart, of equal amplitude and random phase (seed 2026). The load varies by 10 %
(standard deviation) about 60 kN, and is held within 20 %; the creepages by 0.1 %, the spin by 0.1/m about 0.1/m, which
is what a cone of 1:20 has.
"""

import sys

import numpy as np

SEED = 2026
RADIUS = 0.46  # wheel radius, m
STEP = 1e-3  # s
END = 3.0  # s
SPEEDS = (20.0, 70.0)  # m/s
LOAD, LOAD_DEVIATION, LARGEST_DEVIATION = 60e3, 0.1, 0.2  # N, 1, 1
CREEPAGE_DEVIATION = 1e-3
SPIN, SPIN_DEVIATION = 0.1, 0.1  # 1/m
FREQUENCIES = np.arange(0.5, 60.25, 0.5)  # Hz


def main():
    """Print the table."""
    random = np.random.default_rng(SEED)
    time = STEP * np.arange(round(END / STEP) + 1)

    def noise():
        phases = random.uniform(0.0, 2.0 * np.pi, FREQUENCIES.size)
        waves = np.cos(2.0 * np.pi * np.outer(time, FREQUENCIES) + phases)
        return waves.sum(axis=1) * np.sqrt(2.0 / FREQUENCIES.size)

    speed = np.interp(time, [0.0, END], SPEEDS)
    deviation = np.clip(LOAD_DEVIATION * noise(), -LARGEST_DEVIATION, LARGEST_DEVIATION)
    longitudinal, lateral = (CREEPAGE_DEVIATION * noise() for _ in range(2))
    spin = SPIN + SPIN_DEVIATION * noise()
    wheel_speed, load = speed * (1.0 + longitudinal) / RADIUS, LOAD * (1.0 + deviation)
    columns = [time, wheel_speed, speed, load, speed * lateral, speed * spin]
    sys.stdout.write("time,wheel_speed,vehicle_speed,normal_load,lateral_speed,spin_rate\n")
    for row in zip(*columns, strict=True):
        sys.stdout.write(",".join(f"{value:.9g}" for value in row) + "\n")


if __name__ == "__main__":
    main()
