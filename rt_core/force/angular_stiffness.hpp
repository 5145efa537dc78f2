// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/frame_input.hpp"

namespace tactus
{

/// Of the spring that turns a tool's proxy and its hand to each other: what ToolSpec sets, or the
/// stiffness times the square of the arm that core and radius measure. 0 for a sphere, which
/// nothing turns.
[[nodiscard]] double angular_stiffness_nm_per_rad(const ToolSpec& spec) noexcept TACTUS_NONBLOCKING;

/// How far from the tool's place a surface may touch it, at most; 0 for a sphere. What damps a
/// surface by B damps the tool's turning by at most B x the square of this.
[[nodiscard]] double angular_lever_m(const ToolSpec& spec) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
