// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "suggestion.hpp"

#include <algorithm>

#include "text_header.hpp"

namespace {

/// Letters to insert, remove, replace or swap with their neighbours (Damerau's distance, in which
/// no part is edited twice).
std::size_t distance(const std::string& a, const std::string& b) {
    std::vector<std::vector<std::size_t>> steps(a.size() + 1,
                                                std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) steps[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) steps[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = steps[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            steps[i][j] = std::min({replaced, steps[i - 1][j] + 1, steps[i][j - 1] + 1});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) steps[i][j] = std::min(steps[i][j], steps[i - 2][j - 2] + 1);
        }
    }
    return steps[a.size()][b.size()];
}

/// How far a known word is from a word; more than half of its letters where it is another one. A
/// beginning of at least three letters counts as one step.
std::size_t steps_to(const std::string& word, const std::string& known) {
    const bool begins = word.size() >= 3 && known.starts_with(word);
    return begins ? 1 : distance(word, known);
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& known) {
    constexpr std::size_t longest = 100;  // beyond it, nobody has misspelt a word
    if (word.empty() || word.size() > longest) return "";
    std::string best;
    std::size_t fewest = std::max<std::size_t>(1, (word.size() + 1) / 3) + 1;
    for (const std::string& each : known) {
        if (each.size() > longest) continue;
        const std::size_t steps = steps_to(lower(word), lower(each));
        if (steps < fewest) {
            fewest = steps;
            best = each;
        }
    }
    return best;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
    const std::string meant = nearest(word, known);
    return meant.empty() ? "" : ": did you mean '" + meant + "'?";
}

std::string listed(const std::vector<std::string>& words) {
    constexpr std::size_t most = 12;
    std::string text;
    for (std::size_t i = 0; i < std::min(words.size(), most); ++i) {
        text += (i == 0 ? "'" : ", '") + words[i] + "'";
    }
    return words.size() > most ? text + ", ..." : text;
}
