// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"

#include <cstdint>
#include <vector>

namespace tactus::test
{

/// Forest of a model with all records loaded, driven record by record. An unjustified refusal by
/// the forest ends the test program with a line.
class LoadedForest
{
public:
    explicit LoadedForest(const TestModel& model);

    [[nodiscard]] VertexForest& forest() { return rig_.model().forest; }
    [[nodiscard]] AbTree& tree() { return rig_.model().tree; }
    [[nodiscard]] PageTable& pages() { return rig_.model().pages; }
    [[nodiscard]] ModelCounts counts() { return rig_.model().header.counts(); }
    [[nodiscard]] RecordId random_record(Random& random)
    {
        return {random.below(counts().records)};
    }

    /// Splits a record and its dependencies; returns their number.
    std::uint32_t split_with_dependencies(RecordId target);
    void split_everything(Random& random);
    /// Merges repeatedly from random starts until nothing can be merged; returns the number.
    std::uint32_t merge_everything(Random& random);

    [[nodiscard]] std::vector<PrimId> active();

private:
    FrameRig rig_;
};

} // namespace tactus::test
