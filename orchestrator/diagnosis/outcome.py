"""What a diagnosis comes to: the record behind diagnosis.json and report.html. Keys stand as docs/diagnosis.md has them."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Literal

Verdict = Literal["nothing_missing", "effect", "effects", "cannot_tell", "none_of_my_effects", "numerics", "data_fault"]
EXIT = {"numerics": 3, "data_fault": 3}
"""Exit codes other than 0: verdicts that say that nothing could be judged."""


@dataclass
class Estimate:
    """A parameter of an effect: value and standard deviation in its unit."""

    value: float
    sigma: float
    unit: str


@dataclass
class NamedEffect:
    """An effect in the verdict. `unit` is the kind of unit it acts in or is (soil, gear, body, guidance, sensor, ...)."""

    name: str
    title: str
    unit: str
    parameters: dict[str, Estimate]
    probability: float


@dataclass
class Where:
    """A stretch of a channel in which simulation and data disagree, with the port that would explain it best ("" where none does)."""

    channel: str
    from_s: float
    to_s: float
    unit: str
    port: str
    sigmas: float
    landing: str = ""
    """As measured and held-out landings are called; "" where there is one only."""


@dataclass
class Measure:
    """A measurement that would decide: the channel to measure to within sigma, and why."""

    channel: str
    sigma: float
    reason: str


@dataclass
class CannotTell:
    """The smallest set of effects that holds 0.9 of the probability, and what would separate them."""

    names: list[str] = field(default_factory=list)
    measure: list[Measure] = field(default_factory=list)
    answers: list[str] = field(default_factory=list)
    """What the names stand in: an effect alone, or two as "a + b"."""


@dataclass
class Gap:
    """Distance of simulation and data in standard deviations of the noise, RMS over all readings, before and after the revision."""

    fit_before: float = float("nan")
    fit_after: float = float("nan")
    holdout_before: float = float("nan")
    holdout_after: float = float("nan")
    closure: float = float("nan")
    """1 - (excess chi-square after)/(before), on the held-out landings where there are any, else on the fitted ones."""


@dataclass
class Candidate:
    """A hypothesis with what its own fit came to."""

    name: str
    title: str
    log_evidence: float
    """Relative to nothing missing."""
    chi2: float
    probability: float
    adequacy: float
    """p-value of its residual."""
    holdout_gain: float | None
    """ln evidence on the held-out landings, relative to nothing missing."""
    parameters: dict[str, Estimate]
    note: str = ""


@dataclass
class Outcome:
    """All of it. The first seven members are the keys every reader may count on."""

    verdict: Verdict
    effects: list[NamedEffect] = field(default_factory=list)
    cannot_tell: CannotTell = field(default_factory=CannotTell)
    where: list[Where] = field(default_factory=list)
    not_excited: list[str] = field(default_factory=list)
    gap: Gap = field(default_factory=Gap)
    simulations: int = 0
    revised_scenario: str = ""
    sentence: str = ""
    """The verdict in one sentence."""
    scenario: str = ""
    measured: list[str] = field(default_factory=list)
    holdout: list[str] = field(default_factory=list)
    candidates: list[Candidate] = field(default_factory=list)
    readings: int = 0
    chi2_null: float = float("nan")
    adequacy_null: float = float("nan")
    nuisances: dict[str, dict[str, float]] = field(default_factory=dict)
    """name -> value, sigma, pull (in standard deviations of its prior)."""
    noise: dict[str, dict[str, float]] = field(default_factory=dict)
    """channel -> stated, used, colour."""
    faults: list[dict[str, Any]] = field(default_factory=list)
    term: dict[str, Any] = field(default_factory=dict)
    """A term found outside the library: port, formula, coefficient, energy, rivals in its class."""
    checks: dict[str, Any] = field(default_factory=dict)
    """Of the co-simulation: twin against units in sigma, ablation, placebo, energy, interval."""
    events: dict[str, float] = field(default_factory=dict)
    """Simulated contacts, s."""
    seconds: float = 0.0
    titles: dict[str, str] = field(default_factory=dict)
    """Of every effect of the library."""
    warnings: list[str] = field(default_factory=list)
    provenance: dict[str, Any] = field(default_factory=dict)
    """What was used: versions, hashes of scenario, FMUs and data, seed, command. Name -> text or number, or a level more of them."""

    def to_json(self) -> dict[str, Any]:
        """Plain data; what is not a number becomes null."""
        tree: dict[str, Any] = _plain(asdict(self))
        return tree

    def write(self, folder: Path) -> Path:
        """diagnosis.json."""
        path = folder / "diagnosis.json"
        path.write_text(json.dumps(self.to_json(), indent=1, ensure_ascii=False) + "\n", "utf-8")
        return path


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if isinstance(value, float) and (value != value or value in (float("inf"), float("-inf"))):
        return None
    return value
