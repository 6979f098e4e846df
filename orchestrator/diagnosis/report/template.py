"""HTML from templates: what the pages share. Everything but pictures and styles is escaped."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup

from orchestrator.diagnosis.report import numbers, words


def render(template: str, **names: Any) -> str:
    """A template of this package, filled."""
    environment = Environment(
        loader=PackageLoader("orchestrator.diagnosis.report", "."),
        autoescape=select_autoescape(("html", "jinja"), default_for_string=True, default=True),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "num": _number,
        "count": _count,
        "chance": _chance,
        "unbroken": unbroken,
        "pm": _with_sigma,
        "share": _share,
        "plus": _plus,
        "p": _probability,
        "unit": numbers.spelt,
        "si": words.unit_of,
        "known": is_known,
    }
    environment.filters["effect"] = names.pop("effect_title", str)
    environment.globals["ratio"] = ratio
    css = environment.loader.get_source(environment, "page.css")[0] if environment.loader else ""
    return environment.get_template(template).render(css=css, **names)


def is_known(value: Any) -> bool:
    """Whether it is a finite number."""
    return isinstance(value, (int, float, np.number)) and isfinite(value)


def ratio(one: Any, other: Any) -> float | None:
    return one / other if is_known(one) and is_known(other) and other else None


def unbroken(text: str) -> str:
    """No line ends before a percent sign or at a plus-minus."""
    return text.replace(" %", "\u00a0%").replace(" ± ", "\u00a0±\u00a0")


def flat(tree: Mapping[str, Any], before: str = "") -> list[tuple[str, str]]:
    """Rows of a table from nested names, a level joined to the next by a comma."""
    rows: list[tuple[str, str]] = []
    for key, value in tree.items():
        name = f"{before}, {key}" if before else str(key).replace("_", " ")
        if isinstance(value, Mapping) and not _is_estimate(value):
            rows += flat(value, name)
        else:
            rows.append((name, in_words(value)))
    return rows


def _is_estimate(value: Mapping[str, Any]) -> bool:
    return is_known(value.get("value")) and is_known(value.get("sigma"))


def in_words(value: Any) -> str:
    """A number, a truth, a list, a text."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if value is None or isinstance(value, (float, np.floating)):
        text = numbers.number(None if value is None else float(value), 4)
        return text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text
    if isinstance(value, (list, tuple)):
        return ", ".join(in_words(item) for item in value) or numbers.NONE
    if isinstance(value, Mapping):
        if _is_estimate(value):
            return f"{numbers.with_sigma(value['value'], value['sigma'])} {numbers.spelt(str(value.get('unit', '1')))}".rstrip()
        return ", ".join(f"{str(key).replace('_', ' ')} {in_words(item)}" for key, item in value.items()) or numbers.NONE
    return str(value)


def _data(value: Any, text: str) -> Markup:
    """The rounded number for the eye, with the full one behind it."""
    if not is_known(value):
        return Markup("<span>{}</span>").format(text)
    return Markup('<data value="{}">{}</data>').format(repr(value if isinstance(value, int) else float(value)), text)


def _number(value: Any, digits: int = 3) -> Markup:
    return _data(value, numbers.number(value, digits) if is_known(value) else numbers.NONE)


def _with_sigma(value: Any, sigma: Any) -> Markup:
    known = sigma if is_known(sigma) else None
    return _data(value, numbers.with_sigma(value if is_known(value) else None, known))


def _count(value: Any) -> Markup:
    return _data(value, f"{value:,.0f}".replace(",", "\u202f") if is_known(value) else numbers.NONE)


def _chance(value: Any) -> Markup:
    return _data(value, numbers.chance(value if is_known(value) else None))


def _share(value: Any) -> Markup:
    return _data(value, numbers.percent(value if is_known(value) else None))


def _plus(value: Any) -> Markup:
    return _data(value, numbers.signed(value if is_known(value) else None))


def _probability(value: Any) -> Markup:
    return _data(value, numbers.probability_of_residual(value if is_known(value) else None))
