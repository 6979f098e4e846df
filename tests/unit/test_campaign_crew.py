"""Workers that fly landings: the same landing whoever flies it, and none lost when one dies or one landing fails."""

import os
import signal
from pathlib import Path

import pytest
from fmi_c_sample import c_sample
from fmi_samples import oscillator

from orchestrator.campaign.crew import Crew
from orchestrator.campaign.landing import Base, land
from orchestrator.errors import UserError
from orchestrator.simulation import run_scenario


def test_a_landing_by_kept_units_is_that_of_fresh_ones_to_the_last_bit(tmp_path: Path) -> None:
    path = oscillator(tmp_path)
    base = Base.read(path)
    for mass in (3.5, 0.7, 3.5):
        override = f"a.mass={mass!r}"
        fresh = run_scenario(path, [override])
        kept = land(base, [override])
        assert kept.outcome == "finished"
        for name, column in fresh.columns.items():
            assert kept.outputs[f"columns.{name}.final"] == column[-1]
            assert kept.outputs[f"columns.{name}.max"] == column.max()


def test_a_landing_that_cannot_be_flown_says_why_and_the_next_is_flown(tmp_path: Path) -> None:
    base = Base.read(oscillator(tmp_path))
    for override in ("a.mass=nan", "a.mas=1", "c.mass=1"):
        failed = land(base, [override])
        assert (failed.outcome, failed.trusted, failed.outputs) == ("not flown", False, {})
        assert override.partition("=")[0] in failed.error
        assert "\n" not in failed.error
    assert land(base, ["a.mass=2.0"]).trusted


def test_a_worker_killed_in_mid_campaign_costs_no_landing_and_doubles_none(tmp_path: Path) -> None:
    base = Base.read(oscillator(tmp_path))
    asked = {f"landing {i}": [f"a.mass={1.0 + 0.1 * i!r}"] for i in range(40)}
    alone = {name: land(base, overrides) for name, overrides in asked.items()}
    seen, workers = [], set()
    with Crew(workers=2) as crew:
        for name, landing in crew.fly(base, asked.items()):
            seen.append(name)
            workers.add(landing.worker)
            assert landing.outputs == alone[name].outputs
            if len(seen) == 10:
                os.kill(landing.worker, signal.SIGKILL)
    assert sorted(seen) == sorted(asked)
    assert len(workers) >= 2


def test_a_cluster_that_stands_already_gives_the_same_and_is_left_standing(tmp_path: Path) -> None:
    from distributed import Client, LocalCluster

    base = Base.read(oscillator(tmp_path))
    asked = [[f"a.mass={mass}"] for mass in (1.0, 2.0, 3.0)]
    with LocalCluster(n_workers=1, threads_per_worker=2, dashboard_address=":0") as cluster:
        with Crew(scheduler=cluster.scheduler_address) as crew:
            flown = crew.fly_all(base, asked)
        with Client(cluster.scheduler_address, set_as_default=False) as client:
            assert len(client.scheduler_info()["workers"]) == 1
    assert [landing.outputs for landing in flown] == [land(base, its).outputs for its in asked]


def test_a_scheduler_that_is_not_there_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("orchestrator.campaign.crew.ANSWERS_WITHIN", 1.0)
    nowhere = "tcp://127.0.0.1:9"
    with pytest.raises(UserError, match=f"^--scheduler {nowhere}: no scheduler with a worker answers within 1 s"), Crew(scheduler=nowhere):
        pass


@pytest.mark.slow
def test_a_landing_that_kills_its_workers_is_given_up_and_those_that_waited_for_them_are_not(tmp_path: Path) -> None:
    """A worker takes all that are queued for it along when it dies: of three landings the first crashes, and dask blames two."""
    path = tmp_path / "odd.toml"
    fmu = c_sample()
    path.write_text(f'stop_time = 0.2\nfmus = "{fmu.parent.as_posix()}"\n[units.odd]\nfmu = "{fmu.stem}"\n')
    with Crew(workers=1) as crew:
        landings = crew.fly_all(Base.read(path), [["odd.crash_from=0.1"], ["odd.wall=0.15"], []])
    assert [landing.error[:24] for landing in landings[1:]] == ["", ""]
    assert landings[0].error == "odd.toml: 3 workers died over this landing; fly it alone to see why"
