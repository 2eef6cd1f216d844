// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/compressed_field.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <walk/hanging_nodes.hpp>
#include <walk/walk.hpp>

namespace nestgrid {

namespace {

constexpr std::size_t block_size = 64;

template <class Real>
using Integer = std::conditional_t<std::is_same_v<Real, float>, std::uint32_t, std::uint64_t>;

/// Swaps the order of negative numbers, so that integers are ordered like the numbers of these
/// bits, -0 below 0. It is its own inverse.
template <class Bits>
Bits ordered(Bits bits) {
    constexpr unsigned sign = std::numeric_limits<Bits>::digits - 1;
    return bits >> sign != 0 ? bits ^ (~Bits{0} >> 1U) : bits;
}

/// 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
template <class Bits>
Bits without_sign(Bits difference) {
    constexpr unsigned sign = std::numeric_limits<Bits>::digits - 1;
    return difference << 1U ^ (difference >> sign != 0 ? ~Bits{0} : Bits{0});
}
template <class Bits>
Bits with_sign(Bits code) {
    return code >> 1U ^ (code % 2 != 0 ? ~Bits{0} : Bits{0});
}

/// Codes of values, given what they are expected to be.
template <class Real>
class Codec {
public:
    explicit Codec(double step) : step_{step} {}

    /// \throw InvalidInput where the value has no place among the multiples of the step
    std::uint64_t encode(Real value, Real expected) const {
        if (step_ == 0) {
            return without_sign<Bits>(ordered(std::bit_cast<Bits>(value)) -
                                      ordered(std::bit_cast<Bits>(expected)));
        }
        if (!(std::abs(static_cast<double>(value)) < 0x1p52 * step_)) {
            throw InvalidInput("a value has no place among the multiples of the step: " +
                               std::to_string(value));
        }
        return without_sign(multiple(value) - multiple(expected));
    }
    Real decode(std::uint64_t code, Real expected) const {
        if (step_ == 0) {
            return std::bit_cast<Real>(ordered(static_cast<Bits>(
                with_sign(static_cast<Bits>(code)) + ordered(std::bit_cast<Bits>(expected)))));
        }
        const auto at = static_cast<std::int64_t>(with_sign(code) + multiple(expected));
        return static_cast<Real>(step_ * static_cast<double>(at));
    }

private:
    using Bits = Integer<Real>;

    /// The number of the multiple of the step that is next to a value; 0 where an integer has no
    /// place for it, as codes that no encoder made may ask for.
    std::uint64_t multiple(Real value) const {
        const double at = std::nearbyint(static_cast<double>(value) / step_);
        if (!(std::abs(at) < 0x1p63)) return 0;
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(at));
    }

    double step_;
};

/// \throw InvalidInput unless the step is a finite number of at least 0
void require_step(double step) {
    if (step >= 0 && std::isfinite(step)) return;
    throw InvalidInput("values are compressed by a step of at least 0, not " +
                       std::to_string(step));
}

}  // namespace

/// Encodes the values that a walk meets. Ancestors come first, so that all parents are decoded.
template <class Real>
class CompressedValues<Real>::Encoder final : public engine::Visitor<Real> {
public:
    using View = engine::ElementView<Real>;
    using Split = engine::Split;

    Encoder(const engine::Walk<Real>& walk, double step, std::size_t nodes)
        : walk_{&walk},
          codec_{step},
          codes_(nodes * walk.components()),
          decoded_(nodes * walk.components()) {}

    const std::vector<std::uint64_t>& codes() const { return codes_; }

    bool sees_hidden() const override { return true; }
    engine::Leaves leaves(const Rule&, const Real*, NodeMask, bool) override { return {}; }
    engine::Decision inspect(const View& view, const Split&) override {
        if (view.level > 0) return {};
        std::array<NodeKey, max_corners> keys;
        walk_->corners(view, keys.data(), nullptr);
        for (std::size_t k = 0; k < view.corner_count(); ++k) {
            const std::size_t at = static_cast<std::size_t>(keys[k]) * walk_->components();
            for (std::size_t c = 0; c < walk_->components(); ++c) {
                put(at + c, view.value[k * walk_->components() + c], 0);
            }
        }
        return {};
    }
    void entered(const View& view, const Split& split, const Real* value) override {
        const Rule& rule = *split.rule;
        const std::size_t stride = walk_->components();
        const auto keys = walk_->split_keys(view, split, keys_);
        nodes_.resize(keys.size() * stride);
        for (std::size_t k = 0; k < keys.size(); ++k) {
            const auto from = decoded_.begin() + offset(keys[k]);
            std::copy_n(from, stride, nodes_.begin() + static_cast<std::ptrdiff_t>(k * stride));
        }
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const std::size_t k = view.corner_count() + n;
            const bool hangs = (split.constrained >> n & 1U) != 0;
            for (std::size_t c = 0; c < stride; ++c) {
                const Real mean =
                    nestgrid::detail::interpolate(rule.new_nodes[n], nodes_.data() + c, stride);
                const auto at = static_cast<std::size_t>(offset(keys[k])) + c;
                if (hangs) decoded_[at] = mean;  // whatever the step
                nodes_[k * stride + c] = hangs ? mean : put(at, value[k * stride + c], mean);
            }
        }
    }
    void extract(const View&) override {}

private:
    std::ptrdiff_t offset(NodeKey key) const {
        return static_cast<std::ptrdiff_t>(static_cast<std::size_t>(key) * walk_->components());
    }
    Real put(std::size_t at, Real value, Real expected) {
        codes_[at] = codec_.encode(value, expected);
        decoded_[at] = codec_.decode(codes_[at], expected);
        return decoded_[at];
    }

    const engine::Walk<Real>* walk_;
    Codec<Real> codec_;
    std::vector<std::uint64_t> codes_;
    std::vector<Real> decoded_;
    std::vector<Real> nodes_;
    engine::SplitKeys keys_;
};

template <class Real>
CompressedValues<Real>::CompressedValues(const Hierarchy<Real>& hierarchy,
                                         const CompressionOptions& options)
    : components_{static_cast<std::size_t>(hierarchy.facts().components)},
      size_{hierarchy.facts().node_count * components_},
      packed_{options.step, {}, {}} {
    const std::size_t nodes = hierarchy.facts().node_count;
    if (nodes == 0) throw InvalidInput("values are compressed on grids with dense keys only");
    require_step(options.step);
    const HangingNodes hanging = engine::find_hanging_nodes(hierarchy);
    const engine::Walk<Real> walk(hierarchy, {.values = true, .keys = true}, &hanging);
    Encoder encoder(walk, options.step, nodes);
    walk.run(encoder);
    pack(encoder.codes());
}

template <class Real>
CompressedValues<Real>::CompressedValues(std::size_t count, std::size_t components,
                                         PackedValues packed)
    : components_{components}, size_{count}, packed_{std::move(packed)} {
    require_step(packed_.step);
    const auto& block = packed_.block;
    const bool complete = components > 0 && count % components == 0 &&
                          block.size() == (count + block_size - 1) / block_size + 1 &&
                          block.front() == 0 && block.back() == packed_.words.size();
    const bool narrow =
        std::adjacent_find(block.begin(), block.end(), [](std::uint32_t a, std::uint32_t b) {
            return a > b || b - a > block_size;
        }) == block.end();
    if (!complete || !narrow) {
        throw InvalidInput("the blocks of compressed values are not those of " +
                           std::to_string(count) + " values");
    }
}

template <class Real>
void CompressedValues<Real>::pack(const std::vector<std::uint64_t>& codes) {
    auto& words = packed_.words;
    packed_.block.push_back(0);
    for (std::size_t first = 0; first < codes.size(); first += block_size) {
        const auto block =
            std::span(codes).subspan(first, std::min(block_size, codes.size() - first));
        std::uint64_t all = 0;
        for (const std::uint64_t code : block) all |= code;
        const auto width = static_cast<std::size_t>(std::bit_width(all));
        const std::size_t begin = words.size();
        if (begin + width > std::numeric_limits<std::uint32_t>::max()) {
            throw InvalidInput("compressed values take more than 2^35 bytes");
        }
        words.resize(begin + width);
        for (std::size_t k = 0; k < block.size() && width > 0; ++k) {
            const std::size_t bit = k * width;
            words[begin + bit / 64] |= block[k] << bit % 64;
            if (bit % 64 + width > 64) words[begin + bit / 64 + 1] |= block[k] >> (64 - bit % 64);
        }
        packed_.block.push_back(static_cast<std::uint32_t>(words.size()));
    }
}

template <class Real>
std::uint64_t CompressedValues<Real>::code(std::size_t at) const {
    const auto& words = packed_.words;
    const std::size_t begin = packed_.block[at / block_size];
    const std::size_t width = packed_.block[at / block_size + 1] - begin;
    if (width == 0) return 0;
    const std::size_t bit = at % block_size * width;
    std::uint64_t code = words[begin + bit / 64] >> bit % 64;
    if (bit % 64 + width > 64) code |= words[begin + bit / 64 + 1] << (64 - bit % 64);
    return code & ~std::uint64_t{0} >> (64 - width);
}

template <class Real>
std::size_t CompressedValues<Real>::memory_bytes() const {
    return packed_.block.size() * sizeof(packed_.block[0]) +
           packed_.words.size() * sizeof(packed_.words[0]);
}

template <class Real>
void CompressedValues<Real>::decode_coarse(std::span<const NodeKey> nodes,
                                           std::span<Real> out) const {
    const Codec<Real> codec(packed_.step);
    for (std::size_t i = 0; i < nodes.size() * components_; ++i) {
        const std::size_t at =
            static_cast<std::size_t>(nodes[i / components_]) * components_ + i % components_;
        out[i] = codec.decode(code(at), 0);
    }
}

template <class Real>
void CompressedValues<Real>::decode(const Rule& rule, NodeMask which,
                                    std::span<const NodeKey> nodes, std::span<const Real> corners,
                                    std::span<Real> out) const {
    const Codec<Real> codec(packed_.step);
    std::array<Real, max_corners + max_new_nodes> value;
    const auto before = static_cast<std::size_t>(rule.corner_count());
    for (std::size_t c = 0; c < components_; ++c) {
        for (std::size_t k = 0; k < before; ++k) value[k] = corners[k * components_ + c];
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            Real& at = value[before + n];
            const bool wanted = (which >> n & 1U) != 0;
            if (!wanted && rule.steps == 1) continue;  // no parent of another new node
            at = detail::interpolate(rule.new_nodes[n], value.data(), 1);
            if (!wanted) continue;
            at = codec.decode(code(static_cast<std::size_t>(nodes[n]) * components_ + c), at);
            out[n * components_ + c] = at;
        }
    }
}

template <class Real>
void CompressedValues<Real>::decode_split(const Rule& rule, NodeMask hanging,
                                          std::span<const NodeKey> nodes,
                                          std::span<const Real> corners,
                                          std::span<Real> out) const {
    decode(rule, rule.all() & ~hanging, nodes, corners, out);
    if (hanging == 0) return;
    std::array<Real, max_corners + max_new_nodes> value;
    const auto before = static_cast<std::size_t>(rule.corner_count());
    for (std::size_t c = 0; c < components_; ++c) {
        for (std::size_t k = 0; k < before; ++k) value[k] = corners[k * components_ + c];
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            Real& at = out[n * components_ + c];
            if ((hanging >> n & 1U) != 0) {
                at = detail::interpolate(rule.new_nodes[n], value.data(), 1);
            }
            value[before + n] = at;
        }
    }
}

template class CompressedValues<float>;
template class CompressedValues<double>;

}  // namespace nestgrid
