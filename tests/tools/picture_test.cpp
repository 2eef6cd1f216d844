// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws of pictures, on the pixels of the files that the program writes.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkContourFilter.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

#include <nestgrid/error.hpp>

#include "picture/layout.hpp"
#include "picture/picture.hpp"

namespace {

using nestgrid::Point;

/// A picture that has been written and read again.
class Picture {
public:
    Picture(const std::vector<Panel>& panels, const PictureStyle& style) {
        const auto path = std::filesystem::temp_directory_path() /
                          ("nestgrid_picture_" + std::to_string(getpid()) + ".png");
        write_picture(panels, style, path);
        const vtkNew<vtkPNGReader> reader;
        reader->SetFileName(path.c_str());
        reader->Update();
        image_ = reader->GetOutput();
        std::filesystem::remove(path);
    }
    int width() const { return image_->GetDimensions()[0]; }
    int height() const { return image_->GetDimensions()[1]; }
    int channels() const { return image_->GetNumberOfScalarComponents(); }
    int channel(int x, int y, int c) const {
        return static_cast<int>(image_->GetScalarComponentAsDouble(x, y, 0, c));
    }
    Colour colour(int x, int y) const {
        return {channel(x, y, 0) / 255., channel(x, y, 1) / 255., channel(x, y, 2) / 255.};
    }
    bool is_ground(int x, int y) const {
        return channel(x, y, 0) == 255 && channel(x, y, 1) == 255 && channel(x, y, 2) == 255;
    }

private:
    vtkSmartPointer<vtkImageData> image_;
};

double distance(const Colour& a, const Colour& b) {
    double most = 0;
    for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(a[c] - b[c]));
    return most;
}

/// Triangles of points.
vtkSmartPointer<vtkPolyData> make_surface(const std::vector<Point>& points,
                                          const std::vector<std::array<vtkIdType, 3>>& triangles) {
    const vtkNew<vtkPoints> places;
    const vtkNew<vtkCellArray> cells;
    places->SetDataTypeToDouble();
    for (const Point& x : points) places->InsertNextPoint(x.data());
    for (const auto& t : triangles) cells->InsertNextCell(3, t.data());
    auto surface = vtkSmartPointer<vtkPolyData>::New();
    surface->SetPoints(places);
    surface->SetPolys(cells);
    return surface;
}

/// Balls of triangles side by side.
struct Balls {
    std::vector<Point> points;
    std::vector<std::array<vtkIdType, 3>> triangles;
    std::vector<double> values;  ///< one a point

    void add(const Point& centre, double radius, double value) {
        constexpr int rings = 24;
        constexpr int sectors = 48;
        const auto first = static_cast<vtkIdType>(points.size());
        for (int i = 0; i <= rings; ++i) {
            for (int j = 0; j < sectors; ++j) {
                const double a = i * M_PI / rings;
                const double b = 2 * j * M_PI / sectors;
                points.push_back({centre[0] + radius * std::sin(a) * std::cos(b),
                                  centre[1] + radius * std::sin(a) * std::sin(b),
                                  centre[2] + radius * std::cos(a)});
                values.push_back(value);
            }
        }
        for (vtkIdType i = 0; i < rings; ++i) {
            for (vtkIdType j = 0; j < sectors; ++j) {
                const vtkIdType next = (j + 1) % sectors;
                const vtkIdType p = first + i * sectors;
                triangles.push_back({p + j, p + sectors + j, p + sectors + next});
                triangles.push_back({p + j, p + sectors + next, p + next});
            }
        }
    }
    vtkSmartPointer<vtkPolyData> surface() const {
        const auto data = make_surface(points, triangles);
        const vtkNew<vtkDoubleArray> array;
        array->SetName("f");
        for (const double value : values) array->InsertNextValue(value);
        data->GetPointData()->AddArray(array);
        return data;
    }
};

Panel ball_panel() {
    Balls balls;
    balls.add({0, 0, 0}, 1, 0);
    return {.surface = balls.surface()};
}

/// A square from -1 to 1 in x and y whose values are x.
Panel ramp_panel() {
    const auto data =
        make_surface({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
    const vtkNew<vtkDoubleArray> array;
    array->SetName("f");
    for (const double value : {-1, 1, 1, -1}) array->InsertNextValue(value);
    data->GetPointData()->AddArray(array);
    return {.surface = data, .colour = {"f", {-1, 1}}, .view = seen_from({0, 0, 1}), .lit = false};
}

class PictureTest : public testing::Test {
protected:
    void SetUp() override {
        if (std::system("command -v Xvfb >/dev/null") != 0) GTEST_SKIP() << "needs Xvfb";
    }
};

TEST_F(PictureTest, HasExactlyTheSizeThatIsAskedFor) {
    for (const auto& [width, height] : {std::pair{320, 240}, std::pair{217, 401}}) {
        const Picture picture({ball_panel()}, {.width = width, .height = height, .axes = true});
        EXPECT_EQ(picture.width(), width);
        EXPECT_EQ(picture.height(), height);
    }
}

TEST_F(PictureTest, HasTheBackgroundThatIsAskedFor) {
    PictureStyle style{.width = 200, .height = 160};
    const Picture white({ball_panel()}, style);
    EXPECT_EQ(white.channels(), 3);
    EXPECT_TRUE(white.is_ground(0, 0));
    style.background = Colour{0, 51 / 255., 1};
    const Picture blue({ball_panel()}, style);
    EXPECT_EQ(distance(blue.colour(0, 0), *style.background), 0);
    EXPECT_EQ(distance(blue.colour(199, 159), *style.background), 0);
    style.background.reset();
    const Picture transparent({ball_panel()}, style);
    ASSERT_EQ(transparent.channels(), 4);
    EXPECT_EQ(transparent.channel(0, 0, 3), 0);
    EXPECT_EQ(transparent.channel(199, 159, 3), 0);
    EXPECT_EQ(transparent.channel(100, 80, 3), 255);
    EXPECT_LT(distance(transparent.colour(100, 80), white.colour(100, 80)), 2 / 255.);
    style.opacity = 0.5;
    const Picture translucent({ball_panel()}, style);
    // Through the front and the back.
    EXPECT_NEAR(translucent.channel(100, 80, 3), 191, 3);
}

TEST_F(PictureTest, ColoursAreThoseOfTheMapInTheRange) {
    for (const char* name : {"viridis", "coolwarm_r", "grey"}) {
        for (const ColourRange range : {ColourRange{-1, 1}, ColourRange{-0.5, 2}}) {
            PictureStyle style{.width = 300, .height = 200, .colours = parse_colour_map(name)};
            style.range = range;
            const Picture picture({ramp_panel()}, style);
            const Projector view = make_layout({ramp_panel()}, style).panels.front();
            const auto colours = make_colours(style.colours, range.least, range.greatest);
            for (double x = -0.9; x < 0.95; x += 0.3) {
                const Pixel at = view.at({x, 0.1, 0});
                Colour expected{};
                colours->GetColor(x, expected.data());
                EXPECT_LT(distance(picture.colour(int(at[0]), int(at[1])), expected), 0.03)
                    << name << " at " << x;
            }
        }
    }
}

TEST_F(PictureTest, DrawsAPanelForEachSurface) {
    for (const std::size_t count : {1U, 3U}) {
        const Picture picture(std::vector<Panel>(count, ball_panel()),
                              {.width = 450, .height = 150});
        std::size_t blobs = 0;
        bool inside = false;
        for (int x = 0; x < picture.width(); ++x) {
            bool drawn = false;
            for (int y = 0; y < picture.height(); ++y) drawn |= !picture.is_ground(x, y);
            blobs += std::size_t{drawn && !inside};
            inside = drawn;
        }
        EXPECT_EQ(blobs, count);
    }
}

/// Where a marked ball at +x is drawn, beside a plain one at -x: its mean column as a part of the
/// width; -1 where it is hidden.
double place_of_marked_ball(const Viewpoint& view, bool perspective) {
    Balls balls;
    balls.add({1.5, 0, 0}, 1, 1);
    balls.add({-1.5, 0, 0}, 1, 0);
    Panel panel{.surface = balls.surface(), .colour = {"f", {0, 1}}};
    panel.lit = false;
    PictureStyle style{.width = 300, .height = 200, .perspective = perspective};
    style.view = view;
    const Picture picture({panel}, style);
    const Colour yellow = {0xfd / 255., 0xe7 / 255., 0x25 / 255.};
    double sum = 0;
    int count = 0;
    const int right = static_cast<int>(make_layout({panel}, style).panels.front().cell.width);
    for (int x = 0; x < right; ++x) {
        for (int y = 0; y < picture.height(); ++y) {
            if (distance(picture.colour(x, y), yellow) > 0.02) continue;
            sum += x;
            ++count;
        }
    }
    return count == 0 ? -1 : sum / count / right;
}

TEST_F(PictureTest, LooksFromTheDirectionThatIsAskedFor) {
    for (const bool perspective : {false, true}) {
        const auto place = [&](const char* text) {
            return place_of_marked_ball(parse_view(text), perspective);
        };
        EXPECT_NEAR(place("right"), 0.5, 0.01);
        EXPECT_EQ(place("left"), -1);
        EXPECT_GT(place("front"), 0.6);
        EXPECT_LT(place("back"), 0.4);
        EXPECT_GT(place("top"), 0.6);
        EXPECT_GT(place("bottom"), 0.6);
        EXPECT_NEAR(place("90,0"), 0.5, 0.01);
        EXPECT_GT(place("0,30"), 0.6);
        EXPECT_NEAR(place("20,0,0,0,0,0"), 0.5, 0.01);
        EXPECT_LT(place("0,20,0,0,0,0,0,0,1"), 0.5);
        EXPECT_GT(place("0,20,0,0,0,0,0,0,-1"), 0.5);
    }
}

TEST_F(PictureTest, TranslucentSurfacesDoNotDependOnTheOrderOfTriangles) {
    Balls balls;
    balls.add({0, 0, 0}, 1, 0);
    balls.add({0.7, 0, 0}, 1, 1);
    balls.add({0, 0.5, 0}, 0.4, 0.5);
    const auto picture = [&] {
        Panel panel = ramp_panel();
        panel.veil = balls.surface();
        return Picture({panel}, {.width = 200, .height = 160});
    };
    const Picture sorted = picture();
    std::shuffle(balls.triangles.begin(), balls.triangles.end(), std::mt19937(7));
    const Picture shuffled = picture();
    double most = 0;
    for (int x = 0; x < 200; ++x) {
        for (int y = 0; y < 160; ++y) {
            most = std::max(most, distance(sorted.colour(x, y), shuffled.colour(x, y)));
        }
    }
    EXPECT_LT(most, 3 / 255.);
}

TEST_F(PictureTest, LinesOnASurfaceAreWholeInFrontAndHiddenBehind) {
    Panel panel = ball_panel();
    for (vtkIdType i = 0; i < panel.surface->GetNumberOfPoints(); ++i) {
        panel.surface->GetPointData()->GetArray("f")->SetTuple1(i, panel.surface->GetPoint(i)[2]);
    }
    panel.surface->GetPointData()->SetActiveScalars("f");
    const vtkNew<vtkContourFilter> lines;
    lines->SetInputData(panel.surface);
    lines->SetValue(0, 0.1);
    lines->Update();
    panel.lines = lines->GetOutput();
    panel.kind = Lines::isolines;
    PictureStyle style{.width = 300, .height = 300};
    style.view = parse_view("0,25");
    const Picture picture({panel}, style);
    const Projector view = make_layout({panel}, style).panels.front();
    for (double angle = -80; angle <= 80; ++angle) {
        const double a = angle * M_PI / 180;
        const double r = std::sqrt(1 - 0.1 * 0.1);
        const auto darkest = [&](double towards) {
            const Pixel p = view.at({r * std::sin(a), -towards * r * std::cos(a), 0.1});
            double least = 1;
            for (int dx = -1; dx <= 1; ++dx) {
                for (int dy = -1; dy <= 1; ++dy) {
                    least = std::min(least, picture.colour(int(p[0]) + dx, int(p[1]) + dy)[0]);
                }
            }
            return least;
        };
        EXPECT_LT(darkest(1), 0.35) << "in front at " << angle;
        if (std::abs(angle) > 60) continue;
        EXPECT_GT(darkest(-1), 0.4) << "behind at " << angle;
    }
}

TEST_F(PictureTest, ScaleBarIsAsLongAsItSays) {
    Panel panel = ball_panel();
    const PictureStyle style{.width = 400, .height = 300, .unit = "mm"};
    const Picture picture({panel}, style);
    const Layout layout = make_layout({panel}, style);
    int longest = 0;
    for (int y = 0; y < 40; ++y) {
        int run = 0;
        for (int x = 0; x < 200; ++x) {
            run = picture.colour(x, y)[0] < 0.2 ? run + 1 : 0;
            longest = std::max(longest, run);
        }
    }
    // The ball has radius 1: the longest round length that fits into a third of the width is 0.5.
    const double length = longest / layout.panels.front().pixels_per_unit;
    EXPECT_TRUE(std::abs(length - 1) < 0.03 || std::abs(length - 0.5) < 0.03) << length;
}

TEST_F(PictureTest, LinesThatAreCloseTogetherLeaveColoursVisible) {
    constexpr int n = 150;
    Panel panel = ramp_panel();
    const vtkNew<vtkPoints> points;
    const vtkNew<vtkCellArray> cells;
    const vtkNew<vtkDoubleArray> values;
    values->SetName("f");
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j < n; ++j) {
            const double x = 2. * i / n - 1;
            cells->InsertNextCell(2);
            for (const int end : {j, j + 1}) {
                cells->InsertCellPoint(points->InsertNextPoint(x, 2. * end / n - 1, 0));
                values->InsertNextValue(x);
            }
        }
    }
    panel.lines = vtkSmartPointer<vtkPolyData>::New();
    panel.lines->SetPoints(points);
    panel.lines->SetLines(cells);
    panel.lines->GetPointData()->AddArray(values);
    const PictureStyle style{.width = 300, .height = 250};
    const Picture picture({panel}, style);
    const Projector view = make_layout({panel}, style).panels.front();
    const auto colours = make_colours(style.colours, -1, 1);
    for (const double x : {-0.5, 0., 0.5}) {
        const Pixel at = view.at({x, 0.1, 0});
        Colour expected{};
        colours->GetColor(x, expected.data());
        EXPECT_LT(distance(picture.colour(int(at[0]), int(at[1])), expected), 0.3) << x;
    }
}

/// No two texts touch, and none leaves the picture.
void expect_readable(const std::vector<Panel>& panels, const PictureStyle& style) {
    const Layout layout = make_layout(panels, style);
    const std::vector<Box>& boxes = layout.sheet.texts();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        EXPECT_GE(boxes[i].x, 0);
        EXPECT_GE(boxes[i].y, 0);
        EXPECT_LE(boxes[i].x + boxes[i].width, layout.width);
        EXPECT_LE(boxes[i].y + boxes[i].height, layout.height);
        for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(boxes[i].meets(boxes[j])) << i << ' ' << j;
    }
}

TEST(PictureLayout, TextsDoNotTouch) {
    for (const std::size_t count : {1U, 2U, 5U, 12U}) {
        Panel panel = ramp_panel();
        panel.caption = std::string(70, 'w') + " = 1.234, threshold 0.0001234\n123456789 triangles";
        panel.colour.array = std::string(200, 'm');
        for (int i = 0; i < 60; ++i) panel.colour.isovalues.push_back(-0.999 + i / 31.);
        PictureStyle style{.width = 900, .height = 700, .title = std::string(300, 'T')};
        style.axes = true;
        style.unit = "a long unit of length";
        style.orientation = true;
        for (const char* view : {"front", "top", "30,20", "144,20", "250,-40", "5,3"}) {
            style.view = parse_view(view);
            for (style.perspective = false;; style.perspective = true) {
                expect_readable(std::vector<Panel>(count, panel), style);
                if (style.perspective) break;
            }
        }
    }
}

TEST(PictureLayout, RefusesMorePanelsThanFitIntoTheSize) {
    EXPECT_THROW(make_layout(std::vector<Panel>(12, ramp_panel()), {.width = 200, .height = 200}),
                 nestgrid::InvalidInput);
}

TEST(PictureLayout, IsTheSameViewInAllPanels) {
    Balls small;
    small.add({0, 0, 0}, 0.1, 0);
    const Layout layout = make_layout({ball_panel(), {.surface = small.surface()}}, {});
    EXPECT_EQ(layout.panels[0].pixels_per_unit, layout.panels[1].pixels_per_unit);
}

TEST(PictureView, SurfacesFillThePanelAndStayWithin) {
    for (const bool perspective : {false, true}) {
        for (const char* text : {"front", "10,80", "-20,35"}) {
            PictureStyle style{.width = 500, .height = 400, .perspective = perspective};
            style.view = parse_view(text);
            Balls balls;
            balls.add({10, 0, 0}, 2, 0);
            balls.add({0, 5, 3}, 1, 0);
            const Layout layout = make_layout({{.surface = balls.surface()}}, style);
            double left = 1e9, right = -1e9, low = 1e9, high = -1e9;
            for (const Point& x : balls.points) {
                const Pixel p = layout.panels.front().at(x);
                left = std::min(left, p[0]);
                right = std::max(right, p[0]);
                low = std::min(low, p[1]);
                high = std::max(high, p[1]);
            }
            EXPECT_GE(left, 0);
            EXPECT_GE(low, 0);
            EXPECT_LE(right, 500);
            EXPECT_LE(high, 400);
            EXPECT_GT(std::max((right - left) / 500, (high - low) / 400), perspective ? 0.6 : 0.9);
        }
    }
}

TEST(PictureView, RefusesWhatIsNoView) {
    for (const char* text : {"", "side", "1", "1,2,3", "1,2,", "1,nan", "0,0,0,0,0,0",
                             "0,0,1,0,0,0,0,0,1", "1,2,3,4,5,6,7,8,9,10"}) {
        EXPECT_THROW(parse_view(text), nestgrid::InvalidInput) << text;
    }
}

}  // namespace
