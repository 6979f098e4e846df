"""Strings on the master's board, which holds numbers: every text met in this process has a number."""

from __future__ import annotations

_TEXTS: list[str] = [""]
_NUMBERS: dict[str, int] = {"": 0}


def number_of(text: str) -> int:
    if text not in _NUMBERS:
        _NUMBERS[text] = len(_TEXTS)
        _TEXTS.append(text)
    return _NUMBERS[text]


def text_of(number: float) -> str:
    return _TEXTS[int(number)]
