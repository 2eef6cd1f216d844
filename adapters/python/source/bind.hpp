// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The functions that define the module _nestgrid, and conversions that all of them use. Arguments
// were checked by the half that is written in Python; every one has a name, which the stub
// _nestgrid.pyi repeats.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <nestgrid/algorithms/isosurface_options.hpp>

namespace nestgrid::python {

namespace py = pybind11;

/// Numbers that Python hands over, converted where they are of another type.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Each defines a part of the module.
void bind_sources(py::module_& m);
void bind_extraction(py::module_& m);
void bind_results(py::module_& m);
void bind_budget(py::module_& m);
void bind_volume_files(py::module_& m);

/// An array on memory that `owner` keeps.
template <class Number>
py::array array_on(const py::object& owner, const void* data,
                   const std::vector<py::ssize_t>& shape) {
    return py::array(py::dtype::of<Number>(), shape, static_cast<const Number*>(data), owner);
}

/// \throw InvalidInput where there are not three finite or infinite numbers
Point point_of(const Numbers& numbers, const char* name);

}  // namespace nestgrid::python
