# SPDX-FileCopyrightText: the nestgrid authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes one grid of blocks in each format of block-structured codes, as the codes lay them out.

The blocks have 8 cells along each side and are divided by two, as all formats can have them, on
three levels of the unit cube (or square). Cells that finer blocks cover hold a wrong value.
Arguments: the folder.
"""

from __future__ import annotations

import itertools
import os
import sys
from typing import Any, Callable

import h5py
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk

N = 8  # cells along a block
WRONG = 1e30

Place = tuple[int, ...]
Block = tuple[int, Place]  # level, and its place in blocks


def blocks_of(dim: int) -> list[Block]:
    """Level by level; around the corner (1/2, ...) twice finer, and once along one edge."""
    places = list(itertools.product(range(2), repeat=dim))
    divided = [(0, p) for p in places if sum(p) != 1]
    finer = [(1, tuple(2 * a + b for a, b in zip(p, q))) for _, p in divided for q in places]
    middle = [(1, p) for _, p in finer if all(a in (1, 2) for a in p)][:-1]
    finest = [(2, tuple(2 * a + b for a, b in zip(p, q))) for _, p in middle for q in places]
    return [(0, p) for p in places] + finer + finest


def is_divided(block: Block, blocks: list[Block]) -> bool:
    return (block[0] + 1, tuple(2 * a for a in block[1])) in blocks


def parent(block: Block) -> Block:
    return block[0] - 1, tuple(a // 2 for a in block[1])


def edges(block: Block) -> tuple[np.ndarray, np.ndarray]:
    size = 0.5 / 2 ** block[0]
    low = size * np.array(block[1], float)
    return low, low + size


Function = Callable[..., np.ndarray]


def ball(centre: float) -> Function:
    return lambda *x: np.sqrt(sum((a - c) ** 2 for a, c in zip(x, (centre, 0.5, 0.45)))) - 0.3


def place(*x: np.ndarray) -> np.ndarray:
    return x[0] + 0 * x[-1]


def values(block: Block, f: Function, blocks: list[Block]) -> np.ndarray:
    """Values at the centres of cells, array[i, j, k] along x, y and z."""
    low, high = edges(block)
    axes = [a + (b - a) * (np.arange(N) + 0.5) / N for a, b in zip(low, high)]
    inside = f(*np.meshgrid(*axes, indexing="ij"))
    return np.full_like(inside, WRONG) if is_divided(block, blocks) else inside


Fields = dict[str, Function]


def write_vthb(path: str, dim: int, fields: Fields, across: int = 2, place: float = 0) -> None:
    """The boxes of a plane lie across an axis, at a place of it."""
    blocks = blocks_of(dim)

    def placed(numbers: list[Any], flat: Any) -> list[Any]:
        return numbers if dim == 3 else [*numbers[:across], flat, *numbers[across:]]

    planes = (vtk.VTK_YZ_PLANE, vtk.VTK_XZ_PLANE, vtk.VTK_XY_PLANE)
    levels = [[b for b in blocks if b[0] == level] for level in range(3)]
    amr = vtk.vtkOverlappingAMR()
    amr.Initialize(3, [len(level) for level in levels])
    amr.SetGridDescription(vtk.VTK_XYZ_GRID if dim == 3 else planes[across])
    origin = np.array(placed([0.0] * dim, place))
    amr.SetOrigin(origin)
    for number, level in enumerate(levels):
        step = 0.5 / N / 2**number
        amr.SetSpacing(number, [step] * 3)
        for i, block in enumerate(level):
            low = placed([N * a for a in block[1]], 0)
            high = placed([N * a + N - 1 for a in block[1]], -1)
            amr.SetAMRBox(number, i, vtk.vtkAMRBox(low, high))
            grid = vtk.vtkUniformGrid()
            grid.SetOrigin(origin + step * np.array(low))
            grid.SetSpacing([step] * 3)
            grid.SetDimensions(placed([N + 1] * dim, 1))
            vector = []
            for name, f in fields.items():
                flat = values(block, f, blocks).ravel(order="F")
                array = numpy_to_vtk(flat, deep=True)
                array.SetName(name)
                grid.GetCellData().AddArray(array)
                vector.append(flat)
            both = numpy_to_vtk(np.ascontiguousarray(np.stack(vector, axis=1)), deep=True)
            both.SetName("both")
            grid.GetCellData().AddArray(both)
            amr.SetDataSet(number, i, grid)
    vtk.vtkAMRUtilities.BlankCells(amr)
    writer = vtk.vtkXMLUniformGridAMRWriter()
    writer.SetFileName(path)
    writer.SetInputDataObject(amr)
    assert writer.Write()


def write_htg(path: str, dim: int, fields: Fields) -> None:
    """The cells of level 0 are trees, those that a finer block covers are divided."""
    blocks = blocks_of(dim)
    by_block = [{b: values(b, f, blocks) for b in blocks} for f in fields.values()]
    trees = vtk.vtkHyperTreeGrid()
    trees.SetDimensions([2 * N + 1] * dim + [1] * (3 - dim))
    trees.SetBranchFactor(2)
    for d, put in enumerate((trees.SetXCoordinates, trees.SetYCoordinates, trees.SetZCoordinates)):
        put(numpy_to_vtk(np.linspace(0, 1, 2 * N + 1) if d < dim else np.zeros(1), deep=True))
    cursor = vtk.vtkHyperTreeGridNonOrientedCursor()
    numbers: list[list[float]] = [[] for _ in fields]

    def write(level: int, cell: Place) -> None:
        cursor.SetGlobalIndexFromLocal(len(numbers[0]))
        block = (level, tuple(a // N for a in cell))
        for column, arrays in zip(numbers, by_block):
            column.append(arrays[block][tuple(a % N for a in cell)])
        if not is_divided(block, blocks):
            return
        cursor.SubdivideLeaf()
        for c in range(2**dim):
            cursor.ToChild(c)
            write(level + 1, tuple(2 * a + (c >> d & 1) for d, a in enumerate(cell)))
            cursor.ToParent()

    for tree in range(trees.GetMaxNumberOfTrees()):
        trees.InitializeNonOrientedCursor(cursor, tree, True)
        write(0, tuple(tree // (2 * N) ** d % (2 * N) for d in range(dim)))
    for name, column in [*zip(fields, numbers), ("both", np.transpose(numbers))]:
        array = numpy_to_vtk(np.ascontiguousarray(column), deep=True)
        array.SetName(name)
        trees.GetCellData().AddArray(array)
    writer = vtk.vtkXMLHyperTreeGridWriter()
    writer.SetDataModeToBinary()  # where it appends, it writes ranges over the first line
    writer.SetFileName(path)
    writer.SetInputDataObject(trees)
    assert writer.Write()


def write_trees(
    path: str,
    corners: list[np.ndarray],
    factor: int,
    names: Fields,
    divide: Callable[[int, np.ndarray], bool],
    across: int = 2,
    place: float = 0,
    owner: Callable[[int], int] | None = None,
    is_turned: bool = False,
) -> None:
    """A hyper tree grid with values at the centres of all cells.

    corners: coordinates of the corners of trees, one array a direction; divide(level, centre);
    of two directions: in the plane across an axis at a place of it; owner: whether a tree is one of
    this piece, 0, a ghost, 1, or not here, 2; is_turned: whether trees are counted along z first
    """
    dim = len(corners)
    trees = vtk.vtkHyperTreeGrid()
    trees.SetTransposedRootIndexing(is_turned)
    in_space = list(corners)
    if dim == 2:
        in_space.insert(across, np.array([place]))
    trees.SetDimensions([len(x) for x in in_space])
    trees.SetBranchFactor(factor)
    for d, put in enumerate((trees.SetXCoordinates, trees.SetYCoordinates, trees.SetZCoordinates)):
        put(numpy_to_vtk(in_space[d], deep=True))
    cursor = vtk.vtkHyperTreeGridNonOrientedCursor()
    centres: list[np.ndarray] = []

    def write(level: int, low: np.ndarray, size: np.ndarray) -> None:
        cursor.SetGlobalIndexFromLocal(len(centres))
        centres.append(low + size / 2)
        if not divide(level, low + size / 2):
            return
        cursor.SubdivideLeaf()
        for c in range(factor**dim):
            cursor.ToChild(c)
            write(level + 1, low + size / factor * [c // factor**d % factor for d in range(dim)], size / factor)
            cursor.ToParent()

    counts = [len(x) - 1 for x in corners]
    ghosts: list[int] = []
    for tree in range(int(np.prod(counts))):
        if owner is not None and owner(tree) == 2:
            continue
        trees.InitializeNonOrientedCursor(cursor, tree, True)
        at = list(np.unravel_index(tree, counts, "C" if is_turned else "F"))
        low = np.array([x[i] for x, i in zip(corners, at)])
        write(0, low, np.array([x[i + 1] for x, i in zip(corners, at)]) - low)
        ghosts += [0 if owner is None else owner(tree)] * (len(centres) - len(ghosts))
    columns = {name: f(*np.reshape(centres, (-1, dim)).T) for name, f in names.items()}
    for name, column in (columns | {"both": np.transpose(list(columns.values()))}).items():
        array = numpy_to_vtk(np.ascontiguousarray(column), deep=True)
        array.SetName(name)
        trees.GetCellData().AddArray(array)
    if any(ghosts):
        array = numpy_to_vtk(np.array(ghosts, np.uint8), deep=True)
        array.SetName("vtkGhostType")
        trees.GetCellData().AddArray(array)
    writer = vtk.vtkXMLHyperTreeGridWriter()
    writer.SetDataModeToBinary()  # where it appends, it writes ranges over the first line
    writer.SetFileName(path)
    writer.SetInputDataObject(trees)
    assert writer.Write()


def write_pieces(path: str, *trees: Any) -> None:
    """The trees of three processes, and a layer of ghosts around those of each: layers of cubes.

    Before them the piece of a process that has none.
    """
    corners = trees[0]
    layer = int(np.prod([len(x) - 1 for x in corners[:-1]]))
    ends = [0, 3, 4, len(corners[-1]) - 1, 1000]
    folder, name = os.path.split(path)
    for piece, (begin, end) in enumerate(zip(ends, ends[1:])):

        def owner(tree: int, begin: int = begin, end: int = end) -> int:
            at = tree // layer
            return 0 if begin <= at < end else 1 if begin - 1 <= at <= end < 1000 else 2

        write_trees(os.path.join(folder, f"{name[:-5]}_{piece}.htg"), *trees, owner=owner)
    pieces = "".join(f'<Piece Source="{name[:-5]}_{i}.htg"/>' for i in (3, 0, 1, 2))
    with open(path, "w", encoding="utf-8") as file:
        file.write('<?xml version="1.0"?>\n<VTKFile type="PHyperTreeGrid" version="0.1" ')
        file.write('byte_order="LittleEndian" header_type="UInt32">\n<PHyperTreeGrid>')
        file.write(f"{pieces}</PHyperTreeGrid>\n</VTKFile>\n")


def write_flash(
    path: str, dim: int, fields: Fields, time: float = 0, geometry: str = "cartesian", has_leaves_alone: bool = False
) -> None:
    """Where leaves are alone, names are not filled up to four letters, either."""
    all_blocks = blocks_of(dim)
    blocks = [b for b in all_blocks if not (has_leaves_alone and is_divided(b, all_blocks))]
    padded_length = 0 if has_leaves_alone else 4
    number = {block: i + 1 for i, block in enumerate(blocks)}  # from 1
    corners = list(itertools.product(range(2), repeat=dim))
    gid = np.full((len(blocks), 2 * dim + 1 + 2**dim), -1, np.int32)
    for i, block in enumerate(blocks):
        for d in range(dim):
            for side in range(2):
                beside = list(block[1])
                beside[d] += 2 * side - 1
                inside = 0 <= beside[d] < 2 ** (block[0] + 1)
                key = (block[0], tuple(beside))
                gid[i, 2 * d + side] = number.get(key, -1) if inside else -20
        if block[0] > 0:
            gid[i, 2 * dim] = number.get(parent(block), -1)
        if is_divided(block, blocks):
            for c, corner in enumerate(corners):  # x moves fastest
                child = tuple(2 * a + b for a, b in zip(block[1], corner[::-1]))
                gid[i, 2 * dim + 1 + c] = number[block[0] + 1, child]
    box = np.zeros((len(blocks), 3, 2))
    for i, block in enumerate(blocks):
        low, high = edges(block)
        box[i, :dim, 0], box[i, :dim, 1] = low, high
    with h5py.File(path, "w") as file:
        texts = ["setup call", "file creation time", "flash version", "build date", "build dir"]
        texts += ["build machine", "cflags", "fflags", "setup time stamp", "build time stamp"]
        kind = [("file format version", "<i4")]
        kind += [(name, "S400" if "call" in name or "flags" in name else "S80") for name in texts]
        file["sim info"] = np.array([(9, *[b"FLASH 4"] * len(texts))], kind)

        def scalars(name: str, pairs: dict[str, Any], kind: str) -> None:
            padded = [(key.ljust(80).encode(), value) for key, value in pairs.items()]
            file[name] = np.array(padded, [("name", "S80"), ("value", kind)])

        sides = [N] * dim + [1] * (3 - dim)
        whole = dict(zip(("nxb", "nyb", "nzb"), sides))
        whole |= {"dimensionality": dim, "globalnumblocks": len(blocks), "nstep": 7}
        scalars("integer scalars", whole, "<i4")
        scalars("real scalars", {"time": time, "dt": 0.1}, "<f8")
        roots = dict(zip(("nblockx", "nblocky", "nblockz"), [2] * dim + [1] * (3 - dim)))
        roots |= {"iprocs": 1, "jprocs": 1, "kprocs": 1, "lrefine_max": 3}
        scalars("integer runtime parameters", roots, "<i4")
        ends = {f"{a}{end}": float(e) for a in "xyz" for end, e in (("min", 0), ("max", 1))}
        scalars("real runtime parameters", ends, "<f8")
        scalars("logical runtime parameters", {"restart": 0}, "<i4")
        text = np.array([(b"geometry".ljust(80), geometry.encode().ljust(80))], [("name", "S80"), ("value", "S80")])
        file["string runtime parameters"] = text
        file["string scalars"] = text
        file["gid"] = gid
        file["bounding box"] = box
        file["coordinates"] = box.mean(axis=2)
        file["block size"] = box[:, :, 1] - box[:, :, 0]
        file["refine level"] = np.array([b[0] + 1 for b in blocks], np.int32)
        types = [2 if is_divided(b, blocks) else 1 for b in blocks]
        file["node type"] = np.array(types, np.int32)
        names = [name[:4].ljust(padded_length) for name in fields]
        file["unknown names"] = np.array([[name.encode()] for name in names], "S4")
        for name, f in zip(names, fields.values()):
            data = np.stack([values(b, f, blocks).T for b in blocks])
            file[name] = data.reshape((len(blocks), *sides[::-1]))


def write_enzo(folder: str, dim: int, fields: Fields, time: float = 0, is_packed: bool = True) -> None:
    """Grids in the order of Enzo, siblings before the children of the last.

    Numbers in one file, beside particles, or, as old Enzo wrote them, in a file a grid.
    """
    os.makedirs(folder, exist_ok=True)
    name = os.path.join(folder, "data0000")
    blocks = blocks_of(dim)
    text: list[str] = []
    order: list[Block] = []

    def write(chain: list[Block]) -> None:
        order.append(chain[0])
        number = len(order)
        low, high = edges(chain[0])
        joined = lambda row: " ".join(f"{a:.17g}" for a in row)  # noqa: E731
        text.append(f"\nGrid = {number}\nTask = 0\nGridRank = {dim}")
        text.append(f"GridDimension = {joined([N + 6] * dim)}\nGridStartIndex = {joined([3] * dim)}")
        text.append(f"GridEndIndex = {joined([N + 2] * dim)}")
        text.append(f"GridLeftEdge = {joined(low)}\nGridRightEdge = {joined(high)}")
        text.append(f"Time = {time}\nSubgridsAreStatic = 0\nNumberOfBaryonFields = {len(fields)}")
        text.append(f"FieldType = 0\nNumberOfParticles = 0")
        text.append(f"BaryonFileName = ./data0000.{'cpu0000' if is_packed else f'grid{number:04d}'}")
        text.append(f"Pointer: Grid[{number}]->NextGridThisLevel = {number + 1 if chain[1:] else 0}")
        if chain[1:]:
            write(chain[1:])
        children = [b for b in blocks if b[0] == chain[0][0] + 1 and parent(b) == chain[0]]
        text.append(
            f"Pointer: Grid[{number}]->NextGridNextLevel = {len(order) + 1 if children else 0}"
        )
        if children:
            write(children)

    write([b for b in blocks if b[0] == 0])
    with open(name + ".hierarchy", "w") as file:
        file.write("\n".join(text) + "\n")
    with open(name, "w") as file:
        ends = f"DomainLeftEdge = {'0 ' * dim}\nDomainRightEdge = {'1 ' * dim}\n"
        file.write(f"InitialCycleNumber = 3\nInitialTime = {time}\nTopGridRank = {dim}\n")
        file.write(f"TopGridDimensions = {f'{2 * N} ' * dim}\n{ends}RefineBy = 2\n")
        faces = "3 " * dim
        file.write(f"LeftFaceBoundaryCondition = {faces}\nRightFaceBoundaryCondition = {faces}\n")
        file.write("MaximumRefinementLevel = 2\nHydroMethod = 0\nNumberOfParticles = 0\n")
        file.write("CurrentTimeIdentifier = 1\nComovingCoordinates = 0\nVersionNumber = 2.0\n")
        file.write("LengthUnits = 1\nMassUnits = 1\nTimeUnits = 1\nDensityUnits = 1\n")
        for i, field in enumerate(fields):
            file.write(f"DataLabel[{i}] = {field}\n#DataCGSConversionFactor[{i}] = 1e-24\n")
    for i, block in enumerate(order):
        ending = "cpu0000" if is_packed else f"grid{i + 1:04d}"
        with h5py.File(f"{name}.{ending}", "a" if i > 0 and is_packed else "w") as file:
            group = file.create_group(f"Grid{i + 1:08d}") if is_packed else file
            group.create_group("ActiveParticles")["mass"] = np.ones(3)
            for field, f in fields.items():
                group[field] = values(block, f, blocks).T


def write_chombo(path: str, dim: int, fields: Fields, time: float = 0, ghosts: int = 1) -> None:
    blocks = blocks_of(dim)
    axes = "ijk"[:dim]
    box_kind = [(f"lo_{a}", "<i4") for a in axes] + [(f"hi_{a}", "<i4") for a in axes]
    vector = [(f"intvect{a}", "<i4") for a in axes]
    with h5py.File(path, "w") as file:
        file.attrs["filetype"] = np.bytes_("VanillaAMRFileType")
        file.attrs["num_levels"] = np.int32(3)
        file.attrs["num_components"] = np.int32(len(fields))
        file.attrs["time"] = float(time)
        for i, name in enumerate(fields):
            file.attrs[f"component_{i}"] = np.bytes_(name)
        file.create_group("Chombo_global").attrs["SpaceDim"] = np.int32(dim)
        for level in range(3):
            group = file.create_group(f"level_{level}")
            cells = 2 * N * 2**level
            group.attrs["dx"] = 1 / cells
            group.attrs["dt"] = 0.1
            group.attrs["time"] = float(time)
            group.attrs["ref_ratio"] = np.int32(2 if level < 2 else 1)
            group.attrs["prob_domain"] = np.array((0,) * dim + (cells - 1,) * dim, box_kind)
            mine = [b for b in blocks if b[0] == level]
            boxes = [tuple(N * a for a in b[1]) + tuple(N * a + N - 1 for a in b[1]) for b in mine]
            group["boxes"] = np.array(boxes, box_kind)
            attributes = group.create_group("data_attributes")
            attributes.attrs["comps"] = np.int32(len(fields))
            attributes.attrs["ghost"] = np.array((ghosts,) * dim, vector)
            attributes.attrs["outputGhost"] = np.array((ghosts,) * dim, vector)
            attributes.attrs["objectType"] = np.bytes_("FArrayBox")
            data, offsets = [], [0]
            for block in mine:
                for f in fields.values():
                    padded = np.pad(values(block, f, blocks), ghosts, constant_values=WRONG)
                    data.append(padded.ravel(order="F"))
                offsets.append(offsets[-1] + len(fields) * data[-1].size)
            group["data:datatype=0"] = np.concatenate(data)
            group["data:offsets=0"] = np.array(offsets, np.int64)


def write_athena(path: str, dim: int, fields: Fields, time: float = 0, kind: str = ">f8") -> None:
    """Leaves alone, as Athena++ writes them, the first field in one data set, others in another."""
    blocks = blocks_of(dim)
    leaves = [b for b in blocks if not is_divided(b, blocks)]
    sides = [N] * dim + [1] * (3 - dim)
    names = list(fields)
    sets = {"prim": names[:1], "user": names[1:]}
    with h5py.File(path, "w") as file:
        file.attrs["NumCycles"] = np.array(7, ">i4")
        file.attrs["Time"] = np.array(time, ">f8")
        file.attrs["Coordinates"] = np.bytes_("cartesian")
        for d in range(3):
            file.attrs[f"RootGridX{d + 1}"] = np.array([0, 1, 1], ">f8")
        roots = [2 * N] * dim + [1] * (3 - dim)
        file.attrs["RootGridSize"] = np.array(roots, ">i4")
        file.attrs["NumMeshBlocks"] = np.array(len(leaves), ">i4")
        file.attrs["MeshBlockSize"] = np.array(sides, ">i4")
        file.attrs["MaxLevel"] = np.array(2, ">i4")
        file.attrs["NumVariables"] = np.array([len(each) for each in sets.values()], ">i4")
        file.attrs["DatasetNames"] = np.array([each.encode() for each in sets], "S21")
        file.attrs["VariableNames"] = np.array([each.encode() for each in names], "S21")
        file["Levels"] = np.array([b[0] for b in leaves], ">i4")
        places = [b[1] + (0,) * (3 - dim) for b in leaves]
        file["LogicalLocations"] = np.array(places, ">i8")
        for d in range(3):
            faces, middles = [], []
            for b in leaves:
                low, high = (edges(b)[0][d], edges(b)[1][d]) if d < dim else (0.0, 1.0)
                f = np.linspace(low, high, sides[d] + 1)
                faces.append(f)
                middles.append((f[1:] + f[:-1]) / 2)
            file[f"x{d + 1}f"] = np.array(faces, kind)
            file[f"x{d + 1}v"] = np.array(middles, kind)
        for name, members in sets.items():
            data = [[values(b, fields[m], blocks).T.reshape(sides[::-1]) for b in leaves] for m in members]
            file[name] = np.array(data, kind)


def write_all(folder: str, dim: int, time: float = 0, prefix: str = "") -> None:
    fields = {"dist": ball(0.45 + 0.1 * time), "plac": place}
    path = lambda name: os.path.join(folder, prefix + name)  # noqa: E731
    write_vthb(path("amr.vthb"), dim, fields)
    write_htg(path("trees.htg"), dim, fields)
    write_flash(path("run_hdf5_plt_cnt_0000"), dim, fields, time)
    write_flash(path("leaves_hdf5_plt_cnt_0000"), dim, fields, time, "CARTESIAN", True)
    write_flash(path("round_hdf5_plt_cnt_0000"), dim, fields, time, "cylindrical")
    write_enzo(path("enzo"), dim, fields, time)
    write_enzo(path("old_enzo"), dim, fields, time, False)
    write_chombo(path("chombo.hdf5"), dim, fields, time)
    write_athena(path("athena.athdf"), dim, fields, time)
    even, uneven = [np.linspace(0, 1, 9)] * dim, [np.linspace(0, 1, 9) ** 1.3] * dim
    near = lambda level, x: level < 2 and abs(ball(0.5)(*x)) < 0.1 / 3**level  # noqa: E731
    write_trees(path("thirds.htg"), even, 3, fields, near)
    write_trees(path("uneven.htg"), uneven, 2, fields, near)
    if prefix != "later_":
        write_trees(path("even.htg"), even, 2, fields, near)
        for name, corners, factor in (("thirds", even, 3), ("uneven", uneven, 2), ("even", even, 2)):
            write_pieces(path(f"{name}.phtg"), corners, factor, fields, near)
            write_trees(path(f"{name}_turned.htg"), corners, factor, fields, near, is_turned=True)
        for name, hidden in (("ghosts", 1), ("missing", 2)):
            half = lambda tree: hidden if tree % 8 < 4 else 0  # noqa: E731, B023
            write_trees(path(f"{name}.htg"), even, 2, fields, near, owner=half)
    for axis, name in enumerate("xyz" if dim == 2 else ""):
        write_vthb(path(f"across_{name}.vthb"), dim, fields, axis, 0.3)
        for factor in (2, 3):
            write_trees(path(f"across_{name}_{factor}.htg"), even, factor, fields, near, axis, 0.3)
    write_trees(path("backwards.htg"), [even[0][::-1], *even[1:]], 2, fields, near)


if __name__ == "__main__":
    write_all(sys.argv[1], 3)
    write_all(sys.argv[1], 3, 1, "later_")
    write_all(sys.argv[1], 2, 0, "plane_")
