"""The study's scene at its fourteen ray counts: Mitsuba 3 beside `acuity render`, both as whole processes.

    python with_mitsuba.py ACUITY       ACUITY: the release build of the program

Needs `pip install mitsuba numpy`. `llvm_ad_spectral` needs LLVM 19 or later: Debian's `libllvm19`, or another
libLLVM named by DRJIT_LIBLLVM_PATH. Mitsuba cannot take fewer rays than pixels, so each count is rendered
with one sample in each pixel of a square of as many pixels, with direct light and two mirrors; nothing is
written. Ours makes all 28 images, writes them as EXR and PNG, and the manifest. Prints the least wall time of
three runs each, taken in turn, and the ratio.
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
os.environ.setdefault("DRJIT_LIBLLVM_PATH", "/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1")


def render(variant):
    """One process: import, load, fourteen renders."""
    import mitsuba as mi
    import numpy as np

    mi.set_variant(variant)
    sys.path.insert(0, str(ROOT / "renderer/tests/mitsuba"))
    from export import Exported

    integrator = '<integrator type="path"><integer name="max_depth" value="4"/></integrator>'
    with tempfile.TemporaryDirectory() as folder:
        exported = Exported(SCENE, folder)
        for rays in range(10_000, 150_000, 10_000):
            side = round(rays**0.5)
            scene = mi.load_string(exported.xml([side, side], 1, integrator=integrator))
            np.array(mi.render(scene, spp=1))


def wall(command):
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def main(acuity):
    times = {}
    for _ in range(3):
        with tempfile.TemporaryDirectory() as folder:
            seconds = wall([acuity, "render", "--quiet", "--out", folder, PROTOCOL])
        times.setdefault("acuity", []).append(seconds)
        for variant in VARIANTS:
            times.setdefault(variant, []).append(wall([sys.executable, __file__, "--variant", variant]))
    ours = min(times["acuity"])
    print(f"acuity: {ours:.2f} s for 28 images, written")
    for variant in VARIANTS:
        theirs = min(times[variant])
        print(f"{variant}: {theirs:.2f} s for 14 images, not written; {theirs / ours:.1f} times ours")


if __name__ == "__main__":
    if sys.argv[1] == "--variant":
        render(sys.argv[2])
    else:
        main(sys.argv[1])
