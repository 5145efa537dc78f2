// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::detail
{

/// Edges and vertices that a split into manifold pieces changed.
struct ManifoldSplit
{
    std::size_t cut_edges{0};
    /// Original vertex of each added vertex.
    std::vector<std::uint32_t> copy_of;
};

/// Renumbers face corners until every edge has at most two faces, in opposite directions, and every
/// vertex one fan. New vertices are numbered from `vertex_count` on. Each face must have three
/// different vertices, and no two faces may be equal up to rotation. Linear, except for a sort
/// around each vertex.
[[nodiscard]] ManifoldSplit split_into_manifold(std::vector<std::array<std::uint32_t, 3>>& faces,
                                                std::uint32_t vertex_count);

} // namespace tactus::detail
