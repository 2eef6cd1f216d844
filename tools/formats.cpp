// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "formats.hpp"

#include <algorithm>

#include "text_header.hpp"

namespace {

std::vector<Format>& all_formats() {
    static std::vector<Format> all;
    return all;
}

/// Adds what one source knows of a format to what another has registered.
void add(const Format& more, Format& format) {
    for (const std::string& ending : more.endings) {
        if (std::ranges::find(format.endings, ending) == format.endings.end()) {
            format.endings.push_back(ending);
        }
    }
    if (format.holds.empty()) format.holds = more.holds;
    format.options.insert(format.options.end(), more.options.begin(), more.options.end());
    format.detached.insert(format.detached.end(), more.detached.begin(), more.detached.end());
    format.single_precision = format.single_precision || more.single_precision;
    format.keeps_elements = format.keeps_elements || more.keeps_elements;
    format.compresses = format.compresses || more.compresses;
    format.has_doubles = format.has_doubles || more.has_doubles;
    format.reads_beside = format.reads_beside || more.reads_beside;
    format.fills_complexes = format.fills_complexes || more.fills_complexes;
    format.keeps_hierarchies = format.keeps_hierarchies || more.keeps_hierarchies;
    if (more.recognises != nullptr) format.recognises = more.recognises;
    if (more.read_samples != nullptr) format.read_samples = more.read_samples;
    if (more.read_mesh != nullptr) format.read_mesh = more.read_mesh;
    if (more.read_field != nullptr) format.read_field = more.read_field;
    if (more.describe != nullptr) format.describe = more.describe;
    if (more.write_surface != nullptr) format.write_surface = more.write_surface;
}

}  // namespace

RegisteredFormat::RegisteredFormat(Format format) {
    std::vector<Format>& all = all_formats();
    const auto known = std::ranges::lower_bound(all, format.name, {}, &Format::name);
    if (known != all.end() && known->name == format.name) {
        add(format, *known);
    } else {
        all.insert(known, std::move(format));
    }
}

const std::vector<Format>& formats() { return all_formats(); }

std::vector<std::string> endings_of_fields() {
    std::vector<std::string> endings;
    for (const Format& format : formats()) {
        if (!format.has_fields()) continue;
        endings.insert(endings.end(), format.endings.begin(), format.endings.end());
    }
    return endings;
}

const Format* format_of(const std::filesystem::path& path) {
    const std::string name = lower(path.filename().string());
    const auto is_called = [&](const std::string& ending) { return name.ends_with(ending); };
    const auto found = std::ranges::find_if(formats(), [&](const Format& format) {
        return std::ranges::any_of(format.endings, is_called);
    });
    if (found != formats().end()) return &*found;
    const auto recognised = std::ranges::find_if(formats(), [&](const Format& format) {
        return format.recognises != nullptr && format.recognises(path);
    });
    return recognised == formats().end() ? nullptr : &*recognised;
}
