"""Write examples/braking.csv: a braking manoeuvre from 20 m/s with a wheel-slide episode.

    python3 tools/braking_table.py > examples/braking.csv

The vehicle rolls freely for 1 s (a wheel of the rail's material does so at a creepage of 0) and then slows down by
0.9 m/s2. The brake holds the wheel at a creepage of -0.058 %: what Carter's curve, 1 - (1 - xi r/(mu a))^2 of the limit
mu N, asks for this deceleration with mu = 0.45 and the half-length a of 5.5 mm. At 8 s it overdoes: within 0.8 s the
wheel falls to 75 % of the rolling speed, where the slide protection holds it for 0.8 s, and is back 1.4 s after that.
The load varies with the body's bounce (1.2 Hz, 6 %) and with the track (7 Hz, 4 %).
"""

import math
import sys

RADIUS = 0.46  # wheel radius, m
FREE, BRAKED, SLIDING = 0.0, -0.00058, -0.25  # creepages
DECELERATION = 0.9  # m/s2
END = 22.0  # s
ROW = 0.02  # s, a seventh of the shortest period


def smooth(time, start, end):
    """From 0 at start to 1 at end, with zero slope at both."""
    s = min(max((time - start) / (end - start), 0.0), 1.0)
    return s * s * (3.0 - 2.0 * s)


def main():
    """Print the table."""
    write = sys.stdout.write
    write("time,wheel_speed,vehicle_speed,normal_load\n")
    for row in range(round(END / ROW) + 1):
        time = row * ROW
        speed = 20.0 - DECELERATION * max(time - 1.0, 0.0)
        braking = smooth(time, 1.0, 2.0) * (1.0 - smooth(time, 21.0, 21.8))
        slide = smooth(time, 8.0, 8.8) * (1.0 - smooth(time, 9.6, 11.0))
        creepage = FREE + (BRAKED - FREE) * braking
        creepage += (SLIDING - creepage) * slide
        bounce = 0.06 * math.sin(2.0 * math.pi * 1.2 * time)
        track = 0.04 * math.sin(2.0 * math.pi * 7.0 * time + 1.0)
        load = 60e3 * (1.0 + bounce + track)
        write(f"{time:.2f},{speed * (1.0 + creepage) / RADIUS:.9f},{speed:.9f},{load:.1f}\n")


if __name__ == "__main__":
    main()
