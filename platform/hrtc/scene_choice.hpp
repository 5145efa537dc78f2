// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "platform/hrtc/options.hpp"

#include <optional>

namespace tactus::hrtc
{

/// Reads the scene file that the options name, when they name one, and puts its models and objects
/// in their places. Returns why it can't be used.
[[nodiscard]] std::optional<Refusal> take_scene(Options& options);

} // namespace tactus::hrtc
