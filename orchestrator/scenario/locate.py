"""Where scenarios and FMUs are looked for."""

from __future__ import annotations

from pathlib import Path

from orchestrator.errors import ScenarioError, UnitError, nearest
from orchestrator.scenario.read import SSP, is_path


def scenario_folder() -> Path | None:
    """The nearest `scenarios` folder, from the current one upwards."""
    here = Path.cwd()
    for folder in (here, *here.parents):
        if (folder / "scenarios").is_dir():
            return folder / "scenarios"
    return None


def all_scenarios() -> list[Path]:
    """Those of the folder and of the folders in it; `candidates` holds effects, `measured` data, `campaigns` campaigns."""
    folder = scenario_folder()
    found = sorted(folder.rglob("*.toml")) if folder else []
    return [path for path in found if not {"candidates", "measured", "campaigns"} & set(path.relative_to(folder or path).parts)]


def find_scenario(text: str) -> Path:
    """A path as given, or a bare name found among the scenarios."""
    path = Path(text)
    if path.is_file():
        return path
    if is_path(text) or path.suffix in (".toml", SSP):
        raise ScenarioError(f"{text}: no such file; `orchestrator list` shows the scenarios there are")
    if scenario_folder() is None:
        raise ScenarioError(f"{text}: there is no folder `scenarios` here or above; change to the project's folder, or give a file")
    found = [p for p in all_scenarios() if p.stem == text]
    if found:
        return found[0]
    raise ScenarioError(f'{text}: no such scenario; {nearest(text, [p.stem for p in all_scenarios()])}')


def find_campaign(text: str) -> Path:
    """A file or folder as given, or a bare name found in scenarios/campaigns."""
    if Path(text).exists() or is_path(text) or text.endswith(".toml"):
        return Path(text)
    folder = scenario_folder()
    found = {path.stem: path for path in sorted((folder / "campaigns").glob("*.toml"))} if folder else {}
    if text in found:
        return found[text]
    raise ScenarioError(f"{text}: no such campaign, nor a folder of one; {nearest(text, found)}")


def fmu_folder(stated: str | None, scenario: Path | None) -> Path:
    """As stated, else the build/fmus of the nearest folder above the scenario that has one, else of the current folder."""
    if stated is not None:
        return Path(stated)
    for folder in scenario.resolve().parents if scenario else ():
        if (folder / "build" / "fmus").is_dir():
            return folder / "build" / "fmus"
    return Path.cwd() / "build" / "fmus"


def find_fmu(fmu: str, folder: Path, unit: str) -> Path:
    """The file, or a UnitError that says what there is instead."""
    path = Path(fmu) if is_path(fmu) else folder / f"{fmu}.fmu"
    if path.is_file():
        return path
    there = [p.stem for p in path.parent.glob("*.fmu")] if path.parent.is_dir() else []
    if not there and is_path(fmu):
        build = "build it (those in C: python examples/c_units/build.py)"
        raise UnitError(f"{unit}: {path}: no such FMU, nor any other in that folder; {build} or correct the path")
    if not there:
        raise UnitError(f"{unit}: {path}: no such FMU, nor any other in that folder; build them (python build_fmus.py) or set `fmus`")
    raise UnitError(f"{unit}: {path}: no such FMU; {nearest(path.stem, there)}")
