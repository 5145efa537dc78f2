// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

// Any thread: values.
namespace tactus
{

/// A mesh on the integer grid: what the certificate is built on and what full refinement returns.
/// Every edge is shared by at most two faces with opposite directions and every vertex has one fan
/// (open or closed): 2-manifold with borders. Two vertices may share a position.
struct QuantisedMesh
{
    std::vector<std::array<std::int32_t, 3>> positions; ///< In quanta, 0 .. 2^bits - 1.
    std::vector<std::array<std::uint32_t, 3>> faces;    ///< Three different vertices each.
};

} // namespace tactus
