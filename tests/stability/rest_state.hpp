// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/forest/vertex_forest.hpp"

#include <cstdint>
#include <string>

namespace tactus::test
{

/// What must be the same whenever nothing is refined.
struct RestState
{
    std::uint64_t hash{0};
    std::uint32_t refined{0};
    std::uint32_t faces{0};
    std::uint32_t blocks{0};
    std::uint32_t nodes{0};

    /// Blocks merge later than they part, so that a face that comes and goes moves nothing: which
    /// blocks there are tells of what was before. They may not become more and more.
    [[nodiscard]] bool is_again(const RestState& start) const
    {
        return hash == start.hash && refined == start.refined && faces == start.faces &&
               blocks <= 2 * start.blocks && nodes <= 2 * start.nodes;
    }
};

[[nodiscard]] inline RestState state_of(const VertexForest& forest, const AbTree& tree)
{
    return {forest.state_hash(), forest.refined_records(), forest.active_faces(),
            tree.blocks_used(), tree.nodes_used()};
}

[[nodiscard]] inline std::string describe(const RestState& now, const RestState& start)
{
    const auto one = [](const RestState& state)
    {
        return "hash " + std::to_string(state.hash) + ", records " + std::to_string(state.refined) +
               ", faces " + std::to_string(state.faces) + ", blocks " +
               std::to_string(state.blocks) + ", nodes " + std::to_string(state.nodes);
    };
    return one(now) + "; at the start " + one(start);
}

} // namespace tactus::test
