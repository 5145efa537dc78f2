// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"

#include <string>

namespace tactus::hrtc
{

/// What is to be touched, where, and what each tool can do there: a line for each object, or one
/// for many, and one for each tool. What will come to nothing says so, as does what was left to its
/// default where others were not.
[[nodiscard]] std::string start_lines(const Options& options, const Controller& controller);

} // namespace tactus::hrtc
