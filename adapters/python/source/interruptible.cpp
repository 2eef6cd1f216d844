// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "interruptible.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <list>
#include <mutex>
#include <thread>

namespace nestgrid::python {

namespace {

namespace py = pybind11;

/// A thread that works, and whether it has ended.
class Worker {
public:
    explicit Worker(std::function<void()> work)
        : state_{std::make_shared<State>()},
          thread_([state = state_, work = std::move(work)]() mutable {
              std::exception_ptr failure;
              try {
                  work();
              } catch (...) {
                  failure = std::current_exception();
              }
              work = nullptr;  // drops what the work owns before anybody hears of the end
              const std::scoped_lock lock(state->mutex);
              state->failure = failure;
              state->ended = true;
              state->changed.notify_all();
          }) {}

    /// \return whether the work has ended
    bool wait(std::chrono::milliseconds most) {
        std::unique_lock lock(state_->mutex);
        return state_->changed.wait_for(lock, most, [&] { return state_->ended; });
    }
    bool ended() const {
        const std::scoped_lock lock(state_->mutex);
        return state_->ended;
    }
    /// Waits for the end.
    /// \return what the work has thrown, or null
    std::exception_ptr join() {
        thread_.join();
        return state_->failure;
    }

private:
    struct State {
        std::mutex mutex;
        std::condition_variable changed;
        bool ended = false;
        std::exception_ptr failure;
    };
    std::shared_ptr<State> state_;
    std::thread thread_;
};

/// Workers that nobody waits for. Used with Python's lock.
std::list<Worker>& abandoned() {
    static std::list<Worker> workers;
    return workers;
}

void drop_ended_workers() {
    abandoned().remove_if([](Worker& worker) {
        if (!worker.ended()) return false;
        worker.join();
        return true;
    });
}

/// Called while this thread waits for work, which it is borrowed for; or null.
thread_local PyObject* looks = nullptr;

/// \return whether a signal handler, or what watches, has raised
bool has_raised() {
    if (PyErr_CheckSignals() != 0) return true;
    if (looks == nullptr) return false;
    PyObject* const result = PyObject_CallNoArgs(looks);
    Py_XDECREF(result);
    return result == nullptr;
}

}  // namespace

py::object watched(const py::object& function, const py::object& look) {
    struct Looks {
        explicit Looks(PyObject* now) { looks = now; }
        Looks(const Looks&) = delete;
        Looks& operator=(const Looks&) = delete;
        ~Looks() { looks = before; }
        PyObject* before = looks;
    };
    const Looks now(look.ptr());
    return function();
}

void run_apart(std::function<void()> work, const std::function<void()>& stop) {
    constexpr std::chrono::milliseconds look(20);      // for signals so often
    constexpr std::chrono::milliseconds hearing(200);  // for work that is told to end
    drop_ended_workers();
    Worker worker(std::move(work));
    const auto wait = [&](std::chrono::milliseconds most) {
        const py::gil_scoped_release unlocked;
        return worker.wait(most);
    };
    while (!wait(look)) {
        if (!has_raised()) continue;
        py::error_already_set raised;
        stop();
        if (wait(hearing)) {
            worker.join();
        } else {
            abandoned().push_back(std::move(worker));
        }
        throw std::move(raised);
    }
    if (const std::exception_ptr failure = worker.join()) std::rethrow_exception(failure);
}

std::shared_ptr<const void> keep(py::object object) {
    return {object.release().ptr(), [](PyObject* kept) {
                const py::gil_scoped_acquire locked;
                Py_DECREF(kept);
            }};
}

void wait_for_abandoned_work() {
    std::list<Worker> workers = std::move(abandoned());
    abandoned().clear();
    const py::gil_scoped_release unlocked;
    for (Worker& worker : workers) worker.join();
}

}  // namespace nestgrid::python
