"""`orchestrator distinguish`: before any diagnosis, which effects these data could tell apart, and which more sensor would help.

What counts of the data are sample times, sigmas and priors; of the readings only when the clock has first contact. Linear in the
nuisances about their prior means (docs/diagnosis.md), so it says what to expect of a diagnosis, not what a diagnosis would say.
"""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from orchestrator.blueprint import draw_up, read_scenario
from orchestrator.diagnosis.coordinates import clipped
from orchestrator.diagnosis.crew import Crew
from orchestrator.diagnosis.diagnose import Request, Told, beside_scenarios, library
from orchestrator.diagnosis.effects.effect import Effect
from orchestrator.diagnosis.hypothesis import Hypothesis
from orchestrator.diagnosis.likeness import Flown, Signature, cosines, groups, just_shows, signature
from orchestrator.diagnosis.measured import read_measured
from orchestrator.diagnosis.more_sensors import SENSORS, Equipped, Sensor, equipped
from orchestrator.diagnosis.problem import Model, Nobody
from orchestrator.diagnosis.report.distinction import ENOUGH, Distinction, EffectSeen, MoreSensor
from orchestrator.diagnosis.setup import Setup, set_up
from orchestrator.diagnosis.stages import align
from orchestrator.diagnosis.tasks.predict import Predict, Slopes
from orchestrator.errors import MeasuredError, UserError

Array = NDArray[np.float64]


def distinguish(request: Request, told: Told | None = None) -> tuple[Distinction, dict[str, str]]:
    """The table, and effects left out with the reason. request.seed: 0 at the prior means, another at a draw of the priors."""
    began = perf_counter()
    blueprint = draw_up(read_scenario(request.scenario, request.overrides), request.scenario)
    measured, effects = [read_measured(p) for p in request.measured], library(request)
    setup = set_up(blueprint, measured, effects, beside_scenarios("tolerances.toml"), request.overrides)
    crew = Crew(setup.make, request.workers)
    try:
        complaint = align(setup, crew)
        if complaint:
            raise MeasuredError(complaint)
        with_all = equipped(setup.landings, () if setup.why_slow else SENSORS)
        jacobian, flown = fly(setup, with_all, crew, request.seed, told)
    finally:
        crew.close()
    table = distinction(jacobian, flown, setup.hypotheses, effects, with_all)
    table.scenario, table.measured = str(request.scenario), [str(p) for p in request.measured]
    table.simulations, table.seconds = crew.flown, perf_counter() - began
    return table, setup.skipped


def fly(setup: Setup, with_all: Equipped, crew: Crew, seed: int, told: Told | None = None) -> tuple[Array, list[Flown]]:
    """White slopes of nuisances and tolerances, and what was flown of every effect, over all rows."""
    told = told or (lambda stage, best, share: None)
    landings, base = with_all.landings, (*setup.nuisances, *setup.tolerances)
    soft = np.arange(len(base)) < len(setup.nuisances)
    z = np.where(soft, np.random.default_rng(seed).standard_normal(len(base)), 0.0) if seed else np.zeros(len(base))
    (null,) = crew.run([Predict(landings, base, (z,))])[0]
    if null is None:
        raise UserError(f"{setup.addresses.where}: cannot be flown from the priors of {', '.join(setup.names)}; check the priors")
    tasks = [Slopes(landings, base, z, null, (i,)) for i in range(len(base))]
    columns = crew.run(tasks, lambda done, of: told("nuisances", "", done / of))
    model = Model(landings, base, Nobody())
    jacobian = model.whitened(np.column_stack(columns), null)
    effects = [(*base, *h.coordinates) for h in setup.hypotheses]
    own = [range(len(base), len(coordinates)) for coordinates in effects]
    at_null = [np.append(z, np.zeros(len(which))) for which in own]
    slopes = crew.run(
        [Slopes(landings, c, x, null, tuple(w)) for c, x, w in zip(effects, at_null, own, strict=True)],
        lambda done, of: told("slopes of effects", "", done / of),
    )
    found = [_Trial(h, model.whitened(s, null), with_all.measured, jacobian) for h, s in zip(setup.hypotheses, slopes, strict=True)]
    there = crew.run(
        [Predict(landings, c, tuple(np.append(z, point) for point in trial.points)) for c, trial in zip(effects, found, strict=True)],
        lambda done, of: told("effects", "", done / of),
    )
    return jacobian, [trial.flown(model, null, rows) for trial, rows in zip(found, there, strict=True)]


class _Trial:
    """One effect to be flown at its starts and, by its slopes, where it just shows."""

    def __init__(self, h: Hypothesis, slopes: Array, measured: Array, jacobian: Array) -> None:
        self.name, self.slopes = h.name, slopes
        self.one_sided = all(c.positive for c in h.coordinates)
        shows = just_shows(slopes[measured], jacobian[measured], self.one_sided)
        self.points = [*map(np.asarray, h.scaled_starts()), *([] if shows is None else [clipped(h.coordinates, shows)])]

    def flown(self, model: Model, null: Array, rows: Sequence[Array | None]) -> Flown:
        unflown = np.full(len(null), np.nan)
        changes = [unflown if row is None else model.whitened((row - null)[:, None], null)[:, 0] for row in rows]
        points = np.array(self.points).reshape(-1, self.slopes.shape[1])
        return Flown(self.name, self.slopes, np.column_stack(changes), points, self.one_sided)


def distinction(
    jacobian: Array, flown: Sequence[Flown], hypotheses: Sequence[Hypothesis], effects: dict[str, Effect], with_all: Equipped
) -> Distinction:
    """The table of the data as they are, and what every sensor would change in it."""
    signatures, cosine, alike = _judged(jacobian, flown, with_all.measured)
    known = {h.name: h for h in hypotheses}
    table = Distinction("", [], [_seen(s, known[s.name], effects) for s in signatures], cosine, alike)
    for sensor, rows in with_all.rows.items():
        table.sensors.append(_more(table, sensor, _judged(jacobian, flown, np.concatenate([with_all.measured, rows]))))
    table.sensors.sort(key=lambda s: -(len(s.splits) + len(s.reveals)))
    return table


Judged = tuple[list[Signature], Array, list[list[str]]]


def _judged(jacobian: Array, flown: Sequence[Flown], rows: Array) -> Judged:
    """Signatures, cosines and groups by these rows."""
    here = jacobian[rows]
    signatures = [signature(one.part(rows), here) for one in flown]
    cosine = cosines(signatures, here)
    return signatures, cosine, groups([s.name for s in signatures], cosine, [s.energy for s in signatures])


def _seen(s: Signature, h: Hypothesis, effects: dict[str, Effect]) -> EffectSeen:
    place = int(np.argmax(np.abs(s.direction)))
    c = h.coordinates[place]
    title = effects[s.name].title if s.name in effects else s.name
    return EffectSeen(s.name, title, s.energy, float(c.sigma * abs(s.direction[place]) * s.shows), c.unit, c.name)


def _more(table: Distinction, sensor: Sensor, judged: Judged) -> MoreSensor:
    """Groups of the table that fall apart, each as the names that no longer stand with its first; effects that come above ENOUGH."""
    signatures, _, alike = judged
    splits = []
    for group in table.groups:
        left = [name for name in group if any(name in other and len(set(other) & set(group)) > 1 for other in alike)]
        parted = [name for name in group if name not in left]
        pieces = [sorted(set(other) & set(group)) for other in alike if len(set(other) & set(group)) > 1]
        if parted or len(pieces) > 1:
            splits.append([*parted, *(" + ".join(piece) for piece in pieces)])
    before = {e.name: e.lambda_ for e in table.effects}
    reveals = [s.name for s in signatures if s.energy >= ENOUGH > before[s.name]]
    return MoreSensor(sensor.name, sensor.sigma, sensor.unit, splits, reveals)
