#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# pip makes one wheel from the root without a network, and a folder into which it is installed is
# all that its import needs. Arguments: the source folder, the build folder, Python.
set -euo pipefail
source=$1 build=$2 python=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$source"
"$python" -m pip install . --no-index --no-deps --no-build-isolation --quiet \
    --disable-pip-version-check --root-user-action ignore --no-cache-dir \
    --config-settings "build-dir=$build" --target "$work/site"
cd "$work"
[ -d site/nestgrid-0.1.0.dist-info ] || { echo "FAILED: no metadata"; exit 1; }
library=$(echo site/nestgrid/_nestgrid.*.so)
! ldd "$library" | grep -i nestgrid || { echo "FAILED: the library is not linked statically"; exit 1; }
PYTHONPATH=$work/site "$python" - <<'EOF'
import numpy as np, nestgrid, os
assert nestgrid.__file__.startswith(os.getcwd()), nestgrid.__file__
assert os.path.exists(f"site/nestgrid-{nestgrid.__version__}.dist-info"), nestgrid.__version__
assert os.path.exists("site/nestgrid/_nestgrid.pyi")
x, y, z = np.meshgrid(*[np.linspace(-1, 1, 17)] * 3, indexing="ij")
surface = nestgrid.Volume(1 - np.sqrt(x * x + y * y + z * z)).isosurface(0.5)
assert surface.report()["closed"] and len(surface.triangles) > 100
EOF
echo "wheel: $(du -sk site | cut -f1) KB installed"
