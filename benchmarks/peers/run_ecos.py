"""ecos through ecospy: its fixed-step algorithm."""

from time import perf_counter

import job
from ecospy import EcosLib, EcosSimulation, EcosSimulationStructure
from ecospy.EcosParameterSet import EcosParameterSet


def main():
    task = job.read()
    structure = EcosSimulationStructure()
    for unit in task["units"]:
        structure.add_model(unit["name"], unit["fmu"])
    joiners = {"Real": structure.make_real_connection, "Integer": structure.make_int_connection, "Boolean": structure.make_bool_connection}
    for unit, name, _, kind, target, taken, _, _ in task["links"]:
        joiners[kind](f"{unit}::{name}", f"{target}::{taken}")
    parameters = EcosParameterSet()
    adders = {"Real": (parameters.add_real, float), "Integer": (parameters.add_int, int), "Boolean": (parameters.add_bool, bool)}
    for unit, name, _, kind, value in task["start"]:
        add, as_kind = adders[kind]
        add(f"{unit}::{name}", as_kind(value))
    structure.add_parameter_set("start", parameters)
    simulation = EcosSimulation(structure=structure, step_size=task["step"])
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
