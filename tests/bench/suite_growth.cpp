// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The suite `growth`: how costs grow with the model.

#include "tests/bench/growth_case.hpp"
#include "tests/bench/suites.hpp"

namespace tactus::bench
{

namespace
{

std::vector<Case> growth_cases()
{
    return {make_case("sizes", When::always, run_growth_law_case,
                      GrowthLawCase{{4'000, 10'000, 40'000, 100'000},
                                    {4'000, 40'000, 400'000, 4'000'000}}),
            make_case("tiny", When::named_only, run_growth_law_case,
                      GrowthLawCase{{2'000, 4'000}, {2'000, 4'000}})};
}

} // namespace

Suite growth_suite()
{
    return {"growth", growth_cases};
}

} // namespace tactus::bench
