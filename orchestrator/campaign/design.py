"""Which values each landing gets: a column for each varied input, a row for each landing."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from orchestrator.campaign.model import CampaignTable, Varied
from orchestrator.errors import ScenarioError
from orchestrator.scenario.model import Scalar

Columns = dict[str, list[Scalar]]
Array = NDArray[np.float64]


def drawn(table: CampaignTable, folder: Path) -> Columns:
    """The same for the same file and seed. `folder` is where a table's file is looked for."""
    if table.design == "table":
        return _from_file(folder / str(table.table), table.vary)
    if table.design == "grid":
        combinations = itertools.product(*(_levels(varied) for varied in table.vary.values()))
        return {name: list(column) for name, column in zip(table.vary, zip(*combinations, strict=True), strict=True)}
    shares = _shares(table)
    return {name: from_shares(varied, shares[:, i]) for i, (name, varied) in enumerate(table.vary.items())}


def from_shares(varied: Varied, shares: Array) -> list[Scalar]:
    """Cumulative probabilities in [0, 1) -> values."""
    from scipy import stats

    if varied.values is not None:
        return [varied.values[int(share * len(varied.values))] for share in shares]
    distribution: Any
    if varied.uniform is not None:
        low, high = varied.uniform
        distribution = stats.uniform(low, high - low)
    elif varied.normal is not None:
        distribution = stats.norm(*varied.normal)
    else:
        mean, sigma, low, high = varied.truncated or (0.0, 1.0, 0.0, 1.0)
        distribution = stats.truncnorm((low - mean) / sigma, (high - mean) / sigma, mean, sigma)
    inside = np.clip(shares, np.finfo(float).tiny, 1.0 - np.finfo(float).epsneg)  # a normal's ends lie at infinity
    return [float(value) for value in distribution.ppf(inside)]


def _shares(table: CampaignTable) -> Array:
    """Points of the unit cube, a row a landing."""
    from scipy.stats import qmc

    count, inputs = int(table.samples or 0), len(table.vary)
    if table.design == "saltelli":
        return _saltelli(count, list(table.vary), table.seed)
    generator = np.random.default_rng(table.seed)
    engine = qmc.LatinHypercube if table.design == "latin" else qmc.Sobol
    points: Array = engine(inputs, seed=generator).random(count)
    return points


def _saltelli(count: int, names: Sequence[str], seed: int) -> Array:
    """Blocks of inputs + 2 rows: A, A with one column of B after the other, B (Saltelli et al. 2010)."""
    from SALib.sample import sobol

    if count & (count - 1):
        raise ScenarioError(f"samples = {count}: a Saltelli design is balanced for powers of 2; give {2 ** round(math.log2(count))}")
    points: Array = sobol.sample(problem(names), count, calc_second_order=False, scramble=True, seed=seed)
    return points


def problem(names: Sequence[str]) -> dict[str, Any]:
    """As SALib wants it: on the unit cube, for the distributions are ours."""
    return {"num_vars": len(names), "names": list(names), "bounds": [[0.0, 1.0]] * len(names)}


def _levels(varied: Varied) -> list[Scalar]:
    if varied.values is not None:
        return varied.values
    low, high = varied.uniform or (0.0, 1.0)
    return [float(value) for value in np.linspace(low, high, varied.levels or 1)]


def _from_file(path: Path, vary: Mapping[str, Varied]) -> Columns:
    import pyarrow as pa
    import pyarrow.csv
    import pyarrow.parquet

    try:
        table = pa.parquet.read_table(path) if path.suffix == ".parquet" else pa.csv.read_csv(path)
    except (OSError, pa.ArrowInvalid) as error:
        raise ScenarioError(f"{path}: cannot be read ({str(error).splitlines()[0]}); give a CSV or Parquet file with a header") from None
    columns: Columns = table.to_pydict()
    missing = [name for name in vary if name not in columns]
    if missing:
        raise ScenarioError(f'{path}: has no column "{missing[0]}" that [vary] names; it has {", ".join(columns)}')
    if not table.num_rows:
        raise ScenarioError(f"{path}: has a header and no row; add a row for each landing")
    for name, column in columns.items():
        for row, value in enumerate(column):
            if value is None or (isinstance(value, float) and math.isnan(value)):
                raise ScenarioError(f"{path}: row {row + 1}, {name}: has no value; fill it in or remove the row")
    return columns
