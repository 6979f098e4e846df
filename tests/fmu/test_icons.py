"""What tools draw of a unit: its icon, its terminals round it, each file where FMI looks for it."""

import io
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import matplotlib.image
import pytest
from lander.units import unit_files
from lxml import etree

SCHEMA = Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"
NAMES = ["".join(word.capitalize() for word in file.split("_")) for file in unit_files()]


@pytest.fixture(scope="module")
def files(fmus: dict[str, Path]) -> dict[str, zipfile.ZipFile]:
    return {name: zipfile.ZipFile(fmu) for name, fmu in fmus.items()}


@pytest.mark.parametrize("name", NAMES)
def test_terminals_and_icons_keep_the_standards_schema(name: str, files: dict[str, zipfile.ZipFile]) -> None:
    document = etree.fromstring(files[name].read("terminalsAndIcons/terminalsAndIcons.xml"))
    schema = etree.XMLSchema(etree.parse(str(SCHEMA)))
    assert schema.validate(document), schema.error_log


@pytest.mark.parametrize("name", NAMES)
def test_every_icon_is_there_as_png_and_svg_and_is_not_blank(name: str, files: dict[str, zipfile.ZipFile]) -> None:
    for stem, least in (("icon", 100), ("port", 16)):
        picture = matplotlib.image.imread(io.BytesIO(files[name].read(f"terminalsAndIcons/{stem}.png")))
        assert picture.shape[0] == picture.shape[1] >= least
        assert 0.02 < (picture[:, :, 3] > 0.5).mean() < 0.9      # drawn on, and seen through
        assert ElementTree.fromstring(files[name].read(f"terminalsAndIcons/{stem}.svg")).tag == "{http://www.w3.org/2000/svg}svg"
    assert files[name].read("model.png") == files[name].read("terminalsAndIcons/icon.png")


@pytest.mark.parametrize("name", NAMES)
def test_terminals_stand_on_the_icons_edges_each_in_a_place_of_its_own(name: str, files: dict[str, zipfile.ZipFile]) -> None:
    root = ElementTree.fromstring(files[name].read("terminalsAndIcons/terminalsAndIcons.xml"))
    drawings = root.iter("TerminalGraphicalRepresentation")
    places = [[float(drawn.get(edge, "nan")) for edge in ("x1", "y1", "x2", "y2")] for drawn in drawings]
    assert len(places) == len(list(root.iter("Terminal"))) == len({tuple(place) for place in places})
    assert all(abs(0.5 * (x1 + x2)) == 100.0 and -100.0 < y1 < y2 < 100.0 for x1, y1, x2, y2 in places)


def test_no_two_units_look_alike(files: dict[str, zipfile.ZipFile]) -> None:
    assert len({archive.read("model.png") for archive in files.values()}) == len(files)
