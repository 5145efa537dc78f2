// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/model_life.hpp"
#include "rt_core/records/region_ranking.hpp"

#include <optional>
#include <span>

namespace tactus
{

class Pair;
struct FrameAccount;
struct FrameParts;
struct FrameSetup;

/// First stage of a frame: ranks the regions that tools may touch, adopts arrivals, loads and
/// removes streamed models, and requests missing chunks of the regions. Haptic thread. Cost: linear
/// in the pages adopted and the index pages searched, which Budgets limits. From median to
/// 99th percentile 0.4 to 13 us (docs/benchmarks.md).
class Loading
{
public:
    explicit Loading(const FrameSetup& setup) noexcept;

    /// Runs the stage; the pairs must be placed and ordered.
    void run(FrameParts& parts, FrameAccount& account) noexcept TACTUS_NONBLOCKING;

    /// Regions of the last run, highest priority first.
    [[nodiscard]] std::span<const RankedRegion> regions() const noexcept { return ranking_.view(); }

private:
    void rank(std::span<Pair* const> order) noexcept;

    RegionRanking ranking_;
    /// Life cycle of streamed models; none without capacity for them.
    std::optional<ModelLife> life_;
};

} // namespace tactus
