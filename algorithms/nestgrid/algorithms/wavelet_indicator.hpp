// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The wavelet indicator (paper, section 4.2): how much detail of its own frequency a node adds.
//
// Offsets are measured against values at coarser nodes, however noisy these are. Wavelet
// coefficients are measured against means: a transform from the finest nodes to the coarsest keeps
// the integral of the data (lifting.hpp), and eta of a node is the amplitude of its coefficient, in
// units of the data, or the coefficient's part of the L2 norm. At the finest nodes coefficients are
// offsets. The projection itself keeps true values and interpolates, as it always does: a wavelet
// synthesis needs coefficients of all elements around a node, which no element knows on the way
// down. At threshold 0 the projection is U.
// Memory, while it is made: about 130 bytes a node more than swept_indicator.hpp says.
#pragma once

#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

/// How a coefficient becomes a number.
enum class WaveletNorm : std::uint8_t {
    amplitude,  ///< |d|, in units of the data
    square,     ///< |d| times the root of the integral of the hat function at the node
};

/// What wavelet_indicator may be told.
struct WaveletOptions {
    WaveletNorm norm = WaveletNorm::amplitude;
    Spread spread{};
};

/// The indicator of component 0.
/// \throw InvalidInput where a value of the field is not finite, and for a spread as in
///        measured_indicator()
SweptIndicator wavelet_indicator(const FieldOnGrid& field, const WaveletOptions& options = {});

}  // namespace nestgrid
