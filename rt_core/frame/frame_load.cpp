// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The frame's first stage, T_L: adopt what has come, predict, ask.

#include "rt_core/frame/frame.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// From the arrival of chunks to a certified surface, after a jump at 1.1 M faces some frames: what
/// is asked for has to be here this much before the tool is.
constexpr double kRefineTime_s = 0.008;
/// No hand can be foretold for longer.
constexpr double kLongestLead_s = 0.15;

} // namespace

/// How far ahead this model's chunks have to be asked for.
double Frame::lead_s(ModelId model) const noexcept
{
    const double latency_s = models_[model.value]->cache.latency().most_frames() *
                             static_cast<double>(period_ns_) * 1e-9;
    return std::min(latency_s + kRefineTime_s, kLongestLead_s);
}

/// What the predictor is told of a pair.
PairMotion Frame::motion_of(const ScenePair& pair) const noexcept
{
    const ObjectPose& pose = last_poses_[pair.object];
    PairMotion motion;
    motion.center_m = pair.core.center();
    motion.way_m = to_model(pose, goals_[pair.tool]) - to_model(pose, position_of(pair.tool));
    motion.speed_max_m_per_s = scene_.tools()[pair.tool].speed_max_m_per_s / pose.scale;
    motion.elapsed_s = elapsed_s_[pair.tool];
    if (pair.has_known && !pair.known.nearest_face.is_none())
    {
        const Vec3 apart = pair.known.tool_point_m - pair.known.nearest_point_m;
        const double distance = apart.norm();
        if (distance > 0.0)
        {
            motion.outward = apart / distance;
            motion.gap_m = std::max(distance - radius_of(pair.tool) / pose.scale, 0.0);
        }
    }
    return motion;
}

void Frame::load(const Budgets& budgets) noexcept
{
    RegionRanking ranking;
    for (std::uint32_t i = 0; i < scene_.pairs().size(); ++i)
    {
        const ScenePair& pair = scene_.pairs()[i];
        const ModelId object = model_of(pair);
        const ModelId tool = tool_model_of(pair);
        if (is_complete(object) && (tool.is_none() || is_complete(tool)))
        {
            continue;
        }
        predictors_[i].observe(motion_of(pair), lead_s(object));
        if (MeshPair* mesh = mesh_pair(i); mesh != nullptr)
        {
            mesh->rank(pair, tool, object, predictors_[i], prediction_, ranking);
            continue;
        }
        if (variant_.asks_ahead)
        {
            predictors_[i].rank(prediction_, object, pair.cover, pair.reach_m, ranking);
        }
        else
        {
            RegionPredictor::rank_present(object, pair.cover, pair.reach_m, ranking);
        }
    }
    for (std::uint32_t i = 0; i < model_count_; ++i)
    {
        Model& model = *models_[i];
        model.work = WorkCounters{};
        model.cache.adopt_arrivals(budgets.pages, frame_, model.work);
        door_takes_[i] = model.cache.taken();
        model.pages_used_max = std::max(model.pages_used_max, model.pages.used());
        RegionRanking regions;
        for (const RankedRegion& region : ranking)
        {
            if (region.model.value == i && model.may_ask_for(region))
            {
                regions.push_back(region);
            }
        }
        if (model.residence != Residence::complete)
        {
            model.cache.request_missing(regions.view(), budgets, frame_, model.work, faults_);
        }
        if (model.residence == Residence::filling)
        {
            model.cache.request_everything(budgets, model.work, faults_);
        }
    }
}

} // namespace tactus
