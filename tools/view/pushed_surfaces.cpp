// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pushed_surfaces.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <nestgrid/error.hpp>

#include "request_entries.hpp"
#include "surface_arrays.hpp"

namespace nestgrid::view {

namespace {

constexpr std::chrono::seconds longest_wait{10};
constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_finite(const Point& x) {
    return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
}

/// \throw InvalidInput as Page::push()
void require_shown(const Surface<3>& surface, const PushOptions& options) {
    const std::size_t vertices = surface.vertices.size();
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        if (std::ranges::max(surface.simplices[t]) >= vertices) {
            throw InvalidInput("triangle " + std::to_string(t) +
                               " names a vertex that does not exist");
        }
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        if (!is_finite(surface.vertices[v])) {
            throw InvalidInput("vertex " + std::to_string(v) + " is not finite");
        }
    }
    if (!surface.normals.empty() && surface.normals.size() != vertices) {
        throw InvalidInput("the surface has " + std::to_string(surface.normals.size()) +
                           " normals, and not one for each of " + std::to_string(vertices) +
                           " vertices");
    }
    const std::size_t values = surface.attributes.size();
    if (values == 0) return;
    if (vertices == 0 || values % vertices != 0) {
        throw InvalidInput("the surface has " + std::to_string(values) +
                           " attributes, and not as many for each of " + std::to_string(vertices) +
                           " vertices");
    }
    if (options.component >= values / vertices) {
        throw InvalidInput("component " + std::to_string(options.component) +
                           " is to colour the surface, which has " +
                           std::to_string(values / vertices));
    }
}

void extend(std::array<Point, 2>& box, const Surface<3>& surface) {
    for (const Point& x : surface.vertices) {
        for (std::size_t d = 0; d < 3; ++d) {
            box[0][d] = std::min(box[0][d], x[d]);
            box[1][d] = std::max(box[1][d], x[d]);
        }
    }
}

/// Extends the range by the finite values of a component.
void extend(std::array<double, 2>& range, const Surface<3>& surface, std::size_t component) {
    if (surface.attributes.empty()) return;
    const std::size_t components = surface.attributes.size() / surface.vertices.size();
    for (std::size_t i = component; i < surface.attributes.size(); i += components) {
        const double value = surface.attributes[i];
        if (!std::isfinite(value)) continue;
        range[0] = std::min(range[0], value);
        range[1] = std::max(range[1], value);
    }
}

/// Frees what no page shows, and what may refer to the solver's grid.
void reduce(Surface<3>& surface) {
    surface.elements = {};
    surface.reference = {};
    surface.shape_of = {};
    surface.level_of = {};
    surface.boundary = {};
}

double number_or_null(const std::optional<double>& number) {
    return number.value_or(std::numeric_limits<double>::quiet_NaN());
}

FrameSource::Bytes no_news(std::uint64_t number, bool ended) {
    FrameReply reply;
    reply.header.open('{').key("number").number(static_cast<double>(number));
    reply.header.key("ended").boolean(ended).key("parts").open('[').close(']').close('}');
    return std::make_shared<const std::vector<std::byte>>(reply.bytes());
}

struct PushedRequest {
    std::uint64_t after = 0;
    bool outlines = false;
};

PushedRequest parse_pushed_request(std::string_view text) {
    Entries entries(text);
    PushedRequest request;
    entries.take("after", [&](auto key, auto value) {
        const double number = number_of(key, value);
        if (number < 0 || number > 0x1p53 || number != std::floor(number)) {
            refuse(key, "not the number of a surface", value);
        }
        request.after = static_cast<std::uint64_t>(number);
    });
    entries.take("outlines", [&](auto key, auto value) {
        request.outlines = choice_of<bool, 2>(key, value, {{{"on", true}, {"off", false}}});
    });
    entries.require_empty("after and outlines");
    return request;
}

}  // namespace

/// A surface, and the bytes of it that readers have asked for.
class PushedSurfaces::Frame {
public:
    Frame(std::uint64_t number, Surface<3> surface, PushOptions options,
          const std::array<Point, 2>& box)
        : number_{number}, surface_{std::move(surface)}, options_{std::move(options)}, box_{box} {}

    std::uint64_t number() const { return number_; }

    /// Makes them at the first call.
    Bytes bytes(bool outlines) {
        const bool drawn = outlines && !surface_.element_of.empty();
        Encoded& encoded = encoded_[drawn ? 1 : 0];
        std::call_once(encoded.once, [&] {
            encoded.bytes = std::make_shared<const std::vector<std::byte>>(encode(drawn));
        });
        return encoded.bytes;
    }

private:
    struct Encoded {
        std::once_flag once;
        Bytes bytes;
    };

    std::vector<std::byte> encode(bool outlines) const {
        FrameReply reply;
        JsonText& text = reply.header;
        text.open('{');
        write_caption(text);
        text.key("parts").open('[').open('{').key("kind").string("surface");
        text.key("triangles").number(static_cast<double>(surface_.simplices.size()));
        write_mesh(reply, surface_);
        write_short_normals(
            reply, surface_.normals.empty() ? normals_from_triangles(surface_) : surface_.normals);
        if (!surface_.attributes.empty()) write_values(reply, surface_, options_.component);
        text.close('}');
        if (outlines) write_outlines(reply, surface_);
        text.close(']').close('}');
        return reply.bytes();
    }

    void write_caption(JsonText& text) const {
        text.key("number").number(static_cast<double>(number_)).key("ended").boolean(false);
        text.key("field").string(options_.field);
        text.key("least").number(options_.range[0]).key("greatest").number(options_.range[1]);
        text.key("isovalue").number(number_or_null(options_.isovalue));
        text.key("box").open('[').numbers(box_[0]).numbers(box_[1]).close(']');
        text.key("time").number(number_or_null(options_.time));
        text.key("step").number(number_or_null(options_.step));
        text.key("numbers").open('[');
        for (const auto& [name, value] : options_.numbers) {
            text.open('{').key("name").string(name).key("value").number(value).close('}');
        }
        text.close(']');
        text.key("triangles").number(static_cast<double>(surface_.simplices.size()));
        text.key("outlined").boolean(!surface_.element_of.empty());
    }

    const std::uint64_t number_;
    const Surface<3> surface_;
    const PushOptions options_;
    const std::array<Point, 2> box_;
    std::array<Encoded, 2> encoded_;  // without outlines, and with them
};

PushedSurfaces::PushedSurfaces(const PageOptions& options, std::size_t most_waiting)
    : title_{options.title},
      most_waiting_{most_waiting},
      box_{options.box},
      box_grows_{options.box[0] == options.box[1]},
      range_{infinity, -infinity} {
    if (box_grows_)
        box_ = {Point{infinity, infinity, infinity}, Point{-infinity, -infinity, -infinity}};
}

PushedSurfaces::~PushedSurfaces() = default;

void PushedSurfaces::push(Surface<3> surface, PushOptions options) {
    require_shown(surface, options);
    reduce(surface);
    std::shared_ptr<Frame> last;  // freed behind the lock
    {
        const std::scoped_lock lock(mutex_);
        extend(range_, surface, options.component);
        if (options.range[0] == options.range[1]) options.range = range_;
        if (box_grows_) extend(box_, surface);
        last = std::exchange(newest_, std::make_shared<Frame>(++pushed_, std::move(surface),
                                                              std::move(options), box_));
    }
    changed_.notify_all();
}

std::string PushedSurfaces::info() {
    return JsonText()
        .open('{')
        .key("pushed")
        .boolean(true)
        .key("title")
        .string(title_)
        .close('}')
        .text();
}

FrameSource::Bytes PushedSurfaces::frame(std::string_view text,
                                         const std::function<bool()>& /*is_wanted*/) {
    const PushedRequest request = parse_pushed_request(text);
    std::shared_ptr<Frame> newest;
    {
        std::unique_lock lock(mutex_);
        const auto has_news = [&] { return newest_ && newest_->number() != request.after; };
        if (waiting_ < most_waiting_) {
            ++waiting_;
            changed_.wait_for(lock, longest_wait, [&] { return ended_ || has_news(); });
            --waiting_;
        }
        if (!has_news()) return no_news(request.after, ended_);
        newest = newest_;
    }
    return newest->bytes(request.outlines);
}

void PushedSurfaces::stop() {
    {
        const std::scoped_lock lock(mutex_);
        ended_ = true;
    }
    changed_.notify_all();
}

}  // namespace nestgrid::view
