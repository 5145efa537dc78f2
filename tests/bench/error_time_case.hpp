// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

#include <cstdint>

namespace tactus::bench
{

struct ErrorTimeCase
{
    SceneSource scene;
    double pool_mib; ///< Of the settings that vary something else.
};
/// A measuring tool slides over the model. For every setting of ours, and for every peer over the
/// whole mesh and over coarser ones that our own simplifier makes of it: time against error,
/// memory and bytes on the wire.
[[nodiscard]] CaseFailure run_error_time_case(const CaseContext& context,
                                              const ErrorTimeCase& test_case);

} // namespace tactus::bench
