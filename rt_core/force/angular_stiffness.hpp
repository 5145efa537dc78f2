// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/frame_input.hpp"

namespace tactus
{

/// Of the spring that turns a tool's proxy and its hand to each other: the stiffness times the
/// square of the arm that core and radius measure. 0 for a sphere, which nothing turns.
[[nodiscard]] double angular_stiffness_nm_per_rad(const ToolSpec& spec) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
