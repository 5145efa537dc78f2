// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus::test
{

/// Of the frames that tests count in, unless a test is about another.
inline constexpr double kPeriod_s = 1e-3;

} // namespace tactus::test
