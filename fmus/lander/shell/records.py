"""Records: a variable is declared once, with its start value, its unit and its meaning.

A tuple or list as start value makes a vector, `name[1]`, `name[2]`, ...; a number makes a scalar. A matrix is a vector
of its rows. Companions follow their variable at once, in this order: an input's `_slope` and `_added`, an output's
`_mean` and `_slope`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from .unit_strings import rate_of

Start = float | bool | Sequence[float]


@dataclass(frozen=True)
class Record:
    """One variable of a unit, scalar or vector, before it gets its place in the memory."""

    name: str
    start: tuple[float, ...]
    vector: bool
    unit: str
    description: str
    causality: str  # parameter, input, output, local; state: hidden, saved with the FMU state
    kind: str = "Real"  # Real, Integer, Boolean, String
    minimum: float | None = None
    maximum: float | None = None
    nominal: float | None = None
    depends: tuple[str, ...] = ()  # inputs that an output at a communication point depends on at that same point
    initially: tuple[str, ...] | None = None  # what its initial value depends on; None: all parameters, the unit's `initially`, depends
    companions: tuple[str, ...] = ()

    def expanded(self) -> list["Record"]:
        """The record and its companions, in the order of memory."""
        plain = replace(self, companions=())
        return [plain, *(plain.companion(which) for which in self.companions)]

    def companion(self, which: str) -> "Record":
        """The record of `x_slope`, `x_mean` or `x_added`."""
        name, zeros = f"{self.name}_{which}", (0.0,) * len(self.start)
        if which == "slope":
            when = "coming" if self.causality == "input" else "last"
            text = f"slope of {self.name} over the {when} interval"
            return replace(
                self, name=name, start=zeros, unit=rate_of(self.unit), description=text, minimum=None, maximum=None, nominal=None
            )
        if which == "mean":
            return replace(self, name=name, start=zeros, description=f"mean of {self.name} over the last interval")
        text = f"added to {self.name}: a socket for another effect"
        return replace(self, name=name, start=zeros, description=text, minimum=None, maximum=None)


def record(causality: str, name: str, start: Start, unit: str, description: str, **rest: object) -> Record:
    """A record from a start value that may be a number or a sequence."""
    vector = isinstance(start, Sequence)
    values = tuple(float(x) for x in start) if isinstance(start, Sequence) else (float(start),)
    return Record(name, values, vector, unit, description, causality, **rest)  # type: ignore[arg-type]


def kind_of(integer: bool, boolean: bool) -> str:
    """The FMI type of a variable."""
    return "Integer" if integer else "Boolean" if boolean else "Real"


def parameter(
    name: str,
    start: Start,
    unit: str,
    description: str,
    *,
    minimum: float | None = None,
    maximum: float | None = None,
    nominal: float | None = None,
    integer: bool = False,
    boolean: bool = False,
) -> Record:
    """A parameter: set before or during initialisation, fixed afterwards."""
    return record(
        "parameter", name, start, unit, description, minimum=minimum, maximum=maximum, nominal=nominal, kind=kind_of(integer, boolean)
    )


def text(name: str, description: str) -> Record:
    """A String parameter, empty unless set; it keeps a place in the memory for its reference alone, and is not in the state."""
    return record("parameter", name, 0.0, "", description, kind="String")


def input_(
    name: str,
    start: Start,
    unit: str,
    description: str,
    *,
    minimum: float | None = None,
    maximum: float | None = None,
    nominal: float | None = None,
    integer: bool = False,
    boolean: bool = False,
    slope: bool = False,
    added: bool = False,
) -> Record:
    """An input: its value at the start of the coming interval. `slope` adds `x_slope`, `added` the socket `x_added`."""
    companions = ("slope",) * slope + ("added",) * added
    return record(
        "input",
        name,
        start,
        unit,
        description,
        minimum=minimum,
        maximum=maximum,
        nominal=nominal,
        kind=kind_of(integer, boolean),
        companions=companions,
    )


def output(
    name: str,
    start: Start,
    unit: str,
    description: str,
    *,
    minimum: float | None = None,
    maximum: float | None = None,
    nominal: float | None = None,
    integer: bool = False,
    boolean: bool = False,
    mean: bool = False,
    slope: bool = False,
    depends: Sequence[str] = (),
    initially: Sequence[str] | None = None,
) -> Record:
    """An output: its value at the end of the last interval. `mean` and `slope` add `x_mean` and `x_slope` over it."""
    companions = ("mean",) * mean + ("slope",) * slope
    return record(
        "output",
        name,
        start,
        unit,
        description,
        minimum=minimum,
        maximum=maximum,
        nominal=nominal,
        kind=kind_of(integer, boolean),
        depends=tuple(depends),
        initially=None if initially is None else tuple(initially),
        companions=companions,
    )


def local(
    name: str, start: Start, unit: str, description: str, *, nominal: float | None = None, integer: bool = False, boolean: bool = False
) -> Record:
    """A quantity to look at, which nothing is connected to."""
    return record("local", name, start, unit, description, nominal=nominal, kind=kind_of(integer, boolean))


def state(name: str, start: Start, description: str = "") -> Record:
    """A hidden state: not in the model description, saved and restored with all the rest."""
    return record("state", name, start, "1", description)
