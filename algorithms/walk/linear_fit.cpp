// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/linear_fit.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace nestgrid::engine {

namespace {

// A direction in which the samples spread less than this part of their spread along an axis says
// nothing: what is not linear in the function would be taken for a slope.
constexpr double least_spread = 0.05;

/// Weighted least squares by an orthogonal basis of the columns, the longest one first.
class Fit {
public:
    explicit Fit(const std::vector<FitSample>& samples) {
        centre(samples);
        for (std::size_t d = 0; d < 3; ++d) {
            scale_[d] = length(column_[d]);
            if (scale_[d] > 0) multiply(column_[d], 1 / scale_[d]);
        }
    }

    LinearFit solve(int dimension) {
        while (rank_ < static_cast<std::size_t>(dimension) && take_longest()) {
        }
        LinearFit fit;
        fit.rank = static_cast<int>(rank_);
        for (std::size_t k = rank_; k-- > 0;) {
            double slope = right_[k];
            for (std::size_t j = k + 1; j < rank_; ++j) {
                slope -= upper_[k][order_[j]] * fit.gradient[order_[j]];
            }
            fit.gradient[order_[k]] = slope / upper_[k][order_[k]];
        }
        for (std::size_t k = 0; k < rank_; ++k) fit.gradient[order_[k]] /= scale_[order_[k]];
        return fit;
    }

private:
    using Column = std::vector<double>;

    static double product(const Column& a, const Column& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
        return sum;
    }
    static double length(const Column& a) { return std::sqrt(product(a, a)); }
    static void multiply(Column& a, double by) {
        for (double& x : a) x *= by;
    }
    static void subtract(Column& a, double by, const Column& b) {
        for (std::size_t i = 0; i < a.size(); ++i) a[i] -= by * b[i];
    }

    /// The rows, as seen from their mean, with the weights (distance)^-4, the roots of which they
    /// carry.
    void centre(const std::vector<FitSample>& samples) {
        double unit = 0;
        for (const FitSample& s : samples) unit = std::max(unit, norm(s.offset));
        std::vector<double> root;
        FitSample mean{{0, 0, 0}, 0};
        double total = 0;
        for (const FitSample& s : samples) {
            const Point at = (1 / unit) * s.offset;
            root.push_back(1 / dot(at, at));
            const double weight = root.back() * root.back();
            total += weight;
            mean.offset = mean.offset + (weight / total) * (s.offset - mean.offset);
            mean.value += weight / total * (s.value - mean.value);
        }
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const Point from_mean = samples[i].offset - mean.offset;
            for (std::size_t d = 0; d < 3; ++d) column_[d].push_back(root[i] * from_mean[d]);
            value_.push_back(root[i] * (samples[i].value - mean.value));
        }
    }

    /// Makes the longest column the next one of the basis, if it is long enough.
    bool take_longest() {
        std::size_t longest = 3;
        double most = least_spread;
        for (std::size_t d = 0; d < 3; ++d) {
            const double here = taken_[d] ? 0 : length(column_[d]);
            if (here <= most) continue;
            longest = d;
            most = here;
        }
        if (longest == 3) return false;
        taken_[longest] = true;
        order_[rank_] = longest;
        multiply(column_[longest], 1 / most);
        upper_[rank_][longest] = most;
        right_[rank_] = project_out(value_, column_[longest]);
        for (std::size_t d = 0; d < 3; ++d) {
            if (!taken_[d]) upper_[rank_][d] = project_out(column_[d], column_[longest]);
        }
        ++rank_;
        return true;
    }
    static double project_out(Column& from, const Column& unit) {
        const double along = product(from, unit);
        subtract(from, along, unit);
        return along;
    }

    std::array<Column, 3> column_;
    Column value_;
    Point scale_{};
    std::array<bool, 3> taken_{};
    std::array<std::size_t, 3> order_{};
    std::array<Point, 3> upper_{};
    Point right_{};
    std::size_t rank_ = 0;
};

}  // namespace

LinearFit fit_linear(const std::vector<FitSample>& samples, int dimension) {
    return Fit(samples).solve(dimension);
}

}  // namespace nestgrid::engine
