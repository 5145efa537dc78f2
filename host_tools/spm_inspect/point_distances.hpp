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

/// Reads points as text, x y z in metres on each line; blank lines and those that begin with # are
/// ignored. A refusal names the line.
[[nodiscard]] Result<std::vector<Vec3>, Refusal> parse_points(std::string_view text);

/// Prints the distances of the points of a file to a model's surface, one line each in their order,
/// or all as one JSON object. Returns the reason if it fails.
[[nodiscard]] std::optional<std::string>
print_distances(const std::string& model_file, const std::string& point_file, bool as_json);

} // namespace tactus
