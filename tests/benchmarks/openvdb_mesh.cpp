// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "openvdb_mesh.hpp"

#include <tbb/global_control.h>

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/VolumeToMesh.h>

struct OpenVdbVolume::Grid {
    openvdb::FloatGrid::Ptr grid;
};

OpenVdbVolume::OpenVdbVolume(const std::vector<float>& samples, int n)
    : grid_{std::make_unique<Grid>()} {
    openvdb::initialize();
    const openvdb::CoordBBox box(openvdb::Coord(0), openvdb::Coord(n - 1));
    const openvdb::tools::Dense<const float, openvdb::tools::LayoutXYZ> dense(box, samples.data());
    grid_->grid = openvdb::FloatGrid::create(-1.0F);
    openvdb::tools::copyFromDense(dense, *grid_->grid, 0.0F);
}

OpenVdbVolume::~OpenVdbVolume() = default;

std::size_t OpenVdbVolume::mesh(double isovalue) const {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quadrilaterals;
    openvdb::tools::volumeToMesh(*grid_->grid, points, triangles, quadrilaterals, isovalue);
    return triangles.size() + 2 * quadrilaterals.size();
}
