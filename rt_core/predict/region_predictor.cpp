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

void RegionPredictor::rank(ModelId model, const CoreCover& balls, double reach_m,
                           RegionRanking& ranking) const noexcept
{
    const auto add = [&](const Vec3& way, double wider_m, std::int64_t lead_ns)
    {
        for (const Ball& ball : balls)
        {
            // A full ranking leaves the later pairs' balls out: they come on demand.
            static_cast<void>(
                ranking.try_push_back({model, ball.center + way, ball.radius + wider_m, lead_ns}));
        }
    };
    add(Vec3(0.0, 0.0, 0.0), reach_m, 0);
    for (const std::int64_t lead_ns : kLeads_ns)
    {
        const Vec3 way = velocity_ * (static_cast<double>(lead_ns) * 1e-9);
        add(way, reach_m + 0.1 * way.norm(), lead_ns);
    }
}

} // namespace tactus
