"""What a held-out landing adds: evidence of both landings together less that of the first."""

from collections.abc import Mapping

import numpy as np
import pytest
from diagnosis_samples import Formula, coordinate, tracks
from numpy.typing import NDArray

from orchestrator.diagnosis.coordinates import Coordinate
from orchestrator.diagnosis.fit import Fit, refined, seen_from
from orchestrator.diagnosis.held_out import posterior_of, predictive
from orchestrator.diagnosis.observation import Observation
from orchestrator.diagnosis.problem import Landings, Model

Array = NDArray[np.float64]
TIMES = np.linspace(0.05, 1.95, 40)
BASE = dict.fromkeys(("start", "vehicle", "effect"), 0.0)
VEHICLE, EFFECT = coordinate("vehicle", 0.1), coordinate("effect", 0.5)


class Straight(Formula):
    """The effect does nearly what a vehicle does that is not as stated."""

    def column(self, name: str, values: Mapping[str, float], t: Array) -> Array:
        v = values
        return np.asarray(v["start"] + v["vehicle"] * t + v["effect"] * (t + 0.1 * t * t))


def landing(hidden: Mapping[str, float], seed: int) -> Observation:
    return Observation(tracks(Straight(), {**BASE, **hidden}, ["y"], TIMES, 0.05, seed), ())


def fit_of(observations: list[Observation], coordinates: tuple[Coordinate, ...]) -> Fit:
    model = Model(Landings(observations, [dict(BASE)] * len(observations), [2.0] * len(observations)), coordinates, Straight())
    z = np.zeros(len(coordinates))
    predicted = model.predict(z)
    assert predicted is not None
    return refined(model, seen_from(model, z, predicted, model.slopes(z, predicted)))


def gains(hidden: Mapping[str, float]) -> tuple[float, float, float]:
    """Of the effect on the second landing: as it is, as exact algebra has it, and with the effect alone carried over."""
    one, two = landing(hidden | {"start": 0.2}, 1), landing(hidden | {"start": -0.1}, 2)
    starts = tuple(Coordinate(f"start {k}", (("start", 1.0),), 1.0, landing=k) for k in (0, 1))
    found, exact, alone = [], [], []
    for own in ((), (EFFECT,)):
        first = fit_of([one], (coordinate("start"), VEHICLE, *own))
        second = fit_of([two], (coordinate("start"), VEHICLE, *posterior_of(first, 2)))
        found.append(predictive(first, second, [(i, i) for i in range(1, 2 + len(own))]))
        exact.append(fit_of([one, two], (*starts, VEHICLE, *own)).log_evidence - first.log_evidence)
        alone.append(second.log_evidence)
    return found[1] - found[0], exact[1] - exact[0], alone[1] - alone[0]


@pytest.mark.parametrize("hidden", [{}, {"vehicle": 0.25}, {"effect": 0.6}])
def test_the_gain_is_what_both_landings_say_less_what_the_first_said(hidden: Mapping[str, float]) -> None:
    """A straight world, in which Laplace is exact; fits stop where a step promises 0.3."""
    found, exact, _ = gains(hidden)
    assert found == pytest.approx(exact, abs=0.1)


def test_a_vehicle_off_by_its_tolerance_is_held_against_nobody_twice() -> None:
    """2.5 sigma: were the stated tolerance the prior of the second landing too, the effect would gain what the first one taught."""
    found, _, alone = gains({"vehicle": 0.25})
    assert alone > found + 1.0
    assert found < 1.0
