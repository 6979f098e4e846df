"""From a scenario, folders of measured data and a library to the search's own terms: landings, nuisances, tolerances, hypotheses."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from orchestrator.blueprint import Blueprint
from orchestrator.diagnosis.addresses import Addresses
from orchestrator.diagnosis.coordinates import SHARED, Coordinate, Operation
from orchestrator.diagnosis.effects.effect import Effect, Parameter
from orchestrator.diagnosis.hypothesis import Hypothesis
from orchestrator.diagnosis.landing import Lander
from orchestrator.diagnosis.measured.channels import CANONICAL
from orchestrator.diagnosis.measured.landing import Measured, Prior, Scalar
from orchestrator.diagnosis.measured.units import UNITS
from orchestrator.diagnosis.observation import CLOCK, ORIGIN, SEEN, Observation, Reading, Track
from orchestrator.diagnosis.problem import Landings
from orchestrator.diagnosis.recorded import recorded_unit, twin_column
from orchestrator.diagnosis.vehicle import Vehicle, vehicle_of
from orchestrator.errors import AddressError, MeasuredError, ScenarioError

Array = NDArray[np.float64]
LONGEST_BESIDE = 60.0  # s: what a record may be longer than its landing
ORIGIN_SIGMA = 0.005  # s: how well the data's zero is first contact when they say nothing else
LEAST_EFFECT_STEP, NUISANCE_STEP, TOLERANCE_STEP = 0.08, 0.2, 0.5  # of z, for differences


@dataclass
class Setup:
    """What a search needs."""

    addresses: Addresses
    make: Callable[[], Lander]
    base: dict[str, float]
    """The scenario's values in the lander's names."""
    landings: Landings
    names: list[str]
    """Of the landings."""
    nuisances: list[Coordinate]
    tolerances: list[Coordinate]
    hypotheses: list[Hypothesis]
    skipped: dict[str, str] = field(default_factory=dict)
    """Effects that this scenario cannot hold, and why."""
    why_slow: str = ""
    """Why the search goes through the master; empty where the twin flies."""


def nuisances_of(vehicle: Vehicle, prior: Prior, landing: int, base: dict[str, float]) -> list[Coordinate]:
    """Coordinates of one prior; its mean becomes the landing's base value."""
    groups = vehicle.slots(prior.name)
    _in_unit(prior.unit, vehicle.addresses.unit_of_measure(prior.name), f"prior.{prior.name}")
    means = np.atleast_1d(prior.mean)
    if len(groups) != len(means):
        raise MeasuredError(f"prior.{prior.name}: gives {len(means)} numbers, expects {len(groups)}; give one for each component")
    spread = prior.sigma if prior.sigma is not None else prior.sigma_log
    sigmas = np.broadcast_to(np.atleast_1d(0.0 if spread is None else spread), means.shape)
    operation: Operation = "add" if prior.sigma is not None else "scale"
    found = []
    for i, (names, mean, sigma) in enumerate(zip(groups, means.tolist(), sigmas.tolist(), strict=True)):
        for name in names:
            base[name] = float(mean)
        label = prior.name if len(groups) == 1 else f"{prior.name}[{i + 1}]"
        low = -0.95 * mean if operation == "add" and prior.name in ("soil.friction",) else -np.inf
        found.append(
            Coordinate(
                label,
                tuple((n, 1.0) for n in names),
                sigma,
                operation=operation,
                low=low,
                unit=prior.unit,
                landing=landing,
                step=NUISANCE_STEP,
            )
        )
    return found


def tolerances_of(vehicle: Vehicle, path: Path) -> list[Coordinate]:
    """The bands of `scenarios/tolerances.toml` that mean something in this scenario."""
    try:
        table = tomllib.loads(path.read_text("utf-8"))["tolerances"]
    except (OSError, KeyError, tomllib.TOMLDecodeError) as error:
        raise ScenarioError(f"{path}: no table of tolerances ({error}); restore the file") from None
    found = []
    for address, entry in table.items():
        slots = tuple((name, 1.0) for group in slots_or_none(vehicle, address) for name in group)
        if slots and any(vehicle.base.get(name, 0.0) != 0.0 for name, _ in slots):
            found.append(Coordinate(address, slots, float(entry["sigma_log"]), operation="scale", step=TOLERANCE_STEP))
    return found


def slots_or_none(vehicle: Vehicle, address: str) -> list[list[str]]:
    """`vehicle.slots`; nothing where somebody else's unit has no such parameter: only what the data say of one must be there."""
    try:
        groups = vehicle.slots(address)
    except AddressError:
        if not vehicle.why_slow:
            raise
        return []
    return groups if all(name in vehicle.base or name.startswith(SEEN) for group in groups for name in group) else []


def hypothesis_of(vehicle: Vehicle, effect: Effect) -> Hypothesis | str:
    """The effect in the lander's terms, or why it has none here."""
    coordinates = []
    for address in effect.fixed:
        if not slots_or_none(vehicle, address):
            return f"{address} is not in what the search flies"
    for parameter in effect.parameters:
        slots: list[tuple[str, float]] = []
        for sign, address in parameter.signed_targets():
            groups = slots_or_none(vehicle, address)
            if not groups:
                return f"{address} is not in what the search flies"
            slots += [(name, sign) for group in groups for name in group]
        coordinates.append(_coordinate(parameter, tuple(slots), _fixed(vehicle, effect)))
    starts = tuple(tuple(start[p.name] for p in effect.parameters) for start in effect.starts)
    return Hypothesis(effect.name, tuple(coordinates), starts)


def _coordinate(parameter: Parameter, slots: tuple[tuple[str, float], ...], fixed: tuple[tuple[str, float], ...]) -> Coordinate:
    positive = parameter.prior.shape == "half-normal"
    low, high = parameter.limits
    return Coordinate(
        parameter.name,
        slots,
        parameter.prior.sigma,
        parameter.null,
        parameter.operation,
        low,
        high,
        positive,
        parameter.unit,
        step=LEAST_EFFECT_STEP,
        fixed=fixed,
    )


def _fixed(vehicle: Vehicle, effect: Effect) -> tuple[tuple[str, float], ...]:
    found: list[tuple[str, float]] = []
    for address, value in effect.fixed.items():
        values = value if isinstance(value, list) else [value]
        groups = vehicle.slots(address)
        for i, group in enumerate(groups):
            found += [(name, float(values[min(i, len(values) - 1)])) for name in group]
    return tuple(found)


def _in_unit(given: str, declared: str, where: str) -> None:
    """MeasuredError where a unit was given, in SI, that is not that of the parameter or output."""
    expected = UNITS[declared].si if declared in UNITS else ""
    if given and expected and given != expected:
        raise MeasuredError(f'{where}: is in {given}, the scenario has it in {declared}; correct the unit or the name')


# Observations


def observation_of(addresses: Addresses, measured: Measured) -> Observation:
    """Tracks and readings in the lander's names."""
    tracks = []
    for series in measured.series:
        for i, channel in enumerate(series.channels):
            where = f"{measured.folder.name}: series.{series.name}"
            column = _column(addresses, channel, where)
            _in_unit(series.unit[i] if series.unit else "", recorded_unit(addresses, channel), f"{where}: {channel}")
            valid = series.mask[:, i]
            tracks.append(
                Track(series.name, channel, column, series.times[valid], series.values[valid, i], float(series.sigma[i]), series.colour)
            )
    readings = [_reading(addresses, scalar, measured.folder.name) for scalar in measured.values]
    return Observation(tracks, readings)


def _cut_to_the_landing(measured: Measured, stop: float) -> None:
    """Before contact the scenario's vehicle flies free, and a search asks about every sample: a whole descent is no landing."""
    for series in measured.series:
        length = float(series.times[-1] - series.times[0])
        if length > stop + LONGEST_BESIDE:
            raise MeasuredError(
                f"{measured.folder.name}: series.{series.name}: spans {length:.4g} s, the scenario lands in {stop:.4g} s;"
                " cut it to the landing, from about a second before contact on"
            )


def _reading(addresses: Addresses, scalar: Scalar, where: str) -> Reading:
    peak = scalar.name.startswith("peak.")
    column = _column(addresses, scalar.name.removeprefix("peak."), f"{where}: values.{scalar.name}")
    _in_unit(scalar.unit, recorded_unit(addresses, scalar.name), f"{where}: values.{scalar.name}")
    interval = scalar.kind == "interval"
    kind = "peak" if peak else "time" if scalar.name.startswith("contact_time.") else "rest"
    sigma = 1.0 if interval else scalar.sigma
    found = Reading(scalar.name, column, scalar.value, sigma, scalar.low, scalar.high, interval, kind, scalar.unit)
    if interval and 0.0 in (scalar.low, scalar.high) and not np.isfinite(scalar.high - scalar.low):
        raise MeasuredError(f"{where}: values.{scalar.name}: one end, at 0, does not tell how sharply it is meant; give low and high")
    return found


def _column(addresses: Addresses, channel: str, where: str) -> str:
    column = twin_column(addresses, channel)
    if column is None:
        raise MeasuredError(f"{where}: {channel} is not among the twin's outputs; leave it out, or diagnose a scenario that has it")
    if channel in CANONICAL and channel.startswith("rates.") and column == channel:
        return f"telemetry.{channel.removeprefix('rates.')}"  # of the sensor behind the twin: the body's own until an effect moves it
    return column.removeprefix("sensor.")


def set_up(
    blueprint: Blueprint,
    measured: Sequence[Measured],
    effects: Mapping[str, Effect],
    tolerances: Path,
    overrides: Sequence[str] = (),
    names: Sequence[str] = (),
) -> Setup:
    """Everything, or one line about what does not fit together. names: of the landings, instead of their folders'."""
    addresses = Addresses(blueprint)
    vehicle = vehicle_of(addresses, effects, overrides)
    base = vehicle.base
    bases, observations, nuisances = [], [], []
    stop = blueprint.scenario.table.stop_time - blueprint.scenario.table.start_time
    for k, one in enumerate(measured):
        own = dict(base)
        landing = SHARED if len(measured) == 1 else k
        for prior in one.prior:
            nuisances += nuisances_of(vehicle, prior, landing, own)
        nuisances.append(Coordinate(ORIGIN, ((ORIGIN, 1.0),), ORIGIN_SIGMA, unit="s", landing=landing, step=0.5))
        observation = observation_of(addresses, one)
        _cut_to_the_landing(one, stop)
        bases.append(own)
        observations.append(observation)
    hypotheses, skipped = [], {}
    for name, effect in effects.items():
        adds = effect.insert is not None and not addresses.has(effect.insert.unit)
        found = "it adds a unit, and the search is slow" if adds and vehicle.why_slow else hypothesis_of(vehicle, effect)
        if not isinstance(found, str) and (deaf := _clock_of_nobody(found, measured)):
            found = deaf
        if isinstance(found, str):
            skipped[name] = found
        else:
            hypotheses.append(found)
    landings = Landings(observations, bases, [stop] * len(measured))
    return Setup(
        addresses,
        vehicle.make,
        base,
        landings,
        list(names) or names_of([one.folder for one in measured]),
        nuisances,
        known_otherwise(tolerances_of(vehicle, tolerances), nuisances, len(measured)),
        hypotheses,
        skipped,
        vehicle.why_slow,
    )


def _clock_of_nobody(hypothesis: Hypothesis, measured: Sequence[Measured]) -> str:
    """Why an effect on a series' clock cannot be seen; empty where a landing has that series."""
    series = {CLOCK + one.name for landing in measured for one in landing.series}
    moved = {name for c in hypothesis.coordinates for name, _ in c.slots if name.startswith(CLOCK)}
    if not moved or not moved.isdisjoint(series):
        return ""
    return f'the data have no series "{min(moved).removeprefix(CLOCK)}", whose clock it would move'


def names_of(folders: Sequence[Path]) -> list[str]:
    """What landings are called: their folders, with as many of those above as it takes to tell them apart."""
    parts = [folder.resolve().parts for folder in folders]
    for one in parts:
        if parts.count(one) > 1:
            raise MeasuredError(f"{Path(*one)}: is given twice; a landing can be measured or held out, once")
    k = 1
    while len({one[-k:] for one in parts}) < len(parts):
        k += 1
    return ["/".join(one[-k:]) for one in parts]


def known_otherwise(tolerances: Sequence[Coordinate], nuisances: Sequence[Coordinate], landings: int) -> list[Coordinate]:
    """The tolerances without what the data's own priors say of every landing: a mass known to 5 kg is not to move by 2 % beside."""
    told = [name for one in nuisances for name, _ in one.slots for _ in range(landings if one.landing == SHARED else 1)]
    left = [(one, tuple(slot for slot in one.slots if told.count(slot[0]) < landings)) for one in tolerances]
    return [one if slots == one.slots else replace(one, slots=slots) for one, slots in left if slots]
