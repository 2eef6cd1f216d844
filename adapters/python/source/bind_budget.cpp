// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/functional.h>

#include <nestgrid/algorithms/frame_budget.hpp>

#include "bind.hpp"

namespace nestgrid::python {

void bind_budget(py::module_& m) {
    py::class_<FrameBudget>(m, "FrameBudget")
        .def(py::init<double, double>(), py::arg("goal"), py::arg("greatest"))
        .def_property_readonly("threshold", &FrameBudget::threshold)
        .def_property("goal", &FrameBudget::goal, &FrameBudget::aim)
        .def("drawn", &FrameBudget::drawn, py::arg("cost"))
        .def("settle", &FrameBudget::settle, py::arg("fits"));
}

}  // namespace nestgrid::python
