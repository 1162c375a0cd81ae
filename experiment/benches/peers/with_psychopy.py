"""The session beside PsychoPy, one after the other on one virtual screen, in one run.

    python with_psychopy.py ACUITY STIMULI [TRIALS]    ACUITY: the release build; STIMULI: the rendered set of
                                                       protocols/meyer-liu-1992.toml; 100 trials if not said

Needs Xvfb and xdotool. PsychoPy (`pip install psychopy`) is that of PEER_PYTHON; where it is missing, that is said and
only ours are measured.

Prints for each: process start to the first grey frame in the screen's memory; largest resident memory with the 28 images
loaded; error of a 2 s exposure by the program's own log, with one core kept busy, and how many of the trials are within
one frame, which is the median interval that the program measured; trials finished and trials on disk after SIGKILL. Xvfb
has no vertical blank: both are timed against the scheduler.
"""

import csv
import glob
import json
import mmap
import os
import signal
import statistics
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROTOCOL = Path(__file__).parents[3] / "protocols" / "meyer-liu-1992.toml"
PEER = """import csv, glob, os, sys
from psychopy import core, data, visual
folder, stimuli, trials = sys.argv[1], sys.argv[2], int(sys.argv[3])
window = visual.Window(fullscr=True, color=[0, 0, 0], units="pix", allowGUI=False, checkTiming=False)
window.flip()
images = [visual.ImageStim(window, path) for path in sorted(glob.glob(stimuli + "/*.png"))]
for image in images:
    image.draw()
window.flip()
handler = data.ExperimentHandler(name="peer", dataFileName=folder + "/peer", savePickle=False)
window.recordFrameIntervals = True
log = open(folder + "/exposures.txt", "w", buffering=1)
for trial in range(trials):
    image = images[trial % len(images)]
    image.draw()
    onset = window.flip()
    clock = core.Clock()
    while clock.getTime() < 2.0 - 0.5 / 60:
        image.draw()
        window.flip()
    offset = window.flip()
    core.wait(0.1)
    handler.addData("rating", 7)
    handler.nextEntry()
    log.write(f"{offset - onset}\\n")
with open(folder + "/frames.txt", "w") as file:
    file.write("\\n".join(map(str, window.frameIntervals)) + "\\n.")
core.wait(60)
"""


def screen(folder):
    """A virtual screen, its name, and its memory."""
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-nolisten", "tcp", "-screen", "0", "1280x1024x24", "-fbdir", folder]
    server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
    name = ":" + os.read(read, 16).decode().strip()
    with open(Path(folder) / "Xvfb_screen0", "rb") as file:
        memory = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
    return server, name, memory


def is_grey(memory):
    """Whether most of a grid of pixels has the grey of both programs."""
    header = struct.unpack(">25I", memory[:100])
    start, line = header[0] + 12 * header[19], header[12]
    places = [start + line * y + 4 * x for y in range(200, 900, 50) for x in range(40, 1240, 50)]
    grey = sum(all(118 <= value <= 138 for value in memory[at : at + 3]) for at in places)
    return grey * 2 > len(places)


def first_frame(process, started, memory):
    while process.poll() is None:
        if is_grey(memory):
            return time.perf_counter() - started
        time.sleep(0.001)
    sys.exit(f"the program ended before its first frame: {process.args}")


def peak_mib(process):
    lines = Path(f"/proc/{process.pid}/status").read_text().splitlines()
    return next(int(line.split()[1]) / 1024 for line in lines if line.startswith("VmHWM"))


def ended(process):
    process.send_signal(signal.SIGKILL)
    process.wait()


def clear(display):
    subprocess.run(["xsetroot", "-solid", "black"], env=display, check=False)
    time.sleep(1)


def ours(acuity, stimuli, trials, display, memory):
    """Sessions at five times the speed, so that 10 s are 2 s, until there are enough trials; all are killed."""
    folder = tempfile.mkdtemp()
    times, errors, within, frames_ms, finished = [], [], 0, [], 0
    while len(errors) < trials:
        subject, rows = f"P{len(times)}", []
        command = [acuity, "run", PROTOCOL, "--subject", subject, "--pilot", "5", "--stimuli", stimuli, "--data", folder]
        clear(display)
        started = time.perf_counter()
        process = subprocess.Popen(command, env=display | {"XDG_CONFIG_HOME": folder}, stdout=subprocess.DEVNULL)
        times.append(first_frame(process, started, memory))
        want = min(29, trials - len(errors))
        while len(rows) < want:
            subprocess.run(["xdotool", "key", "7", "Return"], env=display, check=True)
            time.sleep(0.1)
            if process.poll() is not None:
                sys.exit(f"the session ended after {len(rows)} trials")
            for path in glob.glob(f"{folder}/data/*{subject}*task-pilot_data.csv"):
                rows = list(csv.DictReader(open(path)))
        memory_mib, finished = peak_mib(process), len(rows)
        ended(process)
        path = glob.glob(f"{folder}/data/*{subject}*task-pilot_data.csv")[0]
        rows = list(csv.DictReader(open(path)))
        sidecar = json.loads(Path(path.replace("_data.csv", "_data.json")).read_text())
        frames_ms.append(sidecar["sittings"][-1]["frames"]["median_ms"])
        now = [abs(float(row["exposure_submitted_s"]) - 2) * 1e3 for row in rows]
        within += sum(error <= frames_ms[-1] for error in now)
        errors += now
    return times, memory_mib, errors, (statistics.median(frames_ms), within), (finished, len(rows))


def peer(python, stimuli, trials, display, memory):
    folder = tempfile.mkdtemp()
    clear(display)
    started = time.perf_counter()
    process = subprocess.Popen(
        [python, "-c", PEER, folder, stimuli, str(trials)], env=display, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    first = first_frame(process, started, memory)
    log = Path(folder) / "exposures.txt"
    while not log.exists() or len(log.read_text().splitlines()) < trials:
        time.sleep(0.2)
        if process.poll() is not None:
            sys.exit("PsychoPy ended early")
    frames = Path(folder) / "frames.txt"
    while not frames.exists() or not frames.read_text().endswith("."):
        time.sleep(0.2)
    frame_ms = statistics.median(float(line) * 1e3 for line in frames.read_text().split()[:-1])
    memory_mib = peak_mib(process)
    ended(process)
    errors = [abs(float(line) - 2) * 1e3 for line in log.read_text().splitlines()]
    within = sum(error <= frame_ms for error in errors)
    kept = sum(len(list(csv.reader(open(path)))) - 1 for path in glob.glob(folder + "/peer*.csv"))
    return [first], memory_mib, errors, (frame_ms, within), (trials, kept)


def show(name, times, memory_mib, errors, frame, kept):
    errors = sorted(errors)
    median, p99 = errors[len(errors) // 2], errors[min(len(errors) - 1, int(0.99 * len(errors)))]
    first = sorted(times)[len(times) // 2]
    print(
        f"| {name} | {first:.2f} | {memory_mib:.0f} | {median:.1f}, {p99:.1f}, {errors[-1]:.1f} |"
        f" {frame[1]} of {len(errors)} (frame {frame[0]:.1f} ms) | {kept[1]} of {kept[0]} |"
    )


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    acuity, stimuli = sys.argv[1:3]
    trials = int(sys.argv[3]) if len(sys.argv) > 3 else 100
    python = os.environ.get("PEER_PYTHON", sys.executable)
    server, name, memory = screen(tempfile.mkdtemp())
    display = os.environ | {"DISPLAY": name}
    busy = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        print(
            "| | start to first frame, s | peak memory, MiB | error of 2 s, ms: median, p99, most | within one frame |"
            " kept after SIGKILL |"
        )
        print("|---|---|---|---|---|---|")
        show("acuity", *ours(acuity, stimuli, trials, display, memory))
        if subprocess.run([python, "-c", "import psychopy.visual"], env=display, capture_output=True).returncode:
            print(f"PsychoPy is skipped: {python} cannot import psychopy.visual", file=sys.stderr)
        else:
            show("PsychoPy", *peer(python, stimuli, trials, display, memory))
    finally:
        busy.kill()
        server.kill()


if __name__ == "__main__":
    main()
