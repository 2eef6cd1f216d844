// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the frames of a page come from: an Explorer, which draws what a page asks for, or a solver,
// which pushes what it has.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "frame_reply.hpp"
#include "frame_watch.hpp"

namespace nestgrid::view {

/// Answers the requests of pages. All functions may be called by several threads at once.
/// Exceptions that are InvalidInput or GridError are sentences for the reader.
class FrameSource {
public:
    using Bytes = std::shared_ptr<const std::vector<std::byte>>;

    FrameSource() = default;
    FrameSource(const FrameSource&) = delete;
    FrameSource& operator=(const FrameSource&) = delete;
    virtual ~FrameSource() = default;

    /// What a page needs to begin with, as JSON. Where "pushed" is true, the source is a solver.
    virtual std::string info() = 0;
    /// \param is_wanted tells at any time whether somebody still waits for the frame
    /// \return the layout of frame_reply.hpp
    /// \throw FrameAbandoned where nobody does
    virtual Bytes frame(std::string_view request, const std::function<bool()>& is_wanted) = 0;
    /// What is being done, as JSON: doing, an empty text where it is nothing, and share, null where
    /// it is not known (frame_watch.hpp). Never waits.
    virtual std::string pulse() = 0;
    /// Lets those who wait in frame() return. The server calls it when it stops.
    virtual void stop() {}
};

/// A pulse (FrameSource::pulse()).
inline std::string pulse_of(const FrameStep& step) {
    return JsonText()
        .open('{')
        .key("doing")
        .string(step.doing)
        .key("share")
        .number(step.share)
        .close('}')
        .text();
}

}  // namespace nestgrid::view
