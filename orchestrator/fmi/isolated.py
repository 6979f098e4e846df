"""A unit in a process of its own: what crashes there is a line here.

A message a call, 0.06 ms in the median. The child (child.py) holds the unit; both sides keep a copy of its vectors. Text goes as text,
because its numbers are each process's own.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from multiprocessing.connection import Pipe
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from orchestrator.errors import OrchestratorError, StepError, UnitError
from orchestrator.fmi.texts import number_of, text_of
from orchestrator.master.slave import Binding, Interface, Kind, Status, Value

_PATIENCE = 2.0
"""s in which a child that was told to end does so."""
UNDER_WAY = ("save", "restore", "observe")
"""What is asked between steps: there is a run to be kept when the process dies in one of these."""


class Request(NamedTuple):
    method: str
    arguments: tuple[Any, ...]
    u: bytes
    texts: list[str]
    """Of the inputs that are text, in order."""


class Answer(NamedTuple):
    outcome: Any
    """What the method returned, or an OrchestratorError."""
    y: bytes
    texts: list[str]
    reached: float | None
    messages: list[str]
    """New ones."""
    complaint: str


def text_places(interface: Interface, names: Sequence[str]) -> list[int]:
    """Where text stands among these."""
    return [at for at, name in enumerate(names) if interface.variables[name].kind is Kind.STRING]


class IsolatedUnit:
    """Keeps the master's protocol for a unit elsewhere. After its process has died it is never asked again."""

    def __init__(self, name: str, interface: Interface) -> None:
        self.name, self.interface = name, interface
        self.steps = 0
        self.seconds = 0.0
        self.reached: float | None = None
        self.messages: list[str] = []
        self.complaint = ""
        self._dead = False
        self._binding = Binding([], [], [], 0, np.zeros(0), np.zeros(0))
        self._text_in: list[int] = []
        self._text_out: list[int] = []
        self._pipe, there = Pipe()
        command = [sys.executable, "-P", "-m", "orchestrator.fmi.child", str(there.fileno())]
        own = str(Path(__file__).parents[2])
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join([own, *filter(None, [os.environ.get("PYTHONPATH")])]))
        self._process = subprocess.Popen(command, pass_fds=(there.fileno(),), stdin=subprocess.DEVNULL, env=environment)
        there.close()
        self._pipe.send_bytes(pickle.dumps((name, interface)))

    def bind(self, binding: Binding) -> None:
        variables = self.interface.variables
        self._binding = binding
        self._text_in, self._text_out = (text_places(self.interface, names) for names in (binding.inputs, binding.outputs))
        later = [at >= binding.coupled and variables[name].kind is Kind.REAL for at, name in enumerate(binding.outputs)]
        self._stepped, self._observed = np.flatnonzero(~np.array(later, dtype=bool)), np.flatnonzero(later)
        self._ask("bind", binding)

    def set_up(self, start: float, stop: float, values: Mapping[str, Value]) -> None:
        self.messages.clear()
        self._ask("set_up", start, stop, dict(values))

    def exchange(self) -> None:
        self._take(self._ask("exchange"), everything=True)

    def begin(self) -> None:
        self._take(self._ask("begin"), everything=True)

    def step(self, time: float, interval: float) -> Status:
        entered = perf_counter()
        self.steps += 1
        answer = self._ask("step", time, interval)
        self.reached = answer.reached
        status: Status = answer.outcome
        if status is not Status.DISCARD:
            self._take(answer)
        self.seconds += perf_counter() - entered
        return status

    def observe(self) -> None:
        entered = perf_counter()
        y = np.frombuffer(self._ask("observe").y)
        self._binding.y[self._observed] = y[self._observed]
        self.seconds += perf_counter() - entered

    def save(self) -> None:
        self._timed("save")

    def restore(self) -> None:
        self._timed("restore")

    def serialised_state(self) -> bytes:
        return bytes(self._ask("serialised_state").outcome)

    def adopt_state(self, data: bytes) -> None:
        self._ask("adopt_state", data)

    def close(self) -> None:
        if self._dead:
            return
        self._dead = True
        try:
            self._pipe.send_bytes(pickle.dumps(Request("close", (), b"", [])))
            self._process.wait(_PATIENCE)
        except (OSError, subprocess.TimeoutExpired):
            self._process.kill()
            self._process.wait()
        self._pipe.close()

    def _timed(self, method: str) -> None:
        entered = perf_counter()
        self._ask(method)
        self.seconds += perf_counter() - entered

    def _take(self, answer: Answer, everything: bool = False) -> None:
        y = np.frombuffer(answer.y)
        places = slice(None) if everything else self._stepped
        self._binding.y[places] = y[places]
        for at, text in zip(self._text_out, answer.texts, strict=True):
            self._binding.y[at] = number_of(text)

    def _ask(self, method: str, *arguments: Any) -> Answer:
        if self._dead:
            raise StepError(f"{self.name}: its process has ended; load it again")
        u = self._binding.u
        try:
            self._pipe.send_bytes(pickle.dumps(Request(method, arguments, u.tobytes(), [text_of(u[at]) for at in self._text_in])))
            answer: Answer = pickle.loads(self._pipe.recv_bytes())
        except (EOFError, OSError):
            raise self._death(method, arguments) from None
        self.messages += answer.messages
        self.complaint = answer.complaint
        if isinstance(answer.outcome, OrchestratorError):
            raise answer.outcome
        return answer

    def _death(self, method: str, arguments: tuple[Any, ...]) -> OrchestratorError:
        self._dead = True
        code = self._process.wait()
        how = f"was ended by {signal.Signals(-code).name}" if code < 0 else f"ended with exit code {code}"
        said = f": {self.messages[-1]}" if self.messages else ""
        if method == "step":
            step = f"doStep, its step {self.steps}, from t = {arguments[0]:.9g} s"
            return StepError(f"{self.name}: crashed in {step}: its process {how}{said}; mend the unit")
        kind = StepError if method in UNDER_WAY else UnitError
        return kind(f"{self.name}: crashed in {method}: its process {how}{said}; mend the unit")
