"""Outcomes and courses made by hand, for the tests of the report."""

import numpy as np

from orchestrator.diagnosis.outcome import Candidate, CannotTell, Estimate, Gap, Measure, NamedEffect, Outcome, Where
from orchestrator.diagnosis.report import ChannelCourse, Contact, Distinction, EffectSeen, LandingCourses, MoreSensor, RestValue

NAN = float("nan")
VERDICTS = ("nothing_missing", "effect", "effects", "cannot_tell", "none_of_my_effects", "numerics", "data_fault")
ODD = 'a/b +Z <i>"x"</i> & $y$ ü'


def damping() -> dict[str, Estimate]:
    return {"damping": Estimate(41234.5678, 1312.25, "N.s/m")}


def outcome(verdict: str) -> Outcome:
    """A full one; what it holds besides its verdict is the same for all."""
    found = Outcome(verdict, scenario="scenarios/apollo11.toml", measured=["data/a"], holdout=["data/b"])  # type: ignore[arg-type]
    if verdict in ("effect", "effects"):
        found.effects = [NamedEffect("soil_damping", "Soil damping at all pads", "soil", damping(), 0.98125)]
        found.revised_scenario = "out/revised.toml"
    if verdict == "effects":
        found.effects.append(NamedEffect("rcs_pulse", "RCS pulse", "rcs", {"torque[1]": Estimate(-310.5, 20.0, "N.m")}, 0.9625))
    if verdict == "cannot_tell":
        measures = [Measure("penetration.+Z", 0.00203, "differs by 3 sigma between them")]
        found.cannot_tell = CannotTell(["soil_damping", "inertial_drag"], measures)
    if verdict == "data_fault":
        found.faults = [{"channel": "rates.yaw", "what": "stands still for 40 samples", "from_s": 0.4, "to_s": 0.8}]
    if verdict == "none_of_my_effects":
        found.term = {"name": "pad normal, quadratic in sink rate", "coefficient": 1523.75, "rivals": ["|v|", "v²"]}
    found.candidates = [
        Candidate("soil_damping", "Soil damping at all pads", 812.3456, 262.125, 0.98125, 0.41, 241.75, damping()),
        Candidate("inertial_drag", "Inertial drag of the soil", 803.5, 281.5, 0.01875, 0.12, None, {}, "twin of soil damping"),
        Candidate("null", "Nothing missing", 0.0, 1933.25, 0.0, 0.0, 0.0, {}),
    ]
    found.where = [Where("rates.pitch", 0.2875, 0.625, "soil[+Z]", "soil.normal", 38.25), Where("rates.yaw", 0.1, 0.2, "", "", 6.5)]
    found.gap = Gap(6.3125, 1.0625, 5.4375, 1.0875, 0.93125)
    found.not_excited = ["slosh", "crush_primary"]
    found.nuisances = {"soil.friction": {"value": 0.4203, "sigma": 0.0207, "pull": 3.2109}}
    found.noise = {"rates.yaw": {"stated": 0.0017, "used": 0.00213, "colour": 0.375}}
    found.checks = {
        "twin against units": {"sigma": 0.041, "limit": 0.2, "ok": True},
        "energy": False,
        "interval": 0.03,
        "words": "fine",
    }
    found.provenance = {"versions": {"numpy": "2.4.6"}, "seed": 1}
    found.simulations, found.readings, found.seconds, found.chi2_null, found.adequacy_null = 3187, 260, 412.75, 1933.25, 1e-40
    found.events = {"+Z": 0.0, "-Y": 0.4}
    found.warnings = ["attitude: noise found is 1.5 times what was stated"]
    return found


def channel(series: str = "rates", name: str = "rates.yaw", unit: str = "rad/s", after: bool = True) -> ChannelCourse:
    times, read = np.linspace(0.0, 1.6, 81), np.linspace(0.0, 1.6, 41)
    shape = np.sin(3.0 * times)
    noise = np.random.default_rng(1).standard_normal(len(read))
    made = ChannelCourse(series, name, unit, read, 0.1 * np.sin(3.0 * read), 0.002, times, 0.12 * shape, 0.11 * shape)
    made.residual_before = 8.0 * noise
    if after:
        made.after, made.band, made.residual_after = 0.1 * shape, np.full(len(times), 0.002), noise
    return made


def landing(name: str = "a", kind: str = "fit", after: bool = True) -> LandingCourses:
    channels = [channel("rates", f"rates.{axis}", after=after) for axis in ("yaw", "pitch")] + [
        channel("attitude", "attitude.yaw", "rad", after)
    ]
    rest = [RestValue("stroke.+Z.left", "m", 0.1, 0.09, 0.105 if after else None, value=0.1016, sigma=0.00635)]
    rest.append(RestValue("penetration.+Y", "m", 0.01, 0.012, 0.03 if after else None, low=0.02, high=0.0762))
    return LandingCourses(name, kind, channels, rest, [Contact("+Z", 0.0), Contact("-Y", 0.4), Contact("+Y", NAN)])  # type: ignore[arg-type]


def bare(verdict: str) -> Outcome:
    """Nothing but its verdict, with a number missing wherever one may be."""
    found = Outcome(verdict)  # type: ignore[arg-type]
    found.candidates = [Candidate(ODD, "", NAN, NAN, NAN, NAN, None, {ODD: Estimate(NAN, NAN, "1")})]
    found.effects = [NamedEffect(ODD, "", "", {ODD: Estimate(1.0, NAN, "N")}, NAN)]
    found.where = [Where(ODD, NAN, 0.2, "", "", NAN), Where(ODD, 0.1, 0.2, "", "", NAN, ODD)]
    found.cannot_tell = CannotTell([ODD], [Measure(ODD, NAN, ODD)])
    found.nuisances, found.noise = {ODD: {"value": NAN, "sigma": NAN, "pull": NAN}}, {ODD: {"stated": 0.0, "used": NAN}}
    found.faults, found.checks, found.term = [{}], {ODD: {ODD: [NAN, None]}}, {ODD: {}}
    found.events, found.not_excited, found.warnings, found.sentence = {ODD: NAN}, [ODD], [ODD], ""
    return found


def odd_landing() -> LandingCourses:
    """Names that are no file names, courses without a number, no samples."""
    none = np.zeros(0)
    lost = np.full(3, NAN)
    channels = [
        ChannelCourse(ODD, ODD, "1", none, none, NAN, none, none),
        ChannelCourse(ODD, ODD, "m", np.arange(3.0), lost, 0.1, np.arange(3.0), lost),
    ]
    channels[1].after, channels[1].band, channels[1].residual_before = lost, lost, lost
    return LandingCourses(ODD, "fit", channels, [RestValue(ODD, "m", NAN), RestValue(ODD, "", 1.0, value=2.0)], [Contact(ODD, 0.1)], "")


def distinction() -> Distinction:
    rows = [
        ("soil_damping", "Soil damping", 2300.5),
        ("inertial_drag", "Inertial drag", 225.25),
        ("slosh", "Slosh", 0.15),
        ("mass", "Mass", NAN),
    ]
    effects = [EffectSeen(name, title, energy, 12.5, "N.s/m", "damping") for name, title, energy in rows]
    cosine = np.array([[1.0, 0.97, 0.1, 0.0], [0.97, 1.0, 0.2, 0.0], [0.1, 0.2, 1.0, NAN], [0.0, 0.0, NAN, 1.0]])
    pair = ["soil_damping", "inertial_drag"]
    return Distinction(
        "s.toml", ["data/a"], effects, cosine, [pair], [MoreSensor("penetration.+Z", 0.002, "m", [pair], ["slosh"])], 91, 14.25
    )
