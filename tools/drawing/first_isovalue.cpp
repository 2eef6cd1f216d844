// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/first_isovalue.hpp"

#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <span>

namespace {

using Sorted = std::span<const double>;

double quantile(Sorted sorted, double part) {
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
}

double median(Sorted sorted) { return quantile(sorted, 0.5); }

/// The values above a number, of sorted ones.
Sorted above(Sorted sorted, double value) {
    return {std::ranges::upper_bound(sorted, value), sorted.end()};
}

Sorted below(Sorted sorted, double value) {
    return {sorted.begin(), std::ranges::lower_bound(sorted, value)};
}

std::vector<double> mirrored(Sorted sorted) {
    std::vector<double> result;
    for (std::size_t i = sorted.size(); i-- > 0;) result.push_back(-sorted[i]);
    return result;
}

ValueSample mirrored(ValueSample sample) {
    for (double& value : sample.values) value = -value;
    for (double& value : sample.next) value = -value;
    return sample;
}

/// How often sorted values occur between their ends, without few that lie far off.
template <std::size_t bins>
struct Counts {
    explicit Counts(Sorted sorted) {
        const double low = quantile(sorted, 0.01);
        const double high = quantile(sorted, 0.99);
        from = quantile(sorted, 0.0005);
        double to = quantile(sorted, 0.9995);
        const bool most_is_in_one_bin = high > low && to - from > 1000 * (high - low);
        if (most_is_in_one_bin) {
            from = low;
            to = high;
        }
        width = (to - from) / bins;
        if (!(width > 0)) return;
        for (const double value : sorted) {
            if (value < from || value > to) continue;
            const double place = std::min((value - from) / width, bins - 1.0);
            counts[static_cast<std::size_t>(place)] += 1;
        }
    }
    double middle(std::size_t bin) const { return from + (static_cast<double>(bin) + 0.5) * width; }

    double from = 0;
    double width = 0;
    std::array<double, bins> counts{};
};

template <std::size_t bins>
std::array<double, bins> smooth(const std::array<double, bins>& counts) {
    constexpr std::array weights{1.0 / 16, 4.0 / 16, 6.0 / 16, 4.0 / 16, 1.0 / 16};
    std::array<double, bins> result{};
    for (std::size_t i = 0; i < bins; ++i) {
        for (std::size_t k = 0; k < weights.size(); ++k) {
            if (i + k >= 2 && i + k - 2 < bins) result[i] += weights[k] * counts[i + k - 2];
        }
    }
    return result;
}

/// The first peak of a histogram, if a valley and more samples follow.
struct Peak {
    double mode;
    double share;  ///< of the samples, up to the valley
    double
        isovalue;  ///< in the valley, near the middle between the mode and the median of the rest
};

std::optional<Peak> first_peak(Sorted sorted) {
    constexpr std::size_t bins = 64;
    const Counts<bins> raw(sorted);
    if (!(raw.width > 0)) return std::nullopt;
    const std::array<double, bins> counts = smooth(raw.counts);
    const double top = std::ranges::max(counts);
    std::size_t mode = 0;
    std::size_t at = 1;
    while (at < bins && (counts[mode] < 0.02 * top || counts[at] > 0.5 * counts[mode])) {
        if (counts[at] > counts[mode]) mode = at;
        ++at;
    }
    std::size_t valley = std::min(at, bins - 1);
    const auto is_low = [&](std::size_t i) {
        return counts[i] < 2 * counts[valley] + 0.0005 * top;
    };
    while (at < bins && is_low(at)) {
        if (counts[at] < counts[valley]) valley = at;
        ++at;
    }
    if (at == bins) return std::nullopt;
    std::size_t low = valley;
    std::size_t high = valley;
    while (low > mode + 1 && is_low(low - 1)) --low;
    while (high + 1 < bins && is_low(high + 1)) ++high;
    const Sorted rest = above(sorted, raw.middle(valley));
    const double share = 1 - static_cast<double>(rest.size()) / static_cast<double>(sorted.size());
    if (share < 0.03 || rest.empty()) return std::nullopt;
    const double half = (raw.middle(mode) + median(rest)) / 2;
    return Peak{raw.middle(mode), share,
                std::clamp(half, raw.middle(low), std::max(raw.middle(low), raw.middle(high)))};
}

/// The value between bins that parts a histogram best; the middle of those that are alike.
double parting_value(Sorted sorted) {
    constexpr std::size_t bins = 128;
    const Counts<bins> h(sorted);
    if (!(h.width > 0)) return (sorted.front() + sorted.back()) / 2;
    const double total = std::accumulate(h.counts.begin(), h.counts.end(), 0.0);
    double sum = 0;
    for (std::size_t i = 0; i < bins; ++i) sum += static_cast<double>(i) * h.counts[i];
    double below = 0;
    double sum_below = 0;
    double best = 0;
    std::size_t first = bins / 2;
    std::size_t last = bins / 2;
    for (std::size_t i = 0; i + 1 < bins; ++i) {
        below += h.counts[i];
        sum_below += static_cast<double>(i) * h.counts[i];
        if (below == 0 || below == total) continue;
        const double apart = sum_below / below - (sum - sum_below) / (total - below);
        const double between = below * (total - below) * apart * apart;
        if (between > best) first = i + 1;
        if (between >= best) last = i + 1;
        best = std::max(best, between);
    }
    return h.from + static_cast<double>(first + last) / 2 * h.width;
}

/// A value that many samples have exactly.
struct Constant {
    double value;
    double share;
};

/// The most frequent value, and the more frequent one of the two ends.
struct Constants {
    explicit Constants(Sorted sorted) {
        const auto all = static_cast<double>(sorted.size());
        for (std::size_t i = 0; i < sorted.size();) {
            const std::size_t from = i;
            while (i < sorted.size() && sorted[i] == sorted[from]) ++i;
            const Constant found{sorted[from], static_cast<double>(i - from) / all};
            if (found.share > most.share) most = found;
            if ((from == 0 || i == sorted.size()) && found.share > end.share) end = found;
            ++distinct;
        }
    }
    /// Where one value is that of so many samples that it is the background.
    std::optional<double> background() const {
        if (end.share >= 0.05) return end.value;
        if (most.share >= 0.3) return most.value;
        return std::nullopt;
    }

    Constant most{0, 0};
    Constant end{0, 0};
    std::size_t distinct = 0;
};

/// Whether whole numbers name things instead of measuring them: neighbours are equal, or else
/// differ by more than 1.
bool are_labels(const ValueSample& sample, const Constants& constants) {
    if (constants.distinct > 4096) return false;
    double pairs = 0;
    double equal = 0;
    double steps = 0;
    for (std::size_t i = 0; i < sample.values.size(); ++i) {
        const double a = sample.values[i];
        const double b = sample.next[i];
        if (a != std::floor(a)) return false;
        if (a == constants.most.value || b == constants.most.value) continue;
        pairs += 1;
        equal += a == b ? 1 : 0;
        steps += std::abs(a - b) == 1 ? 1 : 0;
    }
    const bool few = constants.distinct <= 16;
    return equal >= 0.6 * pairs && (few || steps <= 0.5 * (pairs - equal));
}

/// Whether neighbours differ by much less than samples in general do.
bool is_smooth(const ValueSample& sample, double from, double to) {
    double differences = 0;
    double deviations = 0;
    for (std::size_t i = 0; i < sample.values.size(); ++i) {
        const double a = sample.values[i];
        const double b = sample.next[i];
        const double other = sample.values[(i + sample.values.size() / 2) % sample.values.size()];
        if (std::min({a, b, other}) < from || std::max({a, b, other}) > to) continue;
        differences += std::abs(a - b);
        deviations += std::abs(a - other);
    }
    return differences < 0.3 * deviations;
}

/// Between a constant background and the median of the values above it.
double beside_background(double background, Sorted rest) {
    const std::optional<Peak> noise = first_peak(rest);
    if (noise && noise->share < 0.98) return noise->isovalue;
    const double apart = median(rest) - background;
    const double half = background + apart / 2;
    const double gap = quantile(rest, 0.01) - background;
    return gap < apart / 4 ? half : std::min(half, background + 0.75 * gap);
}

double beside_label(double label, Sorted sorted) {
    const Sorted higher = above(sorted, label);
    if (!higher.empty()) return (label + higher.front()) / 2;
    return (label + below(sorted, label).back()) / 2;
}

bool changes_sign(Sorted sorted) {
    const auto all = static_cast<double>(sorted.size());
    const auto positive = static_cast<double>(above(sorted, 0).size());
    const auto negative = static_cast<double>(below(sorted, 0).size());
    return std::min(positive, negative) >= 0.0002 * all && all - positive - negative < 0.01 * all;
}

/// \param sorted the values of the sample, or those above a padding value; two differ
double isovalue_of(const ValueSample& sample, Sorted sorted) {
    const Constants constants(sorted);
    if (are_labels(sample, constants)) return beside_label(constants.most.value, sorted);
    const double range = sorted.back() - sorted.front();
    const bool balanced = std::abs(sorted.front() + sorted.back()) < 0.001 * range;
    if (balanced && changes_sign(sorted)) return 0;
    if (const std::optional<double> background = constants.background()) {
        const Sorted rest = above(sorted, *background);
        if (rest.size() < below(sorted, *background).size()) {
            return -isovalue_of(mirrored(sample), mirrored(sorted));
        }
        const double spread = quantile(rest, 0.99) - quantile(rest, 0.01);
        const double gap = quantile(rest, 0.01) - *background;
        const bool is_padding =
            spread > 0 && gap > 10 * spread && is_smooth(sample, rest.front(), rest.back());
        return is_padding ? isovalue_of(sample, rest) : beside_background(*background, rest);
    }
    const std::vector<double> negated = mirrored(sorted);
    const std::optional<Peak> low = first_peak(sorted);
    const std::optional<Peak> high = first_peak(negated);
    if (high && !(low && low->share >= high->share)) return -high->isovalue;
    if (low) return low->isovalue;
    if (changes_sign(sorted) && is_smooth(sample, sorted.front(), sorted.back())) return 0;
    return parting_value(sorted);
}

}  // namespace

std::optional<std::array<double, 2>> usual_range(const ValueSample& sample) {
    if (sample.values.empty()) return std::nullopt;
    std::vector<double> sorted = sample.values;
    std::ranges::sort(sorted);
    const double low = quantile(sorted, 0.001);
    const double high = quantile(sorted, 0.999);
    if (!(high > low) || sample.greatest - sample.least < 1000 * (high - low)) return std::nullopt;
    const double margin = (high - low) / 20;
    return std::array{std::max(low - margin, sample.least),
                      std::min(high + margin, sample.greatest)};
}

double first_isovalue(const ValueSample& sample) {
    if (!(sample.least < sample.greatest)) return sample.least;
    std::vector<double> sorted = sample.values;
    sorted.push_back(sample.least);
    sorted.push_back(sample.greatest);
    std::ranges::sort(sorted);
    const double isovalue = isovalue_of(sample, sorted);
    if (sample.least < isovalue && isovalue < sample.greatest) return isovalue;
    return sample.least + (sample.greatest - sample.least) / 2;
}

double readable_isovalue(const ValueSample& sample) {
    const double isovalue = first_isovalue(sample);
    for (int digits = 1; digits < 17; ++digits) {
        std::array<char, 40> text{};
        std::snprintf(text.data(), text.size(), "%.*g", digits, isovalue);
        const double shorter = std::strtod(text.data(), nullptr);
        const bool is_near =
            std::abs(shorter - isovalue) <= 0.01 * (sample.greatest - sample.least);
        if (is_near && sample.least < shorter && shorter < sample.greatest) return shorter;
    }
    return isovalue;
}
