"""Sobol indices against a sum whose indices are known, and the distributions inputs are drawn from against scipy's own moments."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from orchestrator.campaign.campaign import Campaign
from orchestrator.campaign.data_set import INDEX, as_table
from orchestrator.campaign.design import drawn
from orchestrator.campaign.landing import Base
from orchestrator.campaign.model import CampaignTable
from orchestrator.campaign.sensitivity import sensitivity
from orchestrator.errors import UserError

SCALES = {"a": 1.0, "b": 2.0, "c": 3.0, "idle": 0.0}


def saltelli(samples: int) -> Campaign:
    vary = {name: {"uniform": [0.0, scale or 1.0]} for name, scale in SCALES.items()}
    table = CampaignTable.model_validate({"scenario": "none", "design": "saltelli", "samples": samples, "seed": 4, "vary": vary})
    return Campaign("sum.toml", table, Base("none", ""), {name: [name] for name in SCALES}, as_table(drawn(table, Path())))


def flown(plan: Campaign, folder: Path, missing: int | None = None) -> None:
    """y = a + b + c, z = a·c; one landing without a value."""
    a, b, c = (plan.inputs[name].to_numpy() for name in "abc")
    y = [None if i == missing else float(value) for i, value in enumerate(a + b + c)]
    rows = plan.inputs.append_column("y", pa.array(y, pa.float64())).append_column("z", pa.array(a * c))
    pq.write_table(rows, folder / "landings.parquet")


def test_indices_of_a_sum_are_the_shares_of_the_variances(tmp_path: Path) -> None:
    """Verifies: first order and total of y = Σ xᵢ, xᵢ uniform on [0, sᵢ], are sᵢ²/Σ sⱼ²; a factor of a product interacts.

    Setup: 512 base samples of a Saltelli design drawn as a campaign draws them.
    Tolerance: 0.05, three times the error of 512 quasi-random samples seen here (0.014); the bands must hold the truth as well.
    """
    plan = saltelli(512)
    flown(plan, tmp_path)
    total, product = sensitivity(plan, tmp_path, ["y", "z"])
    shares = np.array([scale**2 for scale in SCALES.values()]) / 14.0
    assert total.first == pytest.approx(shares, abs=0.05)
    assert total.total == pytest.approx(shares, abs=0.05)
    assert (np.abs(np.array(total.first) - shares) <= 2.0 * np.array(total.first_band) + 1e-3).all()
    # z = a c: Var(E[z|a]) = Var(a) E[c]², and of the whole Var(a)Var(c) + ... : for uniforms from 0 S = 3/7 each, total 4/7
    assert [product.first[i] for i in (0, 2)] == pytest.approx([3 / 7, 3 / 7], abs=0.05)
    assert [product.total[i] for i in (0, 2)] == pytest.approx([4 / 7, 4 / 7], abs=0.05)
    assert product.total[3] == pytest.approx(0.0, abs=1e-12)


def test_a_landing_without_a_value_costs_its_base_sample_and_is_counted(tmp_path: Path) -> None:
    plan = saltelli(64)
    flown(plan, tmp_path, missing=17)
    (indices,) = sensitivity(plan, tmp_path, ["y"])
    assert (indices.samples, indices.left_out) == (63, 1)


def test_another_design_or_too_few_samples_is_one_line(tmp_path: Path) -> None:
    plan = saltelli(4)
    flown(plan, tmp_path)
    with pytest.raises(UserError, match="4 whole base samples, at least 8 are needed"):
        sensitivity(plan, tmp_path, ["y"])
    with pytest.raises(UserError, match='no output "zz" that is a number; did you mean "z"'):
        sensitivity(plan, tmp_path, ["zz"])


@pytest.mark.parametrize("design", ["latin", "sobol"])
def test_drawn_values_have_the_moments_that_were_asked_for(design: str) -> None:
    """Verifies: mean and deviation of 4,096 drawn values against the distribution's; a stratified draw misses both by less than 1 %."""
    vary = {"n": {"normal": [5.0, 2.0]}, "u": {"uniform": [-1.0, 3.0]}, "t": {"truncated": [0.0, 1.0, -1.0, 2.0]}, "w": {"values": [1, 2]}}
    table = CampaignTable.model_validate({"scenario": "none", "design": design, "samples": 4096, "seed": 2, "vary": vary})
    columns = {name: np.array(column, dtype=float) for name, column in drawn(table, Path()).items()}
    assert columns["n"].mean() == pytest.approx(5.0, rel=0.01)
    assert columns["n"].std() == pytest.approx(2.0, rel=0.01)
    assert columns["u"].mean() == pytest.approx(1.0, rel=0.01)
    assert columns["u"].std() == pytest.approx(4.0 / np.sqrt(12.0), rel=0.01)
    assert columns["t"].min() >= -1.0
    assert columns["t"].max() <= 2.0
    assert columns["t"].mean() == pytest.approx(0.2296, abs=0.005)   # (φ(−1) − φ(2)) / (Φ(2) − Φ(−1))
    assert set(columns["w"]) == {1.0, 2.0}
    again = drawn(table, Path())
    assert {name: list(column) for name, column in again.items()} == drawn(table, Path())


def test_a_grid_is_every_combination_of_its_levels() -> None:
    vary = {"x": {"uniform": [0.0, 1.0], "levels": 3}, "y": {"values": [7, 8]}}
    table = CampaignTable.model_validate({"scenario": "none", "design": "grid", "vary": vary})
    inputs = as_table(drawn(table, Path()))
    assert inputs["x"].to_pylist() == [0.0, 0.0, 0.5, 0.5, 1.0, 1.0]
    assert inputs["y"].to_pylist() == [7, 8, 7, 8, 7, 8]
    assert inputs[INDEX].to_pylist() == list(range(6))
