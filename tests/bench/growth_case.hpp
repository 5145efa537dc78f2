// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

struct GrowthLawCase
{
    std::vector<std::uint32_t> quick_faces; ///< Of bumpy spheres, ascending.
    std::vector<std::uint32_t> faces;       ///< Without --quick.
};
/// What a slide costs on one surface of more and more faces, what encoding it does, and the
/// exponent of each figure: that of n in the power law that fits it best.
[[nodiscard]] CaseFailure run_growth_law_case(const CaseContext& context,
                                              const GrowthLawCase& test_case);

/// The exponent b of the power law a n^b with the least squares of the logarithms.
[[nodiscard]] double fitted_exponent(const std::vector<double>& n,
                                     const std::vector<double>& values);

} // namespace tactus::bench
