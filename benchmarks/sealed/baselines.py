"""Five ways in which models are commonly mended, on the same cases, behind the same glass as the diagnosis:

    python benchmarks/sealed/run.py run --set SET --results RMS --diagnose "python -m sealed.baselines rms"

    rms         every effect at its starts against the base scenario, nothing fitted; the smallest RMS is named
    bic         every effect fitted alone, nuisances at their prior mean; weights from BIC
    sindy       sparse regression of the smoothed residual's rate of change on features of the simulation (needs the extra `bench`)
    gp          a Gaussian process for the discrepancy over time; detects and corrects, names nothing
    shortlist   nuisances fitted without tempering, a score test for every effect, fits of the best five only
"""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_smoothing_spline

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.crew import Counting
from orchestrator.diagnosis.effects import Effect
from orchestrator.diagnosis.fit import Fit, fitted
from orchestrator.diagnosis.problem import Model
from sealed.gaussian_process import likelihood_gain, mean_at
from sealed.handed import Handed
from sealed.truth import STOP
from sealed.vehicle import Vehicle

Array = NDArray[np.float64]
Tree = dict[str, Any]
SURE = 0.9
SHORT = 5  # effects on the shortlist
GAIN = 5.0  # of ln evidence, for something to be missing


def rms(vehicle: Vehicle, fit: Handed, held: Handed) -> Tree:
    """(a) Ranking against a fixed baseline: exp(-χ²/2) taken as weight, as if nothing else were unknown."""
    scores: dict[str, float] = {"": -0.5 * _chi2(fit.model(()), np.zeros(0))}
    best: dict[str, tuple[float, ...]] = {"": ()}
    for effect in vehicle.effects.values():
        model = fit.model(vehicle.coordinates(effect), effect)
        for z in _starts(vehicle, effect):
            score = -0.5 * _chi2(model, np.array(z))
            if score > scores.get(effect.name, -np.inf):
                scores[effect.name], best[effect.name] = score, z
    return _verdict(vehicle, scores, {name: (np.array(z), None) for name, z in best.items()})


def bic(vehicle: Vehicle, fit: Handed, held: Handed) -> Tree:
    """(b) -2 ln L + k ln n."""
    n = fit.observation.size
    scores: dict[str, float] = {"": -0.5 * _chi2(fit.model(()), np.zeros(0))}
    best: dict[str, tuple[Array, Array | None]] = {"": (np.zeros(0), None)}
    for effect in vehicle.effects.values():
        model = fit.model(vehicle.coordinates(effect), effect)
        for z in _starts(vehicle, effect):
            found = _fit(model, np.array(z))
            if found is None:
                continue
            score = -0.5 * found.chi2 - 0.5 * len(found.z) * np.log(n)
            if score > scores.get(effect.name, -np.inf):
                scores[effect.name], best[effect.name] = score, (found.z, np.sqrt(np.diag(found.covariance)))
    return _verdict(vehicle, scores, best)


def shortlist(vehicle: Vehicle, fit: Handed, held: Handed) -> Tree:
    """(e) One untempered fit of the nuisances; the effects' gain to first order there; Laplace evidence of the five best."""
    nuisances = [*fit.nuisances, *vehicle.tolerances()]
    null = _fit(fit.model(nuisances), np.zeros(len(nuisances)), steps=12)
    if null is None:
        return {"verdict": "numerics"}
    columns = {name: _columns(vehicle, fit, nuisances, null, effect) for name, effect in vehicle.effects.items()}
    seen = fit.model(nuisances)
    gains = {name: _score(null, seen.whitened(own, null.predicted)) for name, own in columns.items()}
    scores: dict[str, float] = {"": null.log_evidence}
    best: dict[str, tuple[Array, Array | None]] = {"": (np.zeros(0), None)}
    for name in sorted(gains, key=gains.__getitem__, reverse=True)[:SHORT]:
        effect, count = vehicle.effects[name], len(nuisances)
        model, own = fit.model([*nuisances, *vehicle.coordinates(effect)], effect), range(count, count + len(effect.parameters))
        for start in (np.zeros(len(own)), *map(np.array, _starts(vehicle, effect))):
            z = np.concatenate([null.z, start])
            there = model.predict(z) if start.any() else null.predicted
            if there is None:
                continue
            slopes = model.slopes(z, there, own) if start.any() else columns[name]
            found = fitted(model, z, np.column_stack([null.slopes, slopes]), there, steps=8, renew=tuple(own))
            if found is not None and found.log_evidence > scores.get(name, -np.inf):
                scores[name], best[name] = found.log_evidence, (found.z[count:], np.sqrt(np.diag(found.covariance))[count:])
    return _verdict(vehicle, scores, best)


def gp(vehicle: Vehicle, fit: Handed, held: Handed) -> Tree:
    """(d) One process a channel on the residual of the fitted nuisances; its mean is carried over to the held-out landing."""
    before = after = gain = 0.0
    for track, x, y, sigma in _residuals(fit):
        gained, size, scale = likelihood_gain(x, y, sigma)
        gain += max(gained, 0.0)
        for other, there, left, noise in _residuals(held):
            if other == track:
                carried = mean_at(x, y, sigma, size, scale, there) if gained > 0.0 else np.zeros(len(there))
                before += float(np.sum((left / noise) ** 2)) - len(left)
                after += float(np.sum(((left - carried) / noise) ** 2)) - len(left)
    detected = gain > GAIN
    closure = 1.0 - max(after, 0.0) / before if detected and before > 0.0 else None
    return {"verdict": "none_of_my_effects" if detected else "nothing_missing", "gap": {"closure": closure}}


def sindy(vehicle: Vehicle, fit: Handed, held: Handed) -> Tree:
    """(c) d(ω - ω_simulated)/dt, smoothed, on features of the simulated landing; the port of the largest term is what it says."""
    from pysindy import STLSQ

    features, ports = _features(fit)
    strength = dict.fromkeys(ports, 0.0)
    for track, x, y, sigma in _residuals(fit):
        if not track.startswith("rates."):
            continue
        smooth = make_smoothing_spline(x, y)
        theta = np.column_stack([np.interp(x, features["time"], features[name]) for name in ports])
        theta /= np.maximum(np.abs(theta).max(axis=0), 1e-12)
        found = STLSQ(threshold=3.0 * sigma / max(float(np.ptp(x)), 0.1), alpha=0.05).fit(theta, smooth.derivative()(x)[:, None])
        for name, value in zip(ports, np.ravel(found.coef_).tolist(), strict=True):
            strength[name] += abs(value)
    largest = max(strength, key=strength.__getitem__)
    if strength[largest] == 0.0:
        return {"verdict": "nothing_missing"}
    return {"verdict": "none_of_my_effects", "term": {"port": ports[largest], "name": largest}}


BASELINES: dict[str, Callable[[Vehicle, Handed, Handed], Tree]] = {"rms": rms, "bic": bic, "sindy": sindy, "gp": gp, "shortlist": shortlist}


def _features(fit: Handed) -> tuple[dict[str, Array], dict[str, str]]:
    """Of the scenario at the prior mean: columns over time, and the port each would be a term at."""
    legs = (1, 2, 3, 4)
    ports = {f"soil{i}.penetration": "soil.normal" for i in legs} | {f"soil{i}.skid": "soil.tangential" for i in legs}
    ports |= {f"leg{i}.primary.stroke": "strut" for i in legs} | dict.fromkeys(("rates.yaw", "rates.pitch", "rates.roll"), "body")
    grid = fit.observation.grid(STOP, {}, np.inf)
    course = fit.lander.land(fit.model(()).landings.bases[0], grid, tuple(ports), ())
    if course is None:
        raise ArithmeticError("the scenario cannot be flown at the prior mean")
    grown = {f"d {name}": np.gradient(course.columns[name], course.times) for name in list(ports) if not name.startswith("rates.")}
    ports |= {name: ports[name.removeprefix("d ")] for name in grown}
    return {**{name: course.columns[name] for name in ports if name not in grown}, **grown, "time": course.times}, ports


def _residuals(landing: Handed) -> list[tuple[str, Array, Array, float]]:
    """(channel, s since first contact, data less prediction, sigma), with nuisances and tolerances fitted once."""
    if not hasattr(landing, "fitted_residuals"):
        free = [*landing.nuisances, *landing.vehicle.tolerances()]
        model = landing.model(free)
        found = _fit(model, np.zeros(len(free)), steps=12)
        predicted = found.predicted if found is not None else landing.model(()).predict(np.zeros(0))
        if predicted is None:
            raise ArithmeticError("the scenario cannot be flown at the prior mean")
        values = model.values(found.z, 0) if found is not None else {}
        rows = [
            (track.channel, track.times - landing.observation.late(track, values), landing.observation.raw(predicted, i), track.sigma)
            for i, track in enumerate(landing.observation.tracks)
        ]  # fmt: skip
        landing.fitted_residuals = rows  # type: ignore[attr-defined]
    kept: list[tuple[str, Array, Array, float]] = landing.fitted_residuals  # type: ignore[attr-defined]
    return kept


def _fit(model: Model, z: Array, steps: int = 6) -> Fit | None:
    predicted = model.predict(z)
    if predicted is None:
        return None
    return fitted(model, z, model.slopes(z, predicted), predicted, steps=steps, renew=tuple(range(len(z))))


def _chi2(model: Model, z: Array) -> float:
    predicted = model.predict(z)
    return np.inf if predicted is None else float(np.sum(model.residual(predicted) ** 2))


def _starts(vehicle: Vehicle, effect: Effect) -> list[tuple[float, ...]]:
    """As z."""
    pairs = list(zip(effect.parameters, vehicle.coordinates(effect), strict=True))
    return [tuple((start[it.name] - c.mean) / c.sigma for it, c in pairs) for start in effect.starts]


def _columns(vehicle: Vehicle, fit: Handed, nuisances: Sequence[Coordinate], null: Fit, effect: Effect) -> Array:
    """Slopes of the prediction by an effect's parameters at its null."""
    model, count = fit.model([*nuisances, *vehicle.coordinates(effect)], effect), len(nuisances)
    z = np.concatenate([null.z, np.zeros(len(effect.parameters))])
    return model.slopes(z, null.predicted, range(count, len(z)))


def _score(null: Fit, own: Array) -> float:
    """Gain in ln evidence to first order, nuisances moving along; own: white slopes of an effect."""
    jacobian = np.column_stack([null.jacobian, own])
    hessian = jacobian.T @ jacobian + np.eye(jacobian.shape[1])
    slope = jacobian.T @ null.residual - np.concatenate([null.z, np.zeros(own.shape[1])])
    return float(0.5 * slope @ np.linalg.solve(hessian, slope) - 0.5 * np.linalg.slogdet(hessian)[1])


def _verdict(vehicle: Vehicle, scores: Mapping[str, float], best: Mapping[str, tuple[Array, Array | None]]) -> Tree:
    """The name with 0.9 of the weight, or the smallest set that has it; nothing missing where that is in the set."""
    names = sorted(scores, key=scores.__getitem__, reverse=True)
    weights = np.exp(np.array([scores[name] for name in names]) - scores[names[0]])
    weights /= weights.sum()
    if names[0] == "":
        return {"verdict": "nothing_missing"}
    if weights[0] >= SURE:
        return {"verdict": "effect", "effects": [_named(vehicle.effects[names[0]], vehicle, best[names[0]], float(weights[0]))]}
    count = int(np.searchsorted(np.cumsum(weights), SURE)) + 1
    if "" in names[:count]:
        return {"verdict": "nothing_missing"}
    return {"verdict": "cannot_tell", "cannot_tell": {"names": names[:count], "measure": []}}


def _named(effect: Effect, vehicle: Vehicle, at: tuple[Array, Array | None], probability: float) -> Tree:
    z, spread = at
    coordinates = vehicle.coordinates(effect)
    sigmas = [None] * len(z) if spread is None else (spread * [c.sigma for c in coordinates]).tolist()
    parameters = {
        it.name: {"value": c.value(x), "sigma": s, "unit": it.unit}
        for it, c, x, s in zip(effect.parameters, coordinates, z.tolist(), sigmas, strict=True)
    }  # fmt: skip
    return {"name": effect.name, "title": effect.title, "unit": effect.port, "parameters": parameters, "probability": probability}


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("name", choices=list(BASELINES))
    parser.add_argument("--out", type=Path, default=Path("out"))
    options = parser.parse_args()
    vehicle = Vehicle()
    lander = Counting(vehicle.lander())
    said = BASELINES[options.name](vehicle, Handed(vehicle, Path("fit"), lander), Handed(vehicle, Path("holdout"), lander))
    text = json.dumps({**said, "simulations": lander.flown, "method": options.name}, indent=1)
    (options.out / "diagnosis.json").write_text(text.replace("NaN", "null") + "\n", "utf-8")
    os._exit(0)  # as run.py


if __name__ == "__main__":
    main()
