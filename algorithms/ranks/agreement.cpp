// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ranks/agreement.hpp>

#include <array>
#include <bit>
#include <cstdio>

#include <nestgrid/error.hpp>
#include <nestgrid/keys.hpp>
#include <surfaces/simplex_tally.hpp>
#include <walk/frontier.hpp>

namespace nestgrid::engine {

namespace {

std::string as_text(const Bytes& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Bytes as_bytes(const std::string& text) {
    const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
    return {begin, begin + text.size()};
}

[[noreturn]] void fail(Outcome::Kind kind, const std::string& sentence) {
    switch (kind) {
        case Outcome::Kind::invalid_input:
            throw InvalidInput(sentence);
        case Outcome::Kind::grid_error:
            throw GridError(sentence);
        case Outcome::Kind::io_error:
            throw IoError(sentence);
        default:
            throw std::runtime_error(sentence);
    }
}

std::uint64_t hash_of(const std::string& text) {
    std::uint64_t sum = text.size();
    for (const char c : text) sum = nestgrid::detail::mix64(sum + static_cast<unsigned char>(c));
    return sum;
}

/// \param asked what each rank is asked for, not all the same
[[noreturn]] void refuse_different(const std::vector<Bytes>& asked) {
    std::size_t other = 1;
    while (other + 1 < asked.size() && asked[other] == asked[0]) ++other;
    throw InvalidInput("all ranks must ask for the same, but rank 0 asks for " + as_text(asked[0]) +
                       ", and rank " + std::to_string(other) + " for " + as_text(asked[other]));
}

/// A number whose order is that of doubles.
std::uint64_t in_order(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    return (bits >> 63U) != 0 ? ~bits : bits | std::uint64_t{1} << 63U;
}
double from_order(std::uint64_t bits) {
    const std::uint64_t sign = std::uint64_t{1} << 63U;
    return std::bit_cast<double>((bits & sign) != 0 ? bits & ~sign : ~bits);
}

}  // namespace

Outcome Outcome::of_exception() {
    try {
        throw;
    } catch (const Cancelled&) {
        return {Kind::cancelled, {}};
    } catch (const OverLimit&) {
        return {Kind::over_limit, {}};
    } catch (const InvalidInput& e) {
        return {Kind::invalid_input, e.what()};
    } catch (const GridError& e) {
        return {Kind::grid_error, e.what()};
    } catch (const IoError& e) {
        return {Kind::io_error, e.what()};
    } catch (const std::exception& e) {
        return {Kind::other, e.what()};
    } catch (...) {
        return {Kind::other, "something was thrown that is no std::exception"};
    }
}

void settle(Ranks& ranks, const std::string& asked, const Outcome& own) {
    const auto none = static_cast<std::uint64_t>(ranks.size());
    const auto here = static_cast<std::uint64_t>(ranks.rank());
    const bool failed = own.kind > Outcome::Kind::cancelled;
    const auto where = [&](bool is) { return is ? here : none; };
    const std::uint64_t hash = hash_of(asked);
    std::array<std::uint64_t, 5> least{where(failed), where(own.kind == Outcome::Kind::cancelled),
                                       where(own.kind == Outcome::Kind::over_limit), hash, ~hash};
    ranks.reduce(least, Ranks::Reduction::min);
    if (least[0] < none) {
        Bytes told;
        if (least[0] == here) {
            told = as_bytes(own.sentence);
            put(told, own.kind);
        }
        Bytes failure = ranks.gather(std::move(told))[static_cast<std::size_t>(least[0])];
        const auto kind = static_cast<Outcome::Kind>(failure.back());
        failure.pop_back();
        fail(kind, "rank " + std::to_string(least[0]) + ": " + as_text(failure));
    }
    if (least[1] < none) throw Cancelled{};
    if (least[2] < none) throw OverLimit{};
    if (least[3] != ~least[4]) refuse_different(ranks.gather(as_bytes(asked)));
}

std::string all_digits(double number) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.17g", number);
    return text.data();
}

void take_sums(Ranks& ranks, std::span<std::uint64_t*> numbers) {
    std::vector<std::uint64_t> all;
    for (const std::uint64_t* number : numbers) all.push_back(*number);
    ranks.reduce(all, Ranks::Reduction::sum);
    for (std::size_t i = 0; i < all.size(); ++i) *numbers[i] = all[i];
}

void take_greatest(Ranks& ranks, std::span<double*> numbers) {
    std::vector<std::uint64_t> all;
    for (const double* number : numbers) all.push_back(in_order(*number));
    ranks.reduce(all, Ranks::Reduction::max);
    for (std::size_t i = 0; i < all.size(); ++i) *numbers[i] = from_order(all[i]);
}

}  // namespace nestgrid::engine
