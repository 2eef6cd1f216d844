#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Makes the pictures of docs/browser.md, by the tests of the page, from a release build: of a bucky ball
# of 129^3 samples, and of docs/examples/live. Arguments: the pictures, of docs/figures/view.png,
# docs/figures/view_slice.png, docs/figures/view_saved.png and docs/figures/view_live.png.
set -euo pipefail
root=$(cd "$(dirname "$0")/../../.." && pwd)
build=$root/build/release
folder=$build/tests/tools/view
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chromium=$(command -v chromium)

volume() {
    [ -e "$work/bucky.nrrd" ] && return
    "$folder/make_bucky_balls" "$work" 129
    mv "$work/first.nrrd" "$work/bucky.nrrd"
}

explored() {
    [ -e "$work/view.png" ] && return
    volume
    node "$folder/page_test.mjs" "$build/tools/nestgrid" "$chromium" "$work" "$work/bucky.nrrd"
}

saved() {
    volume
    node "$folder/picture_test.mjs" "$build/tools/nestgrid" "$chromium" "$work" "$work/bucky.nrrd"
}

pushed() {
    node "$folder/pushed_page_test.mjs" "$build/docs/examples/live" "$chromium" "$work"
}

for file in "$@"; do
    name=$(basename "$file" .png)
    [ "$name" = view ] || name=${name#view_}
    case $name in
        live) pushed ;;
        saved) saved ;;
        *) explored ;;
    esac
    cp "$work/$name.png" "$file"
done
