"""The reference pages of the ports say what the built FMUs say."""

import importlib.util
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.skipif(not (ROOT / "build" / "fmus" / "GearLeg.fmu").exists(), reason="python build_fmus.py first")
def test_the_pages_of_the_ports_are_those_of_the_built_units() -> None:
    spec = importlib.util.spec_from_file_location("make_ports", ROOT / "docs" / "make_ports.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    made = module.pages()
    there = {path.name: path.read_text("utf-8") for path in (ROOT / "docs" / "ports").glob("*.md")}
    assert made.keys() == there.keys()
    for name, text in made.items():
        assert there[name] == text, f"docs/ports/{name}: not of these units; run python docs/make_ports.py"
