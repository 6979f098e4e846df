"""What pydantic found wrong with a table -> one line."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from pydantic import ValidationError

from orchestrator.errors import nearest

Path = tuple[int | str, ...]
_UNION_MEMBER = re.compile(r"float|int|str|bool|(list|dict|literal)\[.*\]|constrained-\w+|function-.*")
"""What pydantic puts into a path to say which member of a union it tried."""


def first_fault(error: ValidationError, known_keys: Callable[[Path], Sequence[str]], whole: str = "the scenario") -> str:
    """"place = value: what is wrong". Unknown keys first: a misspelt key is the usual cause of a missing one."""
    faults = sorted(error.errors(), key=lambda fault: fault["type"] != "extra_forbidden")
    fault = faults[0]
    path = tuple(part for part in fault["loc"] if isinstance(part, int) or not _UNION_MEMBER.fullmatch(part))
    place = ".".join(str(part + 1) if isinstance(part, int) else part for part in path) or whole
    if fault["type"] == "extra_forbidden":
        return f"{place}: unknown key; {nearest(str(path[-1]), known_keys(path[:-1]))}"
    if fault["type"] == "missing":
        return f"{place}: is missing; add it"
    message = fault["msg"].removeprefix("Value error, ")
    given = "" if isinstance(fault["input"], dict) else f" = {fault['input']!r}"
    return f"{place}{given}: {message[0].lower()}{message[1:]}"
