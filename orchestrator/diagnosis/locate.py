"""Where on the time axis simulation and data disagree: windows whose residual is larger than noise makes it, chance corrected."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2 as chi_square
from scipy.stats import norm

from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.outcome import Where
from orchestrator.diagnosis.problem import Landings

Array = NDArray[np.float64]
WIDTHS = (0.1, 0.2, 0.4, 0.8)  # s
SIGNIFICANT = 3.0  # sigmas after the correction
FEWEST = 4  # samples a window


def located(
    fit: Fit, landings: Landings, rivals: Mapping[str, Fit], ports: Mapping[str, tuple[str, str]], names: Sequence[str] = ()
) -> list[Where]:
    """Windows of disagreement of a fit, strongest first, none overlapping another of its channel; readings at rest too.

    rivals   other fits by name; a window goes to the port of the one that explains most of it
    ports    name -> (port, kind of unit)
    names    of the landings, where there are several
    """
    windows = _windows(landings)
    found = []
    for landing, channel, start, end, rows in windows:
        r = fit.residual[rows]
        p = min(float(chi_square.sf(r @ r, len(r))), float(2.0 * norm.sf(abs(r.sum()) / np.sqrt(len(r)))) * 2.0)
        sigmas = float(norm.isf(min(0.5, max(p, 1e-300) * len(windows))))
        if sigmas > SIGNIFICANT:
            port, unit = _explained_by(rows, fit, rivals, ports)
            found.append((sigmas, Where(channel, start, end, unit, port, round(sigmas, 1), names[landing] if names else "")))
    found.sort(key=lambda pair: -pair[0])
    kept: list[Where] = []
    for _, one in found:
        if not any(_overlap(one, other) for other in kept):
            kept.append(one)
    return kept


def _overlap(one: Where, other: Where) -> bool:
    same = (one.channel, one.landing) == (other.channel, other.landing)
    return same and one.to_s > other.from_s and one.from_s < other.to_s


def _windows(landings: Landings) -> list[tuple[int, str, float, float, Array]]:
    """(landing, channel, from, to in s since first contact, rows): windows of every track, half overlapping; and every reading."""
    windows: list[tuple[int, str, float, float, Array]] = []
    for k, (observation, part) in enumerate(zip(landings.observations, landings.parts, strict=True)):
        for track, place in zip(observation.tracks, observation.places, strict=False):
            if len(track.times) < FEWEST:
                continue
            times = track.times - observation.shift
            rows = np.arange(part.start + place.start, part.start + place.stop)
            for width in WIDTHS:
                for start in np.arange(times[0], times[-1] - 0.5 * width, 0.5 * width).tolist():
                    inside = (times >= start) & (times < start + width)
                    if int(inside.sum()) >= FEWEST:
                        windows.append((k, track.channel, round(start, 4), round(min(start + width, float(times[-1])), 4), rows[inside]))
        for reading, place in zip(observation.readings, observation.places[len(observation.tracks) :], strict=True):
            end = float(landings.stop[k])
            windows.append((k, reading.name, end, end, np.array([part.start + place.start])))
    return windows


def _explained_by(rows: Array, fit: Fit, rivals: Mapping[str, Fit], ports: Mapping[str, tuple[str, str]]) -> tuple[str, str]:
    before = float(np.square(fit.residual[rows]).sum())
    left = {name: float(np.square(rival.residual[rows]).sum()) for name, rival in rivals.items() if name in ports}
    if not left:
        return "", ""
    best = min(left, key=lambda name: left[name])
    return ports[best] if left[best] < 0.5 * before else ("", "")
