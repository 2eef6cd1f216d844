// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fields as Python hands them over: of arrays, of octrees, of files, and between frames.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include <nestgrid/adapters/lagrange_cells.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/frames.hpp>

#include "call.hpp"

namespace nestgrid::python {

/// A field on a hierarchy, and its prerolls. Safe for several threads.
class Source {
public:
    explicit Source(std::shared_ptr<Prerolls> prerolls) : prerolls_{std::move(prerolls)} {}
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;
    virtual ~Source() = default;

    Prerolls& prerolls() const { return *prerolls_; }
    const FieldOnGrid& field() const { return prerolls_->field(); }
    int dimension() const { return field().dimension(); }
    /// The least and the greatest value.
    virtual std::array<double, 2> range(const Call& call) const {
        const std::shared_ptr<const Bounds> bounds = prerolls_->bounds(call.work());
        return {bounds->least(), bounds->greatest()};
    }
    /// Drops all prerolls: values have changed.
    void clear() { prerolls_->clear(); }

private:
    std::shared_ptr<Prerolls> prerolls_;
};

/// Samples in memory, without gaps.
struct Samples {
    std::string type;        ///< uint8 ... float64, as NumPy calls it
    std::vector<int> shape;  ///< 2 or 3 numbers, in the order of the indices
    std::vector<int> order;  ///< the indices, that which moves fastest in memory first
    Point spacing{1, 1, 1};  ///< along the indices
    Point origin{0, 0, 0};
    /// Rows of the matrix whose column d is the axis of index d in space.
    std::array<Point, 3> direction{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const void* data = nullptr;
    std::shared_ptr<const void> memory;  ///< keeps the data alive
};

/// The samples as the corners of bisected triangles or tetrahedra. Index d of the array runs along
/// column d of the direction, whatever the order in memory is.
/// \throw InvalidInput as LatticeBisection, and for a type that no field takes
std::shared_ptr<Source> make_volume(const Samples& samples, const Call& call);
/// \param frames of one shape, order, type and place, one at least
/// \param times one for each, ascending
/// \throw InvalidInput as make_volume(), and where they differ in these
Frames make_frames(const std::vector<Samples>& frames, std::vector<double> times, const Call& call);

/// Leaves of trees of squares or cubes, and values in frames, copied.
struct OctreeArrays {
    int dimension = 3;
    int factor = 2;  ///< into how many parts elements are divided along each direction: 2 or 3
    int max_level = 0;
    std::span<const std::int64_t> leaves;  ///< x, y, (z,) level of each, in finest cells
    /// In each frame, one for each leaf, or for each corner of each.
    std::vector<std::span<const double>> values;
    std::vector<std::string> names;        ///< of the frames, for sentences, or nothing
    std::span<const std::uint8_t> masked;  ///< for each leaf, or nothing
    /// Coordinates of the corners of the trees along each direction; trees of squares run along the
    /// two that have more than one.
    std::array<std::vector<double>, 3> coordinates;
    CellRule rule = CellRule::smooth;  ///< for values of leaves
};
/// The leaves of trees as they are kept, and the values at their corners.
struct OctreeLeaves {
    std::vector<std::int64_t> leaves;         ///< as in OctreeArrays, in another order
    std::vector<std::vector<double>> values;  ///< in each frame, for each corner of each
    std::vector<std::uint8_t> masked;         ///< for each leaf, or nothing
};
class OctreeFrames : public Frames {
public:
    OctreeFrames(Frames frames, std::function<OctreeLeaves()> leaves)
        : Frames(std::move(frames)), leaves_{std::move(leaves)} {}
    OctreeLeaves leaves() const { return leaves_(); }

private:
    std::function<OctreeLeaves()> leaves_;
};
/// Leaves without a value (NaN) in any frame are hidden, and those with such a corner.
/// \param times one for each frame, ascending
/// \throw InvalidInput where the leaves are no forest, or values at one node differ
std::shared_ptr<OctreeFrames> make_octree(const OctreeArrays& arrays, std::vector<double> times,
                                          const Call& call);

/// Numbers of the cells of one box, borrowed.
struct BoxOfNumbers {
    int level = 0;
    std::array<int, 3> lower{};              ///< the first cell
    std::array<int, 3> shape{};              ///< cells along each index
    std::array<std::ptrdiff_t, 3> stride{};  ///< in bytes
    const void* data = nullptr;
};
/// Boxes of cells on levels.
struct BoxArrays {
    int dimension = 3;
    bool is_double = true;  ///< floats otherwise
    std::vector<BoxOfNumbers> boxes;
    std::vector<int> ratios;  ///< of each level to the one before; the first is not looked at
    Point spacing{1, 1, 1};   ///< extent of the cells of level 0
    Point origin{0, 0, 0};    ///< where its first cell begins, in space
    std::vector<int> axes;    ///< of space along which the indices go, as Blocks has them
    CellRule rule = CellRule::smooth;
    std::shared_ptr<const void> memory;  ///< keeps the data alive
};
/// Leaves without a value (NaN) are hidden, with all that share a node with them.
/// \param frames one at least
/// \param times one for each, ascending
/// \param names what to call the frames in sentences
/// \throw InvalidInput as BlockGrid, and where they differ in their grids or types
Frames make_blocks(const std::vector<BoxArrays>& frames, std::vector<double> times,
                   const std::vector<std::string>& names, const Call& call);
/// Linear, quadratic or Lagrange cells.
class CellSource : public Source {
public:
    using Source::Source;
    virtual int degree() const = 0;  ///< the greatest of a cell
};
/// \param values one for each point, copied
/// \throw InvalidInput as LagrangeGrid, and where arrays do not fit each other or a value is not
///        finite
std::shared_ptr<CellSource> make_cells(const CellArrays& cells, std::span<const double> values);

/// The field of a file: one frame, or several.
struct LoadedField {
    Frames frames;
    std::string name;  ///< of the field
};

/// \param array name of the field; may be empty where there is only one
/// \throw InvalidInput where there is no such field
/// \throw IoError where the file cannot be read, is damaged, or holds no hierarchy
LoadedField load_hierarchy(const std::filesystem::path& path, const std::string& array,
                           const Call& call);
/// Loads plotfiles of AMReX, folders whose files are mapped, as frames. Parameters as above.
/// \param rule of the values at nodes
/// \param times one for each file, ascending; none for those that the files tell
/// \throw InvalidInput also where times do not ascend, or files differ in their grids or types
LoadedField load_plotfiles(const std::vector<std::string>& paths, const std::string& array,
                           CellRule rule, std::vector<double> times, const Call& call);
/// The place of the field with a name; an empty name stands for the only one.
/// \throw InvalidInput where there is none
std::size_t index_of_field(const std::vector<std::string>& names, const std::string& name);

}  // namespace nestgrid::python
