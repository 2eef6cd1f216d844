// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is drawn on a picture beside its surfaces: texts, lines and areas of one colour, in pixels.
// Needs no display until it is shown.
#pragma once

#include <string>
#include <vector>

#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextProperty.h>

#include "picture/camera.hpp"
#include "picture/colour_map.hpp"

enum class Side { low, middle, high };  ///< left or lower, middle, right or upper

/// Where a text stands.
struct TextPlace {
    Pixel at{};
    Side horizontal = Side::middle;  ///< the part of the text that is there
    Side vertical = Side::middle;
    double size = 12;      ///< of the font, in pixels
    double longest = 1e9;  ///< a longer text has a smaller font or, at last, is cut off
    bool upwards = false;  ///< turned by 90 degrees
};

class Sheet {
public:
    /// \param ink the colour of texts and lines
    explicit Sheet(const Colour& ink) : ink_{ink} {}

    /// The rectangle of a text, without writing it.
    static Box measure(const std::string& text, const TextPlace& place);
    /// Writes a text.
    /// \return its rectangle
    Box write(const std::string& text, const TextPlace& place);
    /// Writes a text unless it would touch another one or leave a rectangle.
    bool write_if_free(const std::string& text, const TextPlace& place, const Box& within);
    void line(const Pixel& from, const Pixel& to, double width);
    void line(const Pixel& from, const Pixel& to, double width, const Colour& colour);
    /// An area of one colour: its corners in order.
    void area(const std::vector<Pixel>& corners, const Colour& colour);

    const Colour& ink() const { return ink_; }
    /// The rectangles of all texts.
    const std::vector<Box>& texts() const { return boxes_; }
    /// Draws everything, each pixel in `factor` times as many on a side.
    void show(vtkRenderer* renderer, int factor) const;

private:
    struct Text {
        std::string text;
        TextPlace place;
    };
    struct Area {
        std::vector<Pixel> corners;
        Colour colour;
    };
    Colour ink_;
    std::vector<Text> texts_;
    std::vector<Box> boxes_;
    std::vector<Area> areas_;
};
