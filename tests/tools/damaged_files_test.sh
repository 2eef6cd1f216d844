#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Damages files of one format and hands them to the program (see mutate_files.cpp).
# Arguments: the folder of the program's tests, the program, the format. The environment variable
# NESTGRID_DAMAGED_FILES says how many files, by default 100.
set -euo pipefail
tools=$1
program=$2
format=$3
count=${NESTGRID_DAMAGED_FILES:-100}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$tools/make_volumes" "$work"
"$tools/make_meshes" "$work" 1
"$tools/make_plotfiles" "$work"
case $format in
vthb | htg | enzo | flash | chombo | athena)
    /usr/bin/python3 -B "$(dirname "$0")/make_amr_files.py" "$work" 2>/dev/null ||
        { echo "skipped: there is no h5py or VTK" && exit 77; }
    ;;
esac
cd "$work"
gzip -c v.raw >v.raw.gz
sed 's/raw$/gzip/; s/v\.gzip/v.raw.gz/' v.nhdr >packed.nhdr
header=(NRRD0004 'type: uchar' 'dimension: 3' 'sizes: 20 24 18' 'spacings: 0.5 1 2')
{ printf '%s\n' "${header[@]}" 'encoding: gzip' '' && cat v.raw.gz; } >packed.nrrd
{ printf '%s\n' "${header[@]}" 'encoding: ascii' '' && od -An -v -t u1 v.raw; } >text.nrrd
printf '%s\n' 'NDims = 3' 'DimSize = 20 24 18' 'ElementType = MET_UCHAR' \
    'ElementDataFile = v.raw' >plain.mhd
"$program" mesh t.off --family bisection --field x -o h.nestgrid >log
"$program" mesh t.off --family bisection --field x+t --times 0,1 -o film.nestgrid >log
"$program" pack film.nestgrid --encode -o exact.nestgrid >log
"$program" pack film.nestgrid --encode-within 0.1 -o near.nestgrid >log

isosurface=(isosurface IN --threshold 5% -o OUT.vtp)
blocks=("${isosurface[@]}" --field dist --value 0 --read-limit 2)
mesh=(mesh IN --read-limit 2 -o OUT.nestgrid)
volume=("${isosurface[@]}" --value 130 --read-limit 2)
# Names are found once, not in the child of each file.
export LD_BIND_NOW=1
mutate() { "$tools/mutate_files" "$count" "$work" "$@"; }
case $format in
mhd) mutate v.mhd v.zraw -- "${volume[@]}" && mutate plain.mhd v.raw -- "${volume[@]}" ;;
nhdr) mutate v.nhdr v.raw -- "${volume[@]}" && mutate packed.nhdr v.raw.gz -- "${volume[@]}" ;;
nrrd)
    mutate v.nrrd -- "${volume[@]}" && mutate packed.nrrd -- "${volume[@]}" &&
        mutate text.nrrd -- "${volume[@]}"
    ;;
plotfile)
    mutate small/Header small/Level_{0,1,2}/Cell_{H,D_00000,D_00001} -- "${isosurface[@]}" --array distance --value 0
    ;;
vthb) mutate amr.vthb amr/*.vti -- "${blocks[@]}" ;;
htg) mutate plane_trees.htg -- isolines IN --field dist --values 0 --threshold 5% --read-limit 2 -o OUT.vtp ;;
enzo) mutate enzo/data0000.hierarchy enzo/data0000 enzo/data0000.cpu0000 -- "${blocks[@]}" ;;
flash) mutate run_hdf5_plt_cnt_0000 -- "${blocks[@]}" ;;
chombo) mutate chombo.hdf5 -- "${blocks[@]}" ;;
athena) mutate athena.athdf -- "${blocks[@]}" ;;
vtu) mutate solution.vtu -- isosurface IN --field u --value 0.3 --error 0.3 --read-limit 2 -o OUT.vtp ;;
raw) mutate v.raw -- "${volume[@]}" --dims 20,24,18 --type uint8 ;;
vti | mha | nii | nii.gz) mutate v.$format -- "${volume[@]}" ;;
off | obj | ply | stl) mutate t.$format -- "${mesh[@]}" --family red-green ;;
ele) mutate c.ele c.node -- "${mesh[@]}" --family bisection ;;
node) mutate c.node c.ele -- "${mesh[@]}" --family bisection ;;
poly) mutate p.poly -- "${mesh[@]}" --family bisection ;;
smesh) mutate s.smesh -- "${mesh[@]}" --family bisection ;;
nestgrid)
    mutate h.nestgrid -- "${isosurface[@]}" --value 0.5 &&
        mutate film.nestgrid -- "${isosurface[@]}" --value 0.5 --time 0.5 &&
        mutate exact.nestgrid -- "${isosurface[@]}" --value 0.5 --time 0.5 &&
        mutate near.nestgrid -- "${isosurface[@]}" --value 0.5 --time 0.5
    ;;
solid)
    # An octahedron, as the domain of a lens.
    printf '%s\n' 'OFF' '6 8 0' '2 9 8' '8 9 8' '5 4 8' '5 14 8' '5 9 3' '5 9 13' '3 0 2 4' '3 2 1 4' \
        '3 1 3 4' '3 3 0 4' '3 2 0 5' '3 1 2 5' '3 3 1 5' '3 0 3 5' >s.off
    "$program" mesh s.off --family red-green --field x -o s.nestgrid >log
    for solid in s.vtp s.stl s.ply s.obj; do "$program" surface s.nestgrid -o $solid >log; done
    lens=(isosurface "$work/v.vti" --value 130 --lens surface:IN -o OUT.vtp)
    mutate s.vtp -- "${lens[@]}" && mutate s.stl -- "${lens[@]}" && mutate s.off -- "${lens[@]}"
    ;;
*) echo "unknown format $format" && exit 1 ;;
esac
