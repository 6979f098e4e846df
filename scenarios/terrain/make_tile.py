"""Makes site.npy, the small synthetic height map of apollo11_dem.toml: python scenarios/terrain/make_tile.py

Not a survey of Tranquility Base. Fractal roughness: amplitudes fall with the wavelength by a power law of Hurst exponent 0.8, scaled to an
rms slope of 5 % (3 degrees) from pixel to pixel. Both are assumed. Rows north to south, heights in m, single precision, fixed seed.
"""

from pathlib import Path

import numpy as np

NODES, PIXEL = 161, 0.25  # 40 m square
HURST, RMS_SLOPE, SEED = 0.8, 0.05, 11


def tile() -> np.ndarray:
    """Heights, m."""
    random = np.random.default_rng(SEED)
    wave = np.hypot(*np.meshgrid(np.fft.fftfreq(2 * NODES), np.fft.fftfreq(2 * NODES)))
    wave[0, 0] = np.inf
    noise = np.fft.fft2(random.standard_normal((2 * NODES, 2 * NODES)))
    rough = np.fft.ifft2(noise * wave ** -(HURST + 1.0)).real[:NODES, :NODES]
    rough -= rough.mean()
    return (rough * RMS_SLOPE * PIXEL / np.diff(rough, axis=0).std()).astype(np.float32)


if __name__ == "__main__":
    np.save(Path(__file__).parent / "site.npy", tile())
