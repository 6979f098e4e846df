"""All cases of a set diagnosed; a case whose result holds a diagnosis.json is done."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

from sealed.sealing import Diagnosis, diagnose


def cases_of(folder: Path) -> list[Path]:
    return sorted(path for path in (folder / "cases").glob("[0-9]*") if (path / "fit").is_dir() and (path / "holdout").is_dir())


def missing(folder: Path, results: Path) -> list[Path]:
    return [case for case in cases_of(folder) if not (results / case.name / "diagnosis.json").is_file()]


def run(folder: Path, results: Path, diagnosis: Diagnosis, jobs: int, told: Callable[[str], None] | None = None) -> list[str]:
    """Names of the cases that ended without a diagnosis; what they said is in said.txt."""
    failed = []
    with ThreadPoolExecutor(jobs) as pool:
        futures = {pool.submit(diagnose, case, results / case.name, diagnosis): case for case in missing(folder, results)}
        for future in as_completed(futures):
            case = futures[future]
            future.result()
            if not (results / case.name / "diagnosis.json").is_file():
                failed.append(case.name)
            if told is not None:
                told(case.name)
    return sorted(failed)
