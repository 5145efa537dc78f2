// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/records/region_ranking.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// Contact-region prediction by linear extrapolation: where will this pair's tool be after the time
/// that loading takes? One instance per pair of tool and object; haptic thread.
class RegionPredictor
{
public:
    /// The core's centre in the model's frame in this frame, `elapsed_s` > 0 after the one before.
    void observe(const Vec3& center_m, double elapsed_s) noexcept TACTUS_NONBLOCKING;

    /// Adds the balls to the ranking, each wider by `reach_m`: where they are, and then where they
    /// go with the core's centre in each lead time, widened by a tenth of the way (the velocity is
    /// an estimate).
    void rank(ModelId model, const CoreCover& balls, double reach_m,
              RegionRanking& ranking) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const Vec3& velocity_m_per_s() const noexcept { return velocity_; }

    /// Lead times: one round trip with a chunk on a local network, and a slower one.
    static constexpr std::array<std::int64_t, 2> kLeads_ns{15'000'000, 40'000'000};

private:
    /// Time constant of the velocity's smoothing: slower than hand tremor, faster than a turn.
    static constexpr double kSmoothing_s = 0.01;

    Vec3 center_{0.0, 0.0, 0.0};
    Vec3 velocity_{0.0, 0.0, 0.0};
    bool has_center_{false};
};

} // namespace tactus
