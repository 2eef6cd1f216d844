// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The part of a file that holds values: of one frame as they are (version 1), or of several frames,
// each as it is or encoded (version 2).
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include <nestgrid/adapters/file_bytes.hpp>
#include <nestgrid/adapters/stored_hierarchy.hpp>

namespace nestgrid::detail {

/// How the values of a frame are kept in version 2.
enum class Kept : std::uint32_t { plain = 0, compressed = 1 };

inline bool times_ascend(const std::vector<double>& times) {
    const auto in_order = [](double a, double b) { return a < b; };
    return !times.empty() &&
           std::ranges::all_of(times, [](double t) { return std::isfinite(t); }) &&
           std::ranges::adjacent_find(times, std::not_fn(in_order)) == times.end();
}

/// \throw InvalidInput where times do not ascend, or a field has not one value for each node of
///        each frame
inline void check_values(const std::vector<NamedField>& fields, std::size_t nodes,
                         const std::vector<double>& times) {
    if (!times_ascend(times)) {
        throw InvalidInput("the times of frames are not finite numbers in ascending order");
    }
    for (const NamedField& f : fields) {
        std::size_t count = f.values.size();
        for (const auto& frame : f.encoded) count += frame.size();
        const bool one_each =
            f.encoded.empty() || (f.values.empty() && f.encoded.size() == times.size());
        if (count != nodes * times.size() || !one_each) {
            throw InvalidInput(
                "field '" + f.name + "' has " + std::to_string(count) + " values, but the grid " +
                std::to_string(nodes) + " nodes" +
                (times.size() == 1 ? "" : " and " + std::to_string(times.size()) + " frames"));
        }
    }
}

/// The lowest version of the format that holds the values.
inline std::uint32_t version_for(const std::vector<NamedField>& fields,
                                 const StoredFileOptions& options) {
    const bool plain =
        !options.compression &&
        std::ranges::all_of(fields, [](const NamedField& field) { return field.encoded.empty(); });
    return plain && options.times == std::vector<double>{0} ? 1 : 2;
}

inline void write_name(const NamedField& field, Writer& out) {
    out.put_all(std::vector<char>(field.name.begin(), field.name.end()));
}

inline void write_plain(const std::vector<NamedField>& fields, Writer& out) {
    out.put(static_cast<std::uint64_t>(fields.size()));
    for (const NamedField& f : fields) {
        write_name(f, out);
        out.put_all(f.values);
    }
}

inline void write_compressed(const CompressedValues<double>& values, Writer& out) {
    const PackedValues& packed = values.packed();
    out.put(Kept::compressed);
    out.put(packed.step);
    out.put_all(packed.block);
    out.put_all(packed.words);
}

template <class Family>
void write_frames(const StoredGrid<Family>& grid, const std::vector<NamedField>& fields,
                  const StoredFileOptions& options, Writer& out) {
    out.put_all(options.times);
    out.put(static_cast<std::uint64_t>(fields.size()));
    for (const NamedField& f : fields) {
        write_name(f, out);
        for (const auto& frame : f.encoded) write_compressed(frame, out);
        for (std::size_t first = 0; first < f.values.size(); first += grid.node_count()) {
            const auto values = std::span(f.values).subspan(first, grid.node_count());
            if (options.compression) {
                const NodeField field(grid, values);
                write_compressed(CompressedValues<double>(erase(grid, field), *options.compression),
                                 out);
            } else {
                out.put(Kept::plain);
                out.put_all(std::vector<double>(values.begin(), values.end()));
            }
        }
    }
}

inline std::string read_name(Reader& in) {
    const auto name = in.get_all<char>();
    return {name.begin(), name.end()};
}

inline std::vector<double> read_values(Reader& in, const std::string& name, std::size_t nodes) {
    auto values = in.get_all<double>();
    if (values.size() != nodes) in.fail("field '" + name + "' has another number of values");
    return values;
}

template <class Family>
void read_plain(Reader& in, StoredHierarchy<Family>& stored) {
    const auto count = in.get<std::uint64_t>();
    for (std::uint64_t i = 0; i < count; ++i) {
        NamedField& field = stored.fields.emplace_back(NamedField{read_name(in), {}});
        field.values = read_values(in, field.name, stored.grid.node_count());
    }
}

inline CompressedValues<double> read_compressed(Reader& in, const std::string& name,
                                                std::size_t nodes) {
    PackedValues packed{in.get<double>(), {}, {}};
    packed.block = in.get_all<std::uint32_t>();
    packed.words = in.get_all<std::uint64_t>();
    try {
        return {nodes, 1, std::move(packed)};
    } catch (const InvalidInput& error) {
        in.fail("field '" + name + "': " + error.what());
    }
}

/// The values of one field. Frames of which some are encoded and others are not are decoded.
template <class Family>
NamedField read_field(Reader& in, Encoded encoded, const StoredHierarchy<Family>& stored) {
    NamedField field{read_name(in), {}};
    const std::size_t nodes = stored.grid.node_count();
    const auto add = [&](const std::vector<double>& values) {
        field.values.insert(field.values.end(), values.begin(), values.end());
    };
    for (std::size_t i = 0; i < stored.times.size(); ++i) {
        const auto kept = in.get<Kept>();
        if (kept == Kept::compressed) {
            auto values = read_compressed(in, field.name, nodes);
            if (encoded == Encoded::keep) {
                field.encoded.push_back(std::move(values));
            } else {
                add(decode(stored.grid, values));
            }
        } else if (kept == Kept::plain) {
            add(read_values(in, field.name, nodes));
        } else {
            in.fail("field '" + field.name + "' is encoded in a way that is not known");
        }
    }
    if (!field.encoded.empty() && field.encoded.size() < stored.times.size()) {
        in.fail("field '" + field.name + "' is encoded in some of its frames only");
    }
    return field;
}

template <class Family>
void read_frames(Reader& in, Encoded encoded, StoredHierarchy<Family>& stored) {
    stored.times = in.get_all<double>();
    if (!times_ascend(stored.times)) {
        in.fail("the times of its frames are not finite numbers in ascending order");
    }
    const auto count = in.get<std::uint64_t>();
    for (std::uint64_t i = 0; i < count; ++i) {
        stored.fields.push_back(read_field(in, encoded, stored));
    }
}

}  // namespace nestgrid::detail
