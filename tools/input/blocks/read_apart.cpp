// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files of blocks that child processes read: what is in a file, and the numbers of a field, as they
// pass through a parcel.
#include <cstring>

#include "input/blocks/read_blocks.hpp"
#include "input/child_process.hpp"
#include "input/input_file.hpp"

namespace {

using nestgrid::InvalidInput;
using nestgrid::IoError;
namespace fs = std::filesystem;
using Box = nestgrid::BlockBox<3>;

/// What a child tells of a file, in this order of blocks.
struct Part {
    enum Number : std::size_t { head, levels, boxes, fields, names };
};
struct Head {
    int dimension;
    bool is_double;
    bool has_time;
    double time;
    nestgrid::Point origin;
    nestgrid::Point spacing;
    std::array<int, 3> axes;
};
struct LevelHead {
    std::array<int, 3> ratio;
    std::size_t boxes;
};
struct FieldHead {
    int components;
    std::size_t letters;
};
/// What a child tells of a field.
struct NumbersPart {
    enum Number : std::size_t { has_numbers, packed };
};

std::size_t bytes_a_number(const BlockFile& file) {
    return file.is_double ? sizeof(double) : sizeof(float);
}

std::array<std::size_t, 3> size_of(const Box& box, int dimension) {
    std::array<std::size_t, 3> size{1, 1, 1};
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
        const auto cells = std::int64_t{box.upper[d]} - box.lower[d] + 1;
        if (cells < 1 || cells > 1 << 30) throw InvalidInput("a box has no cells, or too many");
        size[d] = static_cast<std::size_t>(cells);
    }
    return size;
}

void put(const BlockFile& file, Parcel& out) {
    std::vector<LevelHead> levels;
    std::vector<Box> boxes;
    for (const nestgrid::BlockLevel<3>& level : file.blocks.levels) {
        levels.push_back({level.ratio, level.boxes.size()});
        boxes.insert(boxes.end(), level.boxes.begin(), level.boxes.end());
    }
    if (file.fields.empty()) throw InvalidInput("it has no data of cells");
    std::vector<FieldHead> fields;
    std::string names;
    for (const BlockFile::Field& field : file.fields) {
        fields.push_back({field.components, field.name.size()});
        names += field.name;
    }
    const Head head{file.dimension,        file.is_double,     file.time.has_value(),
                    file.time.value_or(0), file.blocks.origin, file.blocks.spacing,
                    file.blocks.axes};
    out.put(std::span<const Head>(&head, 1));
    out.put(std::span<const LevelHead>(levels));
    out.put(std::span<const Box>(boxes));
    out.put(std::span<const FieldHead>(fields));
    out.put(std::span<const char>(names));
}

BlockFile file_in(const Parcel& parcel) {
    const Head& head = parcel.block<Head>(Part::head).front();
    BlockFile file;
    file.dimension = head.dimension;
    file.is_double = head.is_double;
    if (head.has_time) file.time = head.time;
    file.blocks.origin = head.origin;
    file.blocks.spacing = head.spacing;
    file.blocks.axes = head.axes;
    std::span<const Box> boxes = parcel.block<Box>(Part::boxes);
    for (const LevelHead& from : parcel.block<LevelHead>(Part::levels)) {
        nestgrid::BlockLevel<3>& level = file.blocks.levels.emplace_back();
        level.ratio = from.ratio;
        level.boxes.assign(boxes.begin(), boxes.begin() + static_cast<std::ptrdiff_t>(from.boxes));
        boxes = boxes.subspan(from.boxes);
    }
    std::span<const char> names = parcel.block<char>(Part::names);
    for (const FieldHead& field : parcel.block<FieldHead>(Part::fields)) {
        file.fields.push_back({std::string(names.data(), field.letters), field.components});
        names = names.subspan(field.letters);
    }
    return file;
}

/// Copies the numbers of a box without gaps.
/// \return behind the copy
std::byte* pack(const nestgrid::BlockArray<3, std::byte>& array,
                const std::array<std::size_t, 3>& size, std::size_t bytes, std::byte* to) {
    const auto* const first = static_cast<const std::byte*>(array.first);
    const bool is_row = array.stride[0] == static_cast<std::ptrdiff_t>(bytes);
    for (std::size_t k = 0; k < size[2]; ++k) {
        for (std::size_t j = 0; j < size[1]; ++j) {
            const std::byte* from = first + static_cast<std::ptrdiff_t>(j) * array.stride[1] +
                                    static_cast<std::ptrdiff_t>(k) * array.stride[2];
            const std::size_t run = is_row ? size[0] : 1;
            for (std::size_t i = 0; i < size[0]; i += run) {
                std::memcpy(to, from, run * bytes);
                to += run * bytes;
                from += array.stride[0];
            }
        }
    }
    return to;
}

void put(const BoxNumbers& numbers, const BlockFile& file, Parcel& out) {
    std::vector<std::uint8_t> has_numbers;
    std::size_t count = 0;
    const auto for_each_box = [&](const auto& function) {
        for (std::size_t l = 0; l < file.blocks.levels.size(); ++l) {
            const std::vector<Box>& boxes = file.blocks.levels[l].boxes;
            for (std::size_t b = 0; b < boxes.size(); ++b) {
                function(numbers.arrays[l][b], size_of(boxes[b], file.dimension));
            }
        }
    };
    for_each_box([&](const auto& array, const auto& size) {
        has_numbers.push_back(array.first == nullptr ? 0 : 1);
        if (array.first != nullptr) count += size[0] * size[1] * size[2];
    });
    out.put(std::span<const std::uint8_t>(has_numbers));
    std::byte* to = out.append(count * bytes_a_number(file)).data();
    for_each_box([&](const auto& array, const auto& size) {
        if (array.first != nullptr) to = pack(array, size, bytes_a_number(file), to);
    });
}

/// \throw IoError where the parcel has other numbers than the boxes need
BoxNumbers numbers_in(std::shared_ptr<const Parcel> parcel, const BlockFile& file,
                      const fs::path& path) {
    const auto has_numbers = parcel->block<std::uint8_t>(NumbersPart::has_numbers);
    std::span<const std::byte> rest = parcel->block<std::byte>(NumbersPart::packed);
    const auto require = [&](bool is_same) {
        if (!is_same) throw IoError("'" + path.string() + "' has changed while it was read");
    };
    BoxNumbers numbers;
    std::size_t box_number = 0;
    for (const nestgrid::BlockLevel<3>& level : file.blocks.levels) {
        auto& arrays = numbers.arrays.emplace_back();
        for (const Box& box : level.boxes) {
            auto& array = arrays.emplace_back();
            require(box_number < has_numbers.size());
            if (has_numbers[box_number++] == 0) continue;
            std::size_t bytes = bytes_a_number(file);
            const auto size = size_of(box, file.dimension);
            for (std::size_t d = 0; d < size.size(); ++d) {
                array.stride[d] = static_cast<std::ptrdiff_t>(bytes);
                bytes *= size[d];
            }
            require(bytes <= rest.size());
            array.first = rest.data();
            rest = rest.subspan(bytes);
        }
    }
    require(rest.empty());
    numbers.memory = std::move(parcel);
    return numbers;
}

}  // namespace

BlockFile open_apart(const fs::path& path, double seconds, OpenBlocks open) {
    BlockFile file =
        file_in(*read_file_apart(path, seconds, [&](Parcel& out) { put(open(path), out); }));
    file.numbers = [path, seconds, open, head = file](std::size_t field, int component) {
        auto parcel = read_file_apart(path, seconds, [&](Parcel& out) {
            const BlockFile read = open(path);
            put(read.numbers(field, component), read, out);
        });
        return numbers_in(std::move(parcel), head, path);
    };
    return file;
}

std::vector<BlockFile> open_all(const Input& input, const Paths& paths, OpenBlocks open) {
    const Format* const format = format_of(paths.front());
    std::vector<BlockFile> files;
    for (const fs::path& path : paths) {
        require_file(path);
        if (format == nullptr || format_of(path) != format) {
            throw InvalidInput("'" + path.string() + "' is no file of the format of the first one");
        }
        const double seconds =
            input.read_limit > 0 ? input.read_limit : reading_time(bytes_to_read(path, *format));
        files.push_back(open_apart(path, seconds, open));
    }
    return files;
}
