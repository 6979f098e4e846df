"""The verdict put to the proof: the real co-simulation flown with what was fitted, and what becomes of the gap.

Five checks. Twin: the search's predictions against the units'; where these agree with finer intervals alone, all is flown with those.
Ablation: without the effect the gap returns. Placebo: the runner-up, equally free, does worse. Energy: nothing unexplained. Interval: half
of it, and of the tolerance, changes nothing that matters; where the scenario's own are too coarse for that, all is flown with finer ones.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from orchestrator.diagnosis.effects.effect import Insert
from orchestrator.diagnosis.flight import CoSimulation, Flight
from orchestrator.diagnosis.observation import EDGE, Observation
from orchestrator.diagnosis.outcome import Gap
from orchestrator.results.channels import Channels
from orchestrator.results.energy import account_of
from orchestrator.scenario.model import MasterTable

Array = NDArray[np.float64]
TWIN_LIMIT = 0.2  # sigma, RMS of a channel: twin against units
NUMERICS_LIMIT = 0.2  # sigma, RMS of a channel: half the interval and the tolerance
ENERGY_LIMIT = 2e-3  # of the energy at the start; the published landings with an effect leave 1e-4 at most
HALVINGS = 3  # of interval and tolerance, to find some under which the next half changes nothing that matters
RETURNS = 0.5  # of what the effect closes: without it the gap returns by this much at least
NULL, WINNER, ABLATED, PLACEBO = "nothing missing", "winner", "without the effect", "runner-up"


@dataclass(frozen=True)
class Observed:
    """A measured landing: `stop` in s since first contact."""

    name: str
    observation: Observation
    stop: float
    holdout: bool = False


@dataclass(frozen=True)
class Belief:
    """A hypothesis as fitted. One entry a landing, in the landings' order; a landing whose entry is missing is not flown."""

    name: str
    values: Sequence[Mapping[str, ArrayLike] | None]
    """By address, for the co-simulation."""
    seen: Sequence[Mapping[str, float]]
    """clock.SERIES and time.origin."""
    inserts: Sequence[Insert] = ()
    predicted: Sequence[Array | None] = ()
    """What the search's lander predicted (`Observation.predicted`), where it did."""


Ask = tuple[str, Belief, int]
"""Role, belief, landing's place."""


@dataclass(frozen=True)
class Flown:
    """One hypothesis in one landing, by the co-simulation."""

    belief: str
    landing: str
    holdout: bool
    chi2: float
    rms: float
    """Of the white residual over all readings."""
    channels: Mapping[str, float]
    """RMS of the white residual of each channel."""
    twin: Mapping[str, float]
    """RMS of the difference to the search's prediction, sigma; empty where there was none."""
    energy: float
    """Unexplained, as a share of the energy at the start; NaN where the scenario keeps no account."""
    reason: str
    """Why it was not flown, or is not to be trusted; empty when all is well."""
    predicted: Array | None = field(default=None, repr=False)


@dataclass(frozen=True)
class Numerics:
    """What half the interval and half the tolerance change, sigma (RMS a channel)."""

    channels: Mapping[str, float]
    ok: bool
    reason: str = ""
    halved: int = 0
    """How often both had been halved before half of them changed so little."""
    settings: Mapping[str, float] = field(default_factory=dict)
    """Of the master, so halved; empty for the scenario's own."""
    own: float = float("nan")
    """The worst channel with the scenario's own."""
    apart: float = float("nan")
    """Sigma by which twin and units differed with both `halved` so often, where the units were flown finer for that."""
    agreed: int = 0
    """How often both had been halved when they agreed; `settings` are those."""

    @property
    def worst(self) -> float:
        return max(self.channels.values(), default=float("nan"))


@dataclass
class Proof:
    """All of it; `gap` and `checks` are for the outcome."""

    flown: list[Flown]
    gap: Gap
    checks: dict[str, Any]
    numerics: Numerics
    warnings: list[str]
    simulations: int
    landings: Sequence[Observed] = field(default=(), repr=False)

    def of(self, belief: str, holdout: bool | None = None) -> list[Flown]:
        return [it for it in self.flown if it.belief == belief and holdout in (None, it.holdout)]


def prove(
    simulation: CoSimulation,
    landings: Sequence[Observed],
    null: Belief,
    winner: Belief | None = None,
    ablated: Belief | None = None,
    runner_up: Belief | None = None,
) -> Proof:
    """Fly them all. ablated: the winner's nuisances without its effect. Without a winner the null alone is proven."""
    before = simulation.flown
    beliefs = [(role, it) for role, it in ((NULL, null), (WINNER, winner), (ABLATED, ablated), (PLACEBO, runner_up)) if it is not None]
    tested = winner or null
    first = next((k for k, values in enumerate(tested.values) if values is not None), 0)
    numerics = numerics_gate(simulation, tested.values[first] or {}, tested.inserts, landings[first], tested.seen[first])
    asked = [(role, it, k) for role, it in beliefs for k in range(len(landings))]
    flown = _all_flown(simulation, landings, asked, numerics)
    nearer = _nearer_to_twin(simulation, landings, asked, flown, numerics)
    if nearer is not numerics:
        numerics, flown = nearer, _all_flown(simulation, landings, asked, nearer)
    gap = _gap(flown, landings)
    checks = _checks(flown, numerics)
    return Proof(flown, gap, checks, numerics, _warnings(checks, flown, numerics), simulation.flown - before, landings)


def numerics_gate(
    simulation: CoSimulation, values: Mapping[str, ArrayLike], inserts: Sequence[Insert], landing: Observed, seen: Mapping[str, float]
) -> Numerics:
    """Flights with the scenario's interval and tolerance, with half of both, and so on until the half changes nothing that matters.

    Where that never comes: what the first half changed.
    """
    master = simulation.addresses.blueprint.scenario.table.master
    usual = _fly(simulation, values, inserts, landing, {})
    found: list[Numerics] = []
    for halved in range(HALVINGS + 1):
        finer = _fly(simulation, values, inserts, landing, {"master": finer_settings(master, halved + 1)})
        if usual.course is None or finer.course is None:
            found.append(Numerics({}, False, usual.reason if usual.course is None else finer.reason))
            break
        rows = [landing.observation.predicted(course, seen) for course in (usual.course, finer.course)]
        channels, distrusted = in_sigmas(landing.observation, rows[1] - rows[0]), usual.reason or finer.reason
        worst = max(channels.values(), default=0.0)
        own = found[0].own if found else worst
        settings = finer_settings(master, halved) if halved else {}
        found.append(Numerics(channels, not distrusted and worst <= NUMERICS_LIMIT, distrusted, halved, settings, own))
        if found[-1].ok or distrusted:
            break
        usual = finer
    return found[-1] if found[-1].ok else found[0]


def _all_flown(simulation: CoSimulation, landings: Sequence[Observed], asked: Sequence[Ask], numerics: Numerics) -> list[Flown]:
    settings = {"master": dict(numerics.settings)} if numerics.settings else {}
    return [one for ask in asked if (one := _flown(simulation, landings, *ask, settings)) is not None]


def _nearer_to_twin(
    simulation: CoSimulation, landings: Sequence[Observed], asked: Sequence[Ask], flown: Sequence[Flown], numerics: Numerics
) -> Numerics:
    """The numerics with which the units agree with the twin where they differ most; the same where they agree anyway, or never do.

    Half an interval may change nothing and an eighth much: with 1, 1/2, 1/4 and 1/8 one landing was 0.43, 0.43, 0.23 and 0.06 sigma off.
    """
    worst = max(flown, key=_apart, default=None)
    if worst is None or not _apart(worst) > TWIN_LIMIT or not numerics.ok:
        return numerics
    ask = next((role, it, k) for role, it, k in asked if (role, landings[k].name) == (worst.belief, worst.landing))
    master = simulation.addresses.blueprint.scenario.table.master
    for halved in range(numerics.halved + 1, HALVINGS + 1):
        finer = replace(numerics, agreed=halved, settings=finer_settings(master, halved), apart=_apart(worst))
        again = _all_flown(simulation, landings, [ask], finer)
        if again and not again[0].reason and _apart(again[0]) <= TWIN_LIMIT:
            return finer
    return numerics


def _apart(flown: Flown) -> float:
    """Sigma by which twin and units differ in the worst channel; 0 where nothing was compared."""
    return max(flown.twin.values(), default=0.0)


def finer_settings(master: MasterTable, halved: int) -> dict[str, float]:
    """The master's interval and tolerance, halved so often; its least interval where the greatest comes below it."""
    share = 0.5**halved
    greatest = share * master.max_interval
    return {"max_interval": greatest, "tolerance": share * master.tolerance, "min_interval": min(master.min_interval, greatest)}


def in_sigmas(observation: Observation, difference: Array) -> dict[str, float]:
    """RMS of a difference of two predictions in standard deviations of the noise, channel by channel and reading by reading."""
    count = len(observation.tracks)
    tracks = zip(observation.tracks, observation.noises, observation.places, strict=False)
    found = {track.channel: _rms(difference[place] / noise.sigma) for track, noise, place in tracks}
    for reading, place in zip(observation.readings, observation.places[count:], strict=True):
        sigma = reading.edge / EDGE if reading.interval else reading.sigma  # the width, of an open one its end
        found[reading.name] = _rms(difference[place] / sigma)
    return found


def _fly(
    simulation: CoSimulation, values: Mapping[str, ArrayLike], inserts: Sequence[Insert], landing: Observed, settings: dict[str, Any]
) -> Flight:
    observation = landing.observation
    return simulation.fly(values, inserts, landing.stop, observation.columns, observation.final, settings)


def _flown(
    simulation: CoSimulation, landings: Sequence[Observed], role: str, belief: Belief, k: int, settings: dict[str, Any]
) -> Flown | None:
    values = belief.values[k] if k < len(belief.values) else None
    if values is None:
        return None
    landing, nan = landings[k], float("nan")
    flight = _fly(simulation, values, belief.inserts, landing, settings)
    if flight.course is None:
        return Flown(role, landing.name, landing.holdout, nan, nan, {}, {}, nan, flight.reason or "not flown to the end")
    observation = landing.observation
    predicted = observation.predicted(flight.course, belief.seen[k])
    residual = observation.residual(predicted)
    searched = belief.predicted[k] if k < len(belief.predicted) else None
    twin = {} if searched is None else in_sigmas(observation, predicted - searched)
    channels, energy = _by_label(observation, residual), _unexplained(simulation, flight)
    chi2 = float(residual @ residual)
    return Flown(role, landing.name, landing.holdout, chi2, _rms(residual), channels, twin, energy, flight.reason, predicted)


def _by_label(observation: Observation, residual: Array) -> dict[str, float]:
    labels = np.array(observation.labels)
    return {label: _rms(residual[labels == label]) for label in dict.fromkeys(observation.labels)}


def _unexplained(simulation: CoSimulation, flight: Flight) -> float:
    """Share of the energy at the start that nobody can explain."""
    result = flight.result
    account = None if result is None else account_of(Channels(result.times, result.columns), simulation.addresses.results)
    share = None if account is None else account.summary()["residual_fraction"]
    return float("nan") if share is None else abs(share)


def _gap(flown: Sequence[Flown], landings: Sequence[Observed]) -> Gap:
    """Closure counts what chi-square has beyond its readings, on the held-out landings where there are any."""
    rms = {(role, held): _pooled(flown, landings, role, held) for role in (NULL, WINNER) for held in (False, True)}
    judged = any(it.holdout for it in landings)
    excess = {role: _excess(flown, landings, role, judged) for role in (NULL, WINNER)}
    closure = 1.0 - max(excess[WINNER], 0.0) / excess[NULL] if excess[NULL] > 0.0 else float("nan")
    return Gap(rms[NULL, False], rms[WINNER, False], rms[NULL, True], rms[WINNER, True], closure)


def _pooled(flown: Sequence[Flown], landings: Sequence[Observed], role: str, held: bool) -> float:
    chosen = [it for it in flown if it.belief == role and it.holdout == held]
    sizes = {it.name: it.observation.size for it in landings}
    return float(np.sqrt(sum(it.chi2 for it in chosen) / sum(sizes[it.landing] for it in chosen))) if chosen else float("nan")


def _excess(flown: Sequence[Flown], landings: Sequence[Observed], role: str, held: bool) -> float:
    sizes = {it.name: it.observation.size for it in landings}
    chosen = [it.chi2 - sizes[it.landing] for it in flown if it.belief == role and it.holdout == held]
    return float(sum(chosen)) if chosen else float("nan")


def _total(flown: Sequence[Flown], role: str) -> float:
    chosen = [it.chi2 for it in flown if it.belief == role]
    return float(sum(chosen)) if chosen else float("nan")


def _checks(flown: Sequence[Flown], numerics: Numerics) -> dict[str, Any]:
    """Numbers, and `ok` for each check that could be made."""
    chi2 = {role: _total(flown, role) for role in (NULL, WINNER, ABLATED, PLACEBO)}
    twin: dict[str, float] = {}
    for it in flown:
        for channel, sigmas in it.twin.items():
            twin[channel] = max(sigmas, twin.get(channel, 0.0))
    energies = [it.energy for it in flown if np.isfinite(it.energy)]
    interval = {"channels": dict(numerics.channels), "worst": numerics.worst, "halved": numerics.halved, "ok": numerics.ok}
    checks: dict[str, Any] = {"chi2": chi2, "interval": interval}
    if twin:
        worst = max(twin.values())
        checks["twin"] = {"channels": twin, "worst": worst, "ok": worst <= TWIN_LIMIT}
    if energies:
        checks["energy"] = {"worst": max(energies), "limit": ENERGY_LIMIT, "ok": max(energies) <= ENERGY_LIMIT}
    if np.isfinite(chi2[ABLATED]):
        closed, returned = chi2[NULL] - chi2[WINNER], chi2[ABLATED] - chi2[WINNER]
        enough = returned > RETURNS * max(closed, 0.0) and returned > 0.0
        checks["ablation"] = {"chi2_returns": returned, "chi2_closed": closed, "ok": enough}
    if np.isfinite(chi2[PLACEBO]):
        both = {it.landing for it in flown if it.belief == PLACEBO}  # a runner-up need not have been fitted to the held-out landings
        more = chi2[PLACEBO] - _total([it for it in flown if it.landing in both], WINNER)
        checks["placebo"] = {"chi2_more": more, "ok": more > 0.0}
    return checks


def _warnings(checks: Mapping[str, Any], flown: Sequence[Flown], numerics: Numerics) -> list[str]:
    said = [f"{it.belief}, {it.landing}: {it.reason}" for it in flown if it.reason]
    if numerics.halved:
        said.append(
            f"half the scenario's interval and tolerance move a channel by {numerics.own:.2f} sigma: flown with "
            f"{0.5**numerics.halved:g} of both, half of which moves {numerics.worst:.2f} sigma"
        )
    if numerics.agreed:
        share = f"{0.5**numerics.halved:g} of " if numerics.halved else ""
        said.append(
            f"twin and units differ by {numerics.apart:.2f} sigma with {share}the scenario's interval and tolerance, though half of them "
            f"changes nothing: flown with {0.5**numerics.agreed:g} of both"
        )
    words = {
        "twin": "twin and units differ by {worst:.2f} sigma: the search's own numbers are not exact",
        "energy": "{worst:.2%} of the energy is unexplained, expects at most {limit:.1%}",
        "interval": "half the interval and tolerance move a channel by {worst:.2f} sigma: the simulation is not resolved"
        if numerics.channels
        else f"whether half the interval and tolerance change anything is not known: {numerics.reason}",
        "ablation": "without the effect chi-square rises by {chi2_returns:.1f} only: other parameters can do what it does",
        "placebo": "the runner-up does as well in the co-simulation (chi-square {chi2_more:+.1f})",
    }
    return said + [text.format(**checks[name]) for name, text in words.items() if name in checks and not checks[name]["ok"]]


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else 0.0
