// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Samples of a volume and their types.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <nestgrid/error.hpp>

/// Calls function(std::span<const Sample>) with samples in their own type, or the same without
/// const.
/// \param type uint8, int8, ... uint64, int64, float32 or float64
/// \param data points to bytes, const or not
template <class Byte, class Function>
auto with_samples(const std::string& type, Byte* data, std::size_t count, Function&& function) {
    const auto call = [&]<class Sample>(Sample) {
        using Kept = std::conditional_t<std::is_const_v<Byte>, const Sample, Sample>;
        return function(std::span<Kept>(reinterpret_cast<Kept*>(data), count));
    };
    if (type == "uint8") return call(std::uint8_t{});
    if (type == "int8") return call(std::int8_t{});
    if (type == "uint16") return call(std::uint16_t{});
    if (type == "int16") return call(std::int16_t{});
    if (type == "uint32") return call(std::uint32_t{});
    if (type == "int32") return call(std::int32_t{});
    if (type == "uint64") return call(std::uint64_t{});
    if (type == "int64") return call(std::int64_t{});
    if (type == "float32") return call(float{});
    return call(double{});
}

/// Bytes of a sample; 0 for a type of another name.
inline std::size_t bytes_of(const std::string& type) {
    for (const char* name : {"uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64",
                             "int64", "float32", "float64"}) {
        if (type == name) return std::stoul(type.substr(type.find_first_of("123468"))) / 8;
    }
    return 0;
}
