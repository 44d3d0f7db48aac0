"""A table in, a table out: acceleration into wheel spin on a rail that is wet for some metres.

python examples/simulate.py         (with the package: `make wheel`, `pip install dist/wheelrail-*linux*.whl`)

The result is a data frame in SI units, and goes to simulated.csv.
"""

import wheelrail

# Between the rows the inputs are interpolated; two rows of the same time are a jump.
table = {
    "time": [0.0, 0.3, 0.3, 0.6, 0.6, 1.0],
    "creepage [%]": [0.1, 0.1, 0.1, 3.0, 3.0, 0.1],
    "friction_scale": [1.0, 1.0, 0.4, 0.4, 1.0, 1.0],
    "normal_load [kN]": [60.0, 62.0, 62.0, 58.0, 58.0, 60.0],
}
result = wheelrail.simulate(table, wheel_speed=40.0, friction_law="piecewise_linear", wheel_heating=True)

print(f"largest traction {result['traction_force'].max() / 1e3:.1f} kN")
print(f"hottest {result['peak_temperature'].max() - 273.15:.0f} °C")
print(f"friction energy {result['friction_energy'].iloc[-1]:.0f} J")
result.to_csv("simulated.csv", index=False)
