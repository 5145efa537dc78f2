// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "tests/shared/period.hpp"

namespace tactus::hrtc::test
{

inline constexpr Duration kPeriod = milliseconds(1);
using tactus::test::kPeriod_s;

} // namespace tactus::hrtc::test
