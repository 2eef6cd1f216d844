// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "picture.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <nestgrid/error.hpp>

#include "surface_file.hpp"

namespace {

namespace fs = std::filesystem;
using nestgrid::IoError;

constexpr int panel_width = 640;
constexpr int whole_height = 600;
constexpr int detail_height = 420;
constexpr double magnification = 10;

vtkSmartPointer<vtkRenderer> make_view(const Panel& panel, bool whole) {
    const vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(panel.surface);
    mapper->ScalarVisibilityOff();
    const vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    vtkProperty* look = actor->GetProperty();
    look->SetColor(0.86, 0.80, 0.70);
    look->SetAmbient(0.28);
    look->SetDiffuse(0.75);
    look->SetSpecular(0.1);
    if (!whole) {
        look->SetInterpolationToFlat();
        look->EdgeVisibilityOn();
        look->SetEdgeColor(0.25, 0.30, 0.40);
        look->SetLineWidth(1);
    }
    auto view = vtkSmartPointer<vtkRenderer>::New();
    view->AddActor(actor);
    view->SetBackground(1, 1, 1);
    vtkCamera* camera = view->GetActiveCamera();
    camera->SetPosition(1.1, 1.5, 0.7);
    camera->SetFocalPoint(0, 0, 0);
    camera->SetViewUp(0, 0, 1);
    camera->ParallelProjectionOn();
    view->ResetCamera();
    camera->Zoom(whole ? 1.22 : magnification);
    if (whole) {
        const vtkNew<vtkTextActor> text;
        text->SetInput(panel.caption.c_str());
        text->GetTextProperty()->SetColor(0.1, 0.1, 0.1);
        text->GetTextProperty()->SetFontSize(22);
        text->GetTextProperty()->SetJustificationToCentered();
        text->SetPosition(panel_width / 2.0, whole_height - 64.0);
        view->AddActor2D(text);
    }
    return view;
}

void draw(const std::vector<Panel>& panels, const fs::path& path) {
    const auto count = static_cast<double>(panels.size());
    constexpr double split = double(detail_height) / (whole_height + detail_height);
    const vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(4);
    window->SetSize(panel_width * static_cast<int>(panels.size()), whole_height + detail_height);
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const double left = double(i) / count;
        const double right = double(i + 1) / count;
        const auto whole = make_view(panels[i], true);
        whole->SetViewport(left, split, right, 1);
        window->AddRenderer(whole);
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
