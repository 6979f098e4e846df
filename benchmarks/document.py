"""docs/benchmarks.md from the files of a run: what stands between `<!-- begin: NAME -->` and `<!-- end: NAME -->` is the table NAME.md."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from packs import ROOT

DOCUMENT = ROOT / "docs" / "benchmarks.md"
BLOCK = r"<!-- begin: (\S+) -->.*?<!-- end: \1 -->"


def renew(out: Path) -> None:
    """Tables and figures that `out` holds; the others stay as they are."""

    def table(found: re.Match[str]) -> str:
        path = out / f"{found[1]}.md"
        if not path.is_file():
            return found[0]
        return f"<!-- begin: {found[1]} -->\n\n{path.read_text('utf-8').strip()}\n\n<!-- end: {found[1]} -->"

    DOCUMENT.write_text(re.sub(BLOCK, table, DOCUMENT.read_text("utf-8"), flags=re.DOTALL), "utf-8")
    images = ROOT / "docs" / "images"
    images.mkdir(exist_ok=True)
    for figure in out.glob("bench_*.png"):
        shutil.copyfile(figure, images / figure.name)
