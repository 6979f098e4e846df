"""RateSensor: what the ground received of the body's rates."""

from math import exp, floor

from ..shell import Unit, input_, nanoseconds, output, parameter, state

AXES = ("yaw", "pitch", "roll")
RATES = tuple((f"rates.{axis}", f"rates.{axis}_slope") for axis in AXES)
TELEMETRY = tuple(f"telemetry.{axis}" for axis in AXES)


class RateSensor(Unit):
    """Lag, bias, scale, sampling and quantisation of three rates, in this order.

    τ dy/dt = u - y              first-order lag, exact for an input that is linear over the interval; τ = 0: y = u
    z = scale (y + φ x y) + bias         φ: the sensor's small rotation against B
    sampled at t0, t0 + Δ, t0 + 2Δ, ... and held; Δ = 0: not sampled. The instants are counted in nanoseconds.
    telemetry = q round(z / q), half upwards; q = 0: not quantised

    An input without slope is held over the interval. next_event_time is when the next sample is due. Neutral parameters (the defaults)
    give the input at the interval's end.
    """

    description = "Telemetry of the body's rates: lag, bias, scale, sampling and quantisation."
    required = (*(rate for rate, _ in RATES), *TELEMETRY)
    variables = (
        parameter("time_constant", 0.0, "s", "time constant of the first-order lag", minimum=0.0),
        parameter("sample_interval", 0.0, "s", "time between samples, 0: continuous", minimum=0.0, maximum=1e6),
        parameter("quantum", 0.0, "rad/s", "step of the quantised rate, 0: none", minimum=0.0),
        parameter("bias", (0.0, 0.0, 0.0), "rad/s", "added to yaw, pitch, roll rate"),
        parameter("scale", 1.0, "1", "factor on all rates"),
        parameter("misalignment", (0.0, 0.0, 0.0), "rad", "small rotation of the sensor about X, Y, Z of B"),
        *(input_(f"rates.{axis}", 0.0, "rad/s", f"true {axis} rate, frame B", nominal=0.1, slope=True) for axis in AXES),
        *(
            output(
                f"telemetry.{axis}",
                0.0,
                "rad/s",
                f"received {axis} rate",
                nominal=0.1,
                initially=(*(f"rates.{a}" for a in AXES), "bias", "scale", "misalignment", "quantum"),
            )
            for axis in AXES
        ),
        output("next_event_time", -1.0, "s", "next sample, -1: continuous", nominal=1.0, initially=("sample_interval",)),
        state("lagged", (0.0, 0.0, 0.0)),
        state("held", (0.0, 0.0, 0.0)),
        state("samples", 0.0, "samples taken since the start; counted, not summed"),
    )

    experiment = (0.0, 1.0, 0.01)
    reference_parameters = (
        ("time_constant", 0.05),
        ("sample_interval", 0.025),
        ("quantum", 0.001),
        ("scale", 1.02),
        ("bias", (0.0, 0.01, 0.0)),
    )

    @classmethod
    def stimulus(cls, time: float) -> dict[str, float]:
        slopes = {"yaw": 0.3, "pitch": -0.2, "roll": 0.1}
        return {f"rates.{a}": k * time for a, k in slopes.items()} | {f"rates.{a}_slope": k for a, k in slopes.items()}

    def initialise(self) -> None:
        self["lagged"] = [self.value(f"rates.{axis}") for axis in AXES]
        self["held"] = self["lagged"]
        self["samples"] = 1.0
        self["next_event_time"] = self.next_sample(0)
        self.show()

    def advance(self, time: float, step: float) -> None:
        interval = nanoseconds(self.value("sample_interval"))
        now, end = nanoseconds(time - self.start_time), nanoseconds(time + step - self.start_time)
        count = end // interval if interval else 0  # samples due after the first one, which is at the start
        instant = (count * interval - now) * 1e-9
        lagged, held = self["lagged"], self["held"]
        before = [(y, self.value(u), self.value(k)) for y, (u, k) in zip(lagged.tolist(), RATES, strict=True)]
        if interval and count >= self.value("samples"):
            held[:] = [self.after(y, u, k, instant) for y, u, k in before]
        lagged[:] = [self.after(y, u, k, step) for y, u, k in before]
        if not interval:
            held[:] = lagged
        self["samples"] = max(self.value("samples"), count + 1.0)
        self["next_event_time"] = self.next_sample(count)
        self.show()

    def next_sample(self, count: int) -> float:
        """When the sample after the last `count` is due, in s."""
        interval = nanoseconds(self.value("sample_interval"))
        return self.start_time + (count + 1) * interval * 1e-9 if interval else -1.0

    def after(self, y: float, u: float, k: float, t: float) -> float:
        """The lag's answer a time t after y, when the input is u + k t: y = u + k (t - τ) + (y0 - u + k τ) exp(-t/τ)."""
        tau = self.value("time_constant")
        if tau == 0.0:
            return u + k * t
        return u + k * (t - tau) + (y - u + k * tau) * exp(-t / tau)

    def show(self) -> None:
        """Fill the outputs from the held samples."""
        scale, quantum, held, (a, b, c) = self.value("scale"), self.value("quantum"), self["held"].tolist(), self["misalignment"].tolist()
        if a or b or c:  # φ x y written out: numpy's cross product took half of a step
            x, y, z = held
            held = [x + (b * z - c * y), y + (c * x - a * z), z + (a * y - b * x)]
        for name, rate, bias in zip(TELEMETRY, held, self["bias"].tolist(), strict=True):
            received = scale * rate + bias
            self[name] = quantum * floor(received / quantum + 0.5) if quantum > 0.0 else received
