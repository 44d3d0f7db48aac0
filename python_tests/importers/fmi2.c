/* Calls each function of FMI 2.0 through the standard's own headers. Argument: the GUID. */

#include <stdio.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include "fmi2Functions.h"

/* Each declaration fails to compile where the type is not that of the function. */
#define SAME(f) static f##TYPE *const p_##f = f;
SAME(fmi2GetTypesPlatform) SAME(fmi2GetVersion) SAME(fmi2SetDebugLogging) SAME(fmi2Instantiate)
SAME(fmi2FreeInstance) SAME(fmi2SetupExperiment) SAME(fmi2EnterInitializationMode)
SAME(fmi2ExitInitializationMode) SAME(fmi2Terminate) SAME(fmi2Reset) SAME(fmi2GetReal) SAME(fmi2GetInteger)
SAME(fmi2GetBoolean) SAME(fmi2GetString) SAME(fmi2SetReal) SAME(fmi2SetInteger) SAME(fmi2SetBoolean)
SAME(fmi2SetString) SAME(fmi2GetFMUstate) SAME(fmi2SetFMUstate) SAME(fmi2FreeFMUstate)
SAME(fmi2SerializedFMUstateSize) SAME(fmi2SerializeFMUstate) SAME(fmi2DeSerializeFMUstate)
SAME(fmi2GetDirectionalDerivative) SAME(fmi2SetRealInputDerivatives) SAME(fmi2GetRealOutputDerivatives)
SAME(fmi2DoStep) SAME(fmi2CancelStep) SAME(fmi2GetStatus) SAME(fmi2GetRealStatus) SAME(fmi2GetIntegerStatus)
SAME(fmi2GetBooleanStatus) SAME(fmi2GetStringStatus)

static int messages = 0;

static void logger(fmi2ComponentEnvironment e, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String message, ...) {
    char text[1000];
    va_list arguments;
    (void)e;
    va_start(arguments, message);
    vsnprintf(text, sizeof text, message, arguments);
    va_end(arguments);
    printf("%s %d %s %s\n", name, status, category, text);
    messages++;
}

#define EXPECT(status, call) do { \
    int s = (call); \
    if (s != (status)) { printf("line %d: %s returned %d\n", __LINE__, #call, s); return 1; } \
} while (0)

int main(int argc, char **argv) {
    fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, NULL};
    const fmi2ValueReference input = 0, output = 1000, integer = 3000, text = 18000;
    const fmi2Integer order = 1;
    const fmi2String category = "logEvents";
    const fmi2Real one = 1.0;
    fmi2Real real = 21.0;
    fmi2Integer number = 1;
    fmi2Boolean boolean = 0;
    fmi2String string = "a path/räil.prr";
    fmi2Status status = fmi2OK;
    fmi2FMUstate state = NULL, copy = NULL;
    size_t size = 0;
    fmi2Byte *bytes;

    (void)argc;
    if (strcmp(p_fmi2GetTypesPlatform(), fmi2TypesPlatform) || strcmp(p_fmi2GetVersion(), fmi2Version)) return 1;
    if (p_fmi2Instantiate("c", fmi2CoSimulation, "wrong", NULL, &callbacks, fmi2False, fmi2False)) return 1;
    if (messages != 1) return 1;
    fmi2Component c = p_fmi2Instantiate("c", fmi2CoSimulation, argv[1], "file:///tmp", &callbacks, fmi2False, fmi2True);
    if (!c) return 1;
    EXPECT(fmi2OK, p_fmi2SetDebugLogging(c, fmi2True, 1, &category));
    EXPECT(fmi2OK, p_fmi2SetInteger(c, &integer, 1, &number));
    EXPECT(fmi2OK, p_fmi2SetString(c, &text, 1, &string));
    string = NULL;
    EXPECT(fmi2OK, p_fmi2SetupExperiment(c, fmi2True, 1e-6, 0.0, fmi2True, 1.0));
    EXPECT(fmi2OK, p_fmi2EnterInitializationMode(c));
    EXPECT(fmi2OK, p_fmi2SetReal(c, &input, 1, &real));
    EXPECT(fmi2OK, p_fmi2ExitInitializationMode(c));
    EXPECT(fmi2OK, p_fmi2SetRealInputDerivatives(c, &input, 1, &order, &one));
    EXPECT(fmi2OK, p_fmi2GetFMUstate(c, &state));
    EXPECT(fmi2OK, p_fmi2DoStep(c, 0.0, 0.01, fmi2True));
    EXPECT(fmi2OK, p_fmi2GetReal(c, &output, 1, &real));
    EXPECT(fmi2OK, p_fmi2GetInteger(c, &integer, 1, &number));
    EXPECT(fmi2OK, p_fmi2GetBoolean(c, NULL, 0, NULL));
    EXPECT(fmi2OK, p_fmi2SetBoolean(c, NULL, 0, NULL));
    EXPECT(fmi2OK, p_fmi2GetString(c, &text, 1, &string));
    if (strcmp(string, "a path/räil.prr")) return 1;
    EXPECT(fmi2OK, p_fmi2GetString(c, NULL, 0, NULL));
    EXPECT(fmi2OK, p_fmi2SetString(c, NULL, 0, NULL));
    EXPECT(fmi2OK, p_fmi2GetRealOutputDerivatives(c, &output, 1, &order, &real));
    EXPECT(fmi2OK, p_fmi2GetDirectionalDerivative(c, &output, 1, &input, 1, &one, &real));
    EXPECT(fmi2OK, p_fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &real));
    if (real != 0.01) return 1;
    EXPECT(fmi2OK, p_fmi2GetBooleanStatus(c, fmi2Terminated, &boolean));
    EXPECT(fmi2Discard, p_fmi2GetStatus(c, fmi2DoStepStatus, &status));
    EXPECT(fmi2Discard, p_fmi2GetIntegerStatus(c, fmi2DoStepStatus, &number));
    EXPECT(fmi2Discard, p_fmi2GetStringStatus(c, fmi2PendingStatus, &string));
    EXPECT(fmi2OK, p_fmi2SerializedFMUstateSize(c, state, &size));
    bytes = malloc(size);
    EXPECT(fmi2OK, p_fmi2SerializeFMUstate(c, state, bytes, size));
    EXPECT(fmi2OK, p_fmi2DeSerializeFMUstate(c, bytes, size, &copy));
    free(bytes);
    EXPECT(fmi2OK, p_fmi2SetFMUstate(c, copy));
    EXPECT(fmi2OK, p_fmi2FreeFMUstate(c, &copy));
    EXPECT(fmi2OK, p_fmi2DoStep(c, 0.0, 0.01, fmi2True));
    EXPECT(fmi2OK, p_fmi2Terminate(c));
    EXPECT(fmi2OK, p_fmi2Reset(c));
    EXPECT(fmi2Error, p_fmi2CancelStep(c));
    p_fmi2FreeInstance(c);
    printf("%zu bytes of state\n", size);
    return 0;
}
