// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/prerolls.hpp>

#include <algorithm>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/split_bounds.hpp>
#include <nestgrid/algorithms/swept_key_frames.hpp>
#include <nestgrid/error.hpp>
#include <projection/polynomials.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid {

namespace {

/// The entry of a key, made by make() where there is none.
template <class Map, class Make>
typename Map::mapped_type kept_in(Map& map, const typename Map::key_type& key, const Make& make) {
    const auto found = map.find(key);
    if (found != map.end()) return found->second;
    return map.emplace(key, make()).first->second;
}

/// The sum of indicators of frames, with what it borrows.
/// \tparam Sum KeyFrames or SweptKeyFrames
template <class Sum, class Indicator>
std::shared_ptr<const Sum> weighted_sum(std::vector<std::shared_ptr<const Indicator>> of_frames,
                                        std::span<const float> weights) {
    struct Kept {
        std::vector<std::shared_ptr<const Indicator>> frames;
        Sum sum;
    };
    std::vector<const Indicator*> borrowed;
    for (const auto& each : of_frames) borrowed.push_back(each.get());
    const auto kept =
        std::make_shared<Kept>(Kept{std::move(of_frames), Sum(std::move(borrowed), weights)});
    return {kept, &kept->sum};
}

/// \throw GridError where the grid has changed since the hierarchy was made for it
void require_unchanged(const FieldOnGrid& field) {
    engine::together(field.facts().shared, "a preroll", [&] {
        field.visit([](const auto& hierarchy) {
            const std::unique_ptr<Task> task = hierarchy.open();
            Coarse coarse;
            Family family;
            if (hierarchy.coarse_count() > 0) hierarchy.coarse(task.get(), 0, coarse, family);
        });
    });
}

}  // namespace

/// All that is kept, behind one lock.
class Prerolls::Kept {
public:
    Kept(FieldOnGrid field, std::vector<std::shared_ptr<Prerolls>> frames,
         std::span<const float> weights)
        : field_{std::move(field)},
          frames_{std::move(frames)},
          weights_(weights.begin(), weights.end()) {}

    const FieldOnGrid& field() const { return field_; }
    bool between_frames() const { return !frames_.empty(); }

    /// \param name as of Projection::indicator
    const IndicatorKind& kind_of(std::string_view name, bool between, const Work& work) const {
        return name == "error" ? error_indicator(asked(work).facts(), between)
                               : indicator_named(name);
    }

    ChosenIndicator choose(const IndicatorKind& kind, double blend,
                           std::span<const double> isovalues, const Work& work) {
        const FieldOnGrid& field = asked(work);
        kind.require(field.facts());
        require_unchanged(field);
        ChosenIndicator chosen = kind.of_nodes ? of_nodes(*kind.of_nodes, blend, work)
                                               : of_nodes(NodeError::offset, 1, work);
        chosen.kind = &kind;
        if (kind.of_nodes) return chosen;
        if (kind.of_level_sets) {
            chosen.indicator = of_level_sets(kind, blend, isovalues, *chosen.bounds, work);
        } else if (between_frames() && kind.between_frames) {
            chosen.indicator = sum_of_frames<SweptKeyFrames>([&](Kept& frame) {
                return frame.swept(kind, blend, *frame.of_nodes(NodeError::offset, 1, work).bounds,
                                   work);
            });
        } else {
            chosen.indicator = swept(kind, blend, *chosen.bounds, work);
        }
        return chosen;
    }

    ChosenIndicator finest(const Work& work) {
        const IndicatorKind& offset = indicator_named("offset");
        const FieldOnGrid& field = asked(work);
        if (between_frames() || !detail::are_split_bounds_worth_while(field.facts())) {
            return choose(offset, 1, {}, work);
        }
        if (field.facts().shared != nullptr) {  // bounds of nodes are agreed
            return {&offset, nullptr, choose(offset, 1, {}, work).bounds};
        }
        require_unchanged(field);
        const std::scoped_lock lock(mutex_);
        const auto offsets = of_nodes_.find({NodeError::offset, 1.0});
        if (offsets != of_nodes_.end()) return {&offset, nullptr, offsets->second};
        if (!finest_) {
            finest_ = work.on(field_).visit([&](const auto& hierarchy) {
                return std::make_shared<const SplitBounds>(hierarchy, work.executor);
            });
        }
        return {&offset, nullptr, finest_};
    }

    std::shared_ptr<const SweptIndicator> sizes(const Spread& spread, const Work& work) {
        if (between_frames()) return frames_.front()->kept_->sizes(spread, work);
        const std::scoped_lock lock(mutex_);
        const auto same = [&](const Spread& kept) {
            return kept.factor == spread.factor && kept.slope == spread.slope;
        };
        if (!sizes_ || !same(sizes_->spread())) {
            sizes_ = work.on(field_).visit([&](const auto& hierarchy) {
                return std::make_shared<const SweptIndicator>(mesh_size(hierarchy, spread));
            });
        }
        return sizes_;
    }

    std::shared_ptr<const HighOrder> high_order(const Work& work) {
        if (work.same_field != nullptr) {
            return engine::polynomials_of(*work.same_field, work.executor);
        }
        const std::scoped_lock lock(mutex_);
        if (!high_order_) high_order_ = engine::polynomials_of(field_, work.executor);
        return *high_order_;
    }

    std::size_t node_count(const Work& work) {
        Kept& frame = between_frames() ? *frames_.front()->kept_ : *this;
        return frame.own_of_nodes(NodeError::offset, 1, work)->node_count();
    }

    void clear() {
        const std::scoped_lock lock(mutex_);
        of_nodes_.clear();
        swept_.clear();
        sizes_.reset();
        finest_.reset();
        of_level_sets_.clear();
        high_order_.reset();
    }

    std::size_t memory_bytes() const {
        const std::scoped_lock lock(mutex_);
        std::size_t bytes = 0;
        for (const auto& [key, each] : of_level_sets_) bytes += each.memory_bytes();
        for (const auto& [key, each] : of_nodes_) bytes += each->memory_bytes();
        for (const auto& [key, each] : swept_) bytes += each->memory_bytes();
        if (high_order_ && *high_order_ != nullptr) bytes += (*high_order_)->memory_bytes();
        return bytes + (sizes_ ? sizes_->memory_bytes() : 0) +
               (finest_ ? finest_->memory_bytes() : 0);
    }

private:
    using Made = std::shared_ptr<const SweptIndicator>;

    const FieldOnGrid& asked(const Work& work) const {
        return work.same_field == nullptr ? field_ : *work.same_field;
    }

    /// A hierarchical indicator, which has bounds, too.
    ChosenIndicator of_nodes(NodeError error, double blend, const Work& work) {
        if (between_frames()) {
            const auto sum = sum_of_frames<KeyFrames>(
                [&](Kept& frame) { return frame.own_of_nodes(error, blend, work); });
            return {nullptr, sum, sum};
        }
        const auto own = own_of_nodes(error, blend, work);
        return {nullptr, own, own};
    }
    std::shared_ptr<const HierarchicalIndicator> own_of_nodes(NodeError error, double blend,
                                                              const Work& work) {
        const std::scoped_lock lock(mutex_);
        return kept_in(of_nodes_, {error, blend}, [&] {
            return work.on(field_).visit([&](const auto& hierarchy) {
                return std::make_shared<const HierarchicalIndicator>(
                    hierarchy, error, work.executor, Spread{.factor = blend});
            });
        });
    }

    Made swept(const IndicatorKind& kind, double blend, const Bounds& bounds, const Work& work) {
        const std::scoped_lock lock(mutex_);
        return kept_in(swept_, {&kind, blend}, [&] { return make(kind, blend, {}, bounds, work); });
    }
    Made of_level_sets(const IndicatorKind& kind, double blend, std::span<const double> isovalues,
                       const Bounds& bounds, const Work& work) {
        if (isovalues.empty()) {
            throw InvalidInput("the indicator " + std::string(kind.name) +
                               " is for isosurfaces and isolines with given values");
        }
        const std::scoped_lock lock(mutex_);
        OfLevelSets& last = of_level_sets_[&kind];
        if (last.made && last.blend == blend &&
            std::equal(last.isovalues.begin(), last.isovalues.end(), isovalues.begin(),
                       isovalues.end())) {
            return last.made;
        }
        last = {blend, std::vector(isovalues.begin(), isovalues.end()),
                make(kind, blend, isovalues, bounds, work)};
        return last.made;
    }
    Made make(const IndicatorKind& kind, double blend, std::span<const double> isovalues,
              const Bounds& bounds, const Work& work) const {
        const IndicatorInput input{.range = bounds.greatest() - bounds.least(),
                                   .spread = {.factor = blend},
                                   .isovalues = isovalues,
                                   .bounds = &bounds,
                                   .executor = work.executor};
        return std::make_shared<const SweptIndicator>(kind.make(work.on(field_), input));
    }

    /// \param of gives the indicator of one frame
    template <class Sum, class Of>
    std::shared_ptr<const Sum> sum_of_frames(const Of& of) const {
        std::vector<decltype(of(*frames_.front()->kept_))> of_frames;
        for (const auto& frame : frames_) of_frames.push_back(of(*frame->kept_));
        return weighted_sum<Sum>(std::move(of_frames), weights_);
    }

    /// Made for the isovalues that were asked for last.
    struct OfLevelSets {
        double blend = 1;
        std::vector<double> isovalues{};
        Made made{};

        std::size_t memory_bytes() const { return made ? made->memory_bytes() : 0; }
    };

    FieldOnGrid field_;
    std::vector<std::shared_ptr<Prerolls>> frames_;  // empty where the field is no sum
    std::vector<float> weights_;                     // of the frames
    mutable std::mutex mutex_;
    std::map<std::pair<NodeError, double>, std::shared_ptr<const HierarchicalIndicator>> of_nodes_;
    std::map<std::pair<const IndicatorKind*, double>, Made> swept_;
    Made sizes_;
    std::shared_ptr<const SplitBounds> finest_;
    std::map<const IndicatorKind*, OfLevelSets> of_level_sets_;
    std::optional<std::shared_ptr<const HighOrder>> high_order_;  // nothing: not asked for yet
};

Prerolls::Prerolls(FieldOnGrid field)
    : kept_{std::make_unique<Kept>(std::move(field), std::vector<std::shared_ptr<Prerolls>>{},
                                   std::span<const float>{})} {}

Prerolls::Prerolls(FieldOnGrid field, std::vector<std::shared_ptr<Prerolls>> frames,
                   std::span<const float> weights) {
    if (frames.empty()) throw InvalidInput("there are no frames to interpolate between");
    detail::require_weights(frames.size(), weights);
    kept_ = std::make_unique<Kept>(std::move(field), std::move(frames), weights);
}

Prerolls::~Prerolls() = default;

const FieldOnGrid& Prerolls::field() const { return kept_->field(); }

bool Prerolls::between_frames() const { return kept_->between_frames(); }

ChosenIndicator Prerolls::choose(std::string_view name, double blend,
                                 std::span<const double> isovalues, const Work& work) const {
    if (name == "error" && isovalues.empty()) name = "deviation";
    return kept_->choose(kept_->kind_of(name, between_frames(), work), blend, isovalues, work);
}

std::shared_ptr<const Bounds> Prerolls::prepare(const Projection& projection, bool shared,
                                                const Work& work) const {
    const IndicatorKind& kind =
        kept_->kind_of(projection.indicator, shared || between_frames(), work);
    if (projection.asks_for_everything() && !shared) return finest(work).bounds;
    if (projection.lens) sizes(projection.sizes_spread(), work);
    if (kind.of_nodes || (shared && kind.between_frames)) {
        return kept_->choose(kind, projection.blend, {}, work).bounds;
    }
    return bounds(work);
}

ChosenIndicator Prerolls::finest(const Work& work) const { return kept_->finest(work); }

std::shared_ptr<const Bounds> Prerolls::bounds(const Work& work) const {
    return choose("offset", 1, {}, work).bounds;
}

std::shared_ptr<const SweptIndicator> Prerolls::sizes(const Spread& spread,
                                                      const Work& work) const {
    return kept_->sizes(spread, work);
}

std::shared_ptr<const HighOrder> Prerolls::high_order(const Work& work) const {
    return kept_->high_order(work);
}

std::size_t Prerolls::node_count(const Work& work) const { return kept_->node_count(work); }

void Prerolls::clear() { kept_->clear(); }

std::size_t Prerolls::memory_bytes() const { return kept_->memory_bytes(); }

}  // namespace nestgrid
