// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

/// Points as text, x y z in metres on each line; blank lines and those that begin with # say
/// nothing. Refused by the number of the line.
[[nodiscard]] Result<std::vector<Vec3>, Refusal> parse_points(std::string_view text);

/// Prints how far the points of a file are from a model's surface, a line each in their order, or
/// all as one JSON object. Returns why it could not.
[[nodiscard]] std::optional<std::string>
print_distances(const std::string& model_file, const std::string& point_file, bool as_json);

} // namespace tactus
