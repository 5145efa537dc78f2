// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/predict/region_predictor.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Time constants of the smoothed velocity and acceleration: slower than a tremor, faster than a
/// change of direction.
constexpr double kVelocityTime_s = 0.01;
constexpr double kAccelerationTime_s = 0.02;
/// Weight of the newest error in a method's moving average.
constexpr double kNewestError = 0.2;
/// Share of the present method's error below which another method replaces it.
constexpr double kClearlyBetter = 0.9;
/// Largest widening of a predicted sphere, as a share of its reach_m. The number of its pages grows
/// with the square, and a worse forecast is not worth them. Half and twice this value did worse at
/// 2 model diagonals a second.
constexpr double kWidest = 1.0;
/// Shares of the prediction horizon after which places are predicted.
constexpr std::array<double, 4> kLeads{0.25, 0.5, 0.75, 1.0};

/// Adds each sphere, moved by `moved.center_m` and widened by `moved.radius_m`. A full ranking
/// drops it, and reports that only for a tool's present place.
void add_spheres(const RankedRegion& moved, const CoreCover& spheres,
                 RegionRanking& ranking) noexcept
{
    for (const Sphere& sphere : spheres)
    {
        const bool has_room =
            ranking.try_push_back({moved.model, sphere.center + moved.center_m,
                                   sphere.radius + moved.radius_m, moved.horizon_ns});
        ranking.lacks_present = ranking.lacks_present || (!has_room && moved.horizon_ns == 0);
    }
}

} // namespace

void RegionPredictor::observe(const PairMotion& motion, double horizon_s) noexcept
{
    TACTUS_ASSERT(motion.elapsed_s > 0.0 && horizon_s > 0.0);
    motion_ = motion;
    horizon_s_ = horizon_s;
    follow_device();
    forecast_left_s_ -= motion.elapsed_s;
    if (forecast_left_s_ < 0.5 * motion.elapsed_s)
    {
        judge_forecasts();
    }
}

void RegionPredictor::follow_device() noexcept
{
    const Vec3 device_m = motion_.center_m + motion_.way_m;
    const double elapsed_s = motion_.elapsed_s;
    if (has_device_)
    {
        const Vec3 before = velocity_;
        velocity_ += elapsed_s / (elapsed_s + kVelocityTime_s) *
                     ((device_m - device_m_) / elapsed_s - velocity_);
        acceleration_ += elapsed_s / (elapsed_s + kAccelerationTime_s) *
                         ((velocity_ - before) / elapsed_s - acceleration_);
    }
    device_m_ = device_m;
    has_device_ = true;
}

void RegionPredictor::judge_forecasts() noexcept
{
    for (std::size_t i = 0; i < kPredictions; ++i)
    {
        if (has_forecasts_)
        {
            const double error_m = (forecasts_m_[i] - motion_.center_m).norm();
            errors_m_[i] += kNewestError * (error_m - errors_m_[i]);
        }
        forecasts_m_[i] = motion_.center_m + way_in(static_cast<Prediction>(i), horizon_s_);
    }
    has_forecasts_ = true;
    forecast_left_s_ = horizon_s_;
    for (std::size_t i = 0; i < kPredictions; ++i)
    {
        const auto way = static_cast<Prediction>(i);
        limited_ = error_of(way) < kClearlyBetter * error_of(limited_) ? way : limited_;
    }
}

/// Predicted displacement of the core's centre after `horizon_s`, limited by the tool's largest
/// speed.
Vec3 RegionPredictor::way_in(Prediction way, double horizon_s) const noexcept
{
    if (way == Prediction::local_neighbours)
    {
        return {0.0, 0.0, 0.0};
    }
    Vec3 velocity = velocity_;
    Vec3 ahead = motion_.way_m;
    if (way == Prediction::quadratic)
    {
        velocity += kVelocityTime_s * acceleration_; // Correction of the smoothing's lag.
        ahead += 0.5 * horizon_s * horizon_s * acceleration_;
    }
    ahead += horizon_s * velocity;
    if (way == Prediction::distance_query)
    {
        ahead -= std::min(ahead.dot(motion_.outward) + motion_.gap_m, 0.0) * motion_.outward;
    }
    const double most_m = horizon_s * std::max(motion_.speed_max_m_per_s, velocity.norm());
    const double far_m = ahead.norm();
    return far_m > most_m ? Vec3(ahead * (most_m / far_m)) : ahead;
}

void RegionPredictor::rank_present(ModelId model, const CoreCover& spheres, double reach_m,
                                   RegionRanking& ranking) noexcept
{
    add_spheres({model, Vec3(0.0, 0.0, 0.0), reach_m, 0}, spheres, ranking);
}

void RegionPredictor::rank(Prediction way, ModelId model, const CoreCover& spheres, double reach_m,
                           RegionRanking& ranking) const noexcept
{
    const Prediction chosen = way == Prediction::automatic ? limited_ : way;
    rank_present(model, spheres, reach_m, ranking);
    for (const double share : kLeads)
    {
        const double horizon_s = share * horizon_s_;
        const double wider_m = chosen == Prediction::local_neighbours ? horizon_s * velocity_.norm()
                                                                      : share * error_of(chosen);
        add_spheres({model, way_in(chosen, horizon_s),
                     reach_m + std::min(wider_m, kWidest * reach_m),
                     static_cast<std::int64_t>(horizon_s * 1e9)},
                    spheres, ranking);
    }
}

} // namespace tactus
