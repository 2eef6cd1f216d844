// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <contours/transition_contours.hpp>

#include <numeric>

namespace nestgrid::engine {

auto TransitionContours::append(const TransitionContours& other, std::vector<Index> numbers)
    -> std::vector<Index> {
    if (by_names_) {
        std::vector<KeyPair> names(other.cuts_.size());
        other.vertex_of_.for_each([&](const KeyPair& name, Index v) { names[v] = name; });
        numbers.resize(names.size());
        for (std::size_t v = 0; v < names.size(); ++v) {
            numbers[v] = vertex(names[v], [&] { return other.cut(static_cast<Index>(v)); });
        }
    }
    for (const Segment& s : other.segments_) {
        segments_.push_back({s.face, numbers[s.from], numbers[s.to]});
    }
    other.split_of_.for_each([&](NodeKey face, const Split& s) {
        note_split(face, s.by, other.element(s.owner), s.owner.shape, s.owner.level);
    });
    other.conflicts_.for_each(
        [&](NodeKey face, const Owner&) { conflicts_.insert(face, split_of_.find(face)->owner); });
    other.shared_parts_.for_each(
        [&](NodeKey part, const Corners& c) { shared_parts_.insert(part, c); });
    return numbers;
}

void TransitionContours::finish(const std::function<Point(Index)>& position) {
    group_segments();
    conflicts_.for_each(
        [&](NodeKey face, const Owner& owner) { find_gaps(face, owner, position); });
    std::sort(gaps_.begin(), gaps_.end(),
              [](const Gap& a, const Gap& b) { return a.loop < b.loop; });
    conflicts_ = {};
    split_of_ = {};
    faces_.reset(face_number_.size());
    face_number_.for_each([&](NodeKey face, Index) { faces_.add(hash(face)); });
}

void TransitionContours::group_segments() {
    face_of_.resize(segments_.size());
    for (std::size_t i = 0; i < segments_.size(); ++i) {
        const auto next = static_cast<Index>(face_number_.size());
        face_of_[i] = *face_number_.insert(segments_[i].face, next).first;
    }
    first_on_.assign(face_number_.size() + 1, 0);
    for (const Index f : face_of_) ++first_on_[f + 1U];
    std::partial_sum(first_on_.begin(), first_on_.end(), first_on_.begin());
    place_.assign(first_on_.begin(), first_on_.end());
    for (std::size_t f = 0; f + 1 < first_on_.size(); ++f) {
        for (Index& i = place_[f]; i < first_on_[f + 1]; ++i) {
            while (face_of_[i] != f) {
                const Index to = place_[face_of_[i]]++;
                std::swap(segments_[i], segments_[to]);
                std::swap(face_of_[i], face_of_[to]);
            }
        }
        if (first_on_[f + 1] - first_on_[f] > few) sort_segments(f);
    }
}

void TransitionContours::find_gaps(NodeKey face, const Owner& owner,
                                   const std::function<Point(Index)>& position) {
    const auto place = [&](Index v) { return by_names_ ? cuts_[v].x : position(v); };
    std::vector<Segment> left;
    const Index number = *face_number_.find(face);
    sort_segments(number);
    const std::span<const Segment> all = segments_on(number);
    for (const Segment& s : all) {
        if (!std::binary_search(all.begin(), all.end(), Segment{face, s.to, s.from}, before)) {
            if (left.empty() || !(left.back() == s)) left.push_back(s);
        }
    }
    // Loops begin, and go on, by the places of vertices: their numbers depend on who draws.
    std::sort(left.begin(), left.end(), [&](const Segment& a, const Segment& b) {
        if (a.from != b.from) return place(a.from) > place(b.from);
        return place(a.to) > place(b.to);
    });
    while (!left.empty()) {
        Gap gap{{}, owner};
        const Index start = left.back().from;
        for (Index at = start; gap.loop.empty() || at != start;) {
            const auto next = std::find_if(left.begin(), left.end(),
                                           [&](const Segment& s) { return s.from == at; });
            if (next == left.end()) break;
            gap.loop.push_back(at);
            at = next->to;
            left.erase(next);
        }
        if (gap.loop.size() > 2) gaps_.push_back(std::move(gap));
    }
}

}  // namespace nestgrid::engine
