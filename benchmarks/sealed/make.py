"""Cases: public data in SET/cases/NNN/{fit,holdout}, what is hidden in KEYS/NNN.json. A case that has a key is not made again."""

from __future__ import annotations

import hashlib
import json
import secrets
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.effects import Effect
from orchestrator.diagnosis.measured import write_measured
from orchestrator.diagnosis.vehicle import LONGEST, TOLERANCE
from sealed import truth
from sealed.commit import commit
from sealed.hidden import Hidden, Signatures, parameters
from sealed.instruments import clean_readings, noisy, public
from sealed.kinds import NULLS, TWINS, Plan, plans
from sealed.outside import LAWS
from sealed.scene import Scene, centred, drawn_scene
from sealed.vehicle import JITTERED, Vehicle

Array = NDArray[np.float64]
Random = np.random.Generator
Landed = tuple[Array, dict[str, float]]
DRAWS = 12  # effects tried for one case before the case is given up
FIT, HOLDOUT = 0, 1
WHOLE = slice(None)
FINE = {"tolerance": TOLERANCE, "longest_step": LONGEST}  # of the twin, for λ: as a search flies
MOVED = (0.5, 1.0)  # how far a landing's conditions are from the scenario's, in scene.MOVED


class UnmadeError(Exception):
    """A case that could not be made."""


def make(
    out: Path,
    keys: Path,
    n: int,
    seed: int,
    kinds: tuple[str, ...] = (),
    told: Callable[[int], None] | None = None,
    jobs: int = 1,
    part: slice = WHOLE,
) -> None:
    """The set of n cases, or a part of it, `jobs` cases at a time; `keys` must lie outside `out`."""
    if keys.resolve().is_relative_to(out.resolve()) or out.resolve().is_relative_to(keys.resolve()):
        raise ValueError(f"{keys}: keys beside the data are no secret; give a folder outside {out}")
    keys.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(jobs, get_context("spawn"), initializer=_begin) as pool:
        futures = [pool.submit(_make_one, plan, seed, out, keys) for plan in plans(n, seed, kinds)[part]]
        try:
            for future in as_completed(futures):
                number = future.result()
                if told is not None:
                    told(number + 1)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    _write_manifest(out, keys, n)


_vehicle: Vehicle | None = None


def _begin() -> None:
    global _vehicle
    _vehicle = Vehicle()


def _make_one(plan: Plan, seed: int, out: Path, keys: Path) -> int:
    """The case's number, once its data and then its key are written."""
    path = keys / f"{plan.number:03}.json"
    if not path.is_file():
        key = made(_vehicle or Vehicle(), plan, seed, out / "cases" / f"{plan.number:03}")
        path.write_text(json.dumps(key, indent=1) + "\n", "utf-8")
    return plan.number


def made(vehicle: Vehicle, plan: Plan, seed: int, folder: Path) -> dict[str, Any]:
    """One case written to `folder`; its key."""
    skipped: list[dict[str, Any]] = []
    for attempt in range(3):
        place = [seed, 1 + plan.number, attempt]
        scenes = scenes_of(vehicle, plan, place)
        random = np.random.default_rng([*place, 1])
        try:
            hidden, separation = _hidden(vehicle, plan, scenes[0], random, skipped)
            landings = [_landed(vehicle, scene, plan, hidden) for scene in scenes]
        except (UnmadeError, ArithmeticError):
            continue
        for name, scene, (clean, _) in zip(("fit", "holdout"), scenes, landings, strict=True):
            readings = noisy(random, vehicle, scene.sampling, clean)
            title = f"Sealed landing {plan.number:03}, {name}"
            write_measured(folder / name, public(vehicle, scene.sampling, readings, scene.known, title))
        key = _key(vehicle, plan, hidden, scenes, landings)
        return key | {"seed": place, "separation": separation, "skipped": skipped, "salt": secrets.token_hex(16)}
    raise UnmadeError(f"case {plan.number} ({plan.kind}): no landing in 3 attempts; give another seed")


def scenes_of(vehicle: Vehicle, plan: Plan, place: Sequence[int]) -> list[Scene]:
    """The case's landings without effect: fitted, held out."""
    random = np.random.default_rng([*place, 0])
    gap = random.standard_normal(len(JITTERED))
    return [drawn_scene(vehicle, random, plan, gap, moved) for moved in MOVED]


def _hidden(vehicle: Vehicle, plan: Plan, scene: Scene, random: Random, skipped: list[dict[str, Any]]) -> tuple[Hidden, float | None]:
    """What is hidden, and for twins how much of λ is left once the other of the pair may explain it, too."""
    if plan.kind in NULLS:
        return Hidden((), (), (), 0.0), None
    lander = vehicle.lander(FINE)
    try:
        signatures = Signatures(vehicle, scene, lander)
        if plan.kind == "twin":
            return _twin(vehicle, plan, signatures, random, skipped)
        library = [it for it in (LAWS if plan.kind == "outside" else vehicle.effects).values() if not already_uncertain(vehicle, it, scene)]
        first = _drawn(library, plan, signatures, random, skipped)
        if plan.kind != "two":
            return first, None
        one = first.effects[0]
        others = [it for it in library if it.port != one.port and it.name not in one.twins and one.name not in it.twins]
        second = _drawn(others, plan, signatures, random, skipped)
        effects, z = (*first.effects, *second.effects), (*first.z, *second.z)
        both = signatures.left(effects, z)
        if both is None:
            raise UnmadeError(plan.kind)
        return Hidden(effects, z, (*first.energies, *second.energies), both, (*first.linear, *second.linear)), None
    finally:
        lander.close()


def already_uncertain(vehicle: Vehicle, effect: Effect, scene: Scene) -> bool:
    """Whether a nuisance moves the same variables as each of its parameters: it then is a nuisance beyond its prior, a decoy."""
    known = {frozenset(name for name, _ in c.slots) for c in centred(vehicle, scene).coordinates}
    return all(frozenset(name for name, _ in c.slots) in known for c in vehicle.coordinates(effect))


def _drawn(library: list[Effect], plan: Plan, signatures: Signatures, random: Random, skipped: list[dict[str, Any]]) -> Hidden:
    for i in random.permutation(len(library))[:DRAWS]:
        found = signatures.sized_by_what_is_left(library[i], plan.target, random)
        if found is not None:
            return found
        skipped.append({"effect": library[i].name, "energy": plan.target})
    raise UnmadeError(plan.kind)


def _twin(vehicle: Vehicle, plan: Plan, signatures: Signatures, random: Random, skipped: list[dict[str, Any]]) -> tuple[Hidden, float]:
    pairs = [pair for pair in TWINS if all(name in vehicle.effects for name in pair)]
    for i in random.permutation(len(pairs)):
        mine, other = pairs[i] if random.random() < 0.5 else pairs[i][::-1]
        found = signatures.sized_by_what_is_left(vehicle.effects[mine], plan.target, random)
        if found is None:
            skipped.append({"effect": mine, "energy": plan.target})
            continue
        return found, signatures.left(found.effects, found.z, vehicle.effects[other]) or 0.0
    raise UnmadeError(plan.kind)


def _landed(vehicle: Vehicle, scene: Scene, plan: Plan, hidden: Hidden) -> Landed:
    """Noise-free readings, and the values of the twin's variables they were flown with."""
    coordinates = [*scene.coordinates, *(c for effect in hidden.effects for c in vehicle.coordinates(effect))]
    z = np.concatenate([scene.z, *(np.array(part) for part in hidden.z)])
    fixed = {name: value for effect in hidden.effects for name, value in vehicle.fixed(effect).items()}
    values = {**fixed, **vehicle.values(coordinates, z)}
    course = truth.fly(vehicle, values, hidden.effects, "units" if plan.path == "units" else "twin")
    if course is None:
        raise UnmadeError("the truth cannot be flown")
    return clean_readings(vehicle, scene.sampling, course, values), values


def _key(vehicle: Vehicle, plan: Plan, hidden: Hidden, scenes: list[Scene], landings: list[Landed]) -> dict[str, Any]:
    effects = [
        {"name": effect.name, "port": effect.port, "energy": effect.energy, "fixed": dict(effect.fixed),
         "lambda": size, "lambda_by_slopes": linear, "z": list(z),
         "parameters": parameters(vehicle, effect, z), "prior": {it.name: it.prior.sigma for it in effect.parameters}}
        for effect, z, size, linear in zip(hidden.effects, hidden.z, hidden.energies, hidden.linear, strict=True)
    ]  # fmt: skip
    places = {
        name: {"origin_s": scene.sampling.origin, "nuisances": {c.name: float(x) for c, x in zip(scene.coordinates, scene.z, strict=True)},
               "clean": clean.tolist(), "values": {k: v for k, v in values.items() if v != vehicle.base.get(k)}}
        for name, scene, (clean, values) in zip(("fit", "holdout"), scenes, landings, strict=True)
    }  # fmt: skip
    return {**asdict(plan), "lambda": hidden.energy, "effects": effects, **places}


def _write_manifest(out: Path, keys: Path, n: int) -> None:
    """What is public of the set: how many, by which commit, and a digest of each key, so that none can be changed afterwards."""
    public = out / "set.json"
    manifest = {"cases": n, "made_by": commit(), "keys_sha256": unchanged(keys, public)}
    public.write_text(json.dumps(manifest, indent=1) + "\n", "utf-8")


def unchanged(keys: Path, manifest: Path) -> dict[str, str]:
    """Case → digest of its key; ValueError where a manifest that exists has another."""
    digests = {path.stem: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(keys.glob("[0-9]*.json"))}
    known = json.loads(manifest.read_text("utf-8"))["keys_sha256"] if manifest.is_file() else {}
    changed = [case for case, digest in digests.items() if known.get(case, digest) != digest]
    if changed:
        raise ValueError(f"{keys}: the key of case {changed[0]} is not the one that {manifest} has; begin a new set")
    return digests


def complete(keys: Path, manifest: Path) -> None:
    """ValueError where the keys are not, to the last one, those that the manifest lists."""
    digests, known = unchanged(keys, manifest), json.loads(manifest.read_text("utf-8"))["keys_sha256"]
    if digests != known:
        odd = min(digests.keys() ^ known.keys())
        where = "keys" if odd in digests else "set"
        raise ValueError(f"{keys}: case {odd} is in the {where} alone; give the keys that the set was made with")
