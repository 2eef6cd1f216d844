// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstring>
#include <fstream>

#include <boost/crc.hpp>

#include <nestgrid/adapters/stored_file.hpp>

namespace nestgrid {

namespace detail {

static_assert(std::endian::native == std::endian::little, "the file format is little-endian");

/// The first bytes of a file; what follows them is `body` bytes long.
struct FileHeader {
    std::array<char, 8> magic{'n', 'e', 's', 't', 'g', 'r', 'i', 'd'};
    std::uint32_t version = 1;
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
    if (header.version != FileHeader{}.version) {
        throw IoError(quoted(path) + " has version " + std::to_string(header.version) +
                      " of the format; this program reads version 1");
    }
    if (header.header_checksum != header.own_checksum()) {
        throw IoError(quoted(path) + " is damaged: the checksum of its header is wrong");
    }
    return header;
}

inline std::string text(const std::array<char, 16>& name) {
    return {name.data(), strnlen(name.data(), name.size())};
}

/// Reading and writing what a StoredGrid keeps private.
template <class Family>
class GridFile {
public:
    using Grid = StoredGrid<Family>;

    static void write(const Grid& grid, const std::vector<NamedField>& fields, Writer& out) {
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
        out.put(static_cast<std::uint64_t>(fields.size()));
        for (const NamedField& f : fields) {
            out.put_all(std::vector<char>(f.name.begin(), f.name.end()));
            out.put_all(f.values);
        }
    }

    static StoredHierarchy<Family> read(Reader& in, const Family& family) {
        Grid grid;
        grid.family_ = family;
        read_coarse(grid, in);
        read_table(grid, in);
        grid.node_count_ = static_cast<std::size_t>(in.get<std::uint64_t>());
        grid.leaf_count_ = static_cast<std::size_t>(in.get<std::uint64_t>());
        grid.root_ = in.get_all<std::uint32_t>();
        grid.words_ = in.get_all<std::uint32_t>();
        grid.hanging_ = in.get_all<std::uint32_t>();
        GridFile(grid, in).check();
        std::vector<NamedField> fields;
        const auto count = in.get<std::uint64_t>();
        for (std::uint64_t i = 0; i < count; ++i) {
            const auto name = in.get_all<char>();
            fields.push_back({std::string(name.begin(), name.end()), in.get_all<double>()});
            if (fields.back().values.size() != grid.node_count_) {
                in.fail("field '" + fields.back().name + "' has another number of values");
            }
        }
        if (!in.at_end()) in.fail("there is something after its end");
        return {std::move(grid), std::move(fields)};
    }

private:
    GridFile(Grid& grid, const Reader& in) : grid_{grid}, in_{in} {}

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
                    grid.table_.rule(descriptor, Family::is_temporary(descriptor),
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

    void check() {
        if (grid_.root_.size() != grid_.coarse_count()) in_.fail("it has another number of roots");
        if (grid_.node_count_ < grid_.coarse_.nodes.size() || grid_.node_count_ > 0x7FFFFFFFU ||
            grid_.node_count_ > grid_.coarse_.nodes.size() + grid_.words_.size()) {
            in_.fail("its number of nodes is wrong");
        }
        if (!grid_.hanging_.empty() &&
            (Family::conforming || grid_.hanging_.size() != (grid_.node_count_ + 31) / 32)) {
            in_.fail("its mask of hanging nodes is wrong");
        }
        used_.assign(grid_.node_count_, false);
        std::fill_n(used_.begin(), grid_.coarse_.nodes.size(), true);
        for (std::size_t i = 0; i < grid_.coarse_count(); ++i) {
            if (grid_.root_[i] == Grid::none_) {
                ++leaves_;
            } else {
                check_record(grid_.root_[i], static_cast<std::size_t>(grid_.coarse_.shapes[i]), 0);
            }
        }
        if (next_ != grid_.words_.size()) in_.fail("it has records left over");
        if (leaves_ != grid_.leaf_count_) in_.fail("its number of leaves is wrong");
        grid_.used_node_count_ =
            static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true));
        try {
            if (!grid_.family_.is_prepared(grid_.coarse_) || !Adapter<Family>(grid_).is_sound()) {
                in_.fail("its elements do not fit together");
            }
        } catch (const InvalidInput& error) {
            in_.fail(error.what());
        } catch (const GridError& error) {
            in_.fail(error.what());
        }
    }

    /// Records follow each other as they are written, so none is met twice.
    void check_record(std::uint32_t at, std::size_t pattern, int depth) {
        const Pattern& p = grid_.table_[pattern];
        const std::size_t fixed = p.code_words() + p.mask_words();
        if (at != next_ || grid_.words_.size() - next_ < fixed || depth > 254) {
            in_.fail("a record is out of place");
        }
        std::array<std::uint32_t, max_entities / 32> mask{};
        std::size_t links = 0;
        bool refined = false;
        for (unsigned j = 0; j < 2 * p.code_words(); ++j) {
            const unsigned raw = grid_.raw_code(at, j);
            const unsigned code = raw & ~Grid::has_record_;
            if (raw == 0) continue;
            if (j >= p.exits.size() || code < static_cast<unsigned>(shape_count) ||
                code >= grid_.table_.size() || p.exits[j].entity.empty() ||
                grid_.table_[code].shape != p.exits[j].shape) {
                in_.fail("a record names a wrong pattern");
            }
            refined = true;
            if ((raw & Grid::has_record_) != 0) ++links;
            for (const std::uint8_t entity : grid_.table_[code].node_entity) {
                const unsigned bit = p.exits[j].entity[entity];
                mask[bit / 32] |= 1U << bit % 32;
            }
        }
        std::size_t references = 0;
        for (std::size_t i = 0; i < p.mask_words(); ++i) {
            if (grid_.words_[at + p.code_words() + i] != mask[i]) {
                in_.fail("the nodes of a record do not belong to its patterns");
            }
            references += static_cast<std::size_t>(std::popcount(mask[i]));
        }
        if (!refined || grid_.words_.size() - at - fixed < links + references) {
            in_.fail("a record is incomplete");
        }
        const std::size_t first_link = at + fixed;
        for (std::size_t i = 0; i < references; ++i) {
            const std::uint32_t node = grid_.words_[first_link + links + i];
            if (node >= grid_.node_count_ || node < grid_.coarse_.nodes.size()) {
                in_.fail("a record refers to a node that is not there");
            }
            used_[node] = true;
        }
        next_ = first_link + links + references;
        std::size_t link = first_link;
        for (unsigned j = 0; j < p.exits.size(); ++j) {
            const unsigned raw = grid_.raw_code(at, j);
            const unsigned code = raw & ~Grid::has_record_;
            if ((raw & Grid::has_record_) != 0) {
                check_record(grid_.words_[link++], code, depth + 1);
            } else {
                leaves_ += code == 0 ? 1 : grid_.table_[code].exits.size();
            }
        }
    }

    Grid& grid_;
    const Reader& in_;
    std::size_t next_ = 0;
    std::size_t leaves_ = 0;
    std::vector<bool> used_;
};

}  // namespace detail

template <class Family>
void write_hierarchy(const StoredGrid<Family>& grid, const std::filesystem::path& path,
                     const std::vector<NamedField>& fields) {
    for (const NamedField& f : fields) {
        if (f.values.size() != grid.node_count()) {
            throw InvalidInput("field '" + f.name + "' has " + std::to_string(f.values.size()) +
                               " values, but the grid " + std::to_string(grid.node_count()) +
                               " nodes");
        }
    }
    detail::Writer body;
    detail::GridFile<Family>::write(grid, fields, body);
    detail::FileHeader header;
    header.dimension = static_cast<std::uint32_t>(Family::dimension);
    std::strncpy(header.family.data(), Family::name, header.family.size() - 1);
    header.corners = static_cast<std::uint32_t>(Family::max_corners);
    header.options = grid.family().options();
    header.body = body.bytes.size();
    boost::crc_32_type crc;
    crc.process_bytes(body.bytes.data(), body.bytes.size());
    header.body_checksum = crc.checksum();
    header.header_checksum = header.own_checksum();

    std::filesystem::path part = path;
    part += ".part";
    {
        std::ofstream file(part, std::ios::binary);
        file.write(reinterpret_cast<const char*>(&header), sizeof(header));
        file.write(body.bytes.data(), static_cast<std::streamsize>(body.bytes.size()));
        file.close();
        if (!file) {
            std::error_code ignored;
            std::filesystem::remove(part, ignored);
            throw IoError(detail::quoted(path) + " cannot be written");
        }
    }
    std::error_code failed;
    std::filesystem::rename(part, path, failed);
    if (failed) {
        std::filesystem::remove(part, failed);
        throw IoError(detail::quoted(path) + " cannot be written");
    }
}

inline HierarchyHeader read_hierarchy_header(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const detail::FileHeader header = detail::read_file_header(file, path);
    return {detail::text(header.family), static_cast<int>(header.dimension),
            static_cast<int>(header.corners)};
}

template <class Family>
StoredHierarchy<Family> read_hierarchy(const std::filesystem::path& path) {
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
    return detail::GridFile<Family>::read(body, Family::from_options(header.options));
}

}  // namespace nestgrid
