/* FMI 3.0 around a unit of unit.h. A value reference is the place of a variable's first element in the unit's array. */

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "fmi3Functions.h"
#include "unit.h"

typedef struct { double v[VALUES]; double time; fmi3InstanceEnvironment who; fmi3LogMessageCallback log; } Instance;

static fmi3Status said(Instance* m, const char* complaint) {
    if (!complaint) return fmi3OK;
    if (m->log) m->log(m->who, fmi3Error, "logStatusError", complaint);
    return fmi3Error;
}

const char* fmi3GetVersion(void) { return fmi3Version; }
fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String names[]) { return fmi3OK; }

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
                                         fmi3Boolean logging, fmi3Boolean events, fmi3Boolean early, const fmi3ValueReference required[],
                                         size_t n, fmi3InstanceEnvironment who, fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update) {
    Instance* m = strcmp(token, TOKEN) ? 0 : calloc(1, sizeof *m);
    if (!m) return 0;
    m->who = who;
    m->log = log;
    memcpy(m->v, START, sizeof m->v);
    return m;
}
void fmi3FreeInstance(fmi3Instance c) { free(c); }
fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean t, fmi3Float64 tolerance, fmi3Float64 start, fmi3Boolean s,
                                       fmi3Float64 stop) {
    ((Instance*)c)->time = start;
    return fmi3OK;
}
fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { Instance* m = c; return said(m, unit_start(m->v, m->time)); }
fmi3Status fmi3Terminate(fmi3Instance c) { return fmi3OK; }
fmi3Status fmi3Reset(fmi3Instance c) { memcpy(((Instance*)c)->v, START, sizeof START); return fmi3OK; }

#define GET(TYPE, NAME) \
    fmi3Status fmi3Get##NAME(fmi3Instance c, const fmi3ValueReference r[], size_t n, TYPE x[], size_t count) { \
        size_t at = 0; \
        for (size_t i = 0; i < n; i++) { \
            if (r[i] >= VALUES || at + SIZE[r[i]] > count) return fmi3Error; \
            for (int k = 0; k < SIZE[r[i]]; k++) x[at++] = (TYPE)((Instance*)c)->v[r[i] + k]; \
        } \
        return at == count ? fmi3OK : fmi3Error; \
    }
#define SET(TYPE, NAME) \
    fmi3Status fmi3Set##NAME(fmi3Instance c, const fmi3ValueReference r[], size_t n, const TYPE x[], size_t count) { \
        size_t at = 0; \
        for (size_t i = 0; i < n; i++) { \
            if (r[i] >= VALUES || at + SIZE[r[i]] > count) return fmi3Error; \
            for (int k = 0; k < SIZE[r[i]]; k++, at++) { \
                if (!isfinite((double)x[at])) return said(c, "a value is not finite"); \
                ((Instance*)c)->v[r[i] + k] = x[at]; \
            } \
        } \
        return at == count ? fmi3OK : fmi3Error; \
    }
GET(fmi3Float64, Float64) SET(fmi3Float64, Float64) GET(fmi3Int32, Int32) SET(fmi3Int32, Int32)
GET(fmi3Boolean, Boolean) SET(fmi3Boolean, Boolean) GET(fmi3Int64, Int64) SET(fmi3Int64, Int64)

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 step, fmi3Boolean no_return, fmi3Boolean* event,
                      fmi3Boolean* terminate, fmi3Boolean* early, fmi3Float64* last) {
    Instance* m = c;
    *event = *terminate = *early = fmi3False;
    *last = time + step;
    return said(m, unit_step(m->v, time, step));
}

#ifdef STATES
fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState* s) {
    if (!*s) *s = malloc(sizeof START);
    memcpy(*s, ((Instance*)c)->v, sizeof START);
    return fmi3OK;
}
fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState s) { memcpy(((Instance*)c)->v, s, sizeof START); return fmi3OK; }
fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState* s) { free(*s); *s = 0; return fmi3OK; }
fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState s, size_t* n) { *n = sizeof START; return fmi3OK; }
fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState s, fmi3Byte b[], size_t n) { memcpy(b, s, n); return fmi3OK; }
fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte b[], size_t n, fmi3FMUState* s) {
    if (n != sizeof START) return fmi3Error;
    if (!*s) *s = malloc(n);
    memcpy(*s, b, n);
    return fmi3OK;
}
#endif
