"""From the start of the app's process to its first frame, and its peak memory, in a virtual screen.

    python3 experiment/benches/peers/app_start.py target/release/acuity FOLDER [RUNS]

FOLDER is where a study lies (protocols/, stimuli/, ...); the app opens on its welcome page, and on the first protocol.
"""

import os
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from with_psychopy import clear, ended, peak_mib, screen

GROUND = bytes((247, 245, 244))  # of the light theme: blue, green, red


def is_drawn(memory):
    """Whether a quarter of a grid of pixels has the colour of the app's ground."""
    header = struct.unpack(">25I", memory[:100])
    start, line = header[0] + 12 * header[19], header[12]
    places = [start + line * y + 4 * x for y in range(150, 750, 50) for x in range(40, 1240, 50)]
    return sum(memory[at : at + 3] == GROUND for at in places) * 4 > len(places)


def cpu_s(process):
    fields = Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main():
    acuity, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    runs = int(sys.argv[3]) if len(sys.argv) > 3 else 5
    protocol = sorted(folder.glob("protocols/*.toml"))[0]
    server, name, memory = screen(tempfile.mkdtemp())
    config = Path(tempfile.mkdtemp()) / "acuity"
    config.mkdir()
    (config / "app.toml").write_text('theme = "light"\n')
    display = os.environ | {"DISPLAY": name, "XDG_CONFIG_HOME": str(config.parent)}
    for words in [[], ["app", str(protocol.resolve())]]:
        for _ in range(runs):
            clear(display)
            started = time.perf_counter()
            app = subprocess.Popen([acuity, *words], cwd=folder, env=display)
            while not is_drawn(memory):
                time.sleep(0.001)
            shown_s, cpu = time.perf_counter() - started, cpu_s(app)
            time.sleep(3)
            what = "protocol" if words else "welcome"
            print(f"{what}: first frame {shown_s:.2f} s ({cpu:.2f} CPU-s), peak {peak_mib(app):.0f} MiB", flush=True)
            ended(app)
    ended(server)


if __name__ == "__main__":
    main()
