"""`acuity anova` beside afex (R) and pingouin (Python) on the same tables, all as whole processes, in one run.

    python with_afex_and_pingouin.py ACUITY [ROUNDS]     ACUITY: the release build of the program; 3 rounds if not said

Tables: 12 subjects x 2 x 13 (the paper's design), and 2000 subjects x 4 x 13 (104,000 rows); made here from a fixed
seed. Each prints F, corrected p and generalized eta squared of both factors and their interaction (pingouin: partial).

A peer that is not installed is skipped, and why is said. Debian: r-cran-afex; `pip install pingouin`, whose Python is
PEER_PYTHON if that is set.

Prints for each the least wall time, its CPU time, and its largest memory, and the ratios of wall times to ours.
"""

import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

AFEX = """suppressMessages(library(afex))
d <- read.csv(commandArgs(TRUE)[1]); d$subject <- factor(d$subject); d$a <- factor(d$a); d$b <- factor(d$b)
print(aov_ez("subject", "rating", d, within = c("a", "b"), include_aov = FALSE)$anova_table)
"""
PINGOUIN = """import sys, pandas, pingouin
d = pandas.read_csv(sys.argv[1])
print(pingouin.rm_anova(d, dv="rating", within=["a", "b"], subject="subject"))
"""


def table(path, subjects, a_levels):
    draw = random.Random(1992)
    with open(path, "w") as file:
        file.write("subject,a,b,rating\n")
        for subject in range(subjects):
            own = draw.gauss(0, 1)
            for a in range(a_levels):
                for b in range(13):
                    rating = 5 + own + 0.3 * a + 0.2 * b + 0.05 * a * b + draw.gauss(0, 1.2)
                    file.write(f"s{subject},a{a},b{b},{rating:.3f}\n")


def measured(command):
    """Wall seconds, CPU seconds and MiB of one process; None with what it said if it failed."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    said = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    if status:
        return None, (said.strip().splitlines() or ["it failed"])[-1]
    return (wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024), ""


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    acuity, rounds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 3
    python = os.environ.get("PEER_PYTHON", sys.executable)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "afex.R").write_text(AFEX)
        (folder / "pingouin_.py").write_text(PINGOUIN)
        for subjects, a_levels in [(12, 2), (2000, 4)]:
            path = str(folder / f"{subjects}.csv")
            table(path, subjects, a_levels)
            print(f"{subjects} x {a_levels} x 13")
            jobs = {
                "acuity": [acuity, "anova", path, "--subject", "subject", "--rating", "rating", "--within", "a,b"],
                "afex": ["Rscript", str(folder / "afex.R"), path],
                "pingouin": [python, str(folder / "pingouin_.py"), path],
            }
            best = {}
            for _ in range(rounds):
                for name, command in list(jobs.items()):
                    try:
                        figures, why = measured(command)
                    except FileNotFoundError as error:
                        figures, why = None, str(error)
                    if figures is None:
                        print(f"  {name:9} skipped: {why}")
                        del jobs[name]
                    elif name not in best or figures < best[name]:
                        best[name] = figures
            for name, (wall, cpu, mib) in best.items():
                ratio = f"{wall / best['acuity'][0]:8.0f} times acuity's" if name != "acuity" else ""
                print(f"  {name:9} {1000 * wall:8.1f} ms wall {1000 * cpu:8.1f} ms CPU {mib:6.0f} MiB {ratio}")


main()
