"""The tables of docs/results.md, from run directories. Lengths in cm unless said otherwise; ours in bold."""

import json
import math
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq

LEGS = ("+Z", "+Y", "-Z", "-Y")  # legs 1 to 4 of the twin
STRUTS = ("primary", "right", "left")
TITLES = {"zupp": "Zupp-like", "adams": "Adams-like"}
THRUSTS = {
    "none": "none",
    "": "5 kN to 0 in 1 s (scenario)",
    "weight": "weight to 0 in 1 s",
    "held": "5 kN for 1.5 s, then off",
    "weight_held": "weight for 1.5 s, then off",
}
TABLE_5 = {
    "V_x, m/s (down)": (0.5730, 0.5740),
    "V_y, m/s": (-0.6147, -0.6481),
    "V_z, m/s": (-0.2130, -0.0447),
    "pitch, deg": (0.9430, 1.4827),
    "roll, deg": (2.5450, 2.2937),
    "yaw, deg": (15.09, 0.0),
    "pitch rate, deg/s": (0.0, 0.0),
    "roll rate, deg/s": (-2.8648, -2.8648),
    "yaw rate, deg/s": (-0.6188, -0.6188),
    "ground slope, deg": (4.5, 4.2),
    "ground azimuth, deg": (0.0, -12.0),
}


@cache
def summary(folder: Path) -> dict[str, Any]:
    """What a run came down to."""
    found: dict[str, Any] = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    return found


def series(folder: Path, name: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    """A column of a run's history."""
    column: np.ndarray[Any, np.dtype[np.float64]] = pq.read_table(folder / "history.parquet", columns=[name])[name].to_numpy()
    return column


def table(head: list[str], rows: list[list[str]]) -> str:
    """A Markdown table."""
    rule = ["---", *["---:"] * (len(head) - 1)]
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, rule, *rows])


def cm(metres: float | None) -> str:
    return "–" if metres is None or math.isnan(metres) else f"{100 * metres:.2f}"


def span(pair: list[float] | None, scale: float = 1.0, digits: int = 2) -> str:
    return "–" if not pair else f"{scale * min(pair):.{digits}f} to {scale * max(pair):.{digits}f}"


def depths(folder: Path) -> list[float]:
    return list(summary(folder)["penetration_m"].values())


def skid(folder: Path) -> str:
    return span(list(summary(folder)["skid_m"].values()), 100.0, 1)


def ordered(folder: Path) -> list[tuple[str, float]]:
    """Legs and times of first contact, s, after the first of them."""
    times = summary(folder)["contact_times_s"]
    return [(leg, times[leg] - min(times.values())) for leg in sorted(times, key=times.__getitem__)]


def initial(folder: Path) -> list[float]:
    """The first recorded row in Table 5's order and units."""
    q = np.array([series(folder, f"body.body.quaternion[{i}]")[0] for i in (1, 2, 3, 4)])
    v = np.array([series(folder, f"body.body.velocity[{i}]")[0] for i in (1, 2, 3)])
    u = -q[1:]
    v = v + 2.0 * np.cross(u, np.cross(u, v) + q[0] * v)  # L to B
    angles = [math.degrees(series(folder, f"body.attitude.{a}")[0]) for a in ("pitch", "roll", "yaw")]
    rates = [math.degrees(series(folder, f"body.rates.{a}")[0]) for a in ("pitch", "roll", "yaw")]
    soil = tomllib.loads((folder / "scenario.toml").read_text(encoding="utf-8"))["units"]["soil+Z"]["parameters"]
    return [-v[0], v[1], v[2], *angles, *rates, math.degrees(soil["ground_slope"]), math.degrees(soil["ground_azimuth"])]


def table_5(runs: Path) -> str:
    ours = [initial(runs / f"apollo11_{c}") for c in TITLES]
    head = ["", *(f"{t}, {who}" for t in TITLES.values() for who in ("paper", "**run**"))]
    rows = [[n, f"{z:.4f}", f"**{ours[0][i]:.4f}**", f"{a:.4f}", f"**{ours[1][i]:.4f}**"] for i, (n, (z, a)) in enumerate(TABLE_5.items())]
    return table(head, rows)


def motion(runs: Path) -> str:
    measured = summary(runs / "apollo11_zupp")["comparison"]["observables"]["measured"]
    rows: list[list[str]] = [["stands", "yes", *("**yes**" if summary(runs / f"apollo11_{c}")["stable"] else "**no**" for c in TITLES)]]
    for k, name in enumerate(("first contact", "second", "third", "fourth")):
        found = [ordered(runs / f"apollo11_{c}")[k] for c in TITLES]
        flown = ("+Y", "+Z, nearly together (about 0.1 s)", "-Y and -Z", "")[k]
        rows.append([name, flown, *(f"**{leg} at {time:.3f} s**" for leg, time in found)])
    for axis, sense in (("roll", "left first (negative)"), ("pitch", "up first (positive)"), ("yaw", "–")):
        rates = [summary(runs / f"apollo11_{c}")["peak_rates_deg_s"][axis] for c in TITLES]
        rows.append([f"peak {axis} rate, deg/s", sense, *(f"**{span(r)}**" for r in rates)])
    for axis in ("pitch", "roll", "yaw"):
        angles = [summary(runs / f"apollo11_{c}")["final_attitude_deg"][axis] for c in TITLES]
        rows.append([f"final {axis}, deg", f"{measured['final_attitude_deg'][axis]:.1f}", *(f"**{a:.2f}**" for a in angles)])
    return table(["", "flight", *TITLES.values()], rows)


def contact(runs: Path) -> str:
    rows = []
    for c, title in TITLES.items():
        folder = runs / f"apollo11_{c}"
        found = summary(folder)["comparison"]["observables"]
        published, measured = found["published"], found["measured"]
        ours = [f"**{span(depths(folder), 100.0)}**", span(published["penetration_range_m"], 100.0)]
        rows.append([f"depth of the pads, {title}", *ours, span(measured["penetration_range_m"], 100.0)])
        biggest = cm(max(summary(folder)["skid_m"].values()))
        rows.append([f"largest skid, {title}", f"**{biggest}**", cm(published["max_skid_m"]), cm(measured["max_skid_m"])])
    return table(["cm", "**run**", "GLASS", "photographs"], rows)


def pads(runs: Path) -> str:
    rows = []
    for leg in LEGS:
        values = [cm(summary(runs / f"apollo11_{c}")[q][leg]) for c in TITLES for q in ("penetration_m", "skid_m")]
        rows.append([leg, *values])
    return table(["cm", *(f"{t}, {q}" for t in TITLES.values() for q in ("depth", "skid"))], rows)


def depth_over_time(runs: Path) -> str:
    rows = []
    for instant in (0.75, 1.0, 1.1, 1.25, 1.5, 2.0, 3.0, 4.0):
        row = [f"{instant:g}"]
        for c in TITLES:
            folder = runs / f"apollo11_{c}"
            at = int(np.argmin(np.abs(series(folder, "time") - instant)))
            for quantity, scale, digits in (("penetration", 100.0, 2), ("skid", 100.0, 1)):
                row.append(span([float(series(folder, f"soil{leg}.{quantity}")[at]) for leg in LEGS], scale, digits))
        rows.append(row)
    return table(["time, s", *(f"{t}, {q}, cm" for t in TITLES.values() for q in ("depths", "skids"))], rows)


def table_6(runs: Path) -> str:
    zupp, adams = (summary(runs / f"apollo11_{c}") for c in TITLES)
    columns = ("photo", "rogers", "zupp", "glass_zupp_like", "adams", "glass_adams_like")
    rows = []
    for strut, theirs in zupp["comparison"]["strokes_m"].items():
        ours = [f"**{cm(run['strokes_m'][strut])}**" for run in (zupp, adams)]
        rows.append([strut, *ours, *(cm(theirs[c]) for c in columns)])
    for title, run in zip(TITLES.values(), (zupp, adams), strict=True):
        rows.append([f"RMS of our {title}", "", "", *(cm(run["comparison"]["rms_m"][c]) for c in columns)])
    to_photo = zupp["comparison"]["rms_to_measured_m"]
    ours = [cm(run["comparison"]["rms_m"]["photo"]) for run in (zupp, adams)]
    rows.append(["RMS to the photographs", *(f"**{x}**" for x in ours), "–", *(cm(to_photo[c]) for c in columns[1:])])
    return table(["cm", "**Zupp-like**", "**Adams-like**", "Photo", "Rogers", "Zupp", "GLASS Zupp-like", "Adams", "GLASS Adams-like"], rows)


def pattern(runs: Path) -> str:
    """Which secondary of each leg strokes more."""
    zupp = summary(runs / "apollo11_zupp")
    published = zupp["comparison"]["strokes_m"]

    def higher(right: float | None, left: float | None) -> str:
        if right is None or left is None:
            return "–"
        return "equal" if right == left else "right" if right > left else "left"

    rows = []
    for leg in LEGS:
        runs_say = [higher(*(summary(runs / f"apollo11_{c}")["strokes_m"][f"{leg}.{s}"] for s in ("right", "left"))) for c in TITLES]
        columns = ("photo", "rogers", "zupp", "adams", "glass_zupp_like", "glass_adams_like")
        say = [higher(*(published[f"{leg}.{s}"][column] for s in ("right", "left"))) for column in columns]
        rows.append([leg, *(f"**{s}**" for s in runs_say), *say])
    head = ["leg", "**Zupp-like**", "**Adams-like**", "Photo", "Rogers", "Zupp", "Adams", "GLASS Zupp-like", "GLASS Adams-like"]
    return table(head, rows)


def rows_of(folder: Path, label: str) -> list[str]:
    """One landing in one row: rates, depths, skids, largest strokes, attitude."""
    s = summary(folder)
    if not s["complete"]:
        return [label, "not finished", *[""] * 7]
    rates, angles = s["peak_rates_deg_s"], s["final_attitude_deg"]
    primary, secondary = (
        max(v for name, v in s["strokes_m"].items() if name.endswith("primary") == is_primary) for is_primary in (True, False)
    )
    return [
        label,
        "yes" if s["stable"] else "no",
        f"{rates['pitch'][1]:.2f}",
        f"{rates['roll'][0]:.2f}",
        span(depths(folder), 100.0),
        skid(folder),
        cm(primary),
        cm(secondary),
        f"{angles['pitch']:.2f}, {angles['roll']:.2f}",
    ]


COLUMNS = ["stands", "peak pitch, deg/s", "peak roll, deg/s", "depths, cm", "skids, cm", "primary, cm", "secondary, cm", "pitch, roll, deg"]


def thrust(runs: Path, c: str) -> str:
    rows = []
    for name, label in THRUSTS.items():
        here = label if c == "zupp" else label.replace("5 kN", "3.5 kN")
        rows.append(rows_of(runs / (f"{c}_thrust_{name}" if name else f"apollo11_{c}"), here))
    return table(["thrust after first contact", *COLUMNS], rows)


def thrust_strokes(runs: Path) -> str:
    folders = [runs / (f"zupp_thrust_{name}" if name else "apollo11_zupp") for name in THRUSTS]
    strokes = [summary(f)["strokes_m"] for f in folders]
    rows = [[strut, *(cm(s[strut]) for s in strokes)] for strut in strokes[0]]
    return table(["cm", *THRUSTS.values()], rows)


def laws(runs: Path) -> str:
    rows = []
    for c, title in TITLES.items():
        rows.append(rows_of(runs / f"apollo11_{c}", f"{title}, published law"))
        rows.append(rows_of(runs / f"{c}_law2", f"{title}, rate-independent"))
    return table(["", *COLUMNS], rows)


def difference(cut: Path, other: Path, names: dict[str, str]) -> float:
    """Largest difference of columns over the history; names of the one by those of the other."""
    times, ours = series(other, "time"), series(cut, "time")
    return max(float(np.abs(np.interp(times, ours, series(cut, a)) - series(other, b)).max()) for a, b in names.items())


def law_difference(runs: Path) -> str:
    rows = []
    for c, title in TITLES.items():
        a, b = runs / f"apollo11_{c}", runs / f"{c}_law2"
        position = distance(a, b, "body.body.position", "body.body.position")
        stroke = difference(a, b, {n: n for n in (f"leg{leg}.{s}.stroke" for leg in LEGS for s in STRUTS)})
        rest = max(abs(v - summary(b)["strokes_m"][n]) for n, v in summary(a)["strokes_m"].items())
        rows.append([title, f"{1e3 * position:.2f} mm", f"{100 * stroke:.3f} cm", f"{100 * rest:.3f} cm"])
    return table(["largest difference", "body position", "a stroke, any time", "a stroke, at rest"], rows)


def corrected(runs: Path) -> str:
    rows = [rows_of(runs / "apollo11_zupp", "Zupp-like, as published"), rows_of(runs / "apollo11_lm5", "LM-5, corrected")]
    return table(["", *COLUMNS], rows)


def corrected_strokes(runs: Path) -> str:
    base, lm5 = (summary(runs / name) for name in ("apollo11_zupp", "apollo11_lm5"))
    rows = [
        [strut, cm(value), f"**{cm(lm5['strokes_m'][strut])}**", cm(lm5["comparison"]["strokes_m"][strut]["photo"])]
        for strut, value in base["strokes_m"].items()
    ]
    rows.append(["RMS to the photographs", *(cm(run["comparison"]["rms_m"]["photo"]) for run in (base, lm5)), "–"])
    return table(["cm", "Zupp-like", "**LM-5**", "Photo"], rows)


def distance(cut: Path, other: Path, ours: str, theirs: str) -> float:
    """Greatest distance of two points over the history, m; names of the vectors without index."""
    times, own = series(other, "time"), series(cut, "time")
    parts = [np.interp(times, own, series(cut, f"{ours}[{i}]")) - series(other, f"{theirs}[{i}]") for i in (1, 2, 3)]
    return float(np.sqrt(sum(part**2 for part in parts)).max())


def rest(runs: Path) -> str:
    """How still the pads stand after 2.5 s: unrest of the normal force within any 50 ms, and sink."""
    rows = []
    for c, title in TITLES.items():
        for name, label in ((f"apollo11_{c}", "co-simulation"), (f"apollo11_{c}_twin", "twin"), (f"{c}_law2", "co-simulation, law 2")):
            folder = runs / name
            soils = [f"lander.soil{k}" if name.endswith("twin") else f"soil{leg}" for k, leg in enumerate(LEGS, 1)]
            late = series(folder, "time") > 2.5
            forces = [series(folder, f"{soil}.normal_force")[late] for soil in soils]
            unrest = max(float(f[i : i + 25].std()) for f in forces for i in range(0, len(f) - 25, 5))
            depth = [series(folder, f"{soil}.penetration")[late] for soil in soils]
            rows.append([f"{title}, {label}", f"{unrest:.0f}", f"{max(1e3 * (d[-1] - d[0]) for d in depth):.2f}"])
    return table(["from 2.5 s to the end", "normal force of a pad, r.m.s. in 50 ms, N", "sink of a pad, mm"], rows)


def twin(runs: Path) -> str:
    rows = []
    for c, title in TITLES.items():
        a, b = runs / f"apollo11_{c}", runs / f"apollo11_{c}_twin"
        sa, sb = summary(a), summary(b)
        position = distance(a, b, "body.body.position", "lander.body.position")
        names = {f"leg{leg}.{s}.stroke": f"lander.leg{k}.{s}.stroke" for k, leg in enumerate(LEGS, 1) for s in STRUTS}
        rates = max(
            abs(x - y)
            for axis, pair in sa["peak_rates_deg_s"].items()
            for x, y in zip(pair, sb["peak_rates_deg_s"][axis], strict=True)
        )
        contacts = max(abs(t - sb["contact_times_s"][leg]) for leg, t in sa["contact_times_s"].items())
        depth = max(abs(d - sb["penetration_m"][leg]) for leg, d in sa["penetration_m"].items())
        values = [f"{1e3 * position:.2f} mm", f"{100 * difference(a, b, names):.3f} cm", f"{rates:.3f} deg/s", f"{1e3 * contacts:.3f} ms"]
        rows.append([title, *values, f"{1e3 * depth:.2f} mm"])
    rows.append(["allowed", "2 mm", "0.1 cm", "0.2 deg/s", "2 ms", "–"])
    return table(["largest difference", "body position", "a stroke", "a peak rate", "a contact time", "a depth at rest"], rows)


def cost(runs: Path) -> str:
    rows = []
    for name in ("apollo11_zupp", "apollo11_zupp_twin", "apollo11_adams", "apollo11_adams_twin", "apollo11_lm5", "zupp_law2", "adams_law2"):
        s = summary(runs / name)
        m, e = s["master"], s["energy"]
        energy = f"{e['residual_J']:+.2f} of {e['initial_J']:.0f}"
        share = f"{100 * e['residual_fraction']:+.3f} %"
        rows.append([f"`{name}`", str(m["steps"]), str(m["rejected"]), str(m["unit_steps"]), energy, share])
    return table(["run", "intervals taken", "refused", "unit steps", "energy unexplained, J", "share"], rows)


def honeycomb(runs: Path) -> str:
    rows = []
    for folder in sorted(runs.glob("honeycomb_*_1"), key=lambda f: -int(f.name.split("_")[1])):
        errors = [100.0 * summary(f)["report"]["stroke"]["relative_difference"] for f in (folder, folder.with_name(folder.name[:-1] + "0"))]
        rows.append([f"{int(folder.name.split('_')[1]) / 1000:g}", *(f"{e:+.3f}" for e in errors)])
    return table(["s, mm", "ζ = 1: stroke over eq. 4's, less 1, %", "ζ = 0, %"], rows)


def footpad(runs: Path) -> str:
    folder = runs / "footpad_drop"
    times, depth, rate = series(folder, "time"), series(folder, "soil.penetration"), -series(folder, "body.body.velocity[1]")
    report = summary(folder)["report"]
    first = int(np.flatnonzero((times > 0.5) & (rate <= 1e-4))[0])
    expected = report["depth"]["expected"]
    force = report["force"]
    rows = [
        [f"depth when it comes to rest, at {times[first]:.3f} s", f"{depth[first]:.6f} m", f"{expected:.5f} m (eq. 10)"],
        ["less eq. 10", f"{100 * (depth[first] / expected - 1):+.4f} %", "0.01 %"],
        ["F_n at rest", f"{force['value']:.1f} N", f"{force['expected']:.1f} N (m g)"],
        ["creep at the end", f"{1e3 * rate[-1]:.4f} mm/s", "below 0.1 mm/s"],
    ]
    return table(["", "run", "expected"], rows)


def flat(runs: Path) -> str:
    rows = []
    for name, label in (("flat_symmetric", "scenario, tolerance 1e-6 m"), ("flat_tight", "tolerance 1e-7 m")):
        s = summary(runs / name)
        groups = [list(s["penetration_m"].values()), list(s["skid_m"].values())]
        groups += [[s["strokes_m"][f"{leg}.{strut}"] for leg in LEGS] for strut in STRUTS]
        rows.append([label, *(f"{max(values) / min(values) - 1:.1e}" for values in groups)])
    return table(["largest over least of the four legs, less 1", "depth", "skid", *STRUTS], rows)


def made(runs: Path) -> str:
    """Which sources the runs are of."""
    inputs = json.loads((runs / "apollo11_zupp" / "inputs.json").read_text(encoding="utf-8"))
    commit = (inputs.get("git") or {}).get("commit") or "unknown"
    return f"Made at commit {commit[:7]}."


def tables(runs: Path) -> dict[str, str]:
    """Every table by its marker in docs/results.md."""
    return {
        "made": made(runs),
        "table-5": table_5(runs),
        "motion": motion(runs),
        "contact": contact(runs),
        "pads": pads(runs),
        "depth-over-time": depth_over_time(runs),
        "table-6": table_6(runs),
        "pattern": pattern(runs),
        "thrust-zupp": thrust(runs, "zupp"),
        "thrust-adams": thrust(runs, "adams"),
        "thrust-strokes": thrust_strokes(runs),
        "laws": laws(runs),
        "law-difference": law_difference(runs),
        "corrected": corrected(runs),
        "corrected-strokes": corrected_strokes(runs),
        "twin": twin(runs),
        "rest": rest(runs),
        "cost": cost(runs),
        "honeycomb": honeycomb(runs),
        "footpad": footpad(runs),
        "flat": flat(runs),
    }
