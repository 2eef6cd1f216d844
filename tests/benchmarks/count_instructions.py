# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of a surface that is drawn in two ways, the same to the bit, counted by callgrind.

Arguments: the program; the way that is to cost no more, and the plain one, as the program takes
them; the steps, each a function step_* of the program; --quick for a small grid. Prints millions of
instructions of each step, and the ratio of both. Fails where all together are more than 1.02.
"""
import argparse
import re
import shutil
import subprocess
import sys
import tempfile


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
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("how")
    parser.add_argument("plain")
    parser.add_argument("steps", nargs="+")
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    if shutil.which("valgrind") is None:
        print("valgrind is missing")
        sys.exit(77)
    leaves = 5000 if arguments.quick else 60000
    sums = [0, 0]
    for step in arguments.steps:
        ours, told = count(arguments.program, arguments.how, step, leaves)
        plain, same = count(arguments.program, arguments.plain, step, leaves)
        if told != same:
            sys.exit(f"{arguments.how} draws {told}, and {arguments.plain} {same}")
        sums = [sums[0] + ours, sums[1] + plain]
        beside = f"for {plain / 1e6:9.2f}, ratio {ours / plain:.3f}" if plain else "more"
        print(f"{step:15} {ours / 1e6:9.2f} {beside}")
    print(f"{'all':15} {sums[0] / 1e6:9.2f} for {sums[1] / 1e6:9.2f}, ratio {sums[0] / sums[1]:.3f}")
    print(told.strip().replace("\n", ", "))
    sys.exit(0 if sums[0] <= 1.02 * sums[1] else 1)


main()
