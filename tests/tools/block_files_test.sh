#!/usr/bin/env bash
# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
#
# One grid of blocks in the formats of block-structured codes: all have one surface and one
# description, times of several files are frames, and what is wrong is refused.
# Arguments: the program, the maker of the files.
/usr/bin/python3 -c 'import h5py, vtk' 2>/dev/null || { echo "skipped: there is no h5py or VTK"; exit 77; }
make_files() { mkdir -p "$1" && /usr/bin/python3 -B "$maker" "$1"; }
maker=$2
. "$(dirname "$0")/functions.sh" "$1" true
make_files . || exit 1
files=(amr.vthb trees.htg {run,leaves}_hdf5_plt_cnt_0000 {,old_}enzo/data0000.hierarchy chombo.hdf5 athena.athdf)

for file in "${files[@]}"; do
    run info "$file"
    [ "$(value dimension)" = 3 ] && [ "$(value type)" = float64 ] || fail "info: $file: $(cat out)"
    grep -qE '^ +0 +[18] +4096 +-$' out && grep -qE '^ +2 +[0-9]+ +[0-9]+ +2$' out || fail "levels: $(cat out)"
    grep -qE '^dist +([12] +)?-0\.28[0-9]+ +0\.59[0-9]+$' out || fail "info: fields of $file: $(cat out)"
    # Of leaves, nodes, levels and fields all say the same.
    grep -E '^(leaf_elements|nodes|coarse_elements|origin|spacing)' out >facts
    [ -f all_facts ] || cp facts all_facts
    cmp -s facts all_facts || fail "$file describes another grid: $(cat facts)"
    run isosurface "$file" --field dist --value 0 --threshold 0 --threshold 5e-3 -o s.vtp
    [ "$(value open_edges | sort -u)" = 0 ] || fail "$file: open edges: $(cat out)"
    value area >areas
    [ -f all_areas ] || cp areas all_areas
    cmp -s areas all_areas || fail "$file has another surface: $(cat areas)"
    run slice "$file" --field dist --axis z --at 0.4 --threshold 0
    refused 1 "there is no field 'dits', only .*: did you mean 'dist'\?" \
        isosurface "$file" --field dits --value 0
    refused 1 "there are several fields, choose one by --array" isosurface "$file" --value 0
done
awk -v area="$(head -1 areas)" 'BEGIN { exit !(area > 1.11 && area < 1.135) }' ||
    fail "a sphere of 0.36 pi has the area $(head -1 areas)"

for file in plane_amr.vthb plane_trees.htg plane_{run,leaves}_hdf5_plt_cnt_0000 \
    plane_{,old_}enzo/data0000.hierarchy plane_chombo.hdf5 plane_athena.athdf; do
    run isolines "$file" --field dist --values 0 --threshold 0 -o l.vtp
    value length >lengths
    [ -f all_lengths ] || cp lengths all_lengths
    cmp -s lengths all_lengths || fail "$file has other lines: $(cat out)"
    run info "$file"
    [ "$(value dimension)" = 2 ] || fail "info: $file: $(cat out)"
done

# Trees by threes, and of several sizes, are no boxes: they have the same sphere.
for file in thirds.htg uneven.htg; do
    run info "$file"
    [ "$(value dimension)" = 3 ] && grep -qE '^ +0 +512$' out || fail "info: $file: $(cat out)"
    grep -qE '^dist +1 +-0\.2[0-9]+ +0\.5[0-9]+$' out || fail "info: fields of $file: $(cat out)"
    run isosurface "$file" --field dist --value 0 --threshold 0 --threshold 5e-3 -o s.vtp
    [ "$(value open_edges | sort -u)" = 0 ] || fail "$file: open edges: $(cat out)"
    awk -v area="$(value area | head -1)" 'BEGIN { exit !(area > 1.08 && area < 1.135) }' ||
        fail "$file: a sphere of 0.36 pi has another area: $(cat out)"
    run slice "$file" --field plac --axis x --at 0.4 --threshold 0
    refused 1 "there is no field 'dits', only .*: did you mean 'dist'\?" \
        isosurface "$file" --field dits --value 0
    run isolines "plane_$file" --field dist --values 0 --threshold 0 -o l.vtp
    awk -v a="$(value length)" -v b="$(head -1 all_lengths)" 'BEGIN { exit !(a > 0.99 * b && a < 1.01 * b) }' ||
        fail "plane_$file has other lines: $(cat out)"
    run isosurface "later_$file" --field dist --value 0 --threshold 1e-3 -o alone.vtp
    run isosurface "$file" "later_$file" --field dist --value 0 --threshold 1e-3 --time 1 -o timed.vtp
    cmp -s alone.vtp timed.vtp || fail "$file: the surface at the time of a file is another one"
done
# Pieces of several processes are one grid, with the bits of it, also where levels change between.
# So are trees that are counted along z first.
for name in thirds uneven even plane_thirds plane_even; do
    a=isosurface v=--value
    [[ $name == plane_* ]] && a=isolines v=--values
    run $a $name.htg --field dist $v 0 --threshold 2e-3 -o whole.vtp
    run info $name.htg && cp out whole
    for other in $name.phtg ${name}_turned.htg; do
        run $a $other --field dist $v 0 --threshold 2e-3 -o other.vtp
        cmp -s whole.vtp other.vtp || fail "$other has another surface: $(cat out)"
        run info $other && cmp -s out whole || fail "$other: $(diff out whole)"
    done
done
# Where half of the trees are ghosts, or are not there, the other half is drawn, all of it.
for file in ghosts.htg missing.htg; do
    run slice $file --field dist --axis z --at 0.4 --threshold 0
    [ "$(value area)" = 0.5 ] || fail "$file: the slice of one half: $(cat out)"
done
sed 's/even_1/even_2/' even.phtg >twice.phtg
refused 1 "'twice.phtg': the piece 'even_2.htg': it has tree [0-9]+, which an earlier piece has, too" info twice.phtg
sed 's/even_1/uneven_1/' even.phtg >other.phtg
refused 1 "the piece 'uneven_1.htg': its trees lie elsewhere than those of the first piece" info other.phtg
sed 's/even_1/gone/' even.phtg >gone.phtg
refused 1 "'gone.htg' does not exist" info gone.phtg
sed 's/even_1.htg/even.phtg/' even.phtg >list.phtg
refused 1 "'list.phtg': its piece 'even.phtg' does not end in .htg" info list.phtg
sed 's/even_[012]/even_3/g' even.phtg >none.phtg
refused 1 "'none.phtg': it has no trees" info none.phtg
# Coordinates may go backwards.
run isosurface backwards.htg --field dist --value 0 --threshold 0
[ "$(value open_edges)" = 0 ] || fail "backwards: open edges: $(cat out)"
awk -v area="$(value area)" -v volume="$(value volume)" 'BEGIN { exit !(area > 1.08 && area < 1.135 && volume > 0.1) }' ||
    fail "a sphere in trees that go backwards: $(cat out)"
# Trees and boxes in a plane lie there in space, whichever axis it is across.
ends() { /usr/bin/python3 -c 'import sys, vtk
reader = vtk.vtkXMLPolyDataReader()
reader.SetFileName(sys.argv[1])
reader.Update()
ends = reader.GetOutput().GetBounds()
print(*(f"{a:.3f} {b:.3f}" for a, b in zip(ends[::2], ends[1::2])))' "$1"; }
for kind in _2.htg _3.htg .vthb; do
    for axis in x y z; do
        run info plane_across_$axis$kind
        [ "$(value dimension)" = 2 ] || fail "info: across $axis: $(cat out)"
        run isolines plane_across_$axis$kind --field dist --values 0 --threshold 0 -o l.vtp
        value length >>across$kind
        case $axis in x) at=1 ;; y) at=3 ;; z) at=5 ;; esac
        ends l.vtp | awk -v at=$at '{ if ($at != "0.300" || $(at + 1) != "0.300") exit 1 }' ||
            fail "lines across $axis lie elsewhere: $(ends l.vtp)"
    done
    [ "$(sort -u across$kind | wc -l)" = 1 ] || fail "lengths across axes: $(cat across$kind)"
done
cmp -s <(head -1 across.vthb) all_lengths || fail "boxes across axes have other lines: $(cat across.vthb)"
# A field of cells colours the surface of another one as a formula does, at any time.
for file in trees.htg thirds.htg uneven.htg; do
    for by in plac x; do
        run isolines "$file" --field dist --on-surface 0 --by $by --values 0.4,0.6 --threshold 0 -o $by.vtp
        value length >$by.lengths
        run isolines "$file" "later_$file" --field dist --on-surface 0 --by $by --values 0.5 --time 0.5 -o $by.vtp
        value length >>$by.lengths
    done
    [ "$(wc -l <plac.lengths)" -ge 2 ] || fail "$file: no lines by another field: $(cat plac.lengths)"
    paste plac.lengths x.lengths | awk '{ if ($1 < 1 || $1 > 1.0001 * $2 || $1 < 0.9999 * $2) exit 1 }' ||
        fail "$file: lines by another field: $(paste plac.lengths x.lengths)"
    refused 1 "expression 'plack' is no expression" \
        isolines "$file" --field dist --on-surface 0 --by plack --values 0.5 -o x.vtp
done
# A component of a vector colours by its number, and none without one. It has the surface of a field
# of its own.
for file in amr.vthb trees.htg thirds.htg uneven.htg; do
    for chosen in "dist" "both --component 0"; do
        run isosurface $file --field $chosen --value 0 --threshold 0
        value area
    done >areas
    [ "$(sort -u areas | wc -l)" = 1 ] || fail "$file: a component has another surface: $(cat areas)"
    for by in both:1 plac; do
        run isolines $file --field dist --on-surface 0 --by $by --values 0.4,0.6 --threshold 0 -o by.vtp
        value length >$by.lengths
    done
    cmp -s both:1.lengths plac.lengths || fail "$file: lines by a component: $(cat both:1.lengths plac.lengths)"
    for by in both both: both:2 both:-1 both:x; do
        refused 1 "'both' has 2 numbers per cell: choose one by --by 'both:0' to 'both:1'" \
            isolines $file --field dist --on-surface 0 --by $by --values 0.5 -o x.vtp
    done
done
refused 1 "'uneven.htg' has another grid than the first input" \
    isosurface thirds.htg uneven.htg --field dist --value 0 --time 0.5
for file in thirds.htg uneven.htg; do
    refused 1 "its trees are no boxes, unlike those of the first file" \
        isosurface trees.htg "$file" --field dist --value 0 --time 0.5
done

# Between the times of two files the surface moves; at one of them it is that of the file.
for pair in run_hdf5_plt_cnt_0000 enzo/data0000.hierarchy chombo.hdf5 athena.athdf; do
    run isosurface "later_$pair" --field dist --value 0 --threshold 1e-3 -o alone.vtp
    run isosurface "$pair" "later_$pair" --field dist --value 0 --threshold 1e-3 --time 1 -o timed.vtp
    cmp -s alone.vtp timed.vtp || fail "$pair: the surface at the time of a file is another one"
    run isosurface "$pair" "later_$pair" --field dist --value 0 --threshold 1e-3 --frames 3 -o film.vtp
    [ "$(value time | tr '\n' ' ')" = "0 0.5 1 " ] || fail "$pair: times of the film: $(cat out)"
done
run isosurface chombo.hdf5 --field dist --value 0 --threshold 0 --cells centres
[ "$(value open_edges)" = 0 ] || fail "sharp values: $(cat out)"

refused 1 "'both' has 2 numbers per cell, not one: choose by --component, from 0 to 1" \
    isosurface amr.vthb --field both --value 0
# So it has in files of version 1 and of text, where a field in part keeps no other one away.
rewrite() { /usr/bin/python3 -c 'import sys, vtk
reader, writer = vtk.vtkXMLHyperTreeGridReader(), vtk.vtkXMLHyperTreeGridWriter()
reader.SetFileName("plane_thirds.htg")
reader.Update()
grid = reader.GetOutputDataObject(0)
both = grid.GetCellData().GetArray("both")
for c, name in enumerate(("dist", "plac")):
    both.CopyComponent(c, grid.GetCellData().GetArray(name), 0)
both.SetComponent(both.GetNumberOfTuples() - 1, 0, 1e200)  # VTK writes the range of norms as inf
writer.SetDataSetMajorVersion(int(sys.argv[1]))
getattr(writer, "SetDataModeTo" + sys.argv[2])()
writer.SetFileName("other.htg")
writer.SetInputDataObject(grid)
writer.Write()' "$@"; }
for how in "1 Binary" "1 Appended" "1 Ascii" "2 Ascii"; do
    rewrite $how
    for chosen in "plac" "both --component 1"; do
        run isolines other.htg --field $chosen --values 0.6 --threshold 0 -o l.vtp
        value length
    done >lengths
    [ "$(sort -u lengths | wc -l)" = 1 ] || fail "$how: a component has other lines: $(cat lengths)"
    [[ $how == *Ascii ]] || continue
    sed -i '/Name="both"/,/<InformationKey/ { /^ *[0-9-]/d }' other.htg
    run isolines other.htg --field plac --values 0.6 --threshold 0 -o l.vtp
    refused 1 "the field 'both' has fewer numbers than the trees have cells" \
        isolines other.htg --field both --component 1 --values 0.6 -o l.vtp
done
refused 1 "'plane_chombo.hdf5' has 2 dimensions, not 3" \
    isosurface chombo.hdf5 plane_chombo.hdf5 --field dist --value 0 --time 0.5
refused 1 "'amr.vthb' is no file of the format of the first one" \
    isosurface chombo.hdf5 amr.vthb --field dist --value 0 --time 0.5
refused 1 "round_hdf5_plt_cnt_0000': it has cylindrical coordinates, not cartesian ones" info round_hdf5_plt_cnt_0000
refused 1 "'plane_across_y.vthb' has another grid than the first input" \
    isolines plane_across_x.vthb plane_across_y.vthb --field dist --values 0 --time 0.5 -o l.vtp
# As others write these files: PLUTO says where cells are, texts have their lengths beside them,
# levels may be empty.
edited() { cp "$1" "$2" && /usr/bin/python3 -c 'import sys, h5py, numpy as np
with h5py.File(sys.argv[1], "a") as file:
    levels = [file[f"level_{i}"] for i in range(3)] if "level_0" in file else []
    exec(sys.argv[2])' "$2" "$3"; }
pluto='for level in levels: level.attrs.update(domBeg1=-1.0, domBeg2=3.0, domBeg3=0.5, g_x2stretch=2.0, g_x3stretch=1.0, geometry=1, logr=0)'
edited chombo.hdf5 pluto.hdf5 "$pluto"
run info pluto.hdf5
grep -qE '^origin +-1 3 0.5$' out && grep -qE '^spacing +0.0625 0.125 0.0625$' out || fail "PLUTO: $(cat out)"
edited pluto.hdf5 round.hdf5 'levels[0].attrs["geometry"] = 4'
refused 1 "'round.hdf5': its coordinates are curved, not cartesian" info round.hdf5
edited pluto.hdf5 logarithmic.hdf5 'levels[0].attrs["logr"] = 1'
refused 1 "'logarithmic.hdf5': its cells are not of one size: they grow with the radius" info logarithmic.hdf5
edited chombo.hdf5 empty.hdf5 'file.attrs["num_levels"] = np.int32(4)
file["level_3/boxes"] = np.zeros(0, levels[0]["boxes"].dtype)
for i, name in enumerate(["of any length", "dist"]): file.attrs[f"component_{i}"] = name'
run isosurface empty.hdf5 --field "of any length" --value 0 --threshold 0
[ "$(value area)" = "$(head -1 all_areas)" ] || fail "an empty level and a long name: $(cat out)"
edited run_hdf5_plt_cnt_0000 mixed 'floats = file["dist"][()].astype("f4")
del file["dist"]
file["dist"] = floats'
run info mixed
[ "$(value type)" = float64 ] || fail "a field of floats beside one of doubles: $(cat out)"
edited run_hdf5_plt_cnt_0000 longer 'twice = np.concatenate([file["dist"][()]] * 2)
del file["dist"]
file["dist"] = twice'
refused 1 "'longer': a data set has not one number for each cell of each block" info longer
cp -r enzo longer_enzo
edited enzo/data0000.cpu0000 longer_enzo/data0000.cpu0000 'group = file["Grid00000003"]
twice = np.concatenate([group["dist"][()]] * 2)
del group["dist"]
group["dist"] = twice'
refused 1 "Grid00000003 has not one number of 'dist' for each cell" info longer_enzo/data0000.hierarchy
edited athena.athdf part.athdf 'file["LogicalLocations"][-1] = 0'
refused 1 "'part.athdf': level [12] has [0-9] of the 8 blocks that replace the one from .* of level [01]" info part.athdf
edited athena.athdf thin.athdf 'file.attrs["MeshBlockSize"] = np.array([8, 1, 8], ">i4")'
refused 1 "'thin.athdf': its blocks are one cell thick along x or y: of slices, those across z are read" info thin.athdf
edited athena.athdf line.athdf 'file.attrs["MeshBlockSize"] = np.array([8, 1, 1], ">i4")'
refused 1 "'line.athdf': it has 1 dimension, not 2 or 3" info line.athdf
edited chombo.hdf5 no_fields.hdf5 'file.attrs["num_components"] = np.int32(0)'
refused 1 "'no_fields.hdf5': it has no data of cells" info no_fields.hdf5
sed 's/vtkOverlappingAMR/vtkNonOverlappingAMR/' amr.vthb >other.vthb
refused 1 "'other.vthb': it holds vtkNonOverlappingAMR, not vtkOverlappingAMR" info other.vthb
mv amr/amr_3.vti amr/gone.vti
refused 1 "^nestgrid: 'amr.vthb': " info amr.vthb
truncate -s 300000 athena.athdf
refused 1 "^nestgrid: 'athena.athdf': it is no HDF5 file, or a damaged one" info athena.athdf
printf '\211HDF\r\n\032\n' >nothing
refused 1 "'?nothing'? is of no known format" isosurface nothing --value 0

[ "$failures" = 0 ]
