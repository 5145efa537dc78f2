// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/predict/region_predictor.hpp"

namespace tactus
{

void RegionPredictor::observe(const Vec3& center_m, double elapsed_s) noexcept
{
    TACTUS_ASSERT(elapsed_s > 0.0);
    if (has_center_)
    {
        const double weight = elapsed_s / (elapsed_s + kSmoothing_s);
        velocity_ += weight * ((center_m - center_) / elapsed_s - velocity_);
    }
    center_ = center_m;
    has_center_ = true;
}

void RegionPredictor::rank(ModelId model, double radius_m, RegionRanking& ranking) const noexcept
{
    // A full ranking leaves the later pairs' balls out: they come on demand.
    static_cast<void>(ranking.try_push_back({model, center_, radius_m, 0}));
    for (const std::int64_t lead_ns : kLeads_ns)
    {
        const Vec3 way = velocity_ * (static_cast<double>(lead_ns) * 1e-9);
        const double widened = radius_m + 0.1 * way.norm();
        static_cast<void>(ranking.try_push_back({model, center_ + way, widened, lead_ns}));
    }
}

} // namespace tactus
