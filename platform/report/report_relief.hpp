// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/controller.hpp"
#include "platform/loop/run_statistics.hpp"
#include "platform/plot/relief.hpp"

namespace tactus::hrtc
{

/// Picture of the tools' paths with their forces, and of the base meshes of the nearest objects at
/// their first poses. Call it once the loop has ended.
[[nodiscard]] plot::Relief relief_of(const Controller& controller, const RunStatistics& statistics);

} // namespace tactus::hrtc
