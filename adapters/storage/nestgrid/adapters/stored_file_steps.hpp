// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of stored_file.hpp, at whose end this is included.
#pragma once

#include <cmath>
#include <cstring>
#include <fstream>

#include <boost/crc.hpp>

namespace nestgrid::detail {

static_assert(std::endian::native == std::endian::little, "the file format is little-endian");

/// The first bytes of a file; what follows them is `body` bytes long.
struct FileHeader {
    std::array<char, 8> magic{'n', 'e', 's', 't', 'g', 'r', 'i', 'd'};
    std::uint32_t version = 1;  // 2 where there are frames, or encoded values
    std::uint32_t dimension = 0;
    std::array<char, 16> family{};
    std::uint32_t corners = 0;
    std::uint32_t options = 0;  // of the family
    std::uint64_t body = 0;
    std::uint32_t body_checksum = 0;    // CRC-32
    std::uint32_t header_checksum = 0;  // of all before

    std::uint32_t own_checksum() const {
        boost::crc_32_type crc;
        crc.process_bytes(this, offsetof(FileHeader, header_checksum));
        return crc.checksum();
    }
};
static_assert(sizeof(FileHeader) == 56 && std::is_trivially_copyable_v<FileHeader>);

inline std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

/// The body of a file in memory.
class Writer {
public:
    template <class T>
    void put(const T& value) {
        const auto* at = reinterpret_cast<const char*>(&value);
        bytes.insert(bytes.end(), at, at + sizeof(T));
    }
    template <class T>
    void put_all(const std::vector<T>& values) {
        put(static_cast<std::uint64_t>(values.size()));
        const auto* at = reinterpret_cast<const char*>(values.data());
        bytes.insert(bytes.end(), at, at + values.size() * sizeof(T));
    }
    std::vector<char> bytes;
};

class Reader {
public:
    Reader(std::vector<char> bytes, std::string name)
        : bytes_{std::move(bytes)}, name_{std::move(name)} {}

    [[noreturn]] void fail(const std::string& what) const {
        throw IoError(name_ + " is damaged: " + what);
    }
    template <class T>
    T get() {
        if (bytes_.size() - at_ < sizeof(T)) fail("it ends too early");
        T value;
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return value;
    }
    template <class T>
    std::vector<T> get_all() {
        const auto count = get<std::uint64_t>();
        if (count > (bytes_.size() - at_) / sizeof(T)) fail("it ends too early");
        std::vector<T> values(static_cast<std::size_t>(count));
        if (count > 0) std::memcpy(values.data(), bytes_.data() + at_, values.size() * sizeof(T));
        at_ += values.size() * sizeof(T);
        return values;
    }
    bool at_end() const { return at_ == bytes_.size(); }

private:
    std::vector<char> bytes_;
    std::string name_;
    std::size_t at_ = 0;
};

inline FileHeader read_file_header(std::ifstream& file, const std::filesystem::path& path) {
    FileHeader header;
    if (!file) throw IoError(quoted(path) + " cannot be opened");
    if (!file.read(reinterpret_cast<char*>(&header), sizeof(header)) ||
        header.magic != FileHeader{}.magic) {
        throw IoError(quoted(path) + " is no nestgrid hierarchy");
    }
    if (header.version != 1 && header.version != 2) {
        throw IoError(quoted(path) + " has version " + std::to_string(header.version) +
                      " of the format; this program reads versions 1 and 2");
    }
    if (header.header_checksum != header.own_checksum()) {
        throw IoError(quoted(path) + " is damaged: the checksum of its header is wrong");
    }
    return header;
}

inline std::string text(const std::array<char, 16>& name) {
    return {name.data(), strnlen(name.data(), name.size())};
}

/// Completes the header and writes both. The file appears when it is complete.
inline void write_file(const std::filesystem::path& path, FileHeader header,
                       const std::vector<char>& body) {
    header.body = body.size();
    boost::crc_32_type crc;
    crc.process_bytes(body.data(), body.size());
    header.body_checksum = crc.checksum();
    header.header_checksum = header.own_checksum();

    std::filesystem::path part = path;
    part += ".part";
    {
        std::ofstream file(part, std::ios::binary);
        file.write(reinterpret_cast<const char*>(&header), sizeof(header));
        file.write(body.data(), static_cast<std::streamsize>(body.size()));
        file.close();
        if (!file) {
            std::error_code ignored;
            std::filesystem::remove(part, ignored);
            throw IoError(quoted(path) + " cannot be written");
        }
    }
    std::error_code failed;
    std::filesystem::rename(part, path, failed);
    if (failed) {
        std::filesystem::remove(part, failed);
        throw IoError(quoted(path) + " cannot be written");
    }
}

/// Reading and writing what a StoredGrid keeps private.
template <class Family>
class GridFile {
public:
    using Grid = StoredGrid<Family>;

    static void write(const Grid& grid, Writer& out) {
        const CoarseGrid& coarse = grid.coarse_;
        out.put(static_cast<std::uint64_t>(coarse.nodes.size()));
        for (std::size_t i = 0; i < coarse.nodes.size(); ++i) out.put(coarse.nodes[i]);
        out.put_all(coarse.shapes);
        out.put_all(coarse.corners);
        out.put_all(grid.orientation_);
        std::vector<std::uint64_t> rules;
        for (std::size_t r = 1; r < grid.table_.rule_count(); ++r) {
            rules.push_back(grid.table_.rule(r).descriptor);
        }
        out.put_all(rules);
        out.put(static_cast<std::uint64_t>(grid.table_.size() - shape_count));
        for (std::size_t p = shape_count; p < grid.table_.size(); ++p) {
            out.put_all(grid.table_[p].tree);
        }
        out.put(static_cast<std::uint64_t>(grid.node_count_));
        out.put(static_cast<std::uint64_t>(grid.leaf_count_));
        out.put_all(grid.root_);
        out.put_all(grid.words_);
        out.put_all(grid.hanging_);
        std::vector<bool> used(grid.node_count_, false);
        std::fill_n(used.begin(), coarse.nodes.size(), true);
        grid.for_each_leaf([&](const Leaf& leaf) {
            for (const std::uint32_t node : leaf.nodes) used[node] = true;
        });
        out.put_all(bits(used));
    }

    static Grid read(Reader& in, const Family& family) {
        Grid grid;
        grid.family_ = family;
        read_coarse(grid, in);
        read_table(grid, in);
        grid.node_count_ = static_cast<std::size_t>(in.get<std::uint64_t>());
        grid.leaf_count_ = static_cast<std::size_t>(in.get<std::uint64_t>());
        grid.root_ = in.get_all<std::uint32_t>();
        grid.words_ = in.get_all<std::uint32_t>();
        grid.hanging_ = in.get_all<std::uint32_t>();
        GridFile(grid, in).check(in.get_all<std::uint32_t>());
        return grid;
    }

private:
    GridFile(Grid& grid, const Reader& in) : grid_{grid}, in_{in} {}

    static std::vector<std::uint32_t> bits(const std::vector<bool>& set) {
        std::vector<std::uint32_t> words((set.size() + 31) / 32, 0);
        for (std::size_t i = 0; i < set.size(); ++i) words[i / 32] |= unsigned{set[i]} << i % 32;
        return words;
    }

    static void read_coarse(Grid& grid, Reader& in) {
        CoarseGrid& coarse = grid.coarse_;
        coarse.dimension = Family::dimension;
        const std::vector<Point> nodes = in.get_all<Point>();
        coarse.nodes = Coordinates(nodes);
        const auto shapes = in.get_all<Shape>();
        const auto corners = in.get_all<std::uint32_t>();
        grid.orientation_ = in.get_all<std::int8_t>();
        if (shapes.empty() || grid.orientation_.size() != shapes.size()) {
            in.fail("the coarse grid is incomplete");
        }
        std::size_t at = 0;
        for (const Shape s : shapes) {
            if (static_cast<int>(s) >= shape_count || !Family::refines(s)) {
                in.fail("an element of the coarse grid has a shape the family does not know");
            }
            const std::size_t n = topology(s).corners;
            if (corners.size() - at < n) in.fail("the coarse grid is incomplete");
            coarse.add(s, std::span(corners).subspan(at, n));
            at += n;
        }
        if (at != corners.size()) in.fail("the coarse grid has corners left over");
        try {
            check_nodes(coarse, {.slits = true});
            for (std::size_t e = 0; e < shapes.size(); ++e) check_element(coarse, e);
        } catch (const InvalidInput& error) {
            in.fail(error.what());
        }
        for (const std::int8_t o : grid.orientation_) {
            if (o != 1 && o != -1) in.fail("an orientation is neither 1 nor -1");
        }
    }

    static void read_table(Grid& grid, Reader& in) {
        try {
            for (const std::uint64_t descriptor : in.get_all<std::uint64_t>()) {
                const std::size_t expected = grid.table_.rule_count();
                if (expected > 0xFFFF) in.fail("it has too many rules");
                const std::uint16_t number =
                    grid.table_.rule(descriptor, is_temporary<Family>(descriptor),
                                     [&] { return Family::make_rule(descriptor); });
                if (number != expected) in.fail("a rule is there twice");
            }
            const auto patterns = in.get<std::uint64_t>();
            for (std::uint64_t p = 0; p < patterns; ++p) {
                const auto tree = in.get_all<std::uint16_t>();
                if (tree.empty() || tree.size() > 64 || tree[0] == 0) in.fail("a pattern is wrong");
                for (const std::uint16_t rule : tree) {
                    if (rule >= grid.table_.rule_count()) in.fail("a pattern names no rule");
                }
                const std::size_t expected = grid.table_.size();
                if (grid.table_.pattern(tree) != expected) in.fail("a pattern is there twice");
            }
        } catch (const InvalidInput& error) {
            in.fail(error.what());
        } catch (const GridError& error) {
            in.fail(error.what());
        }
    }

    void check(const std::vector<std::uint32_t>& in_use);
    void check_record(std::uint32_t at, std::size_t pattern, int depth);

    Grid& grid_;
    const Reader& in_;
    std::size_t next_ = 0;
    std::size_t leaves_ = 0;
    std::vector<bool> used_;
};

}  // namespace nestgrid::detail

#include <nestgrid/adapters/stored_values_steps.hpp>

namespace nestgrid {

template <class Family>
void write_hierarchy(const StoredGrid<Family>& grid, const std::filesystem::path& path,
                     const std::vector<NamedField>& fields, const StoredFileOptions& options) {
    detail::check_values(fields, grid.node_count(), options.times);
    detail::FileHeader header;
    header.version = detail::version_for(fields, options);
    detail::Writer body;
    detail::GridFile<Family>::write(grid, body);
    if (header.version == 1) {
        detail::write_plain(fields, body);
    } else {
        detail::write_frames(grid, fields, options, body);
    }
    header.dimension = static_cast<std::uint32_t>(Family::dimension);
    std::strncpy(header.family.data(), Family::name, header.family.size() - 1);
    header.corners = static_cast<std::uint32_t>(Family::max_corners);
    header.options = detail::options(grid.family());
    detail::write_file(path, header, body.bytes);
}

inline HierarchyHeader read_hierarchy_header(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const detail::FileHeader header = detail::read_file_header(file, path);
    return {detail::text(header.family), static_cast<int>(header.dimension),
            static_cast<int>(header.corners)};
}

template <class Family>
StoredHierarchy<Family> read_hierarchy(const std::filesystem::path& path, Encoded encoded) {
    std::ifstream file(path, std::ios::binary);
    const detail::FileHeader header = detail::read_file_header(file, path);
    if (detail::text(header.family) != Family::name ||
        header.dimension != static_cast<std::uint32_t>(Family::dimension) ||
        header.corners != static_cast<std::uint32_t>(Family::max_corners)) {
        throw IoError(detail::quoted(path) + " holds a " + detail::text(header.family) +
                      " hierarchy of dimension " + std::to_string(header.dimension) +
                      " with at most " + std::to_string(header.corners) + " corners");
    }
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (failed || size < sizeof(header) || size - sizeof(header) != header.body) {
        throw IoError(detail::quoted(path) + " is damaged: it should be " +
                      std::to_string(header.body + sizeof(header)) + " bytes long and is " +
                      std::to_string(size));
    }
    std::vector<char> bytes(static_cast<std::size_t>(header.body));
    if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
        throw IoError(detail::quoted(path) + " cannot be read");
    }
    boost::crc_32_type crc;
    crc.process_bytes(bytes.data(), bytes.size());
    if (crc.checksum() != header.body_checksum) {
        throw IoError(detail::quoted(path) + " is damaged: its checksum is wrong");
    }
    detail::Reader body(std::move(bytes), detail::quoted(path));
    StoredHierarchy<Family> stored{
        detail::GridFile<Family>::read(body, detail::from_options<Family>(header.options)), {}};
    if (header.version == 1) {
        detail::read_plain(body, stored);
    } else {
        detail::read_frames(body, encoded, stored);
    }
    if (!body.at_end()) body.fail("there is something after its end");
    return stored;
}

}  // namespace nestgrid

#include <nestgrid/adapters/stored_file_checks.hpp>
