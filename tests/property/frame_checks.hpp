// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/property/random.hpp"
#include "tests/shared/frame_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{

/// Every counter of a frame with one model and one pair against its budget, every pool against its
/// size. The refinement and the query each have the whole budget of nodes and triangles.
inline void expect_all_budgets_kept(const FrameOutput& output, const Budgets& budgets)
{
    const WorkCounters& work = output.work;
    EXPECT_LE(work.splits, budgets.splits) << "K";
    EXPECT_LE(work.merges, budgets.merges) << "K";
    EXPECT_LE(work.scanned, budgets.scanned) << "S";
    EXPECT_LE(work.nodes_visited, 3 * budgets.nodes) << "N";
    EXPECT_LE(work.triangles_tested, 3 * budgets.triangles) << "P";
    EXPECT_LE(work.pages_adopted, budgets.pages) << "A";
    EXPECT_LE(work.requests, budgets.requests + budgets.regions) << "Q, and G index pages";
    EXPECT_LE(work.regions_searched, budgets.regions) << "G";
    for (const ModelOutput& model : output.models)
    {
        for (const PoolUse& use :
             {model.pages, model.index_pages, model.faces, model.blocks, model.nodes})
        {
            EXPECT_LE(use.used, use.used_max);
            EXPECT_LE(use.used_max, use.capacity);
        }
    }
}

/// L <= d <= U against every face of the source, and an open question has a named reason.
[[nodiscard]] inline testing::AssertionResult answer_is_sound(const TestModel& model,
                                                              const FrameOutput& output)
{
    const PairOutput& pair = output.pairs[0];
    const long double truth = brute_distance(pair.point_m, model.faces);
    if (!(static_cast<long double>(pair.lower_m) <= truth &&
          truth <= static_cast<long double>(pair.upper_m)))
    {
        return testing::AssertionFailure() << "L " << pair.lower_m << ", d "
                                           << static_cast<double>(truth) << ", U " << pair.upper_m;
    }
    constexpr FrameFault kReasons = FrameFault::split_budget_spent | FrameFault::forest_full |
                                    FrameFault::tree_full | FrameFault::chunk_late |
                                    FrameFault::cache_full | FrameFault::node_budget_spent;
    if (pair.kind == AnswerKind::bracket && !has_fault(output.faults, kReasons))
    {
        return testing::AssertionFailure()
               << "a bracket, and nothing is said to have run out: L " << pair.lower_m << ", U "
               << pair.upper_m << ", certified to " << pair.certified_radius_m << ", faults "
               << static_cast<std::uint32_t>(output.faults) << ", splits " << output.work.splits
               << ", nodes " << output.work.nodes_visited << ", triangles "
               << output.work.triangles_tested;
    }
    return testing::AssertionSuccess();
}

/// A point outside at this distance from the model, reached from a random direction.
[[nodiscard]] inline Vec3 place_at_distance(const TestModel& model, Random& random,
                                            double distance_m)
{
    const Vec3 target = to_vec3(model.faces[random.below(model.faces.size())][0]);
    Vec3 place = target + random.in_cube(1.0).normalized() * 3.0 * model.diagonal_m;
    const Vec3 way = (target - place).normalized();
    for (int i = 0; i < 200; ++i)
    {
        const auto gap = static_cast<double>(brute_distance(place, model.faces)) - distance_m;
        place += way * gap;
        if (std::abs(gap) < 1e-6 * distance_m)
        {
            break;
        }
    }
    return place;
}

} // namespace tactus::test
