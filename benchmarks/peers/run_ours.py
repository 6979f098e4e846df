"""This project's master on a scenario: the job holds `scenario`, `changes` (merged over the file) and `watch`."""

from pathlib import Path

import job

from orchestrator.simulation import run_scenario


def main():
    task = job.read()
    result = run_scenario(Path(task["scenario"]), (), task["changes"])
    if result.message:
        raise RuntimeError(result.message)
    values = {name: result.columns[name].tolist() for name in task["watch"]}
    job.write(result.times.tolist(), values, result.wall_time)


main()
