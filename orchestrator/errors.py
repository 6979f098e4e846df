"""What can go wrong, in one tree.

    OrchestratorError                    one line: "where: what is wrong with both values; what to do next"
    ├── UserError          exit code 2   the request cannot be run as written
    │   ├── ScenarioError                  the scenario file: bad TOML, unknown key, value of the wrong kind
    │   ├── UnitError                      a unit: missing or broken FMU, unknown parameter, value outside its range
    │   ├── WiringError                    a connection: unknown port, wrong unit of measure, an input fed twice
    │   ├── MeasuredError                  a folder of measured data: missing file or column, wrong unit, no number
    │   ├── SspError                       an .ssp: broken, not valid, or with something this reader does not know
    │   ├── AddressError                   a parameter or channel that the scenario does not have
    │   └── EffectError                    an effect's file: unknown key, no parameter, a start beyond its limits
    └── RunError           exit code 3   the run started and cannot be trusted or finished
        ├── StepError                     a unit refused a step, reported an error or gave a value that is not finite
        └── TrustError                      the step control could not hold its tolerance

Anything else that reaches the user as a traceback is a bug. Ctrl-C is exit code 130 and keeps what was computed.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable

EXIT_INTERRUPTED = 130


class OrchestratorError(Exception):
    """One line for the user; `exit_code` is what the command line returns."""

    exit_code = 1


class UserError(OrchestratorError):
    """The request cannot be run as written."""

    exit_code = 2


class ScenarioError(UserError):
    """The scenario file is at fault."""


class UnitError(UserError):
    """A unit, or a value given to it, is at fault."""


class WiringError(UserError):
    """A connection is at fault."""


class MeasuredError(UserError):
    """A folder of measured data is at fault."""


class SspError(UserError):
    """An .ssp is at fault."""


class AddressError(UserError):
    """A parameter or channel is named that the scenario does not have."""


class EffectError(UserError):
    """An effect's file is at fault."""


class RunError(OrchestratorError):
    """The run cannot be finished or trusted; what was computed is kept."""

    exit_code = 3


class StepError(RunError):
    """A unit refused a step at the smallest interval, reported an error, or gave a value that is not finite."""


class TrustError(RunError):
    """The step control could not hold its tolerance often enough."""


def nearest(name: str, known: Iterable[str]) -> str:
    """The ending of a message on an unknown name: `did you mean "x"?`, or the known names when none is near."""
    names = sorted(set(known))
    near = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    if near:
        return f'did you mean "{near[0]}"?'
    if not names:
        return "there are none here"
    shown = ", ".join(names[:12]) + (", ..." if len(names) > 12 else "")
    return f"known here: {shown}"
