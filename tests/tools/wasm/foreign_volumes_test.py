# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""The page reads the volumes of foreign_volumes.py as the program does.

Both give the same samples at the same places, with the same space and unit, or refuse a file for the
same reason.

Arguments: the program, write_with_itk, Node, and the folder explore.
"""

import json
import os
import subprocess
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from foreign_volumes import judge_all  # noqa: E402

PROGRAM, FOLDER = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[4])
NODE = sys.argv[3]
PLACES = 100

# What the library of NRRD says, and what the page does.
REASONS = {
    "parsed 0 values, but space dimension is 3": "of which 'x' is no number",
    "parsed 2 values, but dimension is 3": "the sizes '24 22', but the dimension 3",
    "axis 2 size is zero": "of which 'two' is no number",
    "choose by --component 0 to 2, or by --magnitude": "choose a component, 0 to 2, or the magnitude",
    "choose one by --array": "choose one",
}

failures = 0


def fail(text):
    global failures
    failures += 1
    print("FAILED:", text)


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)


def choice_of(options):
    """What the page takes for options of the program."""
    choice = {}
    for i, word in enumerate(options):
        if word == "--magnitude":
            choice["component"] = "magnitude"
        elif word in ("--frame", "--component", "--array"):
            choice[word[2:]] = options[i + 1]
    return choice


def files_of(name):
    """A file, and with one that may be a header alone all that holds bare samples beside it."""
    files = [name]
    if name.endswith((".nhdr", ".mhd")):
        endings = (".raw", ".raw.gz", ".zraw", ".ascii", ".hex")
        files += sorted(each for each in os.listdir(".") if each.endswith(endings))
    return list(map(os.path.abspath, files))


class Judge:
    def __init__(self):
        self.random = np.random.default_rng(1)
        self.read = self.refusals = 0
        self.page = subprocess.Popen(
            [NODE, os.path.join(HERE, "read_volumes.mjs"), FOLDER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )

    def of_page(self, name, options, places=()):
        request = {"files": files_of(name), "choice": choice_of(options), "places": list(map(int, places))}
        self.page.stdin.write(json.dumps(request) + "\n")
        self.page.stdin.flush()
        return json.loads(self.page.stdout.readline())

    def good(self, name, samples, *options, **_):
        self.range(name, samples, *options)

    def range(self, name, samples, *options):
        self.read += 1
        done = program("info", name, *options, "--json")
        if done.returncode != 0:
            fail(f"{name}: the program says {done.stderr.strip()}")
            return
        facts = json.loads(done.stdout)
        shape = [int(n) for n in facts["samples"]]
        # Rounding puts places at the boundary outside, for the program.
        indices = np.array([self.random.integers(1, n - 1, PLACES) for n in shape])
        numbers = indices[0] + shape[0] * (indices[1] + shape[1] * indices[2])
        told = self.of_page(name, options, numbers)
        if "refusal" in told:
            fail(f"{name}: the page says {told['refusal']}")
            return
        self.compare(name, facts, told)
        if told["samples"] != shape:
            return
        steps = np.array([facts["axis_x"], facts["axis_y"], facts["axis_z"]]).T * facts["spacing"]
        points = np.asarray(facts["origin"])[:, None] + steps @ indices
        self.compare_values(name, options, points.T, told)

    def compare(self, name, facts, told):
        """What is said of a volume."""
        pairs = [
            ("samples", [int(n) for n in facts["samples"]], told["samples"]),
            ("type", facts["type"], told["type"]),
            ("unit", facts.get("length_unit", ""), told["lengthUnit"]),
            ("space", facts.get("space", "").split(" (")[0], told["space"]),
        ]
        for what, of_program, of_page in pairs:
            if of_program != of_page:
                fail(f"{name}: {what} {of_program} in the program, {of_page} in the page")
        for what in "least", "greatest":
            of_program, of_page = facts[f"{what}_value"], told[what]
            # Functions of numbers may round otherwise.
            if abs(of_program - of_page) > 1e-14 * abs(of_program):
                fail(f"{name}: {what} value {of_program} in the program, {of_page} in the page")
        axes = np.array([facts["axis_x"], facts["axis_y"], facts["axis_z"]]).T
        steps = axes * facts["spacing"]
        steps_of_page = np.reshape(told["direction"], (3, 3)) * told["spacing"]
        most = 1e-6 * np.abs(facts["spacing"]).min()
        if np.abs(steps - steps_of_page).max() > most or np.abs(np.subtract(facts["origin"], told["origin"])).max() > most:
            fail(f"{name}: places {facts['origin']} {steps.tolist()} in the program, {told['origin']} {steps_of_page.tolist()} in the page")
        left_out = " ".join(facts["notes"]).split(";")[0]
        if left_out not in told["note"] or (told["note"] and not left_out and "sample" not in told["note"]):
            fail(f"{name}: '{left_out}' in the program, '{told['note']}' in the page")

    def compare_values(self, name, options, points, told):
        with open("points.csv", "w") as file:
            file.writelines(",".join(map(repr, map(float, point))) + "\n" for point in points)
        done = program("probe", name, *options, "--points", "points.csv")
        if done.returncode != 0:
            fail(f"{name}: probe says {done.stderr.strip()}")
            return
        texts = [line.split(",")[3] for line in done.stdout.splitlines()[1:]]
        values = np.array([float(text or "nan") for text in texts])
        most = 1e-6 * (told["greatest"] - told["least"])
        # Beside samples that are missing the program draws nothing.
        of_page = np.array(told["values"], float)
        drawn = ~np.isnan(values) & ~np.isnan(of_page)
        if len(values) != PLACES or drawn.sum() < PLACES / 2 or np.abs(values - of_page)[drawn].max() > most:
            fail(f"{name}: values {values[:4]} in the program, {told['values'][:4]} in the page")

    def refused(self, name, reason, *options):
        self.refusals += 1
        done = program("info", name, *options)
        told = self.of_page(name, options)
        sentence = told.get("refusal", "")
        if done.returncode != 1 or reason not in done.stderr:
            fail(f"{name}: the program says {done.stderr.strip()}")
        for of_program, of_page in REASONS.items():
            reason = reason.replace(of_program, of_page)
        if name not in sentence or reason not in sentence or "\n" in sentence:
            fail(f"{name}: the page says '{sentence}', and the program {done.stderr.strip()}")


def main():
    judge = Judge()
    judge_all(judge)
    judge.page.stdin.close()
    print(f"{judge.read} files and choices read alike, {judge.refusals} refused alike, {failures} failures")
    sys.exit(failures > 0)


main()
