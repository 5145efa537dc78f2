// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "tests/shared/random.hpp"

#include <optional>
#include <string>

namespace tactus::test
{

/// A core of each kind in turn, turned at random, about `size_m` large.
[[nodiscard]] PlacedCore twin_core(std::uint32_t turn, const Vec3& center_m, double size_m,
                                   Random& random);

/// What differs between what a core finds in a refined and in a whole mesh: its contacts within
/// `radius_m` and, of an exact answer, nearest points, normal and side. Empty when nothing does,
/// none when the refined mesh does not certify so much.
[[nodiscard]] std::optional<std::string> core_difference(const AbTree& refined, const AbTree& whole,
                                                         const PlacedCore& core, double radius_m,
                                                         bool is_closed);

} // namespace tactus::test
