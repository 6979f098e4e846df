"""What every peer's script shares: the job it reads and the result it writes. Runs in the peer's own environment: standard library only.

A job is JSON: `ssp`, the system as `orchestrator export` writes it, and for those who cannot read one `units` (name, fmu), `start`
(unit, variable, reference, type, value), `links` (unit, variable, reference, type, and
the same of the target), `bonds` (unit, output and input reference, twice), `watch` (unit, variable, reference), `stop`, `step`,
`tolerance`, `method`. A result holds `times`, `values` by watched variable and `step_s`, the wall time of stepping alone.
"""

import json
import os
import sys
from pathlib import Path


def read():
    return json.loads(Path(sys.argv[1]).read_text("utf-8"))


def write(times, values, step_s):
    """Write the result and leave at once: a Python runtime in a unit may crash while the interpreter is taken down."""
    Path(sys.argv[2]).write_text(json.dumps({"times": list(times), "values": values, "step_s": step_s}), "utf-8")
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)


def label(watched):
    return f"{watched[0]}.{watched[1]}"
