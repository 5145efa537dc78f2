// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus::test
{

/// Period of the frames in tests, unless a test is about another one.
inline constexpr double kPeriod_s = 1e-3;

} // namespace tactus::test
