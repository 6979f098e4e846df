"""report.html: one file to read from top to bottom, with its figures and courses beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from orchestrator.diagnosis.outcome import Outcome
from orchestrator.diagnosis.report import words
from orchestrator.diagnosis.report.course_files import write_courses
from orchestrator.diagnosis.report.courses import LandingCourses
from orchestrator.diagnosis.report.file_names import FileNames
from orchestrator.diagnosis.report.picture import Picture
from orchestrator.diagnosis.report.plot_courses import course_picture
from orchestrator.diagnosis.report.plot_dots import pull_picture, rest_picture
from orchestrator.diagnosis.report.plot_rivals import ranked, rivals_picture
from orchestrator.diagnosis.report.plot_where import where_picture
from orchestrator.diagnosis.report.template import flat, in_words, is_known, render

FIGURES = "figures"
Section = tuple[str, str, list[tuple[str, list[Picture], Picture | None]]]


def write_report(folder: Path, outcome: Outcome, courses: Sequence[LandingCourses]) -> Path:
    """report.html, figures/*.png, courses/*.csv and diagnosis.json in `folder`; the path of the page."""
    folder.mkdir(parents=True, exist_ok=True)
    outcome.sentence = words.verdict_sentence(outcome)
    outcome.write(folder)
    if courses:
        write_courses(folder, courses)
    names = FileNames()
    pictures: dict[str, Any] = {
        "where": _where(outcome, courses, names),
        "rivals": rivals_picture(outcome.candidates, {e.name for e in outcome.effects}, names.stem("rivals")),
        "pulls": pull_picture(outcome.nuisances, names.stem("nuisances")),
        "sections": [s for s in (_section(courses, "fit", names), _section(courses, "holdout", names)) if s],
    }
    files = _save(folder / FIGURES, pictures)
    path = folder / "report.html"
    path.write_text(render("page.html.jinja", **_told(outcome), **pictures, files=files), "utf-8")
    return path


def _told(outcome: Outcome) -> dict[str, Any]:
    """All that stands in words and tables."""
    strength = [w for w in outcome.where if is_known(w.sigmas)]
    return {
        "o": outcome,
        "sentence": outcome.sentence,
        "label": words.LABELS[outcome.verdict],
        "caution": words.caution(outcome),
        "next": words.next_step(outcome),
        "command": words.command(outcome),
        "by_whom": words.by_whom(outcome),
        "undecided": words.listed(words.undecided(outcome)),
        "gaps": _gaps(outcome),
        "windows": sorted(strength, key=lambda w: -w.sigmas) + [w for w in outcome.where if not is_known(w.sigmas)],
        "candidates": ranked(outcome.candidates),
        "named": {e.name for e in outcome.effects},
        "term": flat(outcome.term),
        "checks": [_check(name, value) for name, value in outcome.checks.items()],
        "origin": _origin(outcome),
        "effect_title": lambda name: words.title_of(outcome, name),
    }


def _gaps(outcome: Outcome) -> list[tuple[str, float, float]]:
    gap = outcome.gap
    rows = [("Distance from the data, fitted landings", gap.fit_before, gap.fit_after)]
    rows.append(("Distance from the data, held-out landings", gap.holdout_before, gap.holdout_after))
    return [row for row in rows if is_known(row[1])]


def _check(name: str, value: Any) -> tuple[str, str, bool | None]:
    """A row: what was checked, what came out, whether it passed where that is told."""
    title = name.replace("_", " ")
    if isinstance(value, bool):
        return title, "", value
    if isinstance(value, Mapping):
        passed = value.get("ok")
        rest = {key: item for key, item in value.items() if key != "ok"}
        return title, in_words(rest), passed if isinstance(passed, bool) else None
    return title, in_words(value), None


def _origin(outcome: Outcome) -> list[tuple[str, str]]:
    rows = [("scenario", outcome.scenario or "–"), ("measured", in_words(outcome.measured)), ("held out", in_words(outcome.holdout))]
    return rows + flat(outcome.provenance)


def _where(outcome: Outcome, courses: Sequence[LandingCourses], names: FileNames) -> list[tuple[str, Picture]]:
    """A strip chart a landing that has windows; windows of no named landing belong to the first."""
    known = {landing.name for landing in courses}
    first = courses[0].name if courses else ""
    owners = [w.landing if w.landing in known else first for w in outcome.where]
    shown = [landing for landing in courses if landing.name in owners] or list(courses[:1])
    found: list[tuple[str, Picture]] = []
    everything: list[LandingCourses | None] = [*shown] or [None]
    for landing in everything:
        windows = [w for w, owner in zip(outcome.where, owners, strict=True) if owner == (landing.name if landing else "")]
        stem = names.stem("where") if not found or landing is None else names.stem("where", landing.name)
        picture = where_picture(windows, landing, outcome.events if landing is None or landing is courses[0] else {}, stem)
        if picture:
            found.append((landing.heading if landing else "", picture))
    return found


def _section(courses: Sequence[LandingCourses], kind: str, names: FileNames) -> Section | None:
    chosen = [landing for landing in courses if landing.kind == kind and (landing.channels or landing.rest)]
    if not chosen:
        return None
    rows = []
    for landing in chosen:
        pictures = [course_picture(names.stem(landing.name, series), landing, series) for series in landing.series]
        stem = names.stem("rest") if kind == "fit" and landing is chosen[0] else names.stem(landing.name, "rest")
        rows.append((landing.heading, pictures, rest_picture(landing.rest, stem) if landing.rest else None))
    if kind == "fit":
        compared = any(c.after is not None for landing in chosen for c in landing.channels)
        compared = compared or any(value.after is not None for landing in chosen for value in landing.rest)
        return "Before and after" if compared else "Simulation and data", "The landings the search was fitted to.", rows
    remark = "What was found elsewhere is carried over; only what is uncertain of this landing itself is fitted."
    return "On landings it was not fitted to", remark, rows


def _save(folder: Path, pictures: Mapping[str, Any]) -> list[str]:
    """All PNG files; their stems."""
    folder.mkdir(parents=True, exist_ok=True)
    every = [picture for _, picture in pictures["where"]] + [pictures["rivals"], pictures["pulls"]]
    for _, _, landings in pictures["sections"]:
        for _, own, rest in landings:
            every += [*own, rest]
    kept = [picture for picture in every if picture is not None]
    for picture in kept:
        picture.save(folder)
    return [picture.name for picture in kept]
