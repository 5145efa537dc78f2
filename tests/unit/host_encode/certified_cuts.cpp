// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_encode/certified_cuts.hpp"

#include "host_tools/encode/numbering.hpp"
#include "tests/shared/certificate_refinement.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/shared/test_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace tactus::test
{
namespace
{

using Visit = std::function<bool(const CertifiedCut&, const std::string&)>;

/// Possible rounding of the oracle: a millionth of the least bound.
constexpr double kTolerance_diag = 1e-13;

bool visit_rounds(const EncodedModel& model, std::uint32_t count, const Visit& visit)
{
    const Numbering numbering = number_model(model.prepared.mesh, model.simplification);
    ClosedCut cut(*model.decoded);
    auto collapse = model.simplification.collapses.rbegin();
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const double source_share = count > 1 ? static_cast<double>(i) / (count - 1) : 0.0;
        const double faces = std::pow(model.fields.base_faces, 1.0 - source_share) *
                             std::pow(model.fields.source_faces, source_share);
        while (collapse != model.simplification.collapses.rend() &&
               cut.replay().face_count() + 0.5 < faces)
        {
            EXPECT_EQ(cut.split_with_closure(numbering.record_of(*collapse)).size(), 1U);
            ++collapse;
        }
        const std::string name = "the last " + std::to_string(cut.split_count()) + " collapses";
        if (!visit(cut_of(*model.decoded, cut.replay()), name))
        {
            return false;
        }
    }
    return true;
}

/// Records in a random order, or by distance from one of them.
std::vector<RecordId> any_order(const DecodedModel& model, bool is_local, std::mt19937_64& random)
{
    std::vector<RecordId> order(model.header().counts().records);
    for (std::uint32_t i = 0; i < order.size(); ++i)
    {
        order[i] = {i};
    }
    std::shuffle(order.begin(), order.end(), random);
    if (is_local)
    {
        const Vec3 center_m = to_vec3(model.record(order.front()).position_m);
        const auto way = [&](RecordId id)
        { return (to_vec3(model.record(id).position_m) - center_m).squaredNorm(); };
        std::sort(order.begin(), order.end(),
                  [&](RecordId a, RecordId b) { return way(a) < way(b); });
    }
    return order;
}

void visit_random_cuts(const EncodedModel& model, std::uint32_t count, std::uint64_t seed,
                       const Visit& visit)
{
    std::mt19937_64 random(seed);
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const bool is_local = i % 2 == 1;
        const std::vector<RecordId> order = any_order(*model.decoded, is_local, random);
        const std::size_t splits = 1 + random() % order.size();
        ClosedCut cut(*model.decoded);
        for (auto id = order.begin(); cut.split_count() < splits; ++id)
        {
            cut.split_with_closure(*id);
        }
        const std::string name = std::to_string(cut.split_count()) +
                                 (is_local ? " local splits" : " random splits") + " of cut " +
                                 std::to_string(i);
        if (!visit(cut_of(*model.decoded, cut.replay()), name))
        {
            return;
        }
    }
}

} // namespace

void visit_cuts(const EncodedModel& model, std::uint32_t count, std::uint64_t seed,
                const Visit& visit)
{
    if (visit_rounds(model, count, visit))
    {
        visit_random_cuts(model, count, seed, visit);
    }
}

void expect_sound_bounds(const EncodedModel& model, std::uint32_t count, std::size_t points,
                         std::uint64_t seed)
{
    std::printf("[   seed   ] %s: %llu\n", model.name.c_str(),
                static_cast<unsigned long long>(seed));
    const std::vector<Face> source = faces_on_grid(model.prepared);
    SurfacePoints surface(source, seed);
    const double tolerance_m = kTolerance_diag * model.prepared.diagonal_m;
    std::size_t checked = 0;
    bool fifth_is_caught = false;
    bool zero_is_caught = false;
    visit_cuts(model, count, seed,
               [&](const CertifiedCut& cut, const std::string& name)
               {
                   const std::vector<Vec3> points_m = surface.draw(points);
                   const auto is_violated_by = [&](double factor) {
                       return find_violation(with_bounds_times(factor, cut), points_m, tolerance_m);
                   };
                   const auto violation = find_violation(cut, points_m, tolerance_m);
                   EXPECT_FALSE(violation) << model.name << ", seed " << seed << ", " << name
                                           << ": (" << violation->point_m.transpose() << ") is "
                                           << violation->excess_m << " m beyond every bound";
                   checked += points_m.size();
                   fifth_is_caught = fifth_is_caught || is_violated_by(0.8).has_value();
                   zero_is_caught = zero_is_caught || is_violated_by(0.0).has_value();
                   return !violation;
               });
    std::printf("[  points  ] %s: %zu\n", model.name.c_str(), checked);
    EXPECT_TRUE(fifth_is_caught) << model.name << ", seed " << seed;
    EXPECT_TRUE(zero_is_caught) << model.name << ", seed " << seed;
}

} // namespace tactus::test
