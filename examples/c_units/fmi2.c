/* FMI 2.0 around a unit of unit.h. A value reference is a place in the unit's array. */

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "fmi2Functions.h"
#include "unit.h"

typedef struct { double v[VALUES]; double time; const fmi2CallbackFunctions* callbacks; char name[256]; } Instance;

static fmi2Status said(Instance* m, const char* complaint) {
    if (!complaint) return fmi2OK;
    m->callbacks->logger(m->callbacks->componentEnvironment, m->name, fmi2Error, "logStatusError", "%s", complaint);
    return fmi2Error;
}

const char* fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char* fmi2GetVersion(void) { return "2.0"; }
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String names[]) { return fmi2OK; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean visible, fmi2Boolean logging) {
    Instance* m = type == fmi2CoSimulation && !strcmp(guid, TOKEN) ? calloc(1, sizeof *m) : 0;
    if (!m) return 0;
    m->callbacks = callbacks;
    strncpy(m->name, name, sizeof m->name - 1);
    memcpy(m->v, START, sizeof m->v);
    return m;
}
void fmi2FreeInstance(fmi2Component c) { free(c); }
fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean t, fmi2Real tolerance, fmi2Real start, fmi2Boolean s, fmi2Real stop) {
    ((Instance*)c)->time = start;
    return fmi2OK;
}
fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { Instance* m = c; return said(m, unit_start(m->v, m->time)); }
fmi2Status fmi2Terminate(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2Reset(fmi2Component c) { memcpy(((Instance*)c)->v, START, sizeof START); return fmi2OK; }

#define GET(TYPE) \
    fmi2Status fmi2Get##TYPE(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2##TYPE x[]) { \
        for (size_t i = 0; i < n; i++) { if (r[i] >= VALUES) return fmi2Error; x[i] = (fmi2##TYPE)((Instance*)c)->v[r[i]]; } \
        return fmi2OK; \
    }
#define SET(TYPE) \
    fmi2Status fmi2Set##TYPE(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2##TYPE x[]) { \
        for (size_t i = 0; i < n; i++) { \
            if (r[i] >= VALUES || !isfinite((double)x[i])) return said(c, "a value is not finite, or of no variable"); \
            ((Instance*)c)->v[r[i]] = x[i]; \
        } \
        return fmi2OK; \
    }
GET(Real) SET(Real) GET(Integer) SET(Integer) GET(Boolean) SET(Boolean)

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean no_return) {
    Instance* m = c;
    return said(m, unit_step(m->v, time, step));
}

#ifdef STATES
fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* s) {
    if (!*s) *s = malloc(sizeof START);
    memcpy(*s, ((Instance*)c)->v, sizeof START);
    return fmi2OK;
}
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate s) { memcpy(((Instance*)c)->v, s, sizeof START); return fmi2OK; }
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* s) { free(*s); *s = 0; return fmi2OK; }
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate s, size_t* n) { *n = sizeof START; return fmi2OK; }
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate s, fmi2Byte b[], size_t n) { memcpy(b, s, n); return fmi2OK; }
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte b[], size_t n, fmi2FMUstate* s) {
    if (n != sizeof START) return fmi2Error;
    if (!*s) *s = malloc(n);
    memcpy(*s, b, n);
    return fmi2OK;
}
#endif
