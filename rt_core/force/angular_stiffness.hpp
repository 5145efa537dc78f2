// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/frame_input.hpp"

namespace tactus
{

/// Stiffness of the rotational spring between a tool's proxy and its device. Without a value in
/// `spec` it is the stiffness times the square of core radius plus tool radius. 0 for a sphere,
/// which has no rotation.
[[nodiscard]] double angular_stiffness_nm_per_rad(const ToolSpec& spec) noexcept TACTUS_NONBLOCKING;

/// Bound, in metres, on the distance from the tool's position at which a surface may touch the
/// tool; 0 for a sphere. A surface damping of B damps the tool's rotation by at most B x the square
/// of this bound.
[[nodiscard]] double angular_lever_m(const ToolSpec& spec) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
