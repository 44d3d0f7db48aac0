"""The component through FMPy's low-level classes: refusals, saved states, derivatives."""

import math

import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2Discard, fmi2Error

CREEPAGE = "creepage"


def start(slave, reference, **reals):
    """Bring an instance to step mode with real start values."""
    slave.setupExperiment(startTime=0.0)
    for name, value in reals.items():
        slave.setReal([reference[name]], [value])
    slave.enterInitializationMode()
    slave.exitInitializationMode()


def status_of(call, *arguments):
    """Return the status with which a call is refused."""
    with pytest.raises(FMICallException) as refusal:
        call(*arguments)
    return refusal.value.status


@pytest.mark.parametrize(
    ("name", "value"),
    [
        (CREEPAGE, math.nan),
        ("wheel_speed", math.inf),
        ("normal_load", -1.0),
        ("normal_load", 1.3e5),
        ("vehicle_speed", 500.0),
        ("ambient_temperature", 0.0),
        ("incoming_temperature", 0.0),
        ("incoming_wear_depth", -1e-9),
    ],
)
def test_values_that_cannot_be_are_discarded(instance, callbacks, reference, outputs, name, value):
    """The value is refused with fmi2Discard, and the instance goes on as if it had never been offered."""
    references = [reference[n] for n in outputs]
    results = []
    for offered in (False, True):
        slave = instance()
        start(slave, reference, creepage=0.01)
        slave.doStep(0.0, 0.01)
        if offered:
            assert status_of(slave.setReal, [reference[name]], [value]) == fmi2Discard
        slave.doStep(0.01, 0.01)
        results.append(slave.getReal(references))
    assert results[0] == results[1]
    assert callbacks.messages == [(fmi2Discard, "logStatusWarning")]


@pytest.mark.parametrize("step", [0.0, -1e-3, math.nan, math.inf])
def test_steps_that_cannot_be_are_errors(instance, reference, step):
    """The call is refused with fmi2Error; fmi2Reset leads on."""
    slave = instance()
    start(slave, reference)
    assert status_of(slave.doStep, 0.0, step) == fmi2Error
    slave.reset()
    start(slave, reference)
    slave.doStep(0.0, 1e-3)


def test_combination_of_parameters_that_cannot_be(instance, reference):
    """A hot contact with more friction than a cold one is an error where initialisation ends."""
    slave = instance()
    slave.setupExperiment(startTime=0.0)
    slave.setReal([reference["friction_hot"]], [0.5])
    slave.enterInitializationMode()
    assert status_of(slave.exitInitializationMode) == fmi2Error


def test_fixed_parameters_are_fixed_and_tunable_ones_are_not(instance, reference):
    """After initialisation, friction can be tuned and the wheel's radius cannot be changed."""
    slave = instance()
    start(slave, reference, creepage=0.05)
    slave.doStep(0.0, 0.1)
    before = slave.getReal([reference["traction_coefficient"]])[0]
    slave.setReal([reference["friction_cold"], reference["friction_hot"]], [0.2, 0.1])
    slave.doStep(0.1, 0.1)
    after = slave.getReal([reference["traction_coefficient"]])[0]
    assert 0.1 < after < 0.2 < before
    assert status_of(slave.setReal, [reference["wheel_radius"]], [0.5]) == fmi2Error


def test_wrong_guid_is_refused(unpacked, callbacks):
    """A description of another build gets no instance."""
    slave = FMU2Slave(guid="{0}", unzipDirectory=str(unpacked), modelIdentifier="wheelrail", instanceName="x")
    with pytest.raises(Exception, match="instantiate"):
        slave.instantiate(callbacks=callbacks)
    assert callbacks.messages == [(fmi2Error, "logStatusError")]


@pytest.mark.parametrize("serialised", [False, True])
def test_saved_state_repeats_the_same_bits(instance, reference, outputs, serialised):
    """A state that is restored, in the same instance or after bytes in another one, leads to the same results."""
    references = [reference[name] for name in outputs]

    def advance(slave):
        for number in range(20):
            slave.setReal([reference[CREEPAGE]], [0.01 + 1e-3 * number])
            slave.doStep(0.1 + 0.002 * number, 0.002)
        return slave.getReal(references)

    first = instance("first")
    start(first, reference, creepage=0.01)
    first.doStep(0.0, 0.1)
    state = first.getFMUState()
    expected = advance(first)
    if serialised:
        data = first.serializeFMUState(state)
        second = instance("second")
        start(second, reference)
        restored = second.deserializeFMUState(data)
        second.setFMUState(restored)
        assert advance(second) == expected
        second.freeFMUState(restored)
    else:
        first.setFMUState(state)
        assert advance(first) == expected
    first.freeFMUState(state)


def test_noise_is_no_state(instance, reference):
    """Bytes that are not a whole, untouched state are refused."""
    slave = instance()
    start(slave, reference)
    slave.doStep(0.0, 0.01)
    state = slave.getFMUState()
    data = slave.serializeFMUState(state)
    slave.freeFMUState(state)
    for damaged in (data[:-1], bytes(len(data)), data[:100] + bytes([data[100] ^ 1]) + data[101:]):
        other = instance()
        start(other, reference)
        assert status_of(other.deserializeFMUState, damaged) == fmi2Error


def test_directional_derivative_is_the_slope(instance, reference, outputs):
    """d(traction force)/d(creepage) in partial slip against the differences of a repeated step.

    The difference over 2e-7 of creepage has an error of about (2e-7/3e-3)² of the slope, 4e-9, and rounding of some
    1e-12/2e-7, 5e-6; the linearised system is that of the converged step: 1e-4.
    """
    force, creepage = [reference["traction_force"]], [reference[CREEPAGE]]
    slave = instance()
    start(slave, reference, creepage=0.001)
    for number in range(50):
        slave.doStep(0.01 * number, 0.01)
    state = slave.getFMUState()
    ends = []
    for change in (-1e-7, 1e-7, 0.0):
        slave.setFMUState(state)
        slave.setReal(creepage, [0.001 + change])
        slave.doStep(0.5, 0.01)
        ends.append(slave.getReal(force)[0])
    derivative = slave.getDirectionalDerivative(force, creepage, [1.0])[0]
    assert derivative > 0.0
    assert derivative == pytest.approx((ends[1] - ends[0]) / 2e-7, rel=1e-4)
    slave.freeFMUState(state)
