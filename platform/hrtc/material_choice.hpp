// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"

#include <optional>
#include <string_view>

namespace tactus::hrtc
{

/// What parse_material() takes; for messages.
inline constexpr std::string_view kMaterialForm =
    "STIFFNESS[,STATIC[,DYNAMIC[,DAMPING]]], or any of stiffness=, static=, dynamic= and damping=, "
    "with 1 to 3000 N/m, friction of 0 to 3, the dynamic one at most the static one, and 0 to 20 N "
    "s/m";

/// By name what is left out is as where nothing is said: the tool's stiffness, no friction, no
/// damping; a dynamic friction that is left out is the static one, in either form. None when the
/// text is of neither form, names a key twice, or has a value out of its range.
[[nodiscard]] std::optional<Material> parse_material(std::string_view text);

} // namespace tactus::hrtc
