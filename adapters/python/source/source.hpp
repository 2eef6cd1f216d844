// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fields as Python hands them over: of arrays, of octrees, of files, and between frames.
#pragma once

#include <filesystem>
#include <span>
#include <variant>
#include <vector>

#include <nestgrid/algorithms/key_frames.hpp>

#include "prerolls.hpp"

namespace nestgrid::python {

/// An indicator to compare thresholds with, and bounds of the data for the search.
struct ChosenIndicator {
    std::shared_ptr<const Indicator> indicator;
    std::shared_ptr<const Bounds> bounds;
    /// The bounds, which know the range of the data: those of a field, or between frames.
    std::variant<const HierarchicalIndicator*, const KeyFrames*> ranged;
};

/// A field on a hierarchy. Safe for several threads.
class Source {
public:
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;
    virtual ~Source() = default;

    virtual AnyHierarchy hierarchy() const = 0;
    int dimension() const {
        return std::visit([](const auto* each) { return each->facts().dimension; }, hierarchy());
    }
    /// \param name offset, or as Prerolls::swept()
    /// \param blend at least 1
    /// \throw InvalidInput as Prerolls
    virtual ChosenIndicator choose(const std::string& name, double blend,
                                   const Call& call) const = 0;
    virtual std::shared_ptr<const SweptIndicator> sizes(double slope, const Call& call) const = 0;
    /// The least and the greatest value.
    virtual std::array<double, 2> range(const Call& call) const = 0;
    /// Drops all prerolls: values have changed.
    virtual void clear() = 0;

protected:
    Source() = default;
};

/// A source with prerolls of its own, which is all but one between frames.
class PrerolledSource : public Source {
public:
    ChosenIndicator choose(const std::string& name, double blend, const Call& call) const final;
    std::shared_ptr<const SweptIndicator> sizes(double slope, const Call& call) const final {
        return prerolls().sizes(slope, call);
    }
    std::array<double, 2> range(const Call& call) const final;
    void clear() final { prerolls().clear(); }

protected:
    Prerolls& prerolls() const;

private:
    mutable std::once_flag once_;
    mutable std::unique_ptr<Prerolls> prerolls_;
};

/// Frames of one field, at times.
class FrameSource {
public:
    virtual ~FrameSource() = default;
    /// The field at a time; keeps the frames alive.
    /// \throw InvalidInput where there is not one finite weight for each frame
    virtual std::unique_ptr<Source> at(std::span<const float> weights) = 0;
    virtual void clear() = 0;
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
std::unique_ptr<Source> make_volume(const Samples& samples, const Call& call);
/// \param frames of one shape, order, type and place, one at least
/// \throw InvalidInput as make_volume(), and where they differ in these
std::shared_ptr<FrameSource> make_frames(const std::vector<Samples>& frames, const Call& call);

/// Leaves and values of an octree or quadtree, copied.
struct OctreeArrays {
    int dimension = 3;
    int max_level = 0;
    std::span<const std::int64_t> leaves;  ///< x, y, (z,) level of each, in finest cells
    std::span<const double> values;        ///< one for each leaf, or for each corner of each
    std::span<const std::uint8_t> masked;  ///< for each leaf, or nothing
    /// Coordinates of the corners of the trees along each direction.
    std::array<std::vector<double>, 3> coordinates;
};
/// The leaves of an octree as they are kept, and the values at their corners.
struct OctreeLeaves {
    std::vector<std::int64_t> leaves;  ///< as in OctreeArrays, in another order
    std::vector<double> values;        ///< for each corner of each
    std::vector<std::uint8_t> masked;  ///< for each leaf, or nothing
};
class OctreeSource : public PrerolledSource {
public:
    virtual OctreeLeaves leaves() const = 0;
};
/// Leaves without a value (NaN) are hidden, and those with such a corner.
/// \throw InvalidInput where the leaves are no forest, or values at one node differ
std::unique_ptr<OctreeSource> make_octree(const OctreeArrays& arrays, const Call& call);

/// The field of a file, or its frames where it has several.
struct LoadedField {
    std::unique_ptr<Source> alone;        ///< null where there are frames
    std::shared_ptr<FrameSource> frames;  ///< null where there is one
    std::vector<double> times;            ///< of the frames
    std::string name;                     ///< of the field
};

/// \param array name of the field; may be empty where there is only one
/// \throw InvalidInput where there is no such field
/// \throw IoError where the file cannot be read, is damaged, or holds no hierarchy
LoadedField load_hierarchy(const std::filesystem::path& path, const std::string& array,
                           const Call& call);

}  // namespace nestgrid::python
