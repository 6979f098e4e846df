"""A guidance of your own to start from: full thrust until a foot has touched, off a moment later. Nothing but pythonfmu is needed.

    python -m pythonfmu build --handle-state --serialize-state -f examples/template_unit/my_guidance.py --dest build/template

Change `declare` (what it takes and gives) and `do_step` (what it does); the rest may stay. The names are those of the port contract,
docs/ports/GuidanceControl.md. Whatever the unit remembers stands in `self.v` and is declared: then a saved state is the whole state.
"""

from xml.etree.ElementTree import Element, SubElement

from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

UNITS = {"N": {"kg": 1, "m": 1, "s": -2}, "N.m": {"kg": 1, "m": 2, "s": -2}, "s": {"s": 1}}
"""Every unit of measure in use, by exponents of the SI base units."""
NOMINAL = {"N": 1e4, "N.m": 1e4}
"""The order of size of the outputs in a unit of measure: a master's step control weighs by it."""
CONTACTS = [f"contact{k}" for k in range(1, 9)]


class MyGuidance(Fmi2Slave):
    """Its state is the dictionary `v`, variable by variable."""

    description = "Thrust until first contact, off after a delay."

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.v = {}
        self.units = {}
        self.declare()

    def declare(self):
        self.real("thrust", 5000.0, "N", "thrust until it is cut", "parameter")
        self.real("cutoff_delay", 0.3, "s", "from first contact to no thrust", "parameter")
        for k, name in enumerate(CONTACTS, 1):
            self.boolean(name, f"pad or probe {k} touches", "input")
        for i in (1, 2, 3):
            self.real(f"engine.force[{i}]", 0.0, "N", "on the body, frame B", "output")
            self.real(f"engine.torque[{i}]", 0.0, "N.m", "on the body, frame B, about the origin of B", "output")
        self.real("engine.thrust", 0.0, "N", "thrust along +X of B", "output")
        self.boolean("engine.on", "whether there is thrust", "output")
        self.real("first_contact", -1.0, "s", "when a foot touched first, -1: not yet", "local")

    def exit_initialization_mode(self):
        self.give(0.0)

    def do_step(self, current_time, step_size):
        """Inputs are those of the interval's start, outputs those of its end."""
        if self.v["first_contact"] < 0.0 and any(self.v[name] for name in CONTACTS):
            self.v["first_contact"] = current_time
        self.give(current_time + step_size)
        return True

    def give(self, time):
        touched = self.v["first_contact"] >= 0.0
        on = not touched or time < self.v["first_contact"] + self.v["cutoff_delay"]
        self.v["engine.thrust"] = self.v["engine.force[1]"] = self.v["thrust"] if on else 0.0
        self.v["engine.on"] = on

    # What every unit needs.

    def real(self, name, start, unit, description, causality):
        self.units[name] = unit
        self.add(Real, name, start, description, causality)

    def boolean(self, name, description, causality):
        self.add(Boolean, name, False, description, causality)

    def add(self, kind, name, start, description, causality):
        self.v[name] = start
        variability = {"parameter": Fmi2Variability.fixed}.get(causality)
        if kind is Boolean and causality != "parameter":
            variability = Fmi2Variability.discrete
        about = {"description": description, "causality": Fmi2Causality[causality], "variability": variability}
        self.register_variable(
            kind(name, getter=lambda: self.v[name], setter=lambda value: self.v.__setitem__(name, value), **about), nested=False
        )

    def to_xml(self, *options, **named):
        """pythonfmu's modelDescription.xml with what it does not write itself: units of measure, nominal values, dependencies."""
        root = super().to_xml(*options, **named)
        definitions = Element("UnitDefinitions")
        for name, exponents in UNITS.items():
            base = {key: str(power) for key, power in exponents.items()}
            SubElement(SubElement(definitions, "Unit", {"name": name}), "BaseUnit", base)
        root.insert(1, definitions)                   # after CoSimulation
        for variable in root.find("ModelVariables"):
            unit = self.units.get(variable.get("name"))
            if unit:
                variable.find("Real").set("unit", unit)
            if variable.get("causality") == "output" and unit in NOMINAL:
                variable.find("Real").set("nominal", str(NOMINAL[unit]))
        structure = root.find("ModelStructure")
        initial = SubElement(structure, "InitialUnknowns")
        for output in structure.find("Outputs"):
            output.set("dependencies", "")            # no input acts at once: an input counts from the start of the coming interval
            SubElement(initial, "Unknown", {"index": output.get("index")})
        return root
