// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of nets.
#include <algorithm>
#include <cmath>
#include <type_traits>

#include <high_order/net.hpp>

namespace nestgrid::engine {

namespace {

using Alpha = SimplexIndex::Alpha;
using Barycentric = std::array<double, 4>;

/// One step of de Casteljau along a segment, of rows of `stride`. `to` may be the net itself.
void segment_step(const double* net, std::size_t degree, std::size_t stride, const Barycentric& at,
                  double* to) {
    for (std::size_t i = 0; i < degree * stride; ++i) {
        to[i] = at[0] * net[i] + at[1] * net[i + stride];
    }
}

/// The coefficients of a segment on a part or at a point of it. Each is what de Casteljau's
/// algorithm finds at the first end, then at the second one, as often as its number says.
void restrict_segment(const double* net, std::size_t degree, std::size_t stride,
                      std::span<const Barycentric> corners, double* out) {
    std::array<double, std::size_t{max_degree + 1} * 81> first;  // at most 81 side by side
    std::array<double, std::size_t{max_degree + 1} * 81> second;
    for (std::size_t left = degree;; --left) {
        // `left` steps are left after those at the first end.
        const double* const from = left == degree ? net : first.data();
        if (corners.size() == 2 || left == 0) {
            const double* at = from;
            for (std::size_t q = left; q > 0; --q, at = second.data()) {
                segment_step(at, q, stride, corners[1], second.data());
            }
            std::copy_n(at, stride, out + (corners.size() == 2 ? left * stride : 0));
        }
        if (left == 0) return;
        segment_step(from, left, stride, corners[0], first.data());
    }
}

/// The coefficients of one factor of a net on a simplex in it, by de Casteljau's algorithm for
/// each multi-index; those with equal beginnings share these. Corners are taken in order.
class FactorRestriction {
public:
    FactorRestriction(int degree, std::size_t dimension, std::size_t stride,
                      std::span<const Barycentric> corners)
        : dimension_{dimension},
          stride_{stride},
          corners_{corners},
          index_{&simplex_index(corners.size() - 1, degree)} {}

    void run(const double* net, int degree, double* out) {
        out_ = out;
        descend(net, degree, 0, {}, work_.data());
    }

private:
    void descend(const double* net, int degree, std::size_t first, const Alpha& alpha,
                 double* work) {
        if (degree == 0) {
            std::copy_n(net, stride_, out_ + index_->number[slot(alpha)] * stride_);
            return;
        }
        for (std::size_t c = first; c < corners_.size(); ++c) {
            const std::size_t count = step(net, degree, corners_[c], work);
            descend(work, degree - 1, c, with_one_more(alpha, c), work + count * stride_);
        }
    }
    /// One step of de Casteljau. \return the number of coefficients left
    std::size_t step(const double* net, int degree, const Barycentric& at, double* to) const {
        const auto& raised = simplex_index(dimension_, degree).raised;
        using One = std::integral_constant<std::size_t, 1>;
        const auto by_dimension = [&](auto stride) {
            if (dimension_ == 2) {
                step_of<2>(net, raised, stride, at, to);
            } else {
                step_of<3>(net, raised, stride, at, to);
            }
        };
        if (stride_ == 1) {
            by_dimension(One{});
        } else {
            by_dimension(stride_);
        }
        return raised.size();
    }
    template <std::size_t dimension, class Raised, class Stride>
    static void step_of(const double* net, const Raised& raised, Stride stride,
                        const Barycentric& at, double* to) {
        for (const auto& of : raised) {
            for (std::size_t s = 0; s < stride; ++s) {
                double sum = at[0] * net[of[0] * stride + s];
                for (std::size_t c = 1; c <= dimension; ++c) sum += at[c] * net[of[c] * stride + s];
                *to++ = sum;
            }
        }
    }

    std::size_t dimension_;
    std::size_t stride_;
    std::span<const Barycentric> corners_;
    const SimplexIndex* index_;
    double* out_ = nullptr;
    // Room for the nets of all degrees below: those of tetrahedra, or of triangles with at most 9
    // coefficients side by side.
    std::array<double, std::size_t{120} * 9> work_;
};

/// Numbers of the coefficients on a part, by steps along its frame: net_index() of its places.
class FrameIndex {
public:
    FrameIndex(int degree, const Factors& whole, std::span<const Place> frame)
        : count_{whole.count} {
        std::size_t stride = 1;
        std::size_t axis = 0;
        for (std::size_t f = 0; f < count_; ++f) {
            const std::size_t dimension = whole.dimension[f];
            Factor& factor = factor_[f];
            factor.stride = stride;
            if (dimension > 1) factor.number = simplex_index(dimension, degree).number.data();
            std::int64_t share = 1;
            for (std::size_t d = axis; d < axis + dimension; ++d, share *= 9) {
                factor.first += share * degree * frame[0][d];
                factor.along += share * (frame[1][d] - frame[0][d]);
                if (frame.size() == 3) factor.across += share * (frame[2][d] - frame[0][d]);
            }
            stride *= simplex_size(degree, whole.dimension[f]);
            axis += dimension;
        }
    }
    std::size_t operator()(std::int64_t i, std::int64_t j) const {
        std::size_t index = 0;
        for (std::size_t f = 0; f < count_; ++f) {
            const Factor& factor = factor_[f];
            const auto share =
                static_cast<std::size_t>(factor.first + i * factor.along + j * factor.across);
            index += factor.stride * (factor.number == nullptr ? share : factor.number[share]);
        }
        return index;
    }

private:
    struct Factor {
        const std::uint16_t* number = nullptr;  // of the coefficient at a share; none: the share
        std::size_t stride = 1;
        std::int64_t first = 0, along = 0, across = 0;  // shares as in SimplexIndex::number
    };
    std::array<Factor, 3> factor_;
    std::size_t count_;
};

}  // namespace

NetPart part_at(const Factors& whole, std::span<const Place> points, int level) {
    NetPart part;
    std::size_t axis = 0;
    std::uint8_t stride = 1;
    for (std::size_t f = 0; f < whole.count; ++f) {
        const std::size_t dimension = whole.dimension[f];
        // The last coordinate decides first: so are the corners of the reference element sorted.
        const auto own = [&](const Place& x) {
            Place key{};
            for (std::size_t d = 0; d < dimension; ++d) key[2 - d] = x[axis + d];
            return key;
        };
        std::array<Place, max_corners> sorted;
        std::size_t count = 0;
        for (const Place& x : points) {
            Place key = own(x);
            std::size_t at = 0;
            while (at < count && sorted[at] < key) ++at;
            if (at < count && sorted[at] == key) continue;
            for (std::size_t i = at; i < count; ++i) std::swap(sorted[i], key);
            sorted[count++] = key;
        }
        for (std::size_t c = 0; c < count; ++c) {
            std::array<double, 4>& barycentric = part.corner[f][c];
            barycentric[0] = 1;
            for (std::size_t d = 0; d < dimension; ++d) {
                barycentric[d + 1] = std::ldexp(static_cast<double>(sorted[c][2 - d]), -level);
                barycentric[0] -= barycentric[d + 1];
            }
        }
        for (std::size_t k = 0; k < points.size(); ++k) {
            std::uint8_t at = 0;
            while (sorted[at] != own(points[k])) ++at;
            part.number[k] = static_cast<std::uint8_t>(part.number[k] + at * stride);
        }
        stride = static_cast<std::uint8_t>(stride * count);
        part.corners[f] = static_cast<std::uint8_t>(count);
        if (count > 1) {
            part.factors.dimension[part.factors.count++] = static_cast<std::uint8_t>(count - 1);
        }
        axis += dimension;
    }
    return part;
}

void restrict_net(const double* net, int degree, const Factors& whole, const NetPart& part,
                  double* out) {
    std::array<NetRoom, 2> room;
    std::size_t stride = 1;
    const double* from = net;
    std::size_t left = net_size(degree, whole);
    for (std::size_t f = 0; f < whole.count; ++f) {
        const std::size_t dimension = whole.dimension[f];
        const std::span corners(part.corner[f].data(), part.corners[f]);
        const std::size_t count = simplex_size(degree, whole.dimension[f]);
        const std::size_t made = simplex_size(degree, part.corners[f] - 1);
        double* const to = f + 1 == whole.count ? out : room[f % 2].data();
        const std::size_t outer = left / (count * stride);
        for (std::size_t o = 0; o < outer; ++o) {
            const double* const block = from + o * count * stride;
            if (dimension == 1) {
                restrict_segment(block, static_cast<std::size_t>(degree), stride, corners,
                                 to + o * made * stride);
            } else {
                FactorRestriction(degree, dimension, stride, corners)
                    .run(block, degree, to + o * made * stride);
            }
        }
        left = outer * made * stride;
        stride *= made;
        from = to;
    }
}

BoxRows::BoxRows(int degree, const Factors& box, std::span<const Place> frame)
    : count{static_cast<std::size_t>(degree) + 1}, rows{frame.size() == 3 ? count : 1} {
    std::ptrdiff_t stride = 1;
    for (std::size_t d = 0; d < box.count; ++d) {
        first += stride * degree * frame[0][d];
        along += stride * (frame[1][d] - frame[0][d]);
        if (rows > 1) across += stride * (frame[2][d] - frame[0][d]);
        stride *= degree + 1;
    }
}

void take_part(const double* net, int degree, const Factors& whole, std::span<const Place> frame,
               const Factors& part, double* out) {
    if (whole.all_segments()) {
        const BoxRows from(degree, whole, frame);
        for (std::size_t j = 0; j < from.rows; ++j) {
            for (std::size_t i = 0; i < from.count; ++i) *out++ = net[from(i, j)];
        }
        return;
    }
    const bool is_triangle = part.count == 1 && part.dimension[0] == 2;
    const std::int64_t rows = frame.size() == 3 ? degree : 0;
    const FrameIndex index(degree, whole, frame);
    for (std::int64_t j = 0; j <= rows; ++j) {
        for (std::int64_t i = 0; i <= (is_triangle ? degree - j : degree); ++i) {
            *out++ = net[index(i, j)];
        }
    }
}

}  // namespace nestgrid::engine
