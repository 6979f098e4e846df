/* The smallest host that runs an FMI 2.0 co-simulation FMU: no Python, no library but the C one.

     cc -I FMI_HEADERS -o plain_host plain_host.c -ldl
     plain_host BINARY RESOURCES_URI GUID STOP STEP [VR=VALUE ...] [VR ...]

   VR=VALUE sets a Real by its value reference before initialisation, VR prints one after each step, behind the time.
   An FMU that is written in Python needs more: env $(orchestrator host-env) plain_host ...; see docs/hosts.md. */
#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "fmi2FunctionTypes.h"

#define FUNCTION(name) fmi2##name##TYPE* name = (fmi2##name##TYPE*)load(library, "fmi2" #name)

static void* load(void* library, const char* name) {
    void* found = dlsym(library, name);
    if (!found) { fprintf(stderr, "%s: not in the binary\n", name); exit(2); }
    return found;
}

static void tell(fmi2ComponentEnvironment who, fmi2String name, fmi2Status status, fmi2String category, fmi2String message, ...) {
    va_list arguments;
    va_start(arguments, message);
    vfprintf(stderr, message, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

static void must(fmi2Status status, const char* what) {
    if (status > fmi2Warning) { fprintf(stderr, "%s returned %d\n", what, status); exit(3); }
}

int main(int count, char** given) {
    if (count < 6) { fprintf(stderr, "usage: plain_host BINARY RESOURCES_URI GUID STOP STEP [VR=VALUE ...] [VR ...]\n"); return 2; }
    void* library = dlopen(given[1], RTLD_NOW | RTLD_GLOBAL);
    if (!library) { fprintf(stderr, "%s\n", dlerror()); return 2; }
    FUNCTION(Instantiate); FUNCTION(SetupExperiment); FUNCTION(EnterInitializationMode); FUNCTION(ExitInitializationMode);
    FUNCTION(SetReal); FUNCTION(GetReal); FUNCTION(DoStep); FUNCTION(Terminate); FUNCTION(FreeInstance);

    double stop = atof(given[4]), step = atof(given[5]);
    fmi2CallbackFunctions callbacks = {tell, calloc, free, NULL, NULL};
    fmi2Component unit = Instantiate("unit", fmi2CoSimulation, given[3], given[2], &callbacks, fmi2False, fmi2True);
    if (!unit) { fprintf(stderr, "no instance\n"); return 3; }
    must(SetupExperiment(unit, fmi2False, 0.0, 0.0, fmi2True, stop), "SetupExperiment");
    must(EnterInitializationMode(unit), "EnterInitializationMode");
    for (int i = 6; i < count; i++) {
        char* value = strchr(given[i], '=');
        fmi2ValueReference reference = (fmi2ValueReference)atol(given[i]);
        fmi2Real number = value ? atof(value + 1) : 0.0;
        if (value) must(SetReal(unit, &reference, 1, &number), "SetReal");
    }
    must(ExitInitializationMode(unit), "ExitInitializationMode");
    for (long n = 0; n * step < stop - 0.5 * step; n++) {
        must(DoStep(unit, n * step, step, fmi2True), "DoStep");
        printf("%.17g", (n + 1) * step);
        for (int i = 6; i < count; i++) {
            fmi2ValueReference reference = (fmi2ValueReference)atol(given[i]);
            fmi2Real number;
            if (strchr(given[i], '=')) continue;
            must(GetReal(unit, &reference, 1, &number), "GetReal");
            printf(" %.17g", number);
        }
        putchar('\n');
    }
    fflush(stdout);
    must(Terminate(unit), "Terminate");
    FreeInstance(unit);
    _Exit(0);      /* not exit(): a Python that was started inside the process may crash while libraries are unloaded, after correct results */
}
