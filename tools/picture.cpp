// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/error.hpp>

#include "surface_file.hpp"

namespace {

namespace fs = std::filesystem;
using nestgrid::IoError;
using nestgrid::operator+;
using nestgrid::operator*;

constexpr int panel_width = 640;
constexpr int whole_height = 600;
constexpr int detail_height = 420;
constexpr int caption_height = 72;
constexpr int bar_height = 84;
constexpr double magnification = 10;

/// The range with ends that have short names: no wider by more than a ten-thousandth.
std::pair<double, double> rounded(const ColourBy& colour) {
    const double range = colour.greatest - colour.least;
    if (!(range > 0)) return {colour.least, colour.least + 1};
    const double unit = std::pow(10, std::floor(std::log10(range)) - 4);
    return {unit * std::floor(colour.least / unit + 1e-6),
            unit * std::ceil(colour.greatest / unit - 1e-6)};
}

/// Black to violet, green and yellow, of even steps in lightness (Smith and van der Walt's viridis,
/// through nine of its colours).
vtkSmartPointer<vtkColorTransferFunction> make_colours(const ColourBy& colour) {
    constexpr std::array<std::array<double, 3>, 9> viridis{{{0.267, 0.005, 0.329},
                                                            {0.283, 0.141, 0.458},
                                                            {0.229, 0.322, 0.546},
                                                            {0.173, 0.449, 0.558},
                                                            {0.128, 0.567, 0.551},
                                                            {0.158, 0.684, 0.502},
                                                            {0.369, 0.789, 0.383},
                                                            {0.678, 0.864, 0.190},
                                                            {0.993, 0.906, 0.144}}};
    auto colours = vtkSmartPointer<vtkColorTransferFunction>::New();
    colours->SetColorSpaceToLab();
    const auto [least, greatest] = rounded(colour);
    for (std::size_t i = 0; i < viridis.size(); ++i) {
        const double at = double(i) / double(viridis.size() - 1);
        const auto& [r, g, b] = viridis[i];
        colours->AddRGBPoint(least + at * (greatest - least), r, g, b);
    }
    return colours;
}

vtkSmartPointer<vtkPolyDataMapper> make_mapper(vtkPolyData* data) {
    auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
    mapper->SetInputData(data);
    mapper->ScalarVisibilityOff();
    return mapper;
}

vtkSmartPointer<vtkActor> make_surface(const Panel& panel, vtkPolyData* surface, bool whole) {
    const auto mapper = make_mapper(surface);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    vtkProperty* look = actor->GetProperty();
    look->SetColor(0.86, 0.80, 0.70);
    look->SetAmbient(0.28);
    look->SetDiffuse(0.75);
    look->SetSpecular(0.1);
    if (!panel.colour.array.empty()) {
        mapper->ScalarVisibilityOn();
        mapper->SetScalarModeToUsePointFieldData();
        mapper->SelectColorArray(panel.colour.array.c_str());
        mapper->SetLookupTable(make_colours(panel.colour));
        mapper->InterpolateScalarsBeforeMappingOn();  // colours are a function of the value
        if (!panel.lit) look->LightingOff();
    }
    if (!whole) {
        look->SetInterpolationToFlat();
        look->EdgeVisibilityOn();
        look->SetEdgeColor(0.25, 0.30, 0.40);
        look->SetLineWidth(1);
    }
    return actor;
}

vtkSmartPointer<vtkActor> make_lines(const Panel& panel) {
    const auto mapper = make_mapper(panel.lines);
    mapper->SetResolveCoincidentTopologyToPolygonOffset();
    mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0, -8);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(0.08, 0.08, 0.10);
    actor->GetProperty()->SetLineWidth(panel.line_width);
    actor->GetProperty()->LightingOff();
    return actor;
}

/// The extent of the points of both surfaces along a direction.
std::pair<double, double> extent(const Panel& panel, const nestgrid::Point& direction) {
    std::pair<double, double> range{INFINITY, -INFINITY};
    for (const auto& data : {panel.surface, panel.veil}) {
        for (vtkIdType i = 0; data != nullptr && i < data->GetNumberOfPoints(); ++i) {
            nestgrid::Point x;
            data->GetPoint(i, x.data());
            const double at = nestgrid::dot(direction, x);
            range = {std::min(range.first, at), std::max(range.second, at)};
        }
    }
    return range;
}

/// Looks at the whole surface from outside, so that it leaves the places of the caption and the
/// scalar bar free.
void set_camera(const Panel& panel, vtkRenderer* view) {
    const nestgrid::Point& from = panel.from;
    nestgrid::Point up{0, 0, 1};
    if (std::abs(from[2]) > 0.9 * nestgrid::norm(from)) up = {0, 1, 0};
    vtkCamera* camera = view->GetActiveCamera();
    camera->SetPosition(from.data());
    camera->SetFocalPoint(0, 0, 0);
    camera->SetViewUp(up.data());
    camera->OrthogonalizeViewUp();
    camera->ParallelProjectionOn();
    view->ResetCamera();
    nestgrid::Point vertical;
    nestgrid::Point towards;
    nestgrid::Point centre;
    nestgrid::Point position;
    camera->GetViewUp(vertical.data());
    camera->GetDirectionOfProjection(towards.data());
    camera->GetFocalPoint(centre.data());
    camera->GetPosition(position.data());
    const nestgrid::Point sideways = nestgrid::cross(towards, vertical);
    const auto [low, high] = extent(panel, vertical);
    const auto [left, right] = extent(panel, sideways);
    const double free_height = 1 - double(caption_height + bar_height) / whole_height;
    const double aspect = double(panel_width) / whole_height;
    const double scale = 0.5 * std::max((high - low) / free_height, (right - left) / aspect) / 0.96;
    camera->SetParallelScale(scale);
    const double lift = scale * double(bar_height - caption_height) / whole_height;
    const nestgrid::Point shift =
        ((low + high) / 2 - nestgrid::dot(centre, vertical) - lift) * vertical +
        ((left + right) / 2 - nestgrid::dot(centre, sideways)) * sideways;
    camera->SetFocalPoint((centre + shift).data());
    camera->SetPosition((position + shift).data());
    view->ResetCameraClippingRange();
}

void add_caption(const Panel& panel, vtkRenderer* view) {
    const vtkNew<vtkTextActor> text;
    text->SetInput(panel.caption.c_str());
    text->GetTextProperty()->SetColor(0.1, 0.1, 0.1);
    text->GetTextProperty()->SetFontSize(22);
    text->GetTextProperty()->SetJustificationToCentered();
    text->SetPosition(panel_width / 2.0, double(whole_height - caption_height + 8));
    view->AddActor2D(text);
}

void add_scalar_bar(const Panel& panel, vtkRenderer* view) {
    const vtkNew<vtkScalarBarActor> bar;
    bar->SetLookupTable(make_colours(panel.colour));
    bar->SetTitle(short_name(panel.colour.array).c_str());
    bar->SetNumberOfLabels(5);
    bar->SetLabelFormat("%.4g");
    bar->SetOrientationToHorizontal();
    bar->UnconstrainedFontSizeOn();
    for (vtkTextProperty* text : {bar->GetLabelTextProperty(), bar->GetTitleTextProperty()}) {
        text->SetColor(0.1, 0.1, 0.1);
        text->SetFontSize(18);
        text->ItalicOff();
        text->BoldOff();
        text->ShadowOff();
    }
    bar->SetPosition(0.1, 0.01);
    bar->SetWidth(0.8);
    bar->SetHeight(double(bar_height - 10) / whole_height);
    view->AddActor2D(bar);
}

vtkSmartPointer<vtkRenderer> make_view(const Panel& panel, bool whole) {
    auto view = vtkSmartPointer<vtkRenderer>::New();
    view->AddActor(make_surface(panel, panel.surface, whole));
    if (panel.veil != nullptr) {
        const auto veil = make_surface(panel, panel.veil, whole);
        veil->GetProperty()->SetOpacity(0.55);
        veil->ForceTranslucentOn();
        view->AddActor(veil);
        view->SetUseDepthPeeling(1);
        view->SetUseFXAA(true);
    }
    if (panel.lines != nullptr) view->AddActor(make_lines(panel));
    view->SetBackground(1, 1, 1);
    const bool coloured = !panel.colour.array.empty();
    set_camera(panel, view);
    if (!whole) view->GetActiveCamera()->Zoom(magnification);
    if (whole) add_caption(panel, view);
    if (whole && coloured) add_scalar_bar(panel, view);
    return view;
}

void draw(const std::vector<Panel>& panels, const fs::path& path) {
    const auto count = static_cast<double>(panels.size());
    const bool detailed = panels.front().detail;
    const int height = whole_height + (detailed ? detail_height : 0);
    const double split = detailed ? double(detail_height) / height : 0;
    const vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    const bool veiled =
        std::ranges::any_of(panels, [](const Panel& p) { return p.veil != nullptr; });
    window->SetMultiSamples(veiled ? 0 : 4);  // depth is peeled without them
    window->SetAlphaBitPlanes(veiled ? 1 : 0);
    window->SetSize(panel_width * static_cast<int>(panels.size()), height);
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const double left = double(i) / count;
        const double right = double(i + 1) / count;
        const auto whole = make_view(panels[i], true);
        whole->SetViewport(left, split, right, 1);
        window->AddRenderer(whole);
        if (!detailed) continue;
        const auto detail = make_view(panels[i], false);
        detail->SetViewport(left, 0, right, split);
        window->AddRenderer(detail);
    }
    window->Render();
    const vtkNew<vtkWindowToImageFilter> image;
    image->SetInput(window);
    image->ReadFrontBufferOff();
    const vtkNew<vtkPNGWriter> writer;
    writer->SetInputConnection(image->GetOutputPort());
    writer->SetFileName(path.c_str());
    writer->SetCompressionLevel(9);
    writer->Write();
}

/// Draws in a child process; whether a complete file came of it.
bool draw_apart(const std::vector<Panel>& panels, const fs::path& path) {
    const pid_t child = fork();
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        draw(panels, path);
        _exit(0);
    }
    int status = 1;
    if (child > 0) waitpid(child, &status, 0);
    std::error_code error;
    return status == 0 && fs::exists(path, error) && fs::file_size(path, error) > 0;
}

/// An X server without a screen, for as long as the object lives.
class VirtualDisplay {
public:
    VirtualDisplay() {
        std::array<int, 2> channel{};
        if (pipe(channel.data()) != 0) return;
        server_ = fork();
        if (server_ == 0) {
            close(channel[0]);
            const int nowhere = open("/dev/null", O_WRONLY);
            dup2(nowhere, STDOUT_FILENO);
            dup2(nowhere, STDERR_FILENO);
            const std::string fd = std::to_string(channel[1]);
            execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "1280x1024x24",
                   "-nolisten", "tcp", nullptr);
            _exit(127);
        }
        close(channel[1]);
        std::string number;
        pollfd ready{channel[0], POLLIN, 0};
        char c = 0;
        while (poll(&ready, 1, 20000) > 0 && read(channel[0], &c, 1) == 1 && c != '\n') {
            number += c;
        }
        close(channel[0]);
        if (!number.empty()) name_ = ":" + number;
    }
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;
    ~VirtualDisplay() {
        if (server_ <= 0) return;
        kill(server_, SIGTERM);
        waitpid(server_, nullptr, 0);
    }
    /// The display, or empty where no server could be started.
    const std::string& name() const { return name_; }

private:
    pid_t server_ = -1;
    std::string name_;
};

}  // namespace

std::string short_name(const std::string& name) {
    constexpr std::size_t most = 30;
    return name.size() <= most ? name : name.substr(0, most - 3) + "...";
}

void write_picture(const std::vector<Panel>& panels, const fs::path& path) {
    const fs::path temporary = temporary_beside(path);
    bool drawn = std::getenv("DISPLAY") != nullptr && draw_apart(panels, temporary);
    std::string problem =
        "the picture could not be drawn on an Xvfb display (is libgl1-mesa-dri "
        "installed?)";
    if (!drawn) {
        const VirtualDisplay display;
        if (display.name().empty()) {
            problem =
                "the picture needs an X display, and Xvfb could not be started: install the "
                "package xvfb";
        } else {
            setenv("DISPLAY", display.name().c_str(), 1);
            drawn = draw_apart(panels, temporary);
            unsetenv("DISPLAY");
        }
    }
    std::error_code error;
    if (drawn) {
        fs::rename(temporary, path, error);
        if (!error) return;
        problem = path.string() + " could not be written: " + error.message();
    }
    fs::remove(temporary, error);
    throw IoError(problem);
}
