// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture/sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkTextActor.h>
#include <vtkTextRenderer.h>
#include <vtkUnsignedCharArray.h>

namespace {

constexpr int dots_per_inch = 72;  // one pixel a point
constexpr double least_font = 9;

/// A font with the letters of all languages that Debian's package fonts-dejavu-core has; VTK's own
/// where it is missing.
void set_font(vtkTextProperty* look) {
    const char* const path = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    if (!std::filesystem::exists(path)) return look->SetFontFamilyToArial();
    look->SetFontFamily(VTK_FONT_FILE);
    look->SetFontFile(path);
}

vtkSmartPointer<vtkTextProperty> make_look(const TextPlace& place, double factor) {
    auto look = vtkSmartPointer<vtkTextProperty>::New();
    set_font(look);
    look->SetFontSize(std::max(1, static_cast<int>(std::lround(place.size * factor))));
    return look;
}

/// Width and height of a text that runs to the right, and what lies below its base line.
struct Extent {
    double width = 0;
    double height = 0;
};

Extent extent_of(const std::string& text, const TextPlace& place) {
    constexpr int fine = 4;
    std::array<int, 4> bounds{};
    vtkTextRenderer::GetInstance()->GetBoundingBox(make_look(place, fine), text, bounds.data(),
                                                   dots_per_inch);
    return {(bounds[1] - bounds[0] + 1.) / fine, (bounds[3] - bounds[2] + 1.) / fine};
}

double shift(Side side) { return side == Side::low ? 0 : side == Side::middle ? 0.5 : 1; }

/// A text without its last letter, as UTF-8 has it.
void shorten(std::string& text) {
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0U) == 0x80U) {
        text.pop_back();
    }
    if (!text.empty()) text.pop_back();
}

/// Makes a text and its font fit into the length of its place.
void fit(std::string& text, TextPlace& place) {
    const double width = extent_of(text, place).width;
    if (width <= place.longest) return;
    place.size = std::max(least_font, std::floor(place.size * place.longest / width));
    std::string kept = text;
    while (!kept.empty() && extent_of(text, place).width > place.longest) {
        shorten(kept);
        text = kept + "...";
    }
}

}  // namespace

Box Sheet::measure(const std::string& text, const TextPlace& place) {
    std::string fitted = text;
    TextPlace p = place;
    fit(fitted, p);
    Extent e = extent_of(fitted, p);
    if (p.upwards) std::swap(e.width, e.height);
    return {p.at[0] - shift(p.horizontal) * e.width, p.at[1] - shift(p.vertical) * e.height,
            e.width, e.height};
}

Box Sheet::write(const std::string& text, const TextPlace& place) {
    Text added{text, place};
    fit(added.text, added.place);
    texts_.push_back(added);
    boxes_.push_back(measure(added.text, added.place));
    return boxes_.back();
}

bool Sheet::write_if_free(const std::string& text, const TextPlace& place, const Box& within) {
    const Box box = measure(text, place);
    if (!within.holds(box)) return false;
    const double gap = place.size / 3;
    const Box around{box.x - gap, box.y - gap / 2, box.width + 2 * gap, box.height + gap};
    for (const Box& other : boxes_) {
        if (around.meets(other)) return false;
    }
    write(text, place);
    return true;
}

void Sheet::line(const Pixel& from, const Pixel& to, double width) { line(from, to, width, ink_); }

void Sheet::line(const Pixel& from, const Pixel& to, double width, const Colour& colour) {
    // As an area, which is as wide as it should be wherever lines are not.
    const Pixel along{to[0] - from[0], to[1] - from[1]};
    const double length = std::hypot(along[0], along[1]);
    if (length == 0) return;
    const double s = width / 2 / length;
    const Pixel side{-s * along[1], s * along[0]};
    area({{from[0] + side[0], from[1] + side[1]},
          {from[0] - side[0], from[1] - side[1]},
          {to[0] - side[0], to[1] - side[1]},
          {to[0] + side[0], to[1] + side[1]}},
         colour);
}

void Sheet::area(const std::vector<Pixel>& corners, const Colour& colour) {
    areas_.push_back({corners, colour});
}

void Sheet::show(vtkRenderer* renderer, int factor) const {
    const vtkNew<vtkPoints> points;
    const vtkNew<vtkCellArray> cells;
    const vtkNew<vtkUnsignedCharArray> colours;
    colours->SetNumberOfComponents(3);
    for (const Area& area : areas_) {
        cells->InsertNextCell(static_cast<int>(area.corners.size()));
        for (const Pixel& p : area.corners) {
            cells->InsertCellPoint(points->InsertNextPoint(p[0] * factor, p[1] * factor, 0));
        }
        const auto& [r, g, b] = area.colour;
        colours->InsertNextTuple3(255 * r, 255 * g, 255 * b);
    }
    const vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(cells);
    data->GetCellData()->SetScalars(colours);
    const vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(data);
    const vtkNew<vtkActor2D> areas;
    areas->SetMapper(mapper);
    renderer->AddActor2D(areas);
    for (std::size_t i = 0; i < texts_.size(); ++i) {
        const TextPlace& place = texts_[i].place;
        const auto look = make_look(place, factor);
        Colour colour = ink_;
        look->SetColor(colour.data());
        if (place.upwards) look->SetOrientation(90);
        const vtkNew<vtkTextActor> actor;
        actor->SetTextScaleModeToNone();
        actor->SetTextProperty(look);
        actor->SetInput(texts_[i].text.c_str());
        // Where the lower left corner of the letters comes to stand.
        std::array<int, 4> bounds{};
        vtkTextRenderer::GetInstance()->GetBoundingBox(look, texts_[i].text, bounds.data(),
                                                       dots_per_inch);
        actor->SetPosition(std::round(boxes_[i].x * factor - bounds[0]),
                           std::round(boxes_[i].y * factor - bounds[2]));
        renderer->AddActor2D(actor);
    }
}
