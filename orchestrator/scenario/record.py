"""Which outputs are kept: globs over "unit.variable"."""

from __future__ import annotations

import fnmatch
from collections.abc import Mapping, Sequence

from orchestrator.errors import ScenarioError, nearest
from orchestrator.master.slave import Interface, Kind, stem

NUMBERS = (Kind.REAL, Kind.INTEGER, Kind.BOOLEAN)
DISCRETE = (Kind.INTEGER, Kind.BOOLEAN)


def matching_outputs(
    patterns: Sequence[str], interfaces: Mapping[str, Interface], where: str, kinds: Sequence[Kind] = NUMBERS
) -> list[list[str]]:
    """Per unit, in the order of the interfaces. A pattern that matches nothing is an error."""
    chosen: list[list[str]] = [[] for _ in interfaces]
    unmatched = dict.fromkeys(patterns)
    for place, (unit, interface) in enumerate(interfaces.items()):
        for variable in interface.of("output"):
            hits = [] if variable.kind not in kinds else [p for p in patterns if matches(p, unit, variable.name)]
            if hits:
                chosen[place].append(variable.name)
                for pattern in hits:
                    unmatched.pop(pattern, None)
    for pattern in unmatched:
        known = [f"{unit}.{stem(v.name)}" for unit, interface in interfaces.items() for v in interface.of("output") if v.kind in kinds]
        raise ScenarioError(f'{where}: "{pattern}" matches no output; {nearest(pattern, known)}')
    return chosen


def matches(pattern: str, unit: str, variable: str) -> bool:
    """Brackets mean an index here, not a set of characters."""
    literal = pattern.replace("[", "[[]")
    return any(fnmatch.fnmatchcase(f"{unit}.{name}", literal) for name in (variable, stem(variable)))
