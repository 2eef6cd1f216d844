// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture/picture.hpp"

#include <cstdint>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkWindowToImageFilter.h>

#include "output/surface_file.hpp"
#include "picture/canvas.hpp"
#include "picture/layout.hpp"
#include "picture/scene.hpp"
#include "picture/virtual_display.hpp"

namespace {

namespace fs = std::filesystem;

/// The pixels of a renderer: red, green and blue, multiplied by the opacity, and the opacity.
/// Each renderer has a window of its own: ambient occlusion fails in a part of a window.
vtkSmartPointer<vtkImageData> render(vtkRenderer* renderer, double width, double height, int factor,
                                     bool peeled) {
    const vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(peeled ? 0 : 4);  // depth is peeled without them
    window->SetAlphaBitPlanes(1);
    window->SetSize(factor * static_cast<int>(width), factor * static_cast<int>(height));
    window->AddRenderer(renderer);
    window->Render();
    const vtkNew<vtkWindowToImageFilter> image;
    image->SetInput(window);
    image->ReadFrontBufferOff();
    image->SetInputBufferTypeToRGBA();
    image->Update();
    vtkSmartPointer<vtkImageData> pixels = image->GetOutput();
    return pixels;
}

/// Draws a picture into a file. Needs a display.
void draw(const std::vector<Panel>& panels, const PictureStyle& style, const Layout& layout,
          const fs::path& path) {
    constexpr std::int64_t most_pixels = 16 << 20;
    // Edges are smooth because each pixel is the mean of several; a huge picture has none to spare.
    const int factor = std::int64_t{layout.width} * layout.height > most_pixels ? 1 : 2;
    Canvas canvas(layout.width, layout.height, style.background);
    const auto lay = [&](const Panel& panel, const Projector& view, bool detail) {
        const auto scene = make_scene(panel, style, layout.range, view, factor, detail);
        const Box& cell = view.cell;
        const auto pixels =
            render(scene, cell.width, cell.height, factor, is_translucent(panel, style));
        canvas.lay(pixels, factor, static_cast<int>(cell.x), static_cast<int>(cell.y));
    };
    for (std::size_t i = 0; i < panels.size(); ++i) {
        lay(panels[i], layout.panels[i], false);
        if (!layout.details.empty()) lay(panels[i], layout.details[i], true);
    }
    const vtkNew<vtkRenderer> notes;
    layout.sheet.show(notes, factor);
    notes->SetBackgroundAlpha(0);
    canvas.lay(render(notes, layout.width, layout.height, factor, false), factor, 0, 0);
    canvas.write(path);
}

}  // namespace

void write_picture(const std::vector<Panel>& panels, const PictureStyle& style,
                   const fs::path& path) {
    // Refuses what does not fit, here and not in the other process.
    const Layout layout = make_layout(panels, style);
    write_by_rename(path, [&](const fs::path& temporary) -> std::string {
        run_with_display([&] {
            draw(panels, style, layout, temporary);
            return fs::exists(temporary) && fs::file_size(temporary) > 0;
        });
        return "";
    });
}

std::string short_name(const std::string& name) {
    constexpr std::size_t most = 30;
    return name.size() <= most ? name : name.substr(0, most - 3) + "...";
}
