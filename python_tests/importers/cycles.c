/* Loads the library, runs an instance of each version of FMI and unloads the library, again and again: prints how many bytes
   of the heap are in use after half of the cycles and after all of them. Arguments: the library, the GUID, the token, cycles. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include "fmi2Functions.h"
#include "fmi3Functions.h"

#define FIND(f) f##TYPE *const p_##f = (f##TYPE *)dlsym(library, #f)

static int cycle(const char *path, const char *guid, const char *token) {
    const fmi2CallbackFunctions callbacks = {NULL, NULL, NULL, NULL, NULL};
    const fmi2ValueReference nodes[] = {3002, 3003};
    const fmi2Integer coarse[] = {25, 17};
    const fmi3ValueReference nodes3[] = {4002, 4003};
    fmi3Boolean event, end, early;
    fmi3Float64 time;
    void *library = dlopen(path, RTLD_NOW);
    if (!library) return 1;
    FIND(fmi2Instantiate); FIND(fmi2SetInteger); FIND(fmi2SetupExperiment); FIND(fmi2EnterInitializationMode);
    FIND(fmi2ExitInitializationMode); FIND(fmi2DoStep); FIND(fmi2FreeInstance);
    fmi2Component two = p_fmi2Instantiate("two", fmi2CoSimulation, guid, NULL, &callbacks, fmi2False, fmi2False);
    if (!two || p_fmi2SetInteger(two, nodes, 2, coarse) || p_fmi2SetupExperiment(two, fmi2False, 0.0, 0.0, fmi2False, 0.0)
        || p_fmi2EnterInitializationMode(two) || p_fmi2ExitInitializationMode(two) || p_fmi2DoStep(two, 0.0, 1e-3, 1)) return 2;
    p_fmi2FreeInstance(two);
    FIND(fmi3InstantiateCoSimulation); FIND(fmi3SetInt32); FIND(fmi3EnterInitializationMode);
    FIND(fmi3ExitInitializationMode); FIND(fmi3DoStep); FIND(fmi3FreeInstance);
    fmi3Instance three = p_fmi3InstantiateCoSimulation("three", token, NULL, 0, 0, 0, 0, NULL, 0, NULL, NULL, NULL);
    if (!three || p_fmi3SetInt32(three, nodes3, 2, coarse, 2) || p_fmi3EnterInitializationMode(three, 0, 0.0, 0.0, 0, 0.0)
        || p_fmi3ExitInitializationMode(three) || p_fmi3DoStep(three, 0.0, 1e-3, 1, &event, &end, &early, &time)) return 3;
    p_fmi3FreeInstance(three);
    if (dlclose(library)) return 4;
    /* Gone, not only counted down. */
    return dlopen(path, RTLD_NOW | RTLD_NOLOAD) ? 5 : 0;
}

int main(int argc, char **argv) {
    const int cycles = argc == 5 ? atoi(argv[4]) : 0;
    size_t half = 0;
    for (int i = 0; i < cycles; i++) {
        int failed = cycle(argv[1], argv[2], argv[3]);
        if (failed) {
            printf("cycle %d: %d %s\n", i, failed, dlerror());
            return 1;
        }
        if (i == cycles / 2) half = mallinfo2().uordblks;
    }
    printf("%zu %zu\n", half, mallinfo2().uordblks);
    return 0;
}
