// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/records/prediction.hpp"
#include "rt_core/records/region_ranking.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// Motion of a pair's tool in one frame. Model frame, SI.
struct PairMotion
{
    Vec3 center_m{0.0, 0.0, 0.0};  ///< Centre of the core at the proxy.
    Vec3 way_m{0.0, 0.0, 0.0};     ///< Vector from there to the device's goal.
    double speed_max_m_per_s{0.0}; ///< Limit of the tool's speed towards its goal.
    double elapsed_s{0.0};         ///< Time since the last frame; > 0.
    /// Direction from the surface of the last query to the tool, and the tool's distance from
    /// contact; zero if no surface is near.
    Vec3 outward{0.0, 0.0, 0.0};
    double gap_m{0.0};
};

/// Contact-region prediction: the place of this pair's tool after the time that loading takes. One
/// instance per pair of tool and object; haptic thread.
///
/// Every method predicts the tool's place after the prediction horizon. At the horizon's end each
/// forecast is compared with the actual place, and a new one is made. A method's recent error
/// widens its spheres, at most to twice the size. Automatic choice takes the method with the least
/// error.
class RegionPredictor
{
public:
    /// Takes the tool's motion in a frame; `horizon_s` > 0 is the present prediction horizon, the
    /// time that a request takes.
    void observe(const PairMotion& motion, double horizon_s) noexcept TACTUS_NONBLOCKING;

    /// Adds the spheres to the ranking, highest priority first, each widened by `reach_m`. They are
    /// added at their present place, and moved with the core's centre at each quarter of the
    /// horizon. The path of a tool that had to wait thus has no gap.
    void rank(Prediction way, ModelId model, const CoreCover& spheres, double reach_m,
              RegionRanking& ranking) const noexcept TACTUS_NONBLOCKING;

    /// Adds the spheres at their present place only, without a prediction.
    static void rank_present(ModelId model, const CoreCover& spheres, double reach_m,
                             RegionRanking& ranking) noexcept TACTUS_NONBLOCKING;

    /// Velocity of the device's goal.
    [[nodiscard]] const Vec3& velocity_m_per_s() const noexcept { return velocity_; }
    /// Method in use for Prediction::automatic.
    [[nodiscard]] Prediction limited() const noexcept { return limited_; }

private:
    void follow_device() noexcept;
    void judge_forecasts() noexcept;
    [[nodiscard]] Vec3 way_in(Prediction way, double horizon_s) const noexcept;
    [[nodiscard]] double error_of(Prediction way) const noexcept
    {
        return errors_m_[static_cast<std::size_t>(way)];
    }

    PairMotion motion_;
    double horizon_s_{0.0};
    Vec3 device_m_{0.0, 0.0, 0.0};
    Vec3 velocity_{0.0, 0.0, 0.0};
    Vec3 acceleration_{0.0, 0.0, 0.0};
    bool has_device_{false};
    /// Forecast of each method, due in forecast_left_s_.
    std::array<Vec3, kPredictions> forecasts_m_{};
    double forecast_left_s_{0.0};
    bool has_forecasts_{false};
    std::array<double, kPredictions> errors_m_{};
    Prediction limited_{Prediction::linear};
};

} // namespace tactus
