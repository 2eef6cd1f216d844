// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The functions that define the module _nestgrid, and conversions that all of them use.
#pragma once

#include <chrono>

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

/// An array on memory that `owner` keeps.
template <class Number>
py::array array_on(const py::object& owner, const void* data,
                   const std::vector<py::ssize_t>& shape) {
    return py::array(py::dtype::of<Number>(), shape, static_cast<const Number*>(data), owner);
}

/// \throw InvalidInput where there are not three finite or infinite numbers
Point point_of(const Numbers& numbers, const char* name);

/// Releases Python's lock while the library works, and looks for signals now and then.
class Interruptible {
public:
    /// Calls work(progress) without the lock, with the function to hand to the library.
    /// \return what it returns
    /// \throw py::error_already_set where a signal handler has raised, such as KeyboardInterrupt
    template <class Work>
    auto run(const Work& work) {
        auto result = [&] {
            const py::gil_scoped_release unlocked;
            return work([this](const TraversalCounts&) { return go_on(); });
        }();
        if (raised_) throw py::error_already_set();
        return result;
    }

private:
    /// Called by the thread that called run().
    bool go_on() {
        using Clock = std::chrono::steady_clock;
        constexpr std::chrono::milliseconds pause(20);
        if (raised_) return false;
        if (Clock::now() < next_) return true;
        const py::gil_scoped_acquire locked;
        raised_ = PyErr_CheckSignals() != 0;
        next_ = Clock::now() + pause;
        return !raised_;
    }

    std::chrono::steady_clock::time_point next_{};
    bool raised_ = false;
};

}  // namespace nestgrid::python
