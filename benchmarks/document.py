"""docs/benchmarks.md and docs/ssp.md from the files of a run.

What stands between `<!-- begin: NAME -->` and `<!-- end: NAME -->` is the table NAME.md."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from packs import ROOT

DOCUMENTS = [ROOT / "docs" / name for name in ("benchmarks.md", "ssp.md")]
BLOCK = r"<!-- begin: (\S+) -->.*?<!-- end: \1 -->"


def renew(out: Path) -> None:
    """Tables and figures that `out` holds; the others stay as they are."""

    def table(found: re.Match[str]) -> str:
        path = out / f"{found[1]}.md"
        if not path.is_file():
            return found[0]
        return f"<!-- begin: {found[1]} -->\n\n{path.read_text('utf-8').strip()}\n\n<!-- end: {found[1]} -->"

    for document in DOCUMENTS:
        document.write_text(re.sub(BLOCK, table, document.read_text("utf-8"), flags=re.DOTALL), "utf-8")
    images = ROOT / "docs" / "images"
    images.mkdir(exist_ok=True)
    for figure in out.glob("bench_*.png"):
        shutil.copyfile(figure, images / figure.name)
