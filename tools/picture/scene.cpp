// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture/scene.hpp"

#include <algorithm>
#include <cmath>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

using nestgrid::Point;
using nestgrid::operator-;

namespace {

constexpr Colour plain{0.93, 0.90, 0.85};  ///< of surfaces without a field
constexpr Colour dark{0.08, 0.08, 0.10};   ///< of lines
constexpr double veil_opacity = 0.45;

void draw_as_lines(vtkProperty* look, double width) {
    look->SetColor(dark[0], dark[1], dark[2]);
    look->SetLineWidth(static_cast<float>(width));
    look->LightingOff();
}

vtkSmartPointer<vtkActor> make_surface(const Panel& panel, vtkPolyData* surface,
                                       const PictureStyle& style, const ColourRange& range,
                                       bool lit, int factor) {
    const vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(surface);
    mapper->ScalarVisibilityOff();
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    vtkProperty* look = actor->GetProperty();
    look->SetColor(plain[0], plain[1], plain[2]);
    look->SetAmbient(0.25);
    look->SetDiffuse(0.85);
    look->SetSpecular(0.08);
    look->SetSpecularPower(20);
    if (surface->GetNumberOfPolys() == 0) {  // an isoline in the plane
        draw_as_lines(look, 2 * factor);
        return actor;
    }
    if (panel.colour.array.empty()) return actor;
    mapper->ScalarVisibilityOn();
    mapper->SetScalarModeToUsePointFieldData();
    mapper->SelectColorArray(panel.colour.array.c_str());
    mapper->SetLookupTable(make_colours(style.colours, range.least, range.greatest));
    mapper->InterpolateScalarsBeforeMappingOn();  // colours are a function of the value
    look->SetAmbient(0.5);
    look->SetDiffuse(0.55);
    look->SetSpecular(0.03);
    if (lit) return actor;
    look->LightingOff();
    look->SetAmbient(1);
    look->SetDiffuse(0);
    return actor;
}

/// Each segment of lines with a colour of its own, which is the paler the shorter the segment is
/// drawn: where many elements lie close together, their colours stay visible.
vtkSmartPointer<vtkPolyData> faded(const Panel& panel, const PictureStyle& style,
                                   const ColourRange& range, const Projector& view) {
    constexpr double full_length = 24;  // pixels
    constexpr double faintest = 0.25;
    constexpr double strongest = 0.8;
    const auto colours = make_colours(style.colours, range.least, range.greatest);
    vtkDataArray* values = panel.lines->GetPointData()->GetArray(panel.colour.array.c_str());
    auto result = vtkSmartPointer<vtkPolyData>::New();
    const vtkNew<vtkPoints> points;
    const vtkNew<vtkCellArray> cells;
    const vtkNew<vtkUnsignedCharArray> shades;
    points->SetDataTypeToDouble();
    shades->SetNumberOfComponents(3);
    for (vtkIdType i = 0; i < panel.lines->GetNumberOfCells(); ++i) {
        vtkIdList* ends = panel.lines->GetCell(i)->GetPointIds();
        std::array<Point, 2> x;
        for (std::size_t k = 0; k < 2; ++k) {
            panel.lines->GetPoint(ends->GetId(static_cast<vtkIdType>(k)), x[k].data());
        }
        const Pixel p = view.at(x[0]);
        const Pixel q = view.at(x[1]);
        const double length = std::hypot(p[0] - q[0], p[1] - q[1]);
        const double strength = std::clamp(strongest * length / full_length, faintest, strongest);
        cells->InsertNextCell(2);
        for (std::size_t k = 0; k < 2; ++k) {
            Colour ground = plain;
            if (values != nullptr) {
                const vtkIdType end = ends->GetId(static_cast<vtkIdType>(k));
                colours->GetColor(values->GetTuple1(end), ground.data());
            }
            const auto [r, g, b] = mixed(ground, dark, strength);
            shades->InsertNextTuple3(255 * r, 255 * g, 255 * b);
            cells->InsertCellPoint(points->InsertNextPoint(view.nearer(x[k], 3).data()));
        }
    }
    result->SetPoints(points);
    result->SetLines(cells);
    result->GetPointData()->SetScalars(shades);
    return result;
}

/// Lines before their surface, of which a steep part would hide half their width.
vtkSmartPointer<vtkPolyData> lifted(vtkPolyData* lines, const Projector& view) {
    const vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (vtkIdType i = 0; i < lines->GetNumberOfPoints(); ++i) {
        Point x;
        lines->GetPoint(i, x.data());
        points->InsertNextPoint(view.nearer(x, 5).data());
    }
    auto result = vtkSmartPointer<vtkPolyData>::New();
    result->SetPoints(points);
    result->SetLines(lines->GetLines());
    return result;
}

vtkSmartPointer<vtkActor> make_lines(const Panel& panel, const PictureStyle& style,
                                     const ColourRange& range, const Projector& view, int factor) {
    const bool fades = panel.kind == Lines::outlines;
    const vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(fades ? faded(panel, style, range, view) : lifted(panel.lines, view));
    mapper->SetScalarVisibility(fades);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    draw_as_lines(actor->GetProperty(), (fades ? 0.8 : 2) * factor);
    return actor;
}

/// Adds lights that move with the camera: from above on the left, weaker from the right, and from
/// the front.
void add_lights(vtkRenderer* renderer) {
    struct Lamp {
        double x, y, z, intensity;
    };
    renderer->AutomaticLightCreationOff();
    for (const Lamp& lamp :
         {Lamp{-0.6, 0.9, 1, 0.75}, Lamp{0.7, 0.1, 1, 0.25}, Lamp{0, 0, 1, 0.2}}) {
        const vtkNew<vtkLight> light;
        light->SetLightTypeToCameraLight();
        light->SetPosition(lamp.x, lamp.y, lamp.z);
        light->SetFocalPoint(0, 0, 0);
        light->SetIntensity(lamp.intensity);
        renderer->AddLight(light);
    }
}

/// Darkens folds, into which little light falls from around.
void add_occlusion(vtkRenderer* renderer, double size) {
    renderer->SetUseSSAO(true);
    renderer->SetSSAORadius(0.05 * size);
    renderer->SetSSAOBias(0.002 * size);
    renderer->SetSSAOKernelSize(64);
    renderer->SetSSAOBlur(true);
}

void show_triangles(vtkProperty* look, int factor) {
    look->SetInterpolationToFlat();
    look->EdgeVisibilityOn();
    look->SetEdgeColor(0.25, 0.30, 0.40);
    look->SetLineWidth(static_cast<float>(factor));
}

}  // namespace

bool is_translucent(const Panel& panel, const PictureStyle& style) {
    return panel.veil != nullptr || style.opacity.value_or(1) < 1;
}

vtkSmartPointer<vtkRenderer> make_scene(const Panel& panel, const PictureStyle& style,
                                        const ColourRange& range, const Projector& view, int factor,
                                        bool detail) {
    auto renderer = vtkSmartPointer<vtkRenderer>::New();
    add_lights(renderer);
    const auto surface = make_surface(panel, panel.surface, style, range, panel.lit, factor);
    if (detail) show_triangles(surface->GetProperty(), factor);
    renderer->AddActor(surface);
    const auto make_translucent = [&](vtkActor* actor, double opacity) {
        if (opacity >= 1) return;
        actor->GetProperty()->SetOpacity(opacity);
        actor->ForceTranslucentOn();
    };
    if (panel.veil != nullptr) {
        const auto veil = make_surface(panel, panel.veil, style, range, true, factor);
        make_translucent(veil, style.opacity.value_or(veil_opacity));
        renderer->AddActor(veil);
    } else {
        make_translucent(surface, style.opacity.value_or(1));
    }
    if (panel.lines != nullptr) {
        renderer->AddActor(make_lines(panel, style, range, view, factor));
    }
    if (is_translucent(panel, style)) {
        // All layers, sorted pixel by pixel.
        renderer->SetUseDepthPeeling(1);
        renderer->SetMaximumNumberOfPeels(100);
        renderer->SetOcclusionRatio(0);
    } else if (panel.colour.array.empty() && panel.surface->GetNumberOfPolys() > 0 && !detail) {
        add_occlusion(renderer, panel.surface->GetLength());
    }
    // Where the background is transparent, colours are multiplied by their opacity.
    const Colour ground = style.background.value_or(Colour{0, 0, 0});
    renderer->SetBackground(ground[0], ground[1], ground[2]);
    renderer->SetBackgroundAlpha(style.background ? 1 : 0);
    view.set(renderer->GetActiveCamera());
    renderer->ResetCameraClippingRange();
    return renderer;
}
