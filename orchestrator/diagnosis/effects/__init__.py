"""Candidate effects: data, each in a file of its own (decision 9)."""

from orchestrator.diagnosis.effects.effect import Effect, Insert, Parameter, Shape
from orchestrator.diagnosis.effects.library import LIBRARY, load_effect, load_library

__all__ = ["LIBRARY", "Effect", "Insert", "Parameter", "Shape", "load_effect", "load_library"]
