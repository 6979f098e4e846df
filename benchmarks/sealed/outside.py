"""Laws that the units can follow and the library has no file for: the generic terms of decision 9 with one set of exponents each.

Left out is what the library has under a name (depth 0, rate 2, while sinking is momentum transfer) or nearly has (depth 2 alone is close to
a layer, strut rate 1 to strut damping).
"""

from __future__ import annotations

from typing import Any

from orchestrator.diagnosis.effects import Effect

_BODY = [{"from": "guidance.engine.thrust", "to": "body_term.engine.thrust"}, {"ports": ["body.body", "body_term.body"]},
         {"ports": ["body_term.effect", "body.effect4"]}]  # fmt: skip
_PORTS = {"soil.normal": ("soil.normal_term", "soil."), "soil.tangential": ("soil.tangent_term", "soil."),
          "strut": ("gear.strut_term", "gear."), "body": ("body_term.coefficient", "body_term.")}  # fmt: skip

def law(name: str, size: float, physics: str, port: str, energy: str, **exponents: float) -> Effect:
    """size: N or N.m, standard deviation of the coefficient's prior, such that most landings can feel it."""
    target, place = _PORTS[port]
    tree: dict[str, Any] = {
        "title": physics, "physics": physics, "equation": name, "port": port, "kind": "force", "energy": energy,
        "parameters": [{"name": "coefficient", "unit": "1" if port == "body" else "N", "target": [target], "starts": [size],
                        "prior": {"shape": "half-normal", "sigma": size}, "limits": [-20.0 * size, 20.0 * size]}],
        "fixed": {place + key: value for key, value in exponents.items()},
    }  # fmt: skip
    if port == "body":
        tree["insert"] = {"unit": "body_term", "fmu": "BodyTerm", "connections": _BODY}
    effect = Effect.model_validate(tree)
    effect._name = name
    return effect


LAWS = {
    it.name: it
    for it in (
        law("outside_normal_depth_rate2", 500.0, "Normal force with depth times the square of the sink rate, while sinking", "soil.normal",
             "dissipative", normal_term_depth=1.0, normal_term_rate=2.0, normal_term_phase=1),
        law("outside_normal_depth2_rate", 2000.0, "Normal force with the square of depth times sink rate, while sinking", "soil.normal",
             "dissipative", normal_term_depth=2.0, normal_term_rate=1.0, normal_term_phase=1),
        law("outside_normal_root_depth", 5000.0, "Normal force with the root of depth, while sinking", "soil.normal",
             "dissipative", normal_term_depth=0.5, normal_term_rate=0.0, normal_term_phase=1),
        law("outside_tangent_speed", 150.0, "Drag in proportion to the slip", "soil.tangential",
             "dissipative", tangent_term_depth=0.0, tangent_term_speed=1.0, tangent_term_phase=0),
        law("outside_tangent_depth_speed", 50.0, "Drag with depth times slip", "soil.tangential",
             "dissipative", tangent_term_depth=1.0, tangent_term_speed=1.0, tangent_term_phase=0),
        law("outside_tangent_depth_slide", 50.0, "A wall of soil pushed ahead, with depth times slide", "soil.tangential",
             "active", tangent_term_depth=1.0, tangent_term_slide=1.0, tangent_term_phase=1),
        law("outside_strut_root_stroke", 400.0, "Strut force with the root of the stroke", "strut",
             "conservative", strut_term_stroke=0.5, strut_term_phase=0),
        law("outside_strut_rate2", 150.0, "Strut force with the square of the stroke rate", "strut",
             "dissipative", strut_term_rate=2.0, strut_term_phase=3),
        law("outside_secondaries_stroke2", 100.0, "Force of the secondaries with the square of the stroke", "strut",
             "conservative", strut_term_stroke=2.0, strut_term_phase=0, strut_term_struts=2),
        law("outside_roll_rate2", 300.0, "Torque about Z with the square of the rate", "body", "active", axis=6, basis=6),
        law("outside_yaw_angle", 200.0, "Torque about X with the yaw angle", "body", "active", axis=4, basis=7),
        law("outside_sideways_drag", 300.0, "Force along Y with the square of the velocity", "body", "active", axis=2, basis=4),
        law("outside_pitch_torque_fading", 300.0, "Torque about Y that fades with a second", "body", "active", axis=5, basis=2),
    )
}  # fmt: skip
