# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Sourced by tools/demo.sh and tests/run.sh: the Debian packages they need, and how to get them.

build_packages=(cmake ninja-build g++ pkgconf libboost-graph-dev libvtk9-dev libcli11-dev zlib1g-dev
    libcgal-dev libtbb-dev libtet1.5-dev libmuparser-dev libjsoncpp-dev libinsighttoolkit5-dev
    libhdf5-dev)
test_packages=(clang gfortran libgtest-dev libopenmesh-dev libdeal.ii-dev mpi-default-dev libp4est-dev libdune-grid-dev
    libdune-functions-dev libdune-istl-dev libalberta-dev openmpi-bin tetgen libopenvdb-dev libzstd-dev valgrind
    doxygen python3 mandoc zsh python3-nibabel python3-vtk9 python3-h5py teem-apps
    python3-meshio assimp-utils gmsh admesh python3-pydicom dcmtk libgdcm-tools)
picture_packages=(xvfb xauth libgl1-mesa-dri fonts-dejavu-core)
data_packages=(mricron-data)
python_packages=(zlib1g-dev python3-dev python3-numpy python3-pip python3-venv pybind11-dev)
python_test_packages=(python3-pytest python3-mypy python3-skimage python3-openvdb python3-vtk9 python3-h5py)
paraview_packages=(paraview)
view_packages=(libcpp-httplib-dev chromium)
wasm_packages=(emscripten chromium python3)
# npm of Debian is for its own nodejs: where there is another one, npm is there, too.
if ! command -v npm >/dev/null; then
    view_packages+=(nodejs npm)
    wasm_packages+=(nodejs npm)
fi

# Unpacks a package into a folder, unless it is there: one that conflicts with others installed.
unpack_package() {
    [ -d "$2" ] && return 0
    local part
    part=$(mktemp -d)
    echo "unpacking $1"
    if (cd "$part" && apt-get -qq download "$1" >log 2>&1 && dpkg -x ./*.deb unpacked); then
        mkdir -p "$(dirname "$2")" && mv "$part/unpacked" "$2"
    else
        tail -n 5 "$part/log" >&2
        rm -rf "$part"
        echo "$1 could not be unpacked" >&2
        return 1
    fi
    rm -rf "$part"
}

# Installs those of the named packages that are missing, as root or through sudo; without a
# network nothing is asked for when all of them are there.
need_packages() {
    local package missing=()
    for package in "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] ||
            missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    local as_root=()
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || {
            echo "these packages are missing and there is no sudo to install them: ${missing[*]}" >&2
            return 1
        }
        as_root=(sudo)
    fi
    echo "installing ${missing[*]}"
    local log
    log=$(mktemp)
    if ! {
        "${as_root[@]}" apt-get -o DPkg::Lock::Timeout=600 -qq update &&
            "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=600 \
                -qq -y --no-install-recommends install "${missing[@]}"
    } >"$log" 2>&1; then
        tail -n 5 "$log" >&2
        rm -f "$log"
        echo "these packages could not be installed: ${missing[*]}" >&2
        return 1
    fi
    rm -f "$log"
}
