"""A rate sensor in C, written against the port contract, and the same with one fault each: what `orchestrator check` is to find."""

import re
import subprocess
import tempfile
import zipfile
from functools import cache
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, tostring

import fmpy
from c_library import compiler
from fmi_c_sample import SOURCE

AXES = ("yaw", "pitch", "roll")
LAG = "lag"
NAMES = (*(f"rates.{a}" for a in AXES), *(f"telemetry.{a}" for a in AXES), LAG)
UNITS = {"rad/s": {"s": "-1", "rad": "1"}, "deg/s": {"s": "-1", "rad": "1", "factor": "0.0174532925199433"}, "s": {"s": "1"},
         "m/s": {"m": "1", "s": "-1"}}

# Fault → what stands before the step, in C. y' = (u - y)/lag over the interval, u held.
BEFORE = {
    "crash": "if (t > 0.025) *(volatile int*)0 = 1;",
    "hang": "volatile int forever = 1; if (t > 0.025) while (forever) {}",
    "crash on nan": "if (isnan(m->v[0])) *(volatile int*)0 = 1;",
    "exit": "if (t > 0.025) exit(7);",
    "lying state": "hidden += h;",
    "clock": "m->v[0] += 1e-9 * (double)clock();",
    "per call": "for (int i = 0; i < 3; i++) m->v[3 + i] += 1e-3;",
    "error": "if (t > 0.025) return fmi2Error;",
}
_REFUSE = "if (!(isfinite(m->v[0]) && isfinite(m->v[1]) && isfinite(m->v[2]) && h > 0.0 && m->v[6] >= 0.0)) return fmi2Discard;"
_STEP = """
#include <time.h>
static double hidden = 0.0;
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t, fmi2Real h, fmi2Boolean keep) {
    Unit* m = c;
    REFUSE
    BEFORE
    for (int i = 0; i < 3; i++) m->v[3 + i] += (m->v[i] - m->v[3 + i]) * (1.0 - exp(-h / (m->v[6] + 1e-9))) + HIDDEN;
    return fmi2OK;
}
"""
_FROM = "fmi2Status fmi2DoStep"


def source(fault: str) -> str:
    """The sample's C with another step: the life cycle is the same."""
    start = r"\1->v[6] = 0.05, \1->v[8] = 1e9;"
    shared, changed = re.subn(r"for \(int i = 2; i < \d; i\+\+\) (.*)->v\[i\] = 1e9;", start, SOURCE[: SOURCE.index(_FROM)])
    assert changed == 2      # where an instance is made and where it is reset; from v[8] s on, saving crashes
    if fault == "feedthrough":
        get = "for (size_t i = 0; i < n; i++) x[i] = ((Unit*)c)->v[r[i]];"
        assert get in shared
        shared = shared.replace(get, get.replace("->v[r[i]]", "->v[r[i]] + (r[i] == 3 ? ((Unit*)c)->v[0] : 0.0)"))
    refuse = "" if fault in ("nan passes", "crash on nan") else _REFUSE
    step = _STEP.replace("REFUSE", refuse).replace("BEFORE", BEFORE.get(fault, ""))
    return shared + step.replace("HIDDEN", "1e-6 * hidden" if fault == "lying state" else "0.0")


def description(name: str, fault: str) -> bytes:
    root = Element("fmiModelDescription", {"fmiVersion": "2.0", "modelName": name, "guid": f"{{sensor-{name}}}",
                                           "variableNamingConvention": "structured"})
    able = {} if fault == "no state" else {"canGetAndSetFMUstate": "true", "canSerializeFMUstate": "true"}
    SubElement(root, "CoSimulation", {"modelIdentifier": name, "canHandleVariableCommunicationStepSize": "true", **able})
    definitions = SubElement(root, "UnitDefinitions")
    for unit, powers in UNITS.items():
        SubElement(SubElement(definitions, "Unit", {"name": unit}), "BaseUnit", powers)
    variables = SubElement(root, "ModelVariables")
    for reference, variable in enumerate(NAMES):
        if fault == "missing port" and variable == "telemetry.roll":
            variable = "telemetry.rol"
        causality = "parameter" if variable == LAG else "input" if reference < 3 else "output"
        if fault == "causality" and variable == "telemetry.roll":
            causality = "local"
        about = {"name": variable, "valueReference": str(reference), "causality": causality}
        about |= {"variability": "fixed"} if causality == "parameter" else {}
        frame = {"no frame": "", "other frame": ", frame L"}.get(fault, ", frame B")
        scalar = SubElement(variables, "ScalarVariable", {**about, "description": f"{variable.partition('.')[2]} rate{frame}"})
        unit = "s" if variable == LAG else {"other unit": "m/s", "degrees": "deg/s"}.get(fault, "rad/s")
        start = {"start": "0.05" if variable == LAG else "0.0"} if causality in ("input", "parameter") else {}
        SubElement(scalar, "Real", {"unit": unit, **({"min": "0.0"} if variable == LAG else {"nominal": "0.1"}), **start})
    structure = SubElement(root, "ModelStructure")
    for part in ("Outputs", "InitialUnknowns"):
        unknowns = SubElement(structure, part)
        for index in (4, 5, 6)[: 2 if fault == "causality" else 3]:
            SubElement(unknowns, "Unknown", {"index": str(index), "dependencies": ""})
    return tostring(root, encoding="UTF-8", xml_declaration=True)


@cache
def c_sensor(fault: str = "") -> Path:
    """The FMU with one fault; without, it keeps the contract."""
    name = "Sensor" + "".join(word.capitalize() for word in fault.split())
    folder = Path(tempfile.mkdtemp(prefix="c_sensor_"))
    (folder / "unit.c").write_text(source(fault))
    library = folder / f"{name}.so"
    headers = Path(fmpy.__file__).parent / "c-code"
    command = [*compiler(), "-shared", "-fPIC", "-O1", "-w", f"-I{headers}", "-o", str(library)]
    subprocess.run([*command, str(folder / "unit.c"), "-lm"], check=True)
    with zipfile.ZipFile(folder / f"{name}.fmu", "w") as archive:
        archive.writestr("modelDescription.xml", description(name, fault))
        archive.write(library, f"binaries/{fmpy.platform}/{name}{fmpy.sharedLibraryExtension}")
    return folder / f"{name}.fmu"
