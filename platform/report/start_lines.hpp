// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"

#include <string>

namespace tactus::hrtc
{

/// Lines on the objects and tools before the run: one for each object, or one for many, and one or
/// two for each tool. They warn of objects out of reach and of walls too soft to feel. They name
/// default places and materials if other objects have given ones.
[[nodiscard]] std::string start_lines(const Options& options, const Controller& controller);

} // namespace tactus::hrtc
