// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include <vtkCommand.h>

/// Collects what VTK would print, except on the ranges that files tell of their arrays: nobody
/// needs them, and VTK does not read the "inf" that it writes there.
class ErrorCollector : public vtkCommand {
public:
    static ErrorCollector* New() { return new ErrorCollector; }  // NOLINT(*-naming)
    void Execute(vtkObject*, unsigned long, void* data) override {
        if (!message.empty()) return;
        const std::string text = data == nullptr ? "" : static_cast<const char*>(data);
        if (text.find("InformationKey") != std::string::npos) return;
        const std::size_t start = text.find("): ");
        message = start == std::string::npos ? text : text.substr(start + 3);
        std::replace(message.begin(), message.end(), '\n', ' ');
        message.erase(message.find_last_not_of(' ') + 1);
        if (message.empty()) message = "it cannot be read";
    }
    std::string message;
};
