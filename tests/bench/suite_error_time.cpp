// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The suite `error_time`: run time against error. On which models; what is varied is in
/// error_time_case.cpp.

#include "tests/bench/error_time_case.hpp"
#include "tests/bench/suites.hpp"

namespace tactus::bench
{

namespace
{

constexpr SceneSource kFandisk{"fandisk-13k", "fandisk.obj", 0, 12'946};
constexpr SceneSource kIgea{"igea-269k", "igea.ply", 0, 268'686};

std::vector<Case> error_time_cases()
{
    const auto on = [](When when, const SceneSource& scene, double pool_mib) {
        return make_case(scene.name, when, run_error_time_case, ErrorTimeCase{scene, pool_mib});
    };
    using enum When;
    return {on(full_only, kFandisk, 2.0), on(always, kBunny, 2.0), on(full_only, kIgea, 2.0),
            on(full_only, kFineBunny, 4.0), on(named_only, kTiny, 1.0)};
}

} // namespace

Suite error_time_suite()
{
    return {"error_time", error_time_cases};
}

} // namespace tactus::bench
