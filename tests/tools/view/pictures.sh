#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Makes the pictures of docs/browser.md, by the test of the page on a bucky ball of 129^3 samples, from
# a release build. Arguments: the pictures, docs/figures/view.png and docs/figures/view_slice.png.
set -euo pipefail
root=$(cd "$(dirname "$0")/../../.." && pwd)
build=$root/build/release
folder=$build/tests/tools/view
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$folder/make_bucky_balls" "$work" 129
mv "$work/first.nrrd" "$work/bucky.nrrd"
node "$folder/page_test.mjs" "$build/tools/nestgrid" "$(command -v chromium)" "$work" "$work/bucky.nrrd"
for file in "$@"; do
    name=$(basename "$file" .png)
    [ "$name" = view ] || name=${name#view_}
    cp "$work/$name.png" "$file"
done
