// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The compiled half of the package nestgrid. Its functions take all arguments; checks, defaults,
// hints and help are in the half that is written in Python.
#include <nestgrid/error.hpp>

#include "bind.hpp"
#include "interruptible.hpp"

namespace nestgrid::python {

Point point_of(const Numbers& numbers, const char* name) {
    if (numbers.size() != 3) {
        throw InvalidInput(std::string(name) + " has " + std::to_string(numbers.size()) +
                           " numbers, not 3");
    }
    return {numbers.data()[0], numbers.data()[1], numbers.data()[2]};
}

}  // namespace nestgrid::python

PYBIND11_MODULE(_nestgrid, m) {
    namespace py = pybind11;
    py::register_exception<nestgrid::InvalidInput>(m, "InvalidInput", PyExc_ValueError);
    py::register_exception<nestgrid::GridError>(m, "GridError", PyExc_RuntimeError);
    py::register_exception<nestgrid::IoError>(m, "IoError", PyExc_OSError);
    for (const char* name : {"InvalidInput", "GridError", "IoError"}) {
        m.attr(name).attr("__module__") = "nestgrid";
    }
    m.attr("__version__") = NESTGRID_VERSION;
    nestgrid::python::bind_sources(m);
    nestgrid::python::bind_results(m);
    nestgrid::python::bind_extraction(m);
    nestgrid::python::bind_budget(m);
    nestgrid::python::bind_volume_files(m);
    m.def("watched", &nestgrid::python::watched, py::arg("function"), py::arg("look"));
    py::module_::import("atexit").attr("register")(
        py::cpp_function(&nestgrid::python::wait_for_abandoned_work));
}
