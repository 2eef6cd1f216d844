// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Puts triangles (segments) without indices together: in chunks for a sink, or in a part that a
// task draws.
#pragma once

#include <nestgrid/wide_point.hpp>
#include <surfaces/surface_builder.hpp>

namespace nestgrid::engine {

template <int dimension>
class SoupBuilder {
public:
    static constexpr bool indexed = false;
    using Simplex = typename Soup<dimension>::Simplex;

    /// Fills a part.
    SoupBuilder(Soup<dimension>& part, bool elements) : soup_{&part}, elements_{elements} {}
    /// Fills a sink in chunks.
    /// \param chunk the memory of a chunk
    SoupBuilder(SimplexSink<dimension>& sink, Soup<dimension>& chunk)
        : soup_{&chunk}, sink_{&sink}, elements_{sink.keeps_elements()} {
        chunk.simplices.reserve(chunk_ + most_of_an_element_);
    }

    bool keeps_elements() const { return elements_; }
    void add_element(const Handle& element, Shape shape, int level) {
        if (!elements_) return;
        soup_->elements.append(element);
        soup_->shape_of.push_back(shape);
        soup_->level_of.push_back(static_cast<std::uint16_t>(level));
    }
    NESTGRID_INLINE void add_simplex(const Simplex& corners, std::span<const Point> reference) {
        soup_->simplices.push_back(corners);
        if (elements_) soup_->element_of.push_back(last_element());
        for (const Point& x : reference) soup_->reference.push_back(x);
    }
    template <class Corners>
    void add_simplices(std::span<const WidePoint> x, std::span<const Corners> all) {
        const std::size_t first = soup_->simplices.size();
        soup_->simplices.resize(first + all.size());
        Simplex* to = soup_->simplices.data() + first;
        for (const Corners& corners : all) {
            for (std::size_t k = 0; k < to->size(); ++k) (*to)[k] = Point(x[corners[k]]);
            ++to;
        }
        if (elements_) soup_->element_of.resize(soup_->simplices.size(), last_element());
    }
    /// Adds several elements and all simplices from them, in their order.
    template <class Corners>
    void add_extracted(std::span<const ExtractedElement> elements, std::span<const WidePoint> x,
                       std::span<const Corners> all) {
        for (const ExtractedElement& e : elements) {
            add_element(e.element, e.shape, e.level);
            add_simplices(x, all.first(e.simplices));
            all = all.subspan(e.simplices);
        }
    }
    /// Hands a part that a task has drawn to the sink, behind what is here.
    void add_part(const Soup<dimension>& part) {
        flush();
        if (!part.simplices.empty()) sink_->take(part);
    }
    /// Hands the chunk to the sink where there is one and the chunk is full.
    void flush_if_full() {
        if (sink_ != nullptr && soup_->simplices.size() >= chunk_) flush();
    }
    /// Hands the rest to the sink where there is one.
    void flush() {
        if (sink_ == nullptr || soup_->simplices.empty()) return;
        sink_->take(*soup_);
        soup_->clear();
    }
    /// Forgets everything but the memory.
    void clear() { soup_->clear(); }

private:
    static constexpr std::size_t chunk_ = 128;  // simplices
    static constexpr std::size_t most_of_an_element_ = 32;

    std::uint32_t last_element() const {
        return static_cast<std::uint32_t>(soup_->level_of.size() - 1);
    }

    Soup<dimension>* soup_;
    SimplexSink<dimension>* sink_ = nullptr;
    bool elements_;
};

}  // namespace nestgrid::engine
