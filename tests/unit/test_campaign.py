"""`orchestrator campaign`: killed, interrupted or left alone it ends with the same data set, and every row can be flown again."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from fmi_samples import oscillator

from orchestrator.campaign.data_set import DataSet

CAMPAIGN = """
scenario = "oscillator.toml"
design = "latin"
samples = 24
seed = 5
outputs = ["columns.*.final", "master.steps"]

[vary."a.mass"]
truncated = [1.0, 0.5, 0.2, 4.0]

[vary.stiffness]
addresses = ["spring.stiffness"]
uniform = [50.0, 200.0]
"""


def command(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "orchestrator", "campaign", *map(str, arguments), "--workers", "2"]


def campaign(*arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command(*arguments), capture_output=True, text=True, timeout=1800)


@pytest.fixture(scope="module")
def begun(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a campaign and its data set, flown in one go."""
    folder = tmp_path_factory.mktemp("campaign")
    oscillator(folder)
    (folder / "few.toml").write_text(CAMPAIGN)
    done = campaign(folder / "few.toml", "--out", folder / "uninterrupted")
    assert done.returncode == 0, done.stderr
    assert "24 landings: 24 finished" in done.stdout
    assert done.stderr == ""
    return folder


def stopped_at(number: int, begun: Path, out: Path, sign: signal.Signals) -> int:
    """The campaign, sent a signal when so many landings are kept; its exit code."""
    process = subprocess.Popen(command(begun / "few.toml", "--out", out, "--quiet"), stderr=subprocess.PIPE)
    while process.poll() is None and len(list(out.glob("parts/*.parquet"))) < number:
        time.sleep(0.02)
    process.send_signal(sign)
    return process.wait(timeout=600)


@pytest.mark.parametrize(("sign", "code"), [(signal.SIGKILL, -9), (signal.SIGINT, 130)])
def test_a_campaign_that_was_stopped_ends_with_the_same_file_and_repeats_nothing(
    sign: signal.Signals, code: int, begun: Path, tmp_path: Path
) -> None:
    assert stopped_at(6, begun, tmp_path / "out", sign) == code
    kept = {row["index"]: row for part in (tmp_path / "out" / "parts").glob("*.parquet") for row in pq.read_table(part).to_pylist()}
    assert 6 <= len(kept) < 24
    done = campaign(begun / "few.toml", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert f"{24 - len(kept)} landings in" in done.stdout
    assert (tmp_path / "out" / "landings.parquet").read_bytes() == (begun / "uninterrupted" / "landings.parquet").read_bytes()
    cost = pq.read_table(tmp_path / "out" / "cost.parquet").to_pylist()
    assert all(cost[index]["seconds"] == row["seconds"] for index, row in kept.items())      # not flown a second time


def test_a_finished_campaign_flies_nothing_when_asked_again(begun: Path) -> None:
    done = campaign(begun / "uninterrupted")
    assert done.returncode == 0, done.stderr
    assert "a minute" not in done.stdout


def test_a_landing_flown_alone_is_its_row_to_the_last_bit(begun: Path) -> None:
    done = campaign(begun / "uninterrupted", "--only", 17)
    assert done.returncode == 0, done.stderr
    assert "landing 17: the same as the campaign's in all 21 outputs, to the last bit" in done.stdout
    row = pq.read_table(begun / "uninterrupted" / "landings.parquet").to_pylist()[17]
    alone = ["run", begun / "uninterrupted" / "scenario.toml", "--out", begun / "alone", "--quiet",
             "--set", f"a.mass={row['a.mass']!r}", "--set", f"spring.stiffness={row['stiffness']!r}"]  # fmt: skip
    subprocess.run([sys.executable, "-m", "orchestrator", *map(str, alone)], check=True, timeout=900)
    columns = json.loads((begun / "alone" / "summary.json").read_text())["columns"]
    assert columns["a.position"]["final"] == row["columns.a.position.final"]


def test_a_landing_that_fails_is_kept_with_its_error_and_inputs(begun: Path, tmp_path: Path) -> None:
    (begun / "breaks.csv").write_text("a.mass,spring.stiffness\n1.0,100.0\n1.5,inf\n0.5,50.0\n")
    (begun / "breaks.toml").write_text('scenario = "oscillator.toml"\ndesign = "table"\ntable = "breaks.csv"\n')
    done = campaign(begun / "breaks.toml", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    rows = pq.read_table(tmp_path / "out" / "landings.parquet").to_pylist()
    assert [row["outcome"] for row in rows] == ["finished", "not flown", "finished"]
    assert "expects a finite number" in rows[1]["error"]
    assert rows[1]["spring.stiffness"] == float("inf")
    assert "1 not flown; the first: landing 1: " in done.stdout


WRONG = {
    "an unknown key": ("sed = 5", "seed = 5", 'sed: unknown key; did you mean "seed"?'),
    "an unknown way to vary": ("unifrm", "uniform", 'vary.stiffness.unifrm: unknown key; did you mean "uniform"?'),
    "a misspelt parameter": ("spring.stifness", "spring.stiffness", '"spring.stifness": no parameter "stifness"; did you mean'),
    "an unknown unit": ('vary."c.mass"', 'vary."a.mass"', '"c.mass": no unit "c"'),
    "an output that is not there": ("columns.*.end", "columns.*.final", 'outputs: "columns.*.end" matches none of the summary'),
    "bounds the wrong way round": ("[200.0, 50.0]", "[50.0, 200.0]", "vary.stiffness: its least value 200 is not below its greatest 50"),
    "no number of samples": ("", "samples = 24", 'the campaign: design = "latin" needs samples; add it'),
}


@pytest.mark.parametrize("what", WRONG)
def test_a_wrong_campaign_is_one_line_and_exit_code_two(what: str, begun: Path, tmp_path: Path) -> None:
    wrong, right, message = WRONG[what]
    oscillator(tmp_path)
    (tmp_path / "few.toml").write_text(CAMPAIGN.replace(right, wrong))
    done = campaign(tmp_path / "few.toml", "--out", tmp_path / "out")
    assert done.returncode == 2
    assert done.stderr.startswith(f"error: few.toml: {message}"), done.stderr
    assert done.stderr.count("\n") == 1


def test_a_folder_begun_with_another_campaign_is_not_gone_on_with(begun: Path) -> None:
    (begun / "other.toml").write_text(CAMPAIGN.replace("seed = 5", "seed = 6"))
    done = campaign(begun / "other.toml", "--out", begun / "uninterrupted")
    assert done.returncode == 2
    assert "was begun with another campaign (seed); give another --out" in done.stderr
    assert os.path.getsize(begun / "uninterrupted" / "landings.parquet") > 0


def test_a_folder_begun_with_other_inputs_is_not_gone_on_with(begun: Path) -> None:
    """A table of inputs can change under the same name."""
    folder = begun / "uninterrupted"
    kept = (folder / "inputs.parquet").read_bytes()
    table = pq.read_table(folder / "inputs.parquet")
    pq.write_table(table.slice(0, table.num_rows - 1), folder / "inputs.parquet")
    try:
        done = campaign(begun / "few.toml", "--out", folder)
    finally:
        (folder / "inputs.parquet").write_bytes(kept)
    assert done.returncode == 2
    assert "was begun with other inputs; give another --out" in done.stderr


def test_a_part_that_a_power_cut_spoilt_is_flown_again(tmp_path: Path) -> None:
    data = DataSet(tmp_path, pa.table({"index": [0, 1]}), {})
    data.begin()
    (data.parts / "000001.parquet").write_bytes(b"")
    assert data.begin() == set()
    assert not list(data.parts.glob("*.parquet"))
