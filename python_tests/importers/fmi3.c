/* Calls the functions of FMI 3.0 through the standard's own headers. Argument: the instantiation token. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "fmi3Functions.h"

/* Each declaration fails to compile where the type is not that of the function. */
#define SAME(type, f) static type##TYPE *const p_##f = f;
SAME(fmi3GetVersion, fmi3GetVersion) SAME(fmi3SetDebugLogging, fmi3SetDebugLogging)
SAME(fmi3InstantiateModelExchange, fmi3InstantiateModelExchange)
SAME(fmi3InstantiateCoSimulation, fmi3InstantiateCoSimulation)
SAME(fmi3InstantiateScheduledExecution, fmi3InstantiateScheduledExecution)
SAME(fmi3FreeInstance, fmi3FreeInstance) SAME(fmi3EnterInitializationMode, fmi3EnterInitializationMode)
SAME(fmi3ExitInitializationMode, fmi3ExitInitializationMode) SAME(fmi3EnterEventMode, fmi3EnterEventMode)
SAME(fmi3Terminate, fmi3Terminate) SAME(fmi3Reset, fmi3Reset) SAME(fmi3GetFloat32, fmi3GetFloat32)
SAME(fmi3GetFloat64, fmi3GetFloat64) SAME(fmi3GetInt8, fmi3GetInt8) SAME(fmi3GetUInt8, fmi3GetUInt8)
SAME(fmi3GetInt16, fmi3GetInt16) SAME(fmi3GetUInt16, fmi3GetUInt16) SAME(fmi3GetInt32, fmi3GetInt32)
SAME(fmi3GetUInt32, fmi3GetUInt32) SAME(fmi3GetInt64, fmi3GetInt64) SAME(fmi3GetUInt64, fmi3GetUInt64)
SAME(fmi3GetBoolean, fmi3GetBoolean) SAME(fmi3GetString, fmi3GetString) SAME(fmi3GetBinary, fmi3GetBinary)
SAME(fmi3GetClock, fmi3GetClock) SAME(fmi3SetFloat32, fmi3SetFloat32) SAME(fmi3SetFloat64, fmi3SetFloat64)
SAME(fmi3SetInt8, fmi3SetInt8) SAME(fmi3SetUInt8, fmi3SetUInt8) SAME(fmi3SetInt16, fmi3SetInt16)
SAME(fmi3SetUInt16, fmi3SetUInt16) SAME(fmi3SetInt32, fmi3SetInt32) SAME(fmi3SetUInt32, fmi3SetUInt32)
SAME(fmi3SetInt64, fmi3SetInt64) SAME(fmi3SetUInt64, fmi3SetUInt64) SAME(fmi3SetBoolean, fmi3SetBoolean)
SAME(fmi3SetString, fmi3SetString) SAME(fmi3SetBinary, fmi3SetBinary) SAME(fmi3SetClock, fmi3SetClock)
SAME(fmi3GetNumberOfVariableDependencies, fmi3GetNumberOfVariableDependencies)
SAME(fmi3GetVariableDependencies, fmi3GetVariableDependencies) SAME(fmi3GetFMUState, fmi3GetFMUState)
SAME(fmi3SetFMUState, fmi3SetFMUState) SAME(fmi3FreeFMUState, fmi3FreeFMUState)
SAME(fmi3SerializedFMUStateSize, fmi3SerializedFMUStateSize)
SAME(fmi3SerializeFMUState, fmi3SerializeFMUState) SAME(fmi3DeserializeFMUState, fmi3DeserializeFMUState)
SAME(fmi3GetDirectionalDerivative, fmi3GetDirectionalDerivative)
SAME(fmi3GetAdjointDerivative, fmi3GetAdjointDerivative)
SAME(fmi3EnterConfigurationMode, fmi3EnterConfigurationMode)
SAME(fmi3ExitConfigurationMode, fmi3ExitConfigurationMode)
SAME(fmi3GetIntervalDecimal, fmi3GetIntervalDecimal) SAME(fmi3GetIntervalFraction, fmi3GetIntervalFraction)
SAME(fmi3GetShiftDecimal, fmi3GetShiftDecimal) SAME(fmi3GetShiftFraction, fmi3GetShiftFraction)
SAME(fmi3SetIntervalDecimal, fmi3SetIntervalDecimal) SAME(fmi3SetIntervalFraction, fmi3SetIntervalFraction)
SAME(fmi3SetShiftDecimal, fmi3SetShiftDecimal) SAME(fmi3SetShiftFraction, fmi3SetShiftFraction)
SAME(fmi3EvaluateDiscreteStates, fmi3EvaluateDiscreteStates)
SAME(fmi3UpdateDiscreteStates, fmi3UpdateDiscreteStates)
SAME(fmi3EnterContinuousTimeMode, fmi3EnterContinuousTimeMode)
SAME(fmi3CompletedIntegratorStep, fmi3CompletedIntegratorStep) SAME(fmi3SetTime, fmi3SetTime)
SAME(fmi3SetContinuousStates, fmi3SetContinuousStates)
SAME(fmi3GetContinuousStateDerivatives, fmi3GetContinuousStateDerivatives)
SAME(fmi3GetEventIndicators, fmi3GetEventIndicators) SAME(fmi3GetContinuousStates, fmi3GetContinuousStates)
SAME(fmi3GetNominalsOfContinuousStates, fmi3GetNominalsOfContinuousStates)
SAME(fmi3GetNumberOfEventIndicators, fmi3GetNumberOfEventIndicators)
SAME(fmi3GetNumberOfContinuousStates, fmi3GetNumberOfContinuousStates)
SAME(fmi3EnterStepMode, fmi3EnterStepMode) SAME(fmi3GetOutputDerivatives, fmi3GetOutputDerivatives)
SAME(fmi3DoStep, fmi3DoStep) SAME(fmi3ActivateModelPartition, fmi3ActivateModelPartition)

static int messages = 0;

static void logger(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category, fmi3String message) {
    (void)environment;
    printf("%d %s %s\n", status, category, message);
    messages++;
}

#define EXPECT(status, call) do { \
    int s = (call); \
    if (s != (status)) { printf("line %d: %s returned %d\n", __LINE__, #call, s); return 1; } \
} while (0)

/* After a call that is never allowed only a reset leads on. */
#define NEVER(call) do { EXPECT(fmi3Error, call); EXPECT(fmi3OK, p_fmi3Reset(c)); } while (0)

int main(int argc, char **argv) {
    const fmi3ValueReference input = 1000, output = 2000, choice = 4000, count = 4002, length = LENGTH, on = SWITCH;
    const fmi3ValueReference array = ARRAY, field = FIELD, text = TEXT, contacts = CONTACTS, nothing = 9999;
    const fmi3Int32 order = 1;
    const fmi3String category = "logEvents";
    const fmi3Float64 one = 1.0;
    fmi3Float64 real = 21.0, values[10], cells[8 * 3], time = 0.0;
    fmi3Int32 number = 31;
    fmi3Int64 chosen = 1;
    fmi3UInt64 cells_along = 8, strips = 3;
    fmi3String string = "a path/räil.prr";
    fmi3Boolean boolean = true, event = true, end = true, early = true;
    fmi3FMUState state = NULL, copy = NULL;
    size_t size = 0;
    fmi3Byte *bytes;

    (void)argc;
    if (strcmp(p_fmi3GetVersion(), fmi3Version)) return 1;
    if (p_fmi3InstantiateModelExchange("c", argv[1], NULL, false, false, NULL, logger)) return 1;
    if (p_fmi3InstantiateScheduledExecution("c", argv[1], NULL, false, false, NULL, logger, NULL, NULL, NULL)) return 1;
    if (p_fmi3InstantiateCoSimulation("c", "wrong", NULL, false, false, false, true, NULL, 0, NULL, logger, NULL)) return 1;
    if (messages != 3) return 1;
    fmi3Instance c = p_fmi3InstantiateCoSimulation("c", argv[1], "/tmp/", false, true, false, true, NULL, 0, NULL, logger, NULL);
    if (!c) return 1;
    EXPECT(fmi3OK, p_fmi3SetDebugLogging(c, true, 1, &category));
    EXPECT(fmi3OK, p_fmi3EnterConfigurationMode(c));
    EXPECT(fmi3OK, p_fmi3SetUInt64(c, &length, 1, &cells_along, 1));
    EXPECT(fmi3OK, p_fmi3SetUInt64(c, (fmi3ValueReference[]){length + 1}, 1, &strips, 1));
    EXPECT(fmi3OK, p_fmi3ExitConfigurationMode(c));
    EXPECT(fmi3OK, p_fmi3SetInt64(c, &choice, 1, &chosen, 1));
    EXPECT(fmi3OK, p_fmi3SetInt32(c, &count, 1, &number, 1));
    EXPECT(fmi3OK, p_fmi3SetBoolean(c, &on, 1, &boolean, 1));
    EXPECT(fmi3OK, p_fmi3SetString(c, &text, 1, &string, 1));
    string = NULL;
    EXPECT(fmi3OK, p_fmi3EnterInitializationMode(c, true, 1e-6, 0.0, true, 1.0));
    EXPECT(fmi3OK, p_fmi3SetFloat64(c, &input, 1, &real, 1));
    EXPECT(fmi3OK, p_fmi3GetFloat64(c, &array, 1, values, 10));
    EXPECT(fmi3OK, p_fmi3SetFloat64(c, &array, 1, values, 10));
    EXPECT(fmi3OK, p_fmi3ExitInitializationMode(c));
    EXPECT(fmi3OK, p_fmi3GetFMUState(c, &state));
    EXPECT(fmi3OK, p_fmi3DoStep(c, 0.0, 0.01, true, &event, &end, &early, &time));
    if (event || end || early || time != 0.01) return 1;
    EXPECT(fmi3OK, p_fmi3GetFloat64(c, &output, 1, &real, 1));
    EXPECT(fmi3OK, p_fmi3GetFloat64(c, &field, 1, cells, 8 * 3));
    EXPECT(fmi3OK, p_fmi3GetInt32(c, &count, 1, &number, 1));
    EXPECT(fmi3OK, p_fmi3GetInt64(c, &choice, 1, &chosen, 1));
    EXPECT(fmi3OK, p_fmi3GetUInt64(c, &length, 1, &cells_along, 1));
    EXPECT(fmi3OK, p_fmi3GetBoolean(c, &on, 1, &boolean, 1));
    EXPECT(fmi3OK, p_fmi3GetString(c, &text, 1, &string, 1));
    if (number != 31 || chosen != 1 || cells_along != 8 || !boolean || strcmp(string, "a path/räil.prr")) return 1;
    EXPECT(fmi3OK, p_fmi3GetFloat64(c, &contacts, 1, values, 4));
    EXPECT(fmi3OK, p_fmi3GetOutputDerivatives(c, &contacts, 1, &order, values, 4));
    EXPECT(fmi3OK, p_fmi3GetDirectionalDerivative(c, &contacts, 1, &input, 1, &one, 1, values, 4));
    EXPECT(fmi3OK, p_fmi3GetOutputDerivatives(c, &output, 1, &order, &real, 1));
    EXPECT(fmi3OK, p_fmi3GetDirectionalDerivative(c, &output, 1, &input, 1, &one, 1, &real, 1));
    EXPECT(fmi3OK, p_fmi3GetAdjointDerivative(c, &output, 1, &input, 1, &one, 1, values, 1));
    if (real != values[0]) return 1;
    EXPECT(fmi3OK, p_fmi3SerializedFMUStateSize(c, state, &size));
    bytes = malloc(size);
    EXPECT(fmi3OK, p_fmi3SerializeFMUState(c, state, bytes, size));
    EXPECT(fmi3OK, p_fmi3DeserializeFMUState(c, bytes, size, &copy));
    free(bytes);
    EXPECT(fmi3OK, p_fmi3SetFMUState(c, copy));
    EXPECT(fmi3OK, p_fmi3FreeFMUState(c, &copy));
    EXPECT(fmi3OK, p_fmi3DoStep(c, 0.0, 0.01, true, &event, &end, &early, &time));
    EXPECT(fmi3OK, p_fmi3Terminate(c));
    EXPECT(fmi3OK, p_fmi3Reset(c));

    /* Types that no variable has: without references they are answered, with one they are errors. */
    EXPECT(fmi3OK, p_fmi3GetFloat32(c, NULL, 0, NULL, 0)); EXPECT(fmi3OK, p_fmi3SetFloat32(c, NULL, 0, NULL, 0));
    EXPECT(fmi3OK, p_fmi3GetInt8(c, NULL, 0, NULL, 0)); EXPECT(fmi3OK, p_fmi3SetInt8(c, NULL, 0, NULL, 0));
    EXPECT(fmi3OK, p_fmi3GetUInt8(c, NULL, 0, NULL, 0)); EXPECT(fmi3OK, p_fmi3SetUInt8(c, NULL, 0, NULL, 0));
    EXPECT(fmi3OK, p_fmi3GetInt16(c, NULL, 0, NULL, 0)); EXPECT(fmi3OK, p_fmi3SetInt16(c, NULL, 0, NULL, 0));
    EXPECT(fmi3OK, p_fmi3GetUInt16(c, NULL, 0, NULL, 0)); EXPECT(fmi3OK, p_fmi3SetUInt16(c, NULL, 0, NULL, 0));
    EXPECT(fmi3OK, p_fmi3GetUInt32(c, NULL, 0, NULL, 0)); EXPECT(fmi3OK, p_fmi3SetUInt32(c, NULL, 0, NULL, 0));
    EXPECT(fmi3OK, p_fmi3GetString(c, NULL, 0, NULL, 0)); EXPECT(fmi3OK, p_fmi3SetString(c, NULL, 0, NULL, 0));
    EXPECT(fmi3OK, p_fmi3GetBinary(c, NULL, 0, NULL, NULL, 0));
    EXPECT(fmi3OK, p_fmi3SetBinary(c, NULL, 0, NULL, NULL, 0));
    NEVER(p_fmi3GetFloat32(c, &nothing, 1, (fmi3Float32[1]){0}, 1));

    NEVER(p_fmi3EnterEventMode(c));
    NEVER(p_fmi3EnterStepMode(c));
    NEVER(p_fmi3GetClock(c, &nothing, 1, (fmi3Clock[1]){0}));
    NEVER(p_fmi3SetClock(c, &nothing, 1, (fmi3Clock[1]){0}));
    NEVER(p_fmi3GetNumberOfVariableDependencies(c, output, &size));
    NEVER(p_fmi3GetVariableDependencies(c, output, NULL, NULL, NULL, NULL, 0));
    NEVER(p_fmi3GetIntervalDecimal(c, &nothing, 1, values, NULL));
    NEVER(p_fmi3GetIntervalFraction(c, &nothing, 1, NULL, NULL, NULL));
    NEVER(p_fmi3GetShiftDecimal(c, &nothing, 1, values));
    NEVER(p_fmi3GetShiftFraction(c, &nothing, 1, NULL, NULL));
    NEVER(p_fmi3SetIntervalDecimal(c, &nothing, 1, values));
    NEVER(p_fmi3SetIntervalFraction(c, &nothing, 1, NULL, NULL));
    NEVER(p_fmi3SetShiftDecimal(c, &nothing, 1, values));
    NEVER(p_fmi3SetShiftFraction(c, &nothing, 1, NULL, NULL));
    NEVER(p_fmi3EvaluateDiscreteStates(c));
    NEVER(p_fmi3UpdateDiscreteStates(c, &event, &end, &early, &early, &early, &time));
    NEVER(p_fmi3EnterContinuousTimeMode(c));
    NEVER(p_fmi3CompletedIntegratorStep(c, true, &event, &end));
    NEVER(p_fmi3SetTime(c, 0.0));
    NEVER(p_fmi3SetContinuousStates(c, values, 0));
    NEVER(p_fmi3GetContinuousStateDerivatives(c, values, 0));
    NEVER(p_fmi3GetEventIndicators(c, values, 0));
    NEVER(p_fmi3GetContinuousStates(c, values, 0));
    NEVER(p_fmi3GetNominalsOfContinuousStates(c, values, 0));
    NEVER(p_fmi3GetNumberOfEventIndicators(c, &size));
    NEVER(p_fmi3GetNumberOfContinuousStates(c, &size));
    NEVER(p_fmi3ActivateModelPartition(c, nothing, 0.0));
    EXPECT(fmi3OK, p_fmi3FreeFMUState(c, &state));
    p_fmi3FreeInstance(c);
    printf("bytes of state\n");
    return 0;
}
