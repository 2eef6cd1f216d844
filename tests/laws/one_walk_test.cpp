// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A drawing is one walk, also where elements stop beside finer ones: it asks a field for the new
// values of each element once.
#include <map>
#include <tuple>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/shading.hpp>

#include "families.hpp"

using namespace nestgrid_test;

namespace one_walk_test {

/// Values at nodes, and how often they were asked for by each element.
template <class Grid>
class AskedField {
public:
    using value_type = double;
    using Element = typename Grid::Element;

    AskedField(const Grid& grid, const std::vector<double>& values) : values_(grid, values) {}

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return values_.coarse_values(i, out);
    }
    NodeMask new_values(const Element& e, NodeMask wanted, std::span<double> out,
                        typename Grid::Context& context) const {
        const auto& place = e.place;
        ++asked_[{place.record, place.pattern, place.exit, place.inner}];
        return values_.new_values(e, wanted, out, context);
    }

    /// The greatest number of times that one element asked since the last call.
    int most_asked() const {
        int most = 0;
        for (const auto& [place, times] : asked_) most = std::max(most, times);
        asked_.clear();
        return most;
    }

private:
    NodeField<Grid, double> values_;
    mutable std::map<std::tuple<unsigned, unsigned, unsigned, unsigned>, int> asked_;
};

template <class Family>
class OneWalk : public testing::Test {};
TYPED_TEST_SUITE(OneWalk, Families);

TYPED_TEST(OneWalk, AsksEachElementOnce) {
    for_each_field_at_sphere<TypeParam>(3, 5, [](const auto& grid, const NodalSamples& samples) {
        const AskedField field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        EXPECT_GE(field.most_asked(), 1);
        for (const double threshold : {0.0, 0.01, 0.1, 0.5}) {
            const Threshold s(&indicator, threshold);
            if constexpr (TypeParam::Grid::dimension == 2) {
                shading(grid, field, under(s, indicator));
                EXPECT_LE(field.most_asked(), 1) << threshold;
            }
            for (const bool cap : {false, true}) {
                isosurface(grid, field, 0.01, under(s, indicator), {.cap = cap});
                EXPECT_LE(field.most_asked(), 1) << threshold;
            }
        }
    });
}

}  // namespace one_walk_test
