"""FMPy on an .ssp, with its own simulate_ssp. Two things of the file it passes over are given to it from here:

- parameter bindings: simulate_ssp takes one parameter set, with names "component.variable", and reads none of the bindings itself;
- the start: it sets every connected input to zero before the first step. A unit that is told the body's attitude is a quaternion of
  zero length refuses, and rightly. Each connector is therefore given what its own FMU holds after initialisation.
"""

from time import perf_counter
from types import SimpleNamespace

import job
from fmpy.ssp import simulation
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import find_components, read_ssd


def bound_parameters(path):
    """The inline parameter sets of all components, as one."""
    found = [
        SimpleNamespace(name=f"{component.name}.{parameter.name}", value=_number(parameter))
        for component in find_components(read_ssd(path).system)
        for binding in component.parameterBindings
        for values in binding.parameterValues
        for parameter in values.parameters
    ]
    return SimpleNamespace(parameters=found)


def _number(parameter):
    """Its set_value compares a Boolean with 0.0, so that the text "false" would be true."""
    return parameter.value == "true" if parameter.type == "Boolean" else float(parameter.value)


def main():
    task = job.read()
    moments = {}
    instantiate, free = simulation.instantiate_fmu, simulation.free_fmu

    def instantiate_and_read(component, *arguments, **options):
        instantiate(component, *arguments, **options)
        for connector in component.connectors:
            connector.value = simulation.get_value(component, connector.name)
        moments["begin"] = perf_counter()

    def free_timed(component):
        moments.setdefault("end", perf_counter())
        free(component)

    simulation.instantiate_fmu, simulation.free_fmu = instantiate_and_read, free_timed
    end = task["stop"] - 0.5 * task["step"]
    result = simulate_ssp(task["ssp"], stop_time=end, step_size=task["step"], parameter_set=bound_parameters(task["ssp"]))
    values = {job.label(watched): [float(x) for x in result[job.label(watched)]] for watched in task["watch"]}
    # a row's values are those after the step, its time is that before it
    job.write([float(t) + task["step"] for t in result["time"]], values, moments["end"] - moments["begin"])


main()
