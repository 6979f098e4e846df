"""Sobol indices of a Saltelli campaign: which share of an output's variance each input causes.

    first order  S_i = Var(E[y | x_i]) / Var(y)             by itself
    total        T_i = E[Var(y | all but x_i)] / Var(y)     with everything it takes part in; T_i − S_i is interaction

Estimated by SALib (Saltelli et al. 2010, Jansen 1999), bands by bootstrap over the base samples. Whole base samples only: one of whose
landings has no value is left out with all its landings, and counted.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from orchestrator.campaign.campaign import Campaign
from orchestrator.campaign.data_set import INDEX, kept_landings
from orchestrator.campaign.design import problem
from orchestrator.errors import UserError, nearest

LEVEL = 0.95
RESAMPLES = 1000
LEAST = 8
"""Base samples: below that a bootstrap says nothing."""
USUAL = (
    "failure.tip_over.least_angle_deg",
    "failure.tip_over.least_energy_margin_J",
    "failure.primary_stroke.peak_m",
    "failure.secondary_tension.peak_m",
    "failure.secondary_compression.peak_m",
)


@dataclass(frozen=True)
class Indices:
    """Of one output; a value for each input."""

    output: str
    inputs: list[str]
    first: list[float]
    first_band: list[float]
    total: list[float]
    total_band: list[float]
    """± at LEVEL."""
    mean: float
    deviation: float
    samples: int
    """Base samples used."""
    left_out: int

    @property
    def ranked(self) -> list[int]:
        """Places of the inputs, the greatest total first."""
        return sorted(range(len(self.inputs)), key=lambda i: -self.total[i])


def sensitivity(plan: Campaign, folder: Path, outputs: Sequence[str] = ()) -> list[Indices]:
    """Of the landings there are so far."""
    if plan.table.design != "saltelli":
        raise UserError(f'{folder}: its design is "{plan.table.design}", Sobol indices need "saltelli"; set design and fly it again')
    rows = kept_landings(folder)
    known = [field.name for field in rows.schema if pa.types.is_floating(field.type) and field.name not in plan.inputs.column_names]
    for output in outputs:
        if output not in known:
            raise UserError(f'{folder}: no output "{output}" that is a number; {nearest(output, known)}')
    wanted = list(outputs) or [output for output in USUAL if output in known] or known[:6]
    return [_indices(plan, rows, output, folder) for output in wanted]


def _indices(plan: Campaign, rows: pa.Table, output: str, folder: Path) -> Indices:
    from SALib.analyze import sobol

    names = list(plan.addresses)
    size = len(names) + 2
    values = np.full(plan.inputs.num_rows, np.nan)
    values[rows[INDEX].to_numpy()] = rows[output].to_numpy()
    flown = np.zeros(plan.inputs.num_rows, dtype=bool)
    flown[rows[INDEX].to_numpy()] = True
    blocks = values.reshape(-1, size)[flown.reshape(-1, size).all(axis=1)]
    whole = blocks[np.isfinite(blocks).all(axis=1)]
    if len(whole) < LEAST:
        raise UserError(f"{folder}: {output}: {len(whole)} whole base samples, at least {LEAST} are needed; fly more of the campaign")
    if not whole.std() > 0.0:
        raise UserError(f"{folder}: {output}: is the same in all landings; ask for another --output")
    options: dict[str, Any] = {"calc_second_order": False, "num_resamples": RESAMPLES, "conf_level": LEVEL, "seed": plan.table.seed}
    found = sobol.analyze(problem(names), whole.ravel(), **options)
    first, first_band, total, total_band = ([float(x) for x in found[key]] for key in ("S1", "S1_conf", "ST", "ST_conf"))
    spread = whole[:, [0, -1]]                          # A and B: independent draws of all inputs
    moments = float(spread.mean()), float(spread.std())
    return Indices(output, names, first, first_band, total, total_band, *moments, len(whole), len(blocks) - len(whole))


def write(found: Sequence[Indices], folder: Path) -> Path:
    """sensitivity.json"""
    path = folder / "sensitivity.json"
    about = {"level": LEVEL, "resamples": RESAMPLES, "outputs": [asdict(indices) for indices in found]}
    path.write_text(json.dumps(about, indent=2, allow_nan=False) + "\n", encoding="utf-8")
    return path
