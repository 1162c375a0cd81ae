"""The study's scene at its fourteen ray counts: Mitsuba 3 beside `acuity render`, both as whole processes.

    python with_mitsuba.py ACUITY [ROUNDS]      ACUITY: the release build of the program; 5 rounds if not said

Needs `pip install mitsuba numpy`. `llvm_ad_spectral` needs LLVM 19 or later: Debian's `libllvm19`, or another
libLLVM named by DRJIT_LIBLLVM_PATH.

Theirs: import, scene loaded once, fourteen renders; nothing is written. Rays are equal: Mitsuba takes at least one
in each pixel, so N rays are one in each of N pixels, in a film whose sides are the two factors of N that are nearest
to each other (100x100 to 350x400). Paths end after two surfaces, each lit by one lamp chosen by chance; ours meet
2.06 on average, each lit by both lamps, so Mitsuba does less for a ray.

Ours: all 28 images, encoded and written as EXR and PNG, synced, and the manifest.

Wall and CPU time of each process, taken in turn after one round that is not counted (Dr.Jit keeps its compiled
kernels on disk from then on); prints the least of each and the ratios.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
SCENE = ROOT / "stimuli/scenes/opponent-solids.toml"
PROTOCOL = ROOT / "protocols/meyer-liu-1992.toml"
VARIANTS = ["scalar_spectral", "llvm_ad_spectral"]
RAYS = range(10_000, 150_000, 10_000)
os.environ.setdefault("DRJIT_LIBLLVM_PATH", "/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1")


def film_size(rays):
    """The two factors of a count that are nearest to each other."""
    width = next(side for side in range(round(rays**0.5), 0, -1) if rays % side == 0)
    return [width, rays // width]


def render(variant):
    """One process: import, load, fourteen renders."""
    import mitsuba as mi
    import numpy as np

    mi.set_variant(variant)
    sys.path.insert(0, str(ROOT / "renderer/tests/mitsuba"))
    from export import Exported

    integrator = '<integrator type="path"><integer name="max_depth" value="3"/></integrator>'
    with tempfile.TemporaryDirectory() as folder:
        exported = Exported(SCENE, folder)
        scene = mi.load_string(exported.xml(film_size(RAYS[0]), 1, integrator=integrator))
        for rays in RAYS:
            camera = f'<scene version="3.0.0">{exported.sensor(film_size(rays), 1)}</scene>'
            sensor = mi.load_string(camera).sensors()[0]
            image = np.array(mi.render(scene, sensor=sensor, spp=1))
            assert image.shape[0] * image.shape[1] == rays and np.isfinite(image).all() and image.max() > 0.1


def measure(command):
    """Wall and CPU seconds of a process."""
    before, start = os.times(), time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    wall, after = time.perf_counter() - start, os.times()
    cpu = after.children_user - before.children_user + after.children_system - before.children_system
    return wall, cpu


def main(acuity, rounds=5):
    times = {}
    for round_number in range(rounds + 1):
        with tempfile.TemporaryDirectory() as folder:
            taken = {"acuity": measure([acuity, "render", "--quiet", "--out", f"{folder}/set", PROTOCOL])}
            assert len(list(Path(folder, "set").glob("*.*"))) == 57
        for variant in VARIANTS:
            taken[variant] = measure([sys.executable, __file__, "--variant", variant])
        if round_number > 0:
            for name, seconds in taken.items():
                times.setdefault(name, []).append(seconds)
    least = {name: [min(column) for column in zip(*rows)] for name, rows in times.items()}
    ours = least["acuity"]
    print(f"acuity: {ours[0]:.2f} s wall, {ours[1]:.2f} s CPU; 28 images, written")
    for variant in VARIANTS:
        wall, cpu = least[variant]
        ratios = f"{wall / ours[0]:.1f} and {cpu / ours[1]:.1f} times ours"
        print(f"{variant}: {wall:.2f} s wall, {cpu:.2f} s CPU; {ratios}; 14 images, not written")


if __name__ == "__main__":
    if sys.argv[1] == "--variant":
        render(sys.argv[2])
    else:
        main(sys.argv[1], *map(int, sys.argv[2:3]))
