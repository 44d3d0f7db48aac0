/* A host of the FMI 2.0 library on any platform: it drives the library through a table of inputs and prints what comes
 * out, so that what two platforms print can be compared. tools/manoeuvre.py writes the table, compiles this file for
 * each platform and compares.
 *
 *     host LIBRARY SCENARIO
 *
 * The scenario is text: the GUID, then names and values in the order of `read_scenario`. What is printed:
 *
 *     step NUMBER VALUES...            the outputs after a step
 *     derivative NUMBER INPUT VALUES...  of all outputs with respect to an input
 *
 * Every SAVE steps the state is saved, serialised, and the next step is made three times: as it comes, from the saved
 * state, and from the serialised one. All bits of the outputs have to be the same; the host fails otherwise, as it does
 * when any call returns another status than fmi2OK.
 */

/* The C library of Windows writes and reads numbers less exactly. */
#define __USE_MINGW_ANSI_STDIO 1

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
static void *open_library(const char *path) { return (void *)LoadLibraryA(path); }
static void *symbol(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
static int close_library(void *library) { return !FreeLibrary((HMODULE)library); }
#else
#include <dlfcn.h>
static void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *symbol(void *library, const char *name) { return dlsym(library, name); }
static int close_library(void *library) { return dlclose(library); }
#endif

#ifdef __x86_64__
#include <xmmintrin.h>
/* Invalid operation, division by zero and overflow raise a signal. */
static void unmask(void) { _mm_setcsr(_mm_getcsr() & ~0x680u); }
static unsigned long long control(void) { return _mm_getcsr() & ~0x3fu; }
#elif defined(__aarch64__)
/* Processors may lack these traps: the bits then stay 0. */
static unsigned long long control(void) {
    unsigned long long word;
    __asm__ volatile("mrs %0, fpcr" : "=r"(word));
    return word;
}
static void unmask(void) {
    unsigned long long word = control() | 0x700u;
    __asm__ volatile("msr fpcr, %0" : : "r"(word));
}
#else
static void unmask(void) {}
static unsigned long long control(void) { return 0; }
#endif

enum { CO_SIMULATION = 1, OK = 0 };
typedef void *Component;
typedef unsigned Reference;

typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

/* The functions that are called, with the types of fmi2Functions.h. */
static struct {
    Component (*Instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int);
    int (*SetupExperiment)(Component, int, double, double, int, double);
    int (*EnterInitializationMode)(Component);
    int (*ExitInitializationMode)(Component);
    int (*SetInteger)(Component, const Reference *, size_t, const int *);
    int (*SetReal)(Component, const Reference *, size_t, const double *);
    int (*GetReal)(Component, const Reference *, size_t, double *);
    int (*GetDirectionalDerivative)(Component, const Reference *, size_t, const Reference *, size_t, const double *,
                                    double *);
    int (*DoStep)(Component, double, double, int);
    int (*GetFMUstate)(Component, void **);
    int (*SetFMUstate)(Component, void *);
    int (*FreeFMUstate)(Component, void **);
    int (*SerializedFMUstateSize)(Component, void *, size_t *);
    int (*SerializeFMUstate)(Component, void *, char *, size_t);
    int (*DeSerializeFMUstate)(Component, const char *, size_t, void **);
    int (*Terminate)(Component);
    void (*FreeInstance)(Component);
} fmi;

static void fail(const char *what, const char *detail) {
    fprintf(stderr, "%s: %s\n", what, detail);
    exit(1);
}

#define CHECK(call) \
    do { \
        int status_ = (call); \
        if (status_ != OK) { \
            fprintf(stderr, "%s returned %d\n", #call, status_); \
            exit(1); \
        } \
    } while (0)

static void logger(void *environment, const char *name, int status, const char *category, const char *message, ...) {
    va_list arguments;
    (void)environment;
    fprintf(stderr, "%s, status %d, %s: ", name, status, category);
    va_start(arguments, message);
    vfprintf(stderr, message, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

static void *load(const char *path) {
    void *library = open_library(path);
    if (library == NULL) {
#ifdef _WIN32
        fprintf(stderr, "error %lu\n", (unsigned long)GetLastError());
#else
        fprintf(stderr, "%s\n", dlerror());
#endif
        fail(path, "cannot be loaded");
    }
/* Through a pointer to void: ISO C has no conversion between pointers to data and to functions. */
#define RESOLVE(name) \
    do { \
        void *found_ = symbol(library, "fmi2" #name); \
        if (found_ == NULL) fail("fmi2" #name, "is not exported"); \
        memcpy(&fmi.name, &found_, sizeof found_); \
    } while (0)
    RESOLVE(Instantiate);
    RESOLVE(SetupExperiment);
    RESOLVE(EnterInitializationMode);
    RESOLVE(ExitInitializationMode);
    RESOLVE(SetInteger);
    RESOLVE(SetReal);
    RESOLVE(GetReal);
    RESOLVE(GetDirectionalDerivative);
    RESOLVE(DoStep);
    RESOLVE(GetFMUstate);
    RESOLVE(SetFMUstate);
    RESOLVE(FreeFMUstate);
    RESOLVE(SerializedFMUstateSize);
    RESOLVE(SerializeFMUstate);
    RESOLVE(DeSerializeFMUstate);
    RESOLVE(Terminate);
    RESOLVE(FreeInstance);
    return library;
}

enum { MOST_VARIABLES = 256 };

static struct {
    char guid[64];
    int unmask, steps, save, derivatives;
    double step;
    int integers, reals, inputs, outputs;
    Reference integer[MOST_VARIABLES], real[MOST_VARIABLES], input[MOST_VARIABLES], output[MOST_VARIABLES];
    int integer_value[MOST_VARIABLES];
    double real_value[MOST_VARIABLES];
    double *table; /* a row of inputs for the start and for each step */
} scenario;

static void expect(FILE *file, const char *name) {
    char word[64];
    if (fscanf(file, "%63s", word) != 1 || strcmp(word, name) != 0) fail("the scenario lacks", name);
}

static int whole(FILE *file, const char *name) {
    int value;
    if (fscanf(file, "%d", &value) != 1) fail("no whole number in the scenario for", name);
    return value;
}

static double number(FILE *file, const char *name) {
    double value;
    if (fscanf(file, "%lf", &value) != 1) fail("no number in the scenario for", name);
    return value;
}

static int named(FILE *file, const char *name) {
    expect(file, name);
    return whole(file, name);
}

static int count(FILE *file, const char *name) {
    int value = named(file, name);
    if (value < 0 || value > MOST_VARIABLES) fail("not a number of variables", name);
    return value;
}

static void references(FILE *file, Reference *reference, int number) {
    for (int i = 0; i < number; i++) reference[i] = (Reference)whole(file, "a value reference");
}

static void read_scenario(const char *path) {
    FILE *file = fopen(path, "r");
    if (file == NULL) fail(path, "cannot be opened");
    expect(file, "guid");
    if (fscanf(file, "%63s", scenario.guid) != 1) fail(path, "no GUID");
    scenario.unmask = named(file, "unmask");
    scenario.save = named(file, "save");
    scenario.derivatives = named(file, "derivatives");
    scenario.integers = count(file, "integers");
    for (int i = 0; i < scenario.integers; i++) {
        references(file, &scenario.integer[i], 1);
        scenario.integer_value[i] = whole(file, "an integer");
    }
    scenario.reals = count(file, "reals");
    for (int i = 0; i < scenario.reals; i++) {
        references(file, &scenario.real[i], 1);
        scenario.real_value[i] = number(file, "a parameter");
    }
    scenario.outputs = count(file, "outputs");
    references(file, scenario.output, scenario.outputs);
    scenario.inputs = count(file, "inputs");
    references(file, scenario.input, scenario.inputs);
    expect(file, "step");
    scenario.step = number(file, "the step");
    scenario.steps = named(file, "steps");
    if (scenario.steps < 1 || scenario.save < 1 || scenario.derivatives < 1) fail(path, "a count below 1");
    size_t numbers = (size_t)(scenario.steps + 1) * (size_t)scenario.inputs;
    scenario.table = malloc((numbers + 1) * sizeof *scenario.table);
    if (scenario.table == NULL) fail(path, "too large");
    for (size_t i = 0; i < numbers; i++) scenario.table[i] = number(file, "the table");
    fclose(file);
}

static void print(const double *values) {
    for (int i = 0; i < scenario.outputs; i++) printf(" %.17g", values[i]);
    putchar('\n');
}

static void set_inputs(Component unit, int row) {
    CHECK(fmi.SetReal(unit, scenario.input, (size_t)scenario.inputs, scenario.table + (size_t)row * scenario.inputs));
}

static void step(Component unit, int number, double *outputs) {
    set_inputs(unit, number);
    CHECK(fmi.DoStep(unit, (number - 1) * scenario.step, scenario.step, 1));
    CHECK(fmi.GetReal(unit, scenario.output, (size_t)scenario.outputs, outputs));
}

/* The step, from the state as it is, from the saved and from the serialised one: the same bits. */
static void step_thrice(Component unit, int number, double *outputs) {
    void *saved = NULL, *copy = NULL;
    size_t size = 0, bytes = (size_t)scenario.outputs * sizeof *outputs;
    double again[MOST_VARIABLES];
    CHECK(fmi.GetFMUstate(unit, &saved));
    CHECK(fmi.SerializedFMUstateSize(unit, saved, &size));
    char *serialised = malloc(size);
    if (serialised == NULL) fail("a serialised state", "too large");
    CHECK(fmi.SerializeFMUstate(unit, saved, serialised, size));
    step(unit, number, outputs);
    CHECK(fmi.SetFMUstate(unit, saved));
    step(unit, number, again);
    if (memcmp(outputs, again, bytes) != 0) fail("a step", "other bits from the saved state");
    CHECK(fmi.DeSerializeFMUstate(unit, serialised, size, &copy));
    CHECK(fmi.SetFMUstate(unit, copy));
    step(unit, number, again);
    if (memcmp(outputs, again, bytes) != 0) fail("a step", "other bits from the serialised state");
    CHECK(fmi.FreeFMUstate(unit, &saved));
    CHECK(fmi.FreeFMUstate(unit, &copy));
    free(serialised);
}

static void print_derivatives(Component unit, int number) {
    const double one = 1.0;
    double values[MOST_VARIABLES];
    for (int i = 0; i < scenario.inputs; i++) {
        CHECK(fmi.GetDirectionalDerivative(unit, scenario.output, (size_t)scenario.outputs, &scenario.input[i], 1, &one,
                                           values));
        printf("derivative %d %u", number, scenario.input[i]);
        print(values);
    }
}

int main(int argc, char **argv) {
    const Callbacks callbacks = {logger, calloc, free, NULL, NULL};
    double outputs[MOST_VARIABLES];
    if (argc != 3) fail("usage", "host LIBRARY SCENARIO");
    read_scenario(argv[2]);
    void *library = load(argv[1]);
    if (scenario.unmask) unmask();
    const unsigned long long before = control();

    Component unit = fmi.Instantiate("platform", CO_SIMULATION, scenario.guid, NULL, &callbacks, 0, 0);
    if (unit == NULL) fail("fmi2Instantiate", "no instance");
    CHECK(fmi.SetInteger(unit, scenario.integer, (size_t)scenario.integers, scenario.integer_value));
    CHECK(fmi.SetReal(unit, scenario.real, (size_t)scenario.reals, scenario.real_value));
    CHECK(fmi.SetupExperiment(unit, 0, 0.0, 0.0, 0, 0.0));
    CHECK(fmi.EnterInitializationMode(unit));
    set_inputs(unit, 0);
    CHECK(fmi.ExitInitializationMode(unit));
    for (int number = 1; number <= scenario.steps; number++) {
        if (number % scenario.save == 0)
            step_thrice(unit, number, outputs);
        else
            step(unit, number, outputs);
        printf("step %d", number);
        print(outputs);
        if (number % scenario.derivatives == 0) print_derivatives(unit, number);
    }
    CHECK(fmi.Terminate(unit));
    fmi.FreeInstance(unit);
    if (control() != before) fail("the control word of the floating-point unit", "has changed");
    if (close_library(library) != 0) fail(argv[1], "cannot be unloaded");
    free(scenario.table);
    return ferror(stdout) || fflush(stdout) ? 1 : 0;
}
