// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/zone.hpp"
#include "rt_core/spm/index_page.hpp"
#include "transport/store/model_store.hpp"

#include <vector>

namespace tactus::test
{

/// Two-level index of a file's influence boxes, entirely in memory.
class InfluenceIndex
{
public:
    /// Reads every index page. The store must outlive this object.
    explicit InfluenceIndex(const ModelStore& store);

    /// Pages and chunks of a zone, in ascending order.
    struct Named
    {
        std::vector<IndexPageId> pages;
        std::vector<ChunkId> chunks;
    };

    /// Pages whose boxes in the header meet the zone, and their chunks whose boxes do; for a sphere
    /// by the controller's own test. The zone is in metres of the model frame.
    [[nodiscard]] Named named_by(const Zone& zone_m) const;

private:
    const ModelHeader& header_;
    std::vector<IndexPage> pages_;
};

} // namespace tactus::test
