"""A small FMU of FMI 3.0 in C: every type, arrays, a structural parameter, early returns, states, and a request to end the run."""

import sys
import tempfile
from functools import cache
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "c_units"))
from c_library import compile_library, pack

SOURCE = r"""
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "fmi3Functions.h"

/* x' = Σu, y = m u (m is 2 by 3) times gain, k_out = k + 1, any = flags ored, said = label with the mode. */
typedef struct {
    double u[3], m[6], x, wall, end_from, error_from, time;
    float gain;
    int32_t k; int8_t small; uint64_t big; int64_t mode; uint16_t steps;
    bool flags[2];
    char label[64], said[80];
} Unit;
typedef struct { Unit v; fmi3LogMessageCallback log; void* who; bool early; } Instance;

static void fresh(Unit* v) {
    memset(v, 0, sizeof *v);
    double m[6] = {1, 0, 0, 0, 1, 0};
    memcpy(v->m, m, sizeof m);
    for (int i = 0; i < 3; i++) v->u[i] = i + 1.0;
    v->wall = v->end_from = v->error_from = 1e9; v->gain = 2; v->mode = 1; v->big = 18446744073709551615ULL; strcpy(v->label, "none");
}
static double y(Unit* v, int row) {
    double sum = 0;
    for (int j = 0; j < 3; j++) sum += v->m[3 * row + j] * v->u[j];
    return v->gain * sum;
}
const char* fmi3GetVersion(void) { return "3.0"; }
fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String k[]) { return fmi3OK; }
fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String where, fmi3Boolean visible, fmi3Boolean logging,
    fmi3Boolean events, fmi3Boolean early, const fmi3ValueReference r[], size_t n, fmi3InstanceEnvironment who,
    fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update) {
    Instance* c = calloc(1, sizeof *c);
    fresh(&c->v); c->log = log; c->who = who; c->early = early;
    return c;
}
void fmi3FreeInstance(fmi3Instance c) { free(c); }
fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean d, fmi3Float64 tol, fmi3Float64 t, fmi3Boolean s, fmi3Float64 e) {
    ((Instance*)c)->v.time = t; return fmi3OK;
}
fmi3Status fmi3ExitInitializationMode(fmi3Instance c) { return fmi3OK; }
fmi3Status fmi3Terminate(fmi3Instance c) { return fmi3OK; }
fmi3Status fmi3Reset(fmi3Instance c) { fresh(&((Instance*)c)->v); return fmi3OK; }
#define UNIT Unit* v = &((Instance*)c)->v; size_t at = 0; for (size_t i = 0; i < n; i++) switch (r[i])
#define DONE default: return fmi3Error; } if (at != count) return fmi3Error; return fmi3OK;
fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 x[], size_t count) { UNIT {
    case 2: memcpy(x + at, v->u, sizeof v->u); at += 3; break;
    case 3: x[at++] = y(v, 0); x[at++] = y(v, 1); break;
    case 5: memcpy(x + at, v->m, sizeof v->m); at += 6; break;
    case 6: x[at++] = v->x; break;
    DONE }
fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Float64 x[], size_t count) { UNIT {
    case 2: memcpy(v->u, x + at, sizeof v->u); at += 3; break;
    case 5: memcpy(v->m, x + at, sizeof v->m); at += 6; break;
    case 7: v->wall = x[at++]; break;
    case 8: v->end_from = x[at++]; break;
    case 9: v->error_from = x[at++]; break;
    DONE }
#define SCALAR(TYPE, CODE) \
    fmi3Status fmi3Set##TYPE(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3##TYPE x[], size_t count) { UNIT { \
        case CODE = x[at++]; break; DONE }
#define GIVEN(TYPE, CODE) \
    fmi3Status fmi3Get##TYPE(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3##TYPE x[], size_t count) { UNIT { \
        case CODE; break; DONE }
SCALAR(Float32, 4: v->gain) GIVEN(Float32, 4: x[at++] = v->gain)
SCALAR(Int32, 10: v->k) GIVEN(Int32, 11: x[at++] = v->k + 1)
SCALAR(Int8, 12: v->small) GIVEN(Int8, 13: x[at++] = v->small)
SCALAR(UInt64, 14: v->big) GIVEN(UInt64, 15: x[at++] = v->big)
SCALAR(Int64, 16: v->mode) GIVEN(Int64, 17: x[at++] = v->mode)
GIVEN(UInt16, 18: x[at++] = v->steps)
fmi3Status fmi3SetBoolean(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3Boolean x[], size_t count) { UNIT {
    case 19: memcpy(v->flags, x + at, 2); at += 2; break; DONE }
GIVEN(Boolean, 20: x[at++] = v->flags[0] || v->flags[1])
fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference r[], size_t n, const fmi3String x[], size_t count) { UNIT {
    case 21: snprintf(v->label, sizeof v->label, "%s", x[at++]); break; DONE }
fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3String x[], size_t count) { UNIT {
    case 22: snprintf(v->said, sizeof v->said, "%s %s", v->label, v->mode == 2 ? "on" : "off"); x[at++] = v->said; break; DONE }
fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState* s) {
    if (!*s) *s = malloc(sizeof(Unit));
    memcpy(*s, &((Instance*)c)->v, sizeof(Unit));
    return fmi3OK;
}
fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState s) { memcpy(&((Instance*)c)->v, s, sizeof(Unit)); return fmi3OK; }
fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState* s) { free(*s); *s = 0; return fmi3OK; }
fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState s, size_t* n) { *n = sizeof(Unit); return fmi3OK; }
fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState s, fmi3Byte b[], size_t n) { memcpy(b, s, n); return fmi3OK; }
fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte b[], size_t n, fmi3FMUState* s) {
    *s = malloc(sizeof(Unit)); memcpy(*s, b, n); return fmi3OK;
}
fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 t, fmi3Float64 h, fmi3Boolean keep, fmi3Boolean* event, fmi3Boolean* end,
                      fmi3Boolean* early, fmi3Float64* last) {
    Instance* m = c; Unit* v = &m->v;
    if (t >= v->error_from) { m->log(m->who, fmi3Error, "error", "the tank is empty"); return fmi3Error; }
    double wall = (floor(t / v->wall + 1e-9) + 1.0) * v->wall;
    double to = t + h > wall + 1e-12 ? wall : t + h;
    *event = false; *end = t >= v->end_from; *early = false; *last = to;
    if (*end) m->log(m->who, fmi3OK, "info", "we have landed");
    if (to < t + h - 1e-12) { if (!m->early) return fmi3Discard; *early = true; }
    for (int j = 0; j < 3; j++) v->x += v->u[j] * (to - t);
    v->steps++; v->time = to;
    return fmi3OK;
}
"""
_DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="NAME" instantiationToken="{sample-of-fmi-3}">
  <CoSimulation modelIdentifier="NAME" canHandleVariableCommunicationStepSize="true" mightReturnEarlyFromDoStep="true" hasEventMode="true"
    CAPABILITIES/>
  <UnitDefinitions><Unit name="m"><BaseUnit m="1"/></Unit><Unit name="km"><BaseUnit m="1" factor="1000"/></Unit></UnitDefinitions>
  <TypeDefinitions><EnumerationType name="Mode"><Item name="off" value="1"/><Item name="on" value="2"/></EnumerationType></TypeDefinitions>
  <ModelVariables>
    <Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
    <UInt64 name="n" valueReference="1" causality="structuralParameter" variability="fixed" start="3"/>
    <Float64 name="u" valueReference="2" causality="input" start="1 2 3" unit="m"><Dimension valueReference="1"/></Float64>
    <Float64 name="y" valueReference="3" causality="output" unit="m"><Dimension start="2"/><Alias name="reading"/></Float64>
    <Float32 name="gain" valueReference="4" causality="parameter" variability="fixed" start="2"/>
    <Float64 name="m" valueReference="5" causality="parameter" variability="fixed" start="1 0 0 0 1 0">
      <Dimension start="2"/><Dimension valueReference="1"/></Float64>
    <Float64 name="x" valueReference="6" causality="output" unit="km"/>
    <Float64 name="wall" valueReference="7" causality="parameter" variability="fixed" start="1e9"/>
    <Float64 name="end_from" valueReference="8" causality="parameter" variability="fixed" start="1e9"/>
    <Float64 name="error_from" valueReference="9" causality="parameter" variability="fixed" start="1e9"/>
    <Int32 name="k" valueReference="10" causality="input" start="0"/>
    <Int32 name="k_out" valueReference="11" causality="output"/>
    <Int8 name="small" valueReference="12" causality="input" start="0"/>
    <Int8 name="small_out" valueReference="13" causality="output"/>
    <UInt64 name="big" valueReference="14" causality="parameter" variability="fixed" start="18446744073709551615"/>
    <UInt64 name="big_out" valueReference="15" causality="output"/>
    <Enumeration name="mode" valueReference="16" causality="parameter" variability="fixed" declaredType="Mode" start="1"/>
    <Enumeration name="mode_out" valueReference="17" causality="output" declaredType="Mode"/>
    <UInt16 name="steps" valueReference="18" causality="output"/>
    <Boolean name="flags" valueReference="19" causality="input" start="false false"><Dimension start="2"/></Boolean>
    <Boolean name="any" valueReference="20" causality="output"/>
    <String name="label" valueReference="21" causality="input"><Start value="none"/></String>
    <String name="said" valueReference="22" causality="output"/>
    <Binary name="picture" valueReference="23" causality="input"><Start value="00"/></Binary>
    <Clock name="tick" valueReference="24" causality="output" intervalVariability="constant" intervalDecimal="0.05"/>
  </ModelVariables>
  <ModelStructure><Output valueReference="3"/><Output valueReference="6"/><Output valueReference="11"/><Output valueReference="13"/>
    <Output valueReference="15"/><Output valueReference="17"/><Output valueReference="18"/><Output valueReference="20"/>
    <Output valueReference="22"/><Output valueReference="24"/>
  </ModelStructure>
</fmiModelDescription>
"""


@cache
def c_sample3(state: bool = True) -> Path:
    """The FMU, with or without states that can be kept."""
    name = "Sample3C" if state else "Sample3CStateless"
    folder = Path(tempfile.mkdtemp(prefix="c_fmu3_"))
    (folder / "unit.c").write_text(SOURCE)
    library = folder / f"{name}.so"
    compile_library(library, [folder / "unit.c"], 3)
    able = 'canGetAndSetFMUState="true" canSerializeFMUState="true"' if state else ""
    return pack(folder / f"{name}.fmu", _DESCRIPTION.replace("NAME", name).replace("CAPABILITIES", able).encode(), library, 3)
