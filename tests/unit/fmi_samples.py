"""Tiny FMUs for tests: built once per session from the scripts below, each in a process of its own, under names unique to this project."""

import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

PREAMBLE = '''
from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real, String
from pythonfmu.enums import Fmi2Status


class Sample(Fmi2Slave):
    """Variables live in the dictionary `v`."""

    def declare(self, causality, **starts):
        for key, value in starts.items():
            name = key.replace("__", ".")
            self.v[name] = value
            fixed = Fmi2Variability.fixed if causality is Fmi2Causality.parameter else None
            self.register_variable(Real(name, causality=causality, variability=fixed, getter=lambda n=name: self.v[n],
                                        setter=lambda value, n=name: self.v.__setitem__(n, value)), nested=False)
'''

SCRIPTS = {
    # A mass that takes a force with slope and gives its motion with mean and slope.
    "SampleMass": '''
class SampleMass(Sample):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.v = {}
        self.declare(Fmi2Causality.parameter, mass=1.0, position_start=0.0)
        self.declare(Fmi2Causality.input, end__force=0.0, end__force_slope=0.0)
        self.declare(Fmi2Causality.output, end__velocity=0.0, end__velocity_mean=0.0, end__velocity_slope=0.0, end__work=0.0, position=0.0)

    def exit_initialization_mode(self):
        self.v["position"] = self.v["position_start"]

    def do_step(self, t, h):
        v = self.v
        f, k, m, v0 = v["end.force"], v["end.force_slope"], v["mass"], v["end.velocity"]
        v1 = v0 + (f * h + k * h * h / 2) / m
        v["position"] += v0 * h + (f * h * h / 2 + k * h**3 / 6) / m
        v["end.velocity"], v["end.velocity_mean"], v["end.velocity_slope"] = v1, v0 + (f * h / 2 + k * h * h / 6) / m, (v1 - v0) / h
        v["end.work"] += m * (v1 * v1 - v0 * v0) / 2
        return True
''',
    # A spring between two moving ends.
    "SampleSpring": '''
class SampleSpring(Sample):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.v = {}
        self.declare(Fmi2Causality.parameter, stiffness=100.0, stretch_start=0.2)
        for p in "ab":
            self.declare(Fmi2Causality.input, **{f"{p}__velocity": 0.0, f"{p}__velocity_slope": 0.0})
            self.declare(Fmi2Causality.output, **{f"{p}__force": 0.0, f"{p}__force_mean": 0.0, f"{p}__force_slope": 0.0, f"{p}__work": 0.0})
        self.declare(Fmi2Causality.output, stretch=0.0)

    def exit_initialization_mode(self):
        self.v["stretch"] = self.v["stretch_start"]
        self.give(self.v["stretch"], self.v["stretch"], self.v["stretch"], 1.0)

    def give(self, before, mean, after, h):
        k = self.v["stiffness"]
        for p, sign in (("a", 1.0), ("b", -1.0)):
            self.v[f"{p}.force"], self.v[f"{p}.force_mean"] = sign * k * after, sign * k * mean
            self.v[f"{p}.force_slope"] = sign * k * (after - before) / h

    def do_step(self, t, h):
        v = self.v
        rate, slope, e0 = v["b.velocity"] - v["a.velocity"], v["b.velocity_slope"] - v["a.velocity_slope"], v["stretch"]
        v["stretch"] = e0 + rate * h + slope * h * h / 2
        mean = e0 + rate * h / 2 + slope * h * h / 6
        for p, sign in (("a", 1.0), ("b", -1.0)):
            v[f"{p}.work"] -= sign * v["stiffness"] * mean * (v[f"{p}.velocity"] * h + v[f"{p}.velocity_slope"] * h * h / 2)
        self.give(e0, mean, v["stretch"], h)
        return True
''',
    # Claims rollback, but an integrator that is no variable survives it.
    "SampleForgetful": '''
class SampleForgetful(Sample):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.v, self.hidden = {}, 0.0
        self.declare(Fmi2Causality.input, end__velocity=0.0)
        self.declare(Fmi2Causality.output, end__force=0.0, end__count=0.0)

    def do_step(self, t, h):
        self.hidden += h
        self.v["end.force"] = -self.v["end.velocity"]
        self.v["end.count"] = self.hidden
        return True
''',
    # Passes on whole numbers, truth values and text.
    "SampleTeller": '''
class SampleTeller(Sample):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.count, self.told, self.flag, self.seen, self.word, self.said = 0, 0, False, False, "", ""
        given, taken = Fmi2Causality.output, Fmi2Causality.input
        for kind, name, causality in ((Integer, "count", taken), (Integer, "told", given), (Boolean, "flag", taken),
                                      (Boolean, "seen", given), (String, "word", taken), (String, "said", given)):
            self.register_variable(kind(name, causality=causality, variability=Fmi2Variability.discrete))

    def do_step(self, t, h):
        self.told, self.seen, self.said = self.count + 1, not self.flag, self.word + "!"
        return True
''',
    # Refuses, raises or gives NaN, as its parameters say.
    "SampleMoody": '''
class SampleMoody(Sample):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.v = {}
        self.declare(Fmi2Causality.parameter, longest=1.0, refuse_from=9.0, raise_from=9.0, nan_from=9.0)
        self.declare(Fmi2Causality.output, time=0.0)

    def do_step(self, t, h):
        if h > self.v["longest"] * (1 + 1e-9) or t >= self.v["refuse_from"]:
            self.log(f"interval of {h:g} s is too long for me", Fmi2Status.discard)
            return False
        if t >= self.v["raise_from"]:
            raise ValueError("the ground gave way")
        self.v["time"] = float("nan") if t >= self.v["nan_from"] else t + h
        return True
''',
}
WITHOUT_STATE = {"SampleStateless": SCRIPTS["SampleForgetful"].replace("SampleForgetful", "SampleStateless")}


@cache
def sample_fmus() -> Path:
    """Folder with all of them."""
    folder = Path(tempfile.mkdtemp(prefix="sample_fmus_"))
    for name, script in (SCRIPTS | WITHOUT_STATE).items():
        source = folder / f"orchestrator_{name.lower()}.py"
        source.write_text(PREAMBLE + script)
        state = [] if name in WITHOUT_STATE else ["--handle-state", "--serialize-state"]
        command = [sys.executable, "-m", "pythonfmu", "build", "-f", str(source), "--dest", str(folder), *state]
        done = subprocess.run(command, capture_output=True, text=True, cwd=folder)
        assert (folder / f"{name}.fmu").is_file(), done.stderr
    return folder


OSCILLATOR = """
title = "Two masses and a spring"
stop_time = 0.5
fmus = "FMUS"

[units.a]
fmu = "SampleMass"

[units.b]
fmu = "SampleMass"
[units.b.parameters]
mass = 2.0
position_start = 1.2

[units.spring]
fmu = "SampleSpring"

[[connections]]
ports = ["a.end", "spring.a"]
[[connections]]
ports = ["b.end", "spring.b"]

[master]
max_interval = 2e-3
tolerance = 1e-6
"""


def oscillator(folder: Path, extra: str = "", **replaced: str) -> Path:
    """The scenario file, with lines added and texts replaced."""
    text = OSCILLATOR.replace("FMUS", sample_fmus().as_posix())
    for old, new in replaced.items():
        assert old in text
        text = text.replace(old, new)
    path = folder / "oscillator.toml"
    path.write_text(text + extra)
    return path
