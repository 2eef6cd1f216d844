// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture/colour_map.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

#include <nestgrid/error.hpp>

namespace {

/// Colours at even steps of the range, between which they are linear.
struct NamedMap {
    const char* name;
    std::array<std::uint32_t, 17> stops;
};

// The maps of matplotlib that these names stand for, through 17 of their colours, and a grey one.
constexpr std::array<NamedMap, 9> maps{
    {{"viridis",
      {0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d, 0x2c728e, 0x26828e, 0x21918c,
       0x1fa088, 0x28ae80, 0x3fbc73, 0x5ec962, 0x84d44b, 0xaddc30, 0xd8e219, 0xfde725}},
     {"plasma",
      {0x0d0887, 0x310597, 0x4c02a1, 0x6600a7, 0x7e03a8, 0x9511a1, 0xaa2395, 0xbc3587, 0xcc4778,
       0xda5a6a, 0xe66c5c, 0xf0804e, 0xf89540, 0xfdac33, 0xfdc527, 0xf8df25, 0xf0f921}},
     {"inferno",
      {0x000004, 0x0b0724, 0x210c4a, 0x3d0965, 0x57106e, 0x71196e, 0x8a226a, 0xa32c61, 0xbc3754,
       0xd24644, 0xe45a31, 0xf1731d, 0xf98e09, 0xfcac11, 0xf9cb35, 0xf2ea69, 0xfcffa4}},
     {"magma",
      {0x000004, 0x0a0822, 0x1d1147, 0x36106b, 0x51127c, 0x6a1c81, 0x832681, 0x9c2e7f, 0xb73779,
       0xd0416f, 0xe75263, 0xf56b5c, 0xfc8961, 0xfea772, 0xfec488, 0xfde2a3, 0xfcfdbf}},
     {"cividis",
      {0x00224e, 0x002e6a, 0x1a386f, 0x32436d, 0x434e6c, 0x535a6d, 0x61656f, 0x6f7073, 0x7d7c78,
       0x8c8878, 0x9b9476, 0xaba072, 0xbcae6c, 0xcdbb63, 0xdec958, 0xf0d846, 0xfee838}},
     {"turbo",
      {0x30123b, 0x4040a2, 0x466be3, 0x4294ff, 0x28bceb, 0x18ddc2, 0x32f298, 0x6dfe62, 0xa4fc3c,
       0xcdec34, 0xeecf3a, 0xfdac34, 0xfb7e21, 0xeb500e, 0xd02f05, 0xa91601, 0x7a0403}},
     {"coolwarm",
      {0x3b4cc0, 0x4e68d8, 0x6282ea, 0x779af7, 0x8db0fe, 0xa3c2fe, 0xb9d0f9, 0xccd9ed, 0xdddcdc,
       0xecd3c5, 0xf5c4ac, 0xf7b093, 0xf4987a, 0xeb7d62, 0xdd5f4b, 0xca3b37, 0xb40426}},
     {"rdbu",
      {0x67001f, 0x930e26, 0xba2832, 0xd05548, 0xe48066, 0xf5aa89, 0xfbccb4, 0xfbe5d8, 0xf7f6f6,
       0xe0ecf3, 0xc2ddec, 0x9bc9e0, 0x6bacd1, 0x3f8ec0, 0x2a71b2, 0x175290, 0x053061}},
     {"grey",
      {0x000000, 0x101010, 0x202020, 0x303030, 0x404040, 0x505050, 0x606060, 0x707070, 0x808080,
       0x8f8f8f, 0x9f9f9f, 0xafafaf, 0xbfbfbf, 0xcfcfcf, 0xdfdfdf, 0xefefef, 0xffffff}}}};

const NamedMap* find(const std::string& name) {
    const auto* const found = std::ranges::find(maps, name, &NamedMap::name);
    return found == maps.end() ? nullptr : found;
}

Colour colour_of(std::uint32_t hex) {
    return {(hex >> 16U & 255U) / 255., (hex >> 8U & 255U) / 255., (hex & 255U) / 255.};
}

}  // namespace

Colour mixed(const Colour& a, const Colour& b, double share) {
    Colour result{};
    for (std::size_t i = 0; i < 3; ++i) result[i] = a[i] + share * (b[i] - a[i]);
    return result;
}

std::string colour_map_names() {
    std::string names;
    for (const NamedMap& map : maps) names += (names.empty() ? "" : ", ") + std::string(map.name);
    return names;
}

ColourMap parse_colour_map(const std::string& text) {
    ColourMap map{text, text.ends_with("_r")};
    if (map.reversed) map.name.resize(map.name.size() - 2);
    if (map.name == "gray") map.name = "grey";
    if (find(map.name) != nullptr) return map;
    throw nestgrid::InvalidInput("'" + text + "' is no colour map: --colours takes " +
                                 colour_map_names() + ", and each with _r reversed");
}

vtkSmartPointer<vtkColorTransferFunction> make_colours(const ColourMap& map, double least,
                                                       double greatest) {
    const auto& stops = find(map.name)->stops;
    auto colours = vtkSmartPointer<vtkColorTransferFunction>::New();
    for (std::size_t i = 0; i < stops.size(); ++i) {
        const double at = static_cast<double>(i) / static_cast<double>(stops.size() - 1);
        const Colour c = colour_of(stops[map.reversed ? stops.size() - 1 - i : i]);
        colours->AddRGBPoint(least + at * (greatest - least), c[0], c[1], c[2]);
    }
    return colours;
}
