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

/// What one frame knows of how a pair's tool moves. Model frame, SI.
struct PairMotion
{
    Vec3 center_m{0.0, 0.0, 0.0};  ///< Of the core, where the surface lets it be.
    Vec3 way_m{0.0, 0.0, 0.0};     ///< From there to where the hand has it.
    double speed_max_m_per_s{0.0}; ///< At which the tool comes after the hand.
    double elapsed_s{0.0};         ///< Since the frame before; > 0.
    /// The surface as the last query found it: towards the tool, and how far the tool is from
    /// touching it. Zero: nothing was near.
    Vec3 outward{0.0, 0.0, 0.0};
    double gap_m{0.0};
};

/// Contact-region prediction: where will this pair's tool be after the time that loading takes? One
/// instance per pair of tool and object; haptic thread.
///
/// All ways foretell the tool's place after the lead; when that time has come each is compared with
/// where the tool is, and foretells anew. What a way erred of late is how much wider its balls are
/// made, at most as much again, and the automatic choice is the way that erred least. So speed,
/// latency and noise decide by what they do to a forecast.
class RegionPredictor
{
public:
    /// `lead_s` > 0: how far ahead things have to be asked for at present.
    void observe(const PairMotion& motion, double lead_s) noexcept TACTUS_NONBLOCKING;

    /// Adds the balls to the ranking, most urgent first, each wider by `reach_m`: where they are,
    /// and where they go with the core's centre in each quarter of the lead, so that there is no
    /// gap on the way of a tool that had to wait.
    void rank(Prediction way, ModelId model, const CoreCover& balls, double reach_m,
              RegionRanking& ranking) const noexcept TACTUS_NONBLOCKING;

    /// Only where the balls are, of what stands still in its own frame.
    static void rank_present(ModelId model, const CoreCover& balls, double reach_m,
                             RegionRanking& ranking) noexcept TACTUS_NONBLOCKING;

    /// The hand's.
    [[nodiscard]] const Vec3& velocity_m_per_s() const noexcept { return velocity_; }
    /// What Prediction::automatic stands for at present.
    [[nodiscard]] Prediction believed() const noexcept { return believed_; }

private:
    void follow_hand() noexcept;
    void judge_forecasts() noexcept;
    [[nodiscard]] Vec3 way_in(Prediction way, double lead_s) const noexcept;
    [[nodiscard]] double error_of(Prediction way) const noexcept
    {
        return errors_m_[static_cast<std::size_t>(way)];
    }

    PairMotion motion_;
    double lead_s_{0.0};
    Vec3 hand_m_{0.0, 0.0, 0.0};
    Vec3 velocity_{0.0, 0.0, 0.0};
    Vec3 acceleration_{0.0, 0.0, 0.0};
    bool has_hand_{false};
    std::array<Vec3, kPredictions> forecasts_m_{}; ///< For forecast_left_s_ from now.
    double forecast_left_s_{0.0};
    bool has_forecasts_{false};
    std::array<double, kPredictions> errors_m_{};
    Prediction believed_{Prediction::linear};
};

} // namespace tactus
