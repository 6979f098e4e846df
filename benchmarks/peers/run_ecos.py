"""ecos through ecospy: its fixed-step algorithm on an .ssp; it has to be told which parameter set to start from."""

from time import perf_counter

import job
from ecospy import EcosLib, EcosSimulation


def main():
    task = job.read()
    simulation = EcosSimulation(ssp_path=task["ssp"], step_size=task["step"])
    if not simulation.init(parameter_set="start"):
        raise RuntimeError(EcosLib.get_last_error())
    names = {job.label(watched): f"{watched[0]}::{watched[1]}" for watched in task["watch"]}
    times, values = [], {name: [] for name in names}
    begin = perf_counter()
    for number in range(1, round(task["stop"] / task["step"]) + 1):
        simulation.step()
        times.append(number * task["step"])
        for name, identifier in names.items():
            values[name].append(simulation.get_real(identifier))
    job.write(times, values, perf_counter() - begin)


main()
