# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of a surface drawn on one rank, beside the same without ranks, counted by callgrind.

Arguments: the program bench_one_rank; --quick for a small grid. Prints millions of instructions of
each step, and the ratio of both.
"""
import re
import shutil
import subprocess
import sys
import tempfile

STEPS = ("grid", "field", "preroll", "surface", "coarse_surface")


def count(program, how, step, leaves):
    """Instructions of one step, and what the program prints."""
    with tempfile.NamedTemporaryFile() as out:
        command = ["valgrind", "--tool=callgrind", f"--toggle-collect=step_{step}"]
        text = subprocess.run(
            [*command, f"--callgrind-out-file={out.name}", program, how, str(leaves)],
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        return int(re.search(r"^(?:totals|summary): (\d+)", open(out.name).read(), re.M)[1]), text


def main():
    if shutil.which("valgrind") is None:
        print("valgrind is missing")
        sys.exit(77)
    leaves = 5000 if "--quick" in sys.argv else 60000
    sums = [0, 0]
    for step in STEPS:
        ranks, told = count(sys.argv[1], "ranks", step, leaves)
        alone, same = count(sys.argv[1], "alone", step, leaves)
        if told != same:
            sys.exit(f"one rank draws {told}, and without ranks {same}")
        sums = [sums[0] + ranks, sums[1] + alone]
        beside = f"for {alone / 1e6:9.2f}, ratio {ranks / alone:.3f}" if alone else "on one rank alone"
        print(f"{step:15} {ranks / 1e6:9.2f} {beside}")
    print(f"{'all':15} {sums[0] / 1e6:9.2f} for {sums[1] / 1e6:9.2f}, ratio {sums[0] / sums[1]:.3f}")
    print(told.strip().replace("\n", ", "))
    sys.exit(0 if sums[0] <= 1.02 * sums[1] else 1)


main()
