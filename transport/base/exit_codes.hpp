// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// Exit codes of every program.
inline constexpr int kExitDone = 0;
inline constexpr int kExitCriterionNotMet = 1;
inline constexpr int kExitFailed = 2;
inline constexpr int kExitUsage = 3;

} // namespace tactus
