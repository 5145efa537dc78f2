// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/priority.hpp"
#include "rt_core/spm/ids.hpp"

#include <cstdint>

namespace tactus
{

/// A sphere of a model that a tool may touch now, or after `horizon_ns` at its present velocity.
/// Model frame, metres.
struct RankedRegion
{
    ModelId model{};
    Vec3 center_m{0.0, 0.0, 0.0};
    double radius_m{0.0};
    std::int64_t horizon_ns{0};
    PriorityClass of{PriorityClass::touching}; ///< Priority class of the pair that may touch here.
};

/// The regions of one frame, highest priority first.
struct RegionRanking : StaticVector<RankedRegion, kMaxRankedRegions>
{
    bool lacks_present{false}; ///< True if a sphere at a tool's present place did not fit.
};

} // namespace tactus
