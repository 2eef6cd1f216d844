// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The newest surface of a solver as frames of a page. Who pushes and who reads do not wait for each
// other: a frame becomes bytes when a reader first asks for it, in the reader's thread.
#pragma once

#include <condition_variable>
#include <mutex>

#include <nestgrid/view/page.hpp>

#include "frame_source.hpp"

namespace nestgrid::view {

class PushedSurfaces final : public FrameSource {
public:
    /// \param most_waiting readers who may wait for the next surface at a time; others are answered
    ///        at once
    PushedSurfaces(const PageOptions& options, std::size_t most_waiting);
    ~PushedSurfaces() override;

    /// As Page::push().
    void push(Surface<3> surface, PushOptions options);

    /// JSON with "pushed": true and a title.
    std::string info() override;
    /// Waits up to 10 seconds for another surface than the reader has.
    /// \param request after=NUMBER, that of the surface the reader has, 0 for none; outlines=on
    /// (off) \return the layout of frame_reply.hpp. The text has number (surfaces are counted from
    /// 1; that
    ///         of the request where there is no other), ended (whether the solver has), and a list
    ///         of parts, which is empty where there is no other surface. With a surface it has
    ///         title, field, least, greatest and isovalue (null where they are not known), box,
    ///         time, step, numbers (a list of name and value), triangles, and parts: surface, with
    ///         positions, indices, normals as int8 and, where there are attributes, values; and
    ///         outlines (explorer.hpp)
    /// \throw InvalidInput with one sentence where the request is malformed
    Bytes frame(std::string_view request, const std::function<bool()>& is_wanted) override;
    std::string pulse() override { return pulse_of({}); }
    void stop() override;

private:
    class Frame;

    const std::string title_;
    const std::size_t most_waiting_;
    std::mutex mutex_;  // of all below
    std::condition_variable changed_;
    std::shared_ptr<Frame> newest_;
    std::uint64_t pushed_ = 0;
    std::size_t waiting_ = 0;
    bool ended_ = false;
    std::array<Point, 2> box_;
    bool box_grows_;
    std::array<double, 2> range_;  // of the attributes so far
};

}  // namespace nestgrid::view
