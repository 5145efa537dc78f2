// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/zone.hpp"
#include "rt_core/spm/index_page.hpp"
#include "transport/store/model_store.hpp"

#include <vector>

namespace tactus::test
{

/// A file's two-level index of influence boxes, all of it in memory.
class InfluenceIndex
{
public:
    /// The store must outlive it. Reads every index page.
    explicit InfluenceIndex(const ModelStore& store);

    /// What the index names for a zone, in ascending order.
    struct Named
    {
        std::vector<IndexPageId> pages;
        std::vector<ChunkId> chunks;
    };

    /// The pages whose boxes in the header meet the zone, and of those the chunks whose boxes do;
    /// for a ball by the controller's own decision. The zone is in metres of the model's frame.
    [[nodiscard]] Named named_by(const Zone& zone_m) const;

private:
    const ModelHeader& header_;
    std::vector<IndexPage> pages_;
};

} // namespace tactus::test
