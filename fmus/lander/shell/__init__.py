"""The FMI shell: a unit declares its variables as records and says what one interval does; the rest is here."""

from .records import input_, local, output, parameter, state, text
from .unit import Unit, UnitError, nanoseconds

__all__ = ["Unit", "UnitError", "input_", "local", "nanoseconds", "output", "parameter", "state", "text"]
