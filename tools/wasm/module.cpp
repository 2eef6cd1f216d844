// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An Explorer of one volume behind functions that JavaScript calls (page/volume_module.js):
// allocate samples, write them there, open, then ask for frames.
//
// Invariant: no exception leaves these functions. Where one says that it failed, failure() tells
// why in one sentence.
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <string>

#include <nestgrid/error.hpp>

#include "../view/explored_samples.hpp"
#include "../view/explorer.hpp"
#include "samples.hpp"

namespace {

using nestgrid::LatticeGeometry;
using nestgrid::view::explored_samples;
using nestgrid::view::ExploredField;
using nestgrid::view::Explorer;

/// Where samples lie in space, as JavaScript writes it.
struct Geometry {
    std::array<double, 3> samples;
    std::array<double, 3> spacing;
    std::array<double, 3> origin;
    std::array<double, 9> direction;  ///< rows of LatticeGeometry::direction
};

const nestgrid::SequentialExecutor executor;
Geometry geometry;
std::array<char, 2001> text;  // of a request or a type, ends with 0
std::unique_ptr<std::byte[]> samples;
std::size_t sample_bytes = 0;
std::optional<Explorer> explorer;
std::string info;
std::vector<std::byte> frame;
std::string failure;

/// Calls function(), and remembers why it failed.
/// \return whether it did not
template <class Function>
bool attempt(const Function& function) {
    failure.clear();
    try {
        function();
    } catch (const std::bad_alloc&) {
        failure = "there is not enough memory: a page has at most 4 GB";
    } catch (const std::exception& error) {
        failure = error.what();
    }
    return failure.empty();
}

LatticeGeometry<3> lattice_geometry() {
    LatticeGeometry<3> g;
    for (std::size_t d = 0; d < 3; ++d) {
        const double n = geometry.samples[d];
        if (!(n >= 2 && n <= 1 << 20)) {
            throw nestgrid::InvalidInput("a volume needs 2 to 2^20 samples along each direction");
        }
        g.samples[d] = static_cast<int>(n);
        g.spacing[d] = geometry.spacing[d];
        g.origin[d] = geometry.origin[d];
    }
    for (std::size_t i = 0; i < 9; ++i) g.direction[i / 3][i % 3] = geometry.direction[i];
    return g;
}

void open_samples(const std::string& type) {
    if (bytes_of(type) == 0) throw nestgrid::InvalidInput("there is no type '" + type + "'");
    explorer.reset();
    const LatticeGeometry<3> g = lattice_geometry();
    const std::size_t count = sample_bytes / bytes_of(type);
    ExploredField field = with_samples(
        type, static_cast<const std::byte*>(samples.get()), count,
        [&]<class Sample>(std::span<const Sample> all) { return explored_samples(g, all); });
    explorer.emplace(std::move(field), executor);
    info = explorer->info();
}

}  // namespace

/// Tells JavaScript what is being done, in a text that ends with 0. A share that is not known is
/// not a number.
extern "C" __attribute__((import_module("env"), import_name("tell"))) void nestgrid_tell(
    const char* doing, double share);

#define NESTGRID_EXPORT(name) extern "C" __attribute__((export_name(#name)))

/// Frees the samples there were, and allocates these.
/// \return where to write them; null where that failed
NESTGRID_EXPORT(allocate) std::byte* nestgrid_allocate(std::size_t bytes) {
    const bool done = attempt([&] {
        explorer.reset();
        samples.reset();
        sample_bytes = 0;
        samples.reset(new std::byte[bytes]);
        sample_bytes = bytes;
    });
    return done ? samples.get() : nullptr;
}
/// Where to write 18 numbers: samples, spacing, origin and direction.
NESTGRID_EXPORT(geometry) double* nestgrid_geometry() { return geometry.samples.data(); }
/// Where to write a text of at most 2,000 bytes and a 0.
NESTGRID_EXPORT(text) char* nestgrid_text() { return text.data(); }
/// Opens the samples, whose type is the text.
/// \return what Explorer::info() tells; null where that failed
NESTGRID_EXPORT(open) const char* nestgrid_open() {
    return attempt([] { open_samples(text.data()); }) ? info.c_str() : nullptr;
}
/// Draws the frame for which the text asks.
/// \return the bytes of Explorer::frame(); null where that failed
NESTGRID_EXPORT(frame) const std::byte* nestgrid_frame() {
    const bool done = attempt([] {
        frame = {};
        if (!explorer) throw nestgrid::InvalidInput("there is no volume yet");
        frame = explorer->frame(text.data(), [](const nestgrid::view::FrameStep& step) {
            nestgrid_tell(step.doing, step.share);
            return true;
        });
    });
    return done ? frame.data() : nullptr;
}
NESTGRID_EXPORT(frame_size) std::size_t nestgrid_frame_size() { return frame.size(); }
NESTGRID_EXPORT(failure) const char* nestgrid_failure() { return failure.c_str(); }
