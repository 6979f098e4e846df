"""A small FMU in C, for what pythonfmu cannot do: an early return with its time, a call that does not come back, fmi2Error, a crash."""

import sys
import tempfile
from functools import cache
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "c_units"))
from c_library import compile_library, pack

VARIABLES = ("u", "x", "wall", "hang_from", "error_from", "nan_from", "fatal_from", "crash_from", "save_crash_from")
"""x' = 1 + u. Discards at each multiple of `wall`, having stepped up to it; hangs, or fails, from a time on, or crashes when saved."""

SOURCE = r"""
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "fmi2Functions.h"

typedef struct { double v[9]; double reached; } Unit;

const char* fmi2GetTypesPlatform(void) { return "default"; }
const char* fmi2GetVersion(void) { return "2.0"; }
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String k[]) { return fmi2OK; }
fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String where, const fmi2CallbackFunctions* f,
                              fmi2Boolean visible, fmi2Boolean log) {
    Unit* m = calloc(1, sizeof(Unit));
    for (int i = 2; i < 9; i++) m->v[i] = 1e9;
    return m;
}
void fmi2FreeInstance(fmi2Component c) { free(c); }
fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean d, fmi2Real tol, fmi2Real t, fmi2Boolean s, fmi2Real e) { return fmi2OK; }
fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2Terminate(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2Reset(fmi2Component c) {
    memset(c, 0, sizeof(Unit));
    for (int i = 2; i < 9; i++) ((Unit*)c)->v[i] = 1e9;
    return fmi2OK;
}
fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real x[]) {
    for (size_t i = 0; i < n; i++) x[i] = ((Unit*)c)->v[r[i]];
    return fmi2OK;
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real x[]) {
    for (size_t i = 0; i < n; i++) ((Unit*)c)->v[r[i]] = x[i];
    return fmi2OK;
}
fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* s) {
    if (((Unit*)c)->reached >= ((Unit*)c)->v[8]) *(volatile int*)0 = 1;
    if (!*s) *s = malloc(sizeof(Unit));
    memcpy(*s, c, sizeof(Unit));
    return fmi2OK;
}
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate s) { memcpy(c, s, sizeof(Unit)); return fmi2OK; }
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* s) { free(*s); *s = 0; return fmi2OK; }
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate s, size_t* n) { *n = sizeof(Unit); return fmi2OK; }
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate s, fmi2Byte b[], size_t n) { memcpy(b, s, n); return fmi2OK; }
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte b[], size_t n, fmi2FMUstate* s) {
    *s = malloc(sizeof(Unit));
    memcpy(*s, b, n);
    return fmi2OK;
}
fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind k, fmi2Real* x) {
    if (k != fmi2LastSuccessfulTime) return fmi2Discard;
    *x = ((Unit*)c)->reached;
    return fmi2OK;
}
#define REFUSED { return fmi2Discard; }
fmi2Status fmi2CancelStep(fmi2Component c) REFUSED
fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind k, fmi2Status* x) REFUSED
fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind k, fmi2Integer* x) REFUSED
fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind k, fmi2Boolean* x) REFUSED
fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind k, fmi2String* x) REFUSED
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Integer x[]) REFUSED
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Boolean x[]) REFUSED
fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2String x[]) REFUSED
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer x[]) REFUSED
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Boolean x[]) REFUSED
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2String x[]) REFUSED
fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference u[], size_t n, const fmi2ValueReference k[], size_t m,
                                        const fmi2Real du[], fmi2Real dk[]) REFUSED
fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer o[],
                                       const fmi2Real x[]) REFUSED
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Integer o[],
                                        fmi2Real x[]) REFUSED
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real h, fmi2Boolean keep) {
    Unit* m = c;
    volatile int forever = 1;
    if (t >= m->v[3]) while (forever) {}
    if (t >= m->v[4]) return fmi2Error;
    if (t >= m->v[6]) return fmi2Fatal;
    if (t >= m->v[7]) *(volatile int*)0 = 1;
    double wall = (floor(t / m->v[2] + 1e-9) + 1.0) * m->v[2];
    double end = t + h > wall + 1e-12 ? wall : t + h;
    m->v[1] += (1.0 + m->v[0]) * (end - t);
    if (t >= m->v[5]) m->v[1] = NAN;
    m->reached = end;
    return end < t + h - 1e-12 ? fmi2Discard : fmi2OK;
}
"""

_DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="NAME" guid="{0f8f1c34-57a5-4b0a-9f0e-sample00000c}">
  <CoSimulation modelIdentifier="NAME" canHandleVariableCommunicationStepSize="true" CAPABILITIES/>
  <ModelVariables>
    <ScalarVariable name="u" valueReference="0" causality="input"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="x" valueReference="1" causality="output"><Real/></ScalarVariable>
PARAMETERS  </ModelVariables>
  <ModelStructure><Outputs><Unknown index="2"/></Outputs></ModelStructure>
</fmiModelDescription>
"""
_PARAMETER = (
    '    <ScalarVariable name="{0}" valueReference="{1}" causality="parameter" variability="fixed">'
    '<Real start="1e9"/></ScalarVariable>\n'
)


@cache
def c_sample(state: bool = True) -> Path:
    """The FMU, with or without states that can be kept."""
    name = "SampleC" if state else "SampleCStateless"
    folder = Path(tempfile.mkdtemp(prefix="c_fmu_"))
    (folder / "unit.c").write_text(SOURCE)
    library = folder / f"{name}.so"
    compile_library(library, [folder / "unit.c"], 2)
    parameters = "".join(_PARAMETER.format(n, at) for at, n in enumerate(VARIABLES) if at > 1)
    able = 'canGetAndSetFMUstate="true" canSerializeFMUstate="true"' if state else ""
    description = _DESCRIPTION.replace("NAME", name).replace("PARAMETERS", parameters).replace("CAPABILITIES", able)
    return pack(folder / f"{name}.fmu", description.encode(), library, 2)
