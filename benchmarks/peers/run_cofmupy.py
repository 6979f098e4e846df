"""CoFmuPy: Jacobi or Gauss-Seidel, iterative or not."""

from time import perf_counter

import job
from cofmupy import Coordinator


def main():
    task = job.read()
    begun = {unit["name"]: {} for unit in task["units"]}
    for unit, name, _, _, value in task["start"]:
        begun[unit][name] = value
    fmus = [{"id": unit["name"], "path": unit["fmu"], "initialization": begun[unit["name"]]} for unit in task["units"]]
    links = [
        {"source": {"id": link[0], "variable": link[1]}, "target": {"id": link[4], "variable": link[5]}} for link in task["links"]
    ]
    method = task["method"].removesuffix(" iterative")
    coordinator = Coordinator()
    coordinator.start({"fmus": fmus, "connections": links, "cosim_method": method, "iterative": task["method"].endswith("iterative")})
    begin = perf_counter()
    coordinator.run_simulation(step_size=task["step"], end_time=task["stop"] - 0.5 * task["step"])
    seconds = perf_counter() - begin
    results = coordinator.get_results()
    values = {job.label(watched): [float(x) for x in results[watched[0], watched[1]]] for watched in task["watch"]}
    # a row's values are those after the step, its time is that before it
    job.write([float(t) + task["step"] for t in results["time"]], values, seconds)


main()
