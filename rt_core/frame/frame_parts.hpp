// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/frame/awake_pairs.hpp"
#include "rt_core/frame/frame_setup.hpp"
#include "rt_core/frame/model_set.hpp"
#include "rt_core/frame/tool_set.hpp"
#include "rt_core/frame/work_shares.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/scene/object_table.hpp"

namespace tactus
{

/// Data that all stages of a frame share: tools, objects, models, and the pairs of tools and
/// objects. Must not move, since pairs point at the other parts. Haptic thread.
struct FrameParts
{
    /// Reads base meshes and takes memory for all parts; the set-up must be valid. `models` is
    /// shorter than in the set-up if a base mesh is damaged, and empty if the arena only measures.
    FrameParts(Arena& arena, const FrameSetup& setup) noexcept;

    PairRules rules;
    ModelPools pools;
    ModelSet models;
    ObjectTable objects;
    ToolSet tools;
    AwakePairs pairs;
};

/// Limits, work and results of the present frame. Haptic thread.
struct FrameAccount
{
    Budgets budgets;
    WorkShares shares;
    WorkCounters work;
    FrameFault faults{FrameFault::none};
    /// Output on the scene; keeps the last frame's values until a stage replaces them.
    SceneOutput scene;

    void begin(const Budgets& given) noexcept TACTUS_NONBLOCKING
    {
        budgets = given;
        work = WorkCounters{};
        shares.begin(given.work, work.budget);
        faults = FrameFault::none;
        scene.walks = 0;
        scene.refused = {};
        scene.edits_refused = {};
    }
};

} // namespace tactus
