"""libcosim through libcosimpy: the fixed-step algorithm on an .ssp, or ECCO with its power bonds."""

from time import perf_counter

import job
from libcosimpy._internal import get_last_error_message
from libcosimpy.CosimAlgorithm import CosimAlgorithm, EccoParams
from libcosimpy.CosimEnums import CosimVariableType
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

NANOSECONDS = 1e9
SHORTEST, LONGEST = 1e-6, 1e-3  # s: what ECCO may choose
SHRINK, GROW = 0.2, 1.5  # per step; libcosimpy's own 0.01 and 0.2 would shrink every step down to the shortest


def from_file(task):
    """Fixed steps, everything else straight from the .ssp."""
    execution = CosimExecution.from_ssp_file(task["ssp"], round(task["step"] * NANOSECONDS))
    index = {unit["name"]: execution.slave_index_from_instance_name(unit["name"]) for unit in task["units"]}
    return execution, None, index


def with_bonds(task):
    """ECCO, which needs power bonds, and no file can say them: put together call by call."""
    parameters = EccoParams(
        step_size=task["step"], min_step_size=SHORTEST, max_step_size=LONGEST, min_change_rate=SHRINK, max_change_rate=GROW,
        abs_tolerance=task["tolerance"], rel_tolerance=task["tolerance"],
    )
    algorithm = CosimAlgorithm.create_ecco_algorithm(parameters)
    execution = CosimExecution.from_algorithm(algorithm)
    slaves = [CosimLocalSlave(unit["fmu"], unit["name"]) for unit in task["units"]]
    index = {unit["name"]: execution.add_local_slave(slave) for unit, slave in zip(task["units"], slaves, strict=True)}
    setters = {"Real": execution.real_initial_value, "Integer": execution.integer_initial_value, "Boolean": execution.boolean_initial_value}
    for unit, name, reference, kind, value in task["start"]:
        if not setters[kind](index[unit], reference, {"Real": float, "Integer": int, "Boolean": bool}[kind](value)):
            raise RuntimeError(f"{unit}.{name}: start value refused")
    joiners = {
        "Real": execution.connect_real_variables,
        "Integer": execution.connect_integer_variables,
        "Boolean": execution.connect_boolean_variables,
    }
    for unit, name, reference, kind, target, _, target_reference, _ in task["links"]:
        if joiners[kind](index[unit], reference, index[target], target_reference) != 0:
            raise RuntimeError(f"{unit}.{name}: connection refused")
    for one, output, taken, other, other_output, other_taken in task["bonds"]:
        if algorithm.add_power_bond(index[one], output, taken, index[other], other_output, other_taken) != 0:
            raise RuntimeError(f"{one}: power bond refused")
    return execution, algorithm, index


def main():
    task = job.read()
    log_output_level(CosimLogLevel.ERROR)
    execution, algorithm, index = with_bonds(task) if task["method"] == "ecco" else from_file(task)
    most = round(task["stop"] / (SHORTEST if algorithm else task["step"])) + 10
    observer = CosimObserver.create_time_series(min(most, 2_000_000))
    execution.add_observer(observer)
    for unit, _, reference in task["watch"]:
        observer.start_time_series(index[unit], reference, CosimVariableType.REAL)
    for one, output, taken, other, other_output, other_taken in task["bonds"] if algorithm else ():
        for unit, reference in ((one, output), (one, taken), (other, other_output), (other, other_taken)):  # ECCO reads what is observed
            observer.start_time_series(index[unit], reference, CosimVariableType.REAL)
    execution.step(0)
    begin = perf_counter()
    if not execution.simulate_until(round(task["stop"] * NANOSECONDS)):
        raise RuntimeError(f"simulate_until failed: {get_last_error_message()}")
    seconds = perf_counter() - begin
    times, values = [], {}
    for watched in task["watch"]:
        points, _, values[job.label(watched)] = observer.time_series_real_samples(index[watched[0]], watched[2], 0, min(most, 2_000_000))
        times = [point / NANOSECONDS for point in points]
    job.write(times, values, seconds)


main()
