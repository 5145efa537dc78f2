// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/controller.hpp"
#include "platform/loop/run_statistics.hpp"
#include "platform/plot/relief.hpp"

namespace tactus::hrtc
{

/// Where the tools were and with what force, and the base meshes of the objects that are nearest to
/// their ways, as they stood at the start. For once the loop has ended.
[[nodiscard]] plot::Relief relief_of(const Controller& controller, const RunStatistics& statistics);

} // namespace tactus::hrtc
