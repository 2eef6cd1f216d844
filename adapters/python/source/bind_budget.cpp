// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/functional.h>

#include <nestgrid/algorithms/frame_budget.hpp>

#include "bind.hpp"

namespace nestgrid::python {

void bind_budget(py::module_& m) {
    py::class_<FrameBudget>(
        m, "FrameBudget",
        "Keeps frames at one cost while a slider is dragged, by correcting the last threshold.\n\n"
        "goal      cost of a frame that is aimed at, in any unit: triangles, seconds\n"
        "greatest  the greatest threshold that makes a difference: the range of the data\n\n"
        "Raises InvalidInput where one of them is not a positive finite number.")
        .def(py::init<double, double>(), py::arg("goal"), py::arg("greatest"))
        .def_property_readonly("threshold", &FrameBudget::threshold, "For the next frame.")
        .def_property("goal", &FrameBudget::goal, &FrameBudget::aim,
                      "The cost that is aimed at; may be set.")
        .def("drawn", &FrameBudget::drawn, py::arg("cost"),
             "Tells what the frame at threshold cost.")
        .def("settle", &FrameBudget::settle, py::arg("fits"),
             "The least threshold at which fits(threshold) is true: when the motion has ended.");
}

}  // namespace nestgrid::python
