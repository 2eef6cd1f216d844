// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "input/volumes/chosen_samples.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <limits>
#include <type_traits>

#include <nestgrid/error.hpp>

#include "input/child_process.hpp"
#include "input/mapped_file.hpp"
#include "sample_layout.hpp"
#include "samples.hpp"

namespace {

using nestgrid::InvalidInput;
using nestgrid::IoError;

/// Puts a text that a file gives, cut short, without what a terminal obeys.
template <std::size_t size>
void put(const std::string& text, std::array<char, size>& to) {
    const std::size_t count = std::min(size - 1, text.size());
    std::transform(
        text.begin(), text.begin() + static_cast<std::ptrdiff_t>(count), to.begin(),
        [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 127 ? '?' : c; });
}

/// At most 2^60.
std::size_t places_in(const nestgrid::LatticeGeometry<3>& geometry) {
    std::size_t count = 1;
    for (const int n : geometry.samples) count *= static_cast<std::size_t>(n);
    return count;
}

/// "0 to 4", or "0 or 1".
std::string numbers_below(std::size_t count) {
    return count == 2 ? "0 or 1" : "0 to " + std::to_string(count - 1);
}

/// \param what "frame" or "component"
std::size_t checked_number(const FileSamples& samples, std::int64_t number, std::size_t count,
                           const std::string& what) {
    if (number >= 0 && static_cast<std::uint64_t>(number) < count) {
        return static_cast<std::size_t>(number);
    }
    throw InvalidInput(samples.path.string() + " has no " + what + " " + std::to_string(number) +
                       ": --" + what + " is " + numbers_below(count));
}

/// Chooses a frame and says how many are left out.
/// \return where its numbers begin
std::size_t choose_frame(FileSamples& samples, const VolumeChoice& choice) {
    const std::size_t count = samples.frames.count;
    if (choice.all_frames) return 0;
    if (count == 1) {
        if (!choice.frame) return 0;
        throw InvalidInput("--frame chooses nothing: " + samples.path.string() +
                           " has one frame only");
    }
    const std::size_t frame = checked_number(samples, choice.frame.value_or(0), count, "frame");
    const std::size_t offset = frame * samples.frames.stride;
    samples.note = "frame " + std::to_string(frame) + " of the " + std::to_string(count) + " in " +
                   samples.path.filename().string() + " is read" +
                   (choice.frame ? "" : "; --frame chooses another, from " + numbers_below(count));
    return offset;
}

/// Chooses a component, unless the norm of all is asked for.
/// \return where its numbers begin
std::size_t choose_component(FileSamples& samples, const VolumeChoice& choice) {
    const std::size_t count = samples.components.count;
    const std::string path = samples.path.string();
    if (choice.component && choice.magnitude) {
        throw InvalidInput("--component and --magnitude exclude each other");
    }
    if (count == 1) {
        if (!choice.component && !choice.magnitude) return 0;
        throw InvalidInput(std::string(choice.magnitude ? "--magnitude" : "--component") +
                           " chooses nothing: " + path + " has one number per sample");
    }
    if (choice.magnitude) return 0;
    if (!choice.component) {
        throw InvalidInput(
            path + " has " + std::to_string(count) + " numbers per sample" +
            (samples.component_kind.empty() ? std::string() : " (" + samples.component_kind + ")") +
            ", not one: choose by --component " + numbers_below(count) + ", or by --magnitude");
    }
    const std::size_t chosen = checked_number(samples, *choice.component, count, "component");
    samples.components.count = 1;
    return chosen * samples.components.stride;
}

/// Whether numbers computed from these need the digits of float64.
bool need_double(const FileSamples& samples) {
    const std::size_t size = bytes_of(samples.type);
    const bool floating = samples.type.starts_with("float");
    if (size > 4 || (size == 4 && !floating)) return true;
    // Float32 tells 2^24 neighbours apart.
    const double steps = size == 1 ? 256 : 65536;
    return !floating && std::abs(samples.intercept) > (8388608 - steps) * std::abs(samples.slope);
}

/// Calls function(i, offset of the first component) for each sample, x fastest.
template <class Function>
void for_each_sample(const FileSamples& samples, Function&& function) {
    const auto& n = samples.geometry.samples;
    const auto& stride = samples.stride;
    std::size_t i = 0;
    for (std::size_t z = 0; z < static_cast<std::size_t>(n[2]); ++z) {
        for (std::size_t y = 0; y < static_cast<std::size_t>(n[1]); ++y) {
            std::size_t at = z * stride[2] + y * stride[1];
            for (int x = 0; x < n[0]; ++x, at += stride[0]) function(i++, at);
        }
    }
}

/// Fills the block with the samples as they are.
void gather(const FileSamples& samples, std::size_t count, std::span<std::byte> block) {
    with_samples(samples.type, block.data(), count, [&]<class Sample>(std::span<Sample> to) {
        const auto* from = reinterpret_cast<const Sample*>(samples.data);
        for_each_sample(samples, [&](std::size_t i, std::size_t at) { to[i] = from[at]; });
    });
}

/// Fills the block with slope times number plus intercept, or with the norm of such numbers.
template <class Result>
void compute(const FileSamples& samples, std::span<Result> to) {
    with_samples(samples.type, samples.data, 0, [&]<class Sample>(std::span<Sample>) {
        const auto* from = reinterpret_cast<const Sample*>(samples.data);
        const auto value = [&](std::size_t at) {
            return samples.slope * static_cast<double>(from[at]) + samples.intercept;
        };
        for_each_sample(samples, [&](std::size_t i, std::size_t at) {
            if (samples.components.count == 1) {
                to[i] = static_cast<Result>(value(at));
                return;
            }
            double norm = 0;
            for (std::size_t c = 0; c < samples.components.count; ++c) {
                norm = std::hypot(norm, value(at + c * samples.components.stride));
            }
            to[i] = static_cast<Result>(norm);
        });
    });
}

/// Turns places to another space, whose axes point the same or the opposite ways: right or left,
/// to the front or back of a patient, up or down.
/// \throw nestgrid::InvalidInput where the file does not say which ways its axes point
void turn_to(const std::string& space, FileSamples& samples) {
    if (space.empty()) return;
    constexpr std::array opposite{"RL", "AP", "SI"};
    std::string wanted = space;
    std::ranges::transform(wanted, wanted.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    for (std::size_t r = 0; r < 3; ++r) {
        const std::string ways = opposite[r];
        if (samples.space.size() != 3 || ways.find(samples.space[r]) == std::string::npos) {
            throw InvalidInput("--space cannot turn " + samples.path.string() + ", which " +
                               (samples.space.empty() ? "does not say where its axes point"
                                                      : "is in the space " + samples.space));
        }
        if (samples.space[r] == wanted[r]) continue;
        samples.geometry.origin[r] = -samples.geometry.origin[r];
        for (double& part : samples.geometry.direction[r]) part = -part;
    }
    samples.space = wanted;
}

/// Makes the axis along which there is one sample only the last one.
void turn_plane(FileSamples& samples) {
    auto& g = samples.geometry;
    if (std::ranges::count(g.samples, 1) != 1) return;
    const auto flat = std::ranges::find(g.samples, 1) - g.samples.begin();
    for (auto d = static_cast<std::size_t>(flat); d < 2; ++d) {
        std::swap(g.samples[d], g.samples[d + 1]);
        std::swap(g.spacing[d], g.spacing[d + 1]);
        std::swap(samples.stride[d], samples.stride[d + 1]);
        for (auto& row : g.direction) std::swap(row[d], row[d + 1]);
    }
}

void check_counts(const FileSamples& samples) {
    const auto& n = samples.geometry.samples;
    if (std::ranges::count_if(n, [](int count) { return count < 2; }) < 2 && n[0] > 0) return;
    throw InvalidInput(samples.path.string() + " has " + std::to_string(n[0]) + " x " +
                       std::to_string(n[1]) + " x " + std::to_string(n[2]) +
                       " samples; a field needs at least 2 along two directions");
}

void check_place(const FileSamples& samples) {
    try {
        if (samples.geometry.samples[2] == 1) {
            const nestgrid::Lattice<2> lattice(plane_of(samples.geometry));
        } else {
            const nestgrid::Lattice<3> lattice(samples.geometry);
        }
    } catch (const InvalidInput& error) {
        throw InvalidInput(samples.path.string() + " cannot be read: " + error.what());
    }
}

/// "(3, 4, 0)".
std::string place_of(std::size_t i, const nestgrid::LatticeGeometry<3>& geometry) {
    const auto nx = static_cast<std::size_t>(geometry.samples[0]);
    const auto ny = static_cast<std::size_t>(geometry.samples[1]);
    const auto nz = static_cast<std::size_t>(geometry.samples[2]);
    return "(" + std::to_string(i % nx) + ", " + std::to_string(i / nx % ny) + ", " +
           std::to_string(i / nx / ny % nz) + ")";
}

/// \param first number of the first of the samples
/// \return how many samples have no value
/// \throw nestgrid::InvalidInput for an infinite one
std::size_t count_missing(const FileSamples& file, const std::string& type, const std::byte* data,
                          std::size_t count, std::size_t first = 0) {
    std::size_t missing = 0;
    with_samples(type, data, count, [&]<class Sample>(std::span<Sample> samples) {
        if constexpr (std::is_floating_point_v<Sample>) {
            for (std::size_t i = 0; i < samples.size(); ++i) {
                if (std::isfinite(samples[i])) continue;
                if (std::isinf(samples[i])) {
                    throw InvalidInput(file.path.string() + ": the sample at " +
                                       place_of(first + i, file.geometry) +
                                       " is infinite; --missing takes a value for none");
                }
                ++missing;
            }
        }
    });
    return missing;
}

/// Counts them in a file, and looks at few samples at a time, as memory may hold no more.
std::size_t count_missing(const FileSamples& file, const NumbersInFile& at, std::size_t count) {
    const std::size_t size = bytes_of(file.type);
    constexpr std::size_t step = std::size_t{1} << 24U;
    std::size_t missing = 0;
    if (!file.type.starts_with("float")) count = 0;  // whole numbers are all there
    for (std::size_t first = 0; first < count; first += step) {
        const std::size_t some = std::min(step, count - first);
        const MappedFile part(at.path, at.begin + first * size, some * size);
        missing += count_missing(file, file.type, part.bytes().data(), some, first);
    }
    return missing;
}

bool is_dense(const FileSamples& samples) {
    const auto& n = samples.geometry.samples;
    const auto nx = static_cast<std::size_t>(n[0]);
    return samples.stride == std::array{std::size_t{1}, nx, nx * static_cast<std::size_t>(n[1])};
}

/// Reads all numbers into memory, unless they are there.
void fill(FileSamples& samples, std::size_t numbers) {
    if (samples.data != nullptr) return;
    const std::size_t bytes = numbers * bytes_of(samples.type);
    const std::shared_ptr<std::byte[]> memory(new std::byte[bytes]);
    samples.fill({memory.get(), bytes});
    samples.memory = std::shared_ptr<void>(memory, memory.get());
    samples.data = memory.get();
}

/// Whether values are other than the numbers of the file, or of another type. Planes have floating
/// values, so that there are fewer grids to compile.
bool is_computed(const FileSamples& samples, const VolumeChoice& choice) {
    const bool plane = samples.geometry.samples[2] == 1;
    return samples.components.count > 1 || samples.slope != 1 || samples.intercept != 0 ||
           choice.label || !choice.missing.empty() || !choice.mask.empty() ||
           (plane && !samples.type.starts_with("float"));
}

VolumeDescription describe(const FileSamples& samples, const VolumeChoice& choice) {
    VolumeDescription description;
    description.geometry = samples.geometry;
    const char* const computed = need_double(samples) && !choice.label ? "float64" : "float32";
    put(is_computed(samples, choice) ? computed : samples.type, description.type);
    put(samples.name, description.name);
    put(samples.length_unit, description.length_unit);
    put(samples.space, description.space);
    put(samples.note, description.note);
    description.frames = choice.all_frames ? samples.frames.count : 1;
    description.first_time = samples.first_time;
    description.time_step = samples.time_step;
    return description;
}

/// Whether samples are kept, x fastest; empty where all are.
using KeptSamples = std::vector<bool>;

/// \throw nestgrid::InvalidInput where the mask has other places than the samples, or several
///        numbers for each
KeptSamples kept_by(FileSamples& mask, const FileSamples& samples) {
    const std::string name = "the mask " + mask.path.string();
    check_counts(mask);
    turn_plane(mask);
    if (mask.components.count > 1) throw InvalidInput(name + " has several numbers per sample");
    const nestgrid::LatticeGeometry<3>& is = mask.geometry;
    const nestgrid::LatticeGeometry<3>& wanted = samples.geometry;
    if (is.samples != wanted.samples) {
        const auto counts = [](const nestgrid::LatticeGeometry<3>& g) {
            return std::to_string(g.samples[0]) + " x " + std::to_string(g.samples[1]) + " x " +
                   std::to_string(g.samples[2]);
        };
        throw InvalidInput(name + " has " + counts(is) + " samples, but " + samples.path.string() +
                           " has " + counts(wanted));
    }
    fill(mask, numbers_in_file(mask));
    const std::size_t count = places_in(is);
    std::vector<double> values(count);
    compute(mask, std::span(values));
    KeptSamples kept(count);
    for (std::size_t i = 0; i < count; ++i) kept[i] = values[i] != 0 && !std::isnan(values[i]);
    return kept;
}

/// Makes samples that have no value not a number.
template <class Value>
void hide_missing(const VolumeChoice& choice, const KeptSamples& kept, std::span<Value> values) {
    constexpr Value none = std::numeric_limits<Value>::quiet_NaN();
    for (std::size_t i = 0; !kept.empty() && i < values.size(); ++i) {
        if (!kept[i]) values[i] = none;
    }
    for (const double missing : choice.missing) {
        std::ranges::replace(values, static_cast<Value>(missing), none);
    }
}

/// Fills the beginning of a block with a frame, of which the data are the first sample.
void put_frame(const FileSamples& samples, const VolumeChoice& choice, const KeptSamples& kept,
               std::size_t count, std::span<std::byte> block, const std::string& type) {
    if (!is_computed(samples, choice)) return gather(samples, count, block);
    if (type == "float64") {
        const std::span values(reinterpret_cast<double*>(block.data()), count);
        compute(samples, values);
        return hide_missing(choice, kept, values);
    }
    const std::span values(reinterpret_cast<float*>(block.data()), count);
    if (!choice.label) {
        compute(samples, values);
        return hide_missing(choice, kept, values);
    }
    std::vector<double> exact(count);
    compute(samples, std::span(exact));
    hide_missing(choice, kept, std::span(exact));
    if (!choice.all_frames && std::ranges::find(exact, *choice.label) == exact.end()) {
        std::array<char, 32> label{};
        std::snprintf(label.data(), label.size(), "%g", *choice.label);
        throw InvalidInput(samples.path.string() + ": no sample has the value " + label.data() +
                           ", which --label asks for");
    }
    std::ranges::transform(exact, values.begin(), [&](double value) {
        if (std::isnan(value)) return std::numeric_limits<float>::quiet_NaN();
        return value == *choice.label ? 1.0F : 0.0F;
    });
}

/// Says how many samples have no value.
/// \throw nestgrid::InvalidInput where none has one
void note_missing(const FileSamples& file, VolumeDescription& description, std::size_t missing,
                  std::size_t all) {
    if (missing == all) throw InvalidInput(file.path.string() + ": no sample has a value");
    description.missing = missing;
    if (missing == 0) return;
    const std::string before = description.note.data();
    put(before + (before.empty() ? "" : "; ") + std::to_string(missing) + " of " +
            std::to_string(all) + " samples have no value: nothing is drawn beside them",
        description.note);
}

}  // namespace

nestgrid::LatticeGeometry<2> plane_of(const nestgrid::LatticeGeometry<3>& geometry) {
    nestgrid::LatticeGeometry<2> plane{
        .spacing = geometry.spacing, .origin = geometry.origin, .direction = geometry.direction};
    std::copy_n(geometry.samples.begin(), 2, plane.samples.begin());
    return plane;
}

std::size_t VolumeDescription::sample_count() const { return places_in(geometry); }

std::size_t numbers_in_file(const FileSamples& samples) {
    // At most 2^60 places.
    const std::size_t places = places_in(samples.geometry);
    const double factor =
        static_cast<double>(samples.components.count) * static_cast<double>(samples.frames.count);
    if (static_cast<double>(places) * factor > 1e18) throw std::bad_alloc();
    return places * samples.components.count * samples.frames.count;
}

void set_dense_strides(FileSamples& samples) {
    samples.components.stride = 1;
    std::size_t stride = samples.components.count;
    for (std::size_t d = 0; d < 3; ++d) {
        samples.stride[d] = stride;
        stride *= static_cast<std::size_t>(samples.geometry.samples[d]);
    }
    samples.frames.stride = stride;
}

FileSamples read_layout(const SampleLayout& layout) {
    FileSamples samples{.path = layout.path, .type = layout.type, .geometry = layout.geometry};
    checked_size(layout);
    samples.fill = [layout](std::span<std::byte> block) { read_samples(layout, block); };
    if (const auto begin = mappable_from(layout)) samples.in_file = {layout.files[0], *begin};
    samples.components.count = layout.components;
    samples.frames.count = layout.frames;
    samples.time_step = layout.time_step;
    set_dense_strides(samples);
    samples.slope = layout.slope;
    samples.intercept = layout.intercept;
    samples.name = layout.name;
    samples.length_unit = layout.unit;
    samples.space = layout.space;
    return samples;
}

void check_plausible(const std::filesystem::path& path, std::uintmax_t found, double asked_for) {
    // Deflate packs at most 1032 to 1.
    if (asked_for <= 1032 * static_cast<double>(found)) return;
    std::array<char, 400> number{};
    std::snprintf(number.data(), number.size(), "%.0f", asked_for);
    throw IoError(path.string() + " is truncated: " + std::to_string(found) +
                  " bytes cannot hold the " + number.data() + " that its header asks for");
}

void put_chosen(FileSamples& samples, const VolumeChoice& choice, FileSamples* mask,
                Parcel& parcel) {
    check_counts(samples);
    turn_plane(samples);
    const KeptSamples kept = mask == nullptr ? KeptSamples() : kept_by(*mask, samples);
    turn_to(choice.space, samples);
    check_place(samples);
    const bool list_is_sample = samples.frames_are_list && samples.components.count == 1 &&
                                !choice.frame && (choice.component || choice.magnitude);
    if (list_is_sample) std::swap(samples.frames, samples.components);
    const std::size_t numbers = numbers_in_file(samples);
    const std::size_t offset = choose_frame(samples, choice) + choose_component(samples, choice);
    auto& description =
        *reinterpret_cast<VolumeDescription*>(parcel.append(sizeof(VolumeDescription)).data());
    description = describe(samples, choice);
    const std::string type = description.type.data();
    const std::size_t count = description.sample_count();
    const std::size_t all = description.frames * count;
    const bool as_they_are = !is_computed(samples, choice);
    const bool in_order = is_dense(samples) && samples.frames.stride == count;
    const bool one_frame = description.frames == 1 && is_dense(samples);
    if (as_they_are && samples.in_file && (one_frame || (numbers == all && in_order))) {
        NumbersInFile at = *samples.in_file;
        at.begin += offset * bytes_of(type);
        note_missing(samples, description, count_missing(samples, at, all), all);
        description.mapped_from = static_cast<std::int64_t>(at.begin);
        return parcel.put(std::span<const char>(at.path.native()));
    }
    if (as_they_are && numbers == all && samples.data == nullptr && (in_order || all == count)) {
        const std::span<std::byte> block = parcel.append(all * bytes_of(type));
        samples.fill(block);
        note_missing(samples, description, count_missing(samples, type, block.data(), all), all);
        return;
    }
    fill(samples, numbers);
    samples.data += offset * bytes_of(samples.type);
    if (as_they_are && description.frames == 1 && is_dense(samples)) {
        note_missing(samples, description, count_missing(samples, type, samples.data, count),
                     count);
        parcel.put_last_use({samples.data, count * bytes_of(type)});
        return;
    }
    const std::span<std::byte> block = parcel.append(all * bytes_of(type));
    for (std::size_t frame = 0; frame < description.frames; ++frame) {
        put_frame(samples, choice, kept, count, block.subspan(frame * count * bytes_of(type)),
                  type);
        samples.data += samples.frames.stride * bytes_of(samples.type);
    }
    note_missing(samples, description, count_missing(samples, type, block.data(), all), all);
}
