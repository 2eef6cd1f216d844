// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// "did you mean": what somebody probably meant by a word that is not known.
#pragma once

#include <string>
#include <vector>

/// The known word that takes the fewest letters to insert, remove, replace or swap; empty where
/// none is near.
std::string nearest(const std::string& word, const std::vector<std::string>& known);

/// ": did you mean 'nearest'?", or nothing where no known word is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& known);

/// "'a', 'b'", at most twelve of them.
std::string listed(const std::vector<std::string>& words);
