"""The process that holds one unit for isolated.py: `python -m orchestrator.fmi.child DESCRIPTOR`."""

from __future__ import annotations

import ctypes
import os
import pickle
import signal
import sys
from dataclasses import replace
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

from orchestrator.errors import OrchestratorError
from orchestrator.fmi.isolated import Answer, Request, text_places
from orchestrator.fmi.load import load
from orchestrator.fmi.texts import number_of, text_of
from orchestrator.fmi.unit import FmuUnit
from orchestrator.master.slave import Binding

_DEATH_OF_PARENT = 1
"""prctl's PR_SET_PDEATHSIG."""


class Child:
    """Answers requests until it is told to close or nobody asks any more."""

    def __init__(self, pipe: Connection) -> None:
        self._pipe = pipe
        self._name, self._interface = pickle.loads(pipe.recv_bytes())
        self._unit: FmuUnit | None = None
        self._binding = Binding([], [], [], 0, np.zeros(0), np.zeros(0))
        self._text_in: list[int] = []
        self._text_out: list[int] = []
        self._told = 0

    def serve(self) -> None:
        while True:
            try:
                request: Request = pickle.loads(self._pipe.recv_bytes())
            except EOFError:
                return
            if request.method == "close":
                if self._unit is not None:
                    self._unit.close()
                return
            self._pipe.send_bytes(pickle.dumps(self._answer(request)))

    def _answer(self, request: Request) -> Answer:
        outcome: Any
        try:
            outcome = self._do(request)
        except OrchestratorError as error:
            outcome = error
        unit = self._unit
        if unit is None:
            return Answer(outcome, b"", [], None, [], "")
        news, self._told = unit.said_since(self._told), unit.said
        y = self._binding.y
        return Answer(outcome, y.tobytes(), [text_of(y[at]) for at in self._text_out], unit.reached, news, unit.complaint)

    def _do(self, request: Request) -> Any:
        if self._unit is None:
            self._unit = load(self._name, self._interface, isolate=False)
        if request.method == "bind":
            return self._bind(*request.arguments)
        if self._binding.u.size:
            self._binding.u[:] = np.frombuffer(request.u)
        for at, text in zip(self._text_in, request.texts, strict=True):
            self._binding.u[at] = number_of(text)
        return getattr(self._unit, request.method)(*request.arguments)

    def _bind(self, binding: Binding) -> None:
        self._binding = replace(binding, u=np.zeros(len(binding.u)), y=np.zeros(len(binding.y)))
        self._text_in, self._text_out = (text_places(self._interface, names) for names in (binding.inputs, binding.outputs))
        assert self._unit is not None
        self._unit.bind(self._binding)


def main() -> None:
    """Ends at once when done: a runtime inside a unit may crash when an interpreter ends properly."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_DEATH_OF_PARENT, signal.SIGKILL)
    Child(Connection(int(sys.argv[1]))).serve()
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
