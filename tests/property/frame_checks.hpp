// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/frame_rig.hpp"
#include "tests/shared/frame_verdict.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tactus::test
{

inline void expect_all_budgets_kept(const FrameOutput& output, const Budgets& budgets)
{
    EXPECT_EQ(broken_budget(output, budgets).value_or(""), "");
}

/// Test of each of some small models with random numbers of its own; a failure names both.
template <std::uint64_t kFirstSeed>
class EachModel : public testing::TestWithParam<std::size_t>
{
protected:
    const TestModel& model_ = small_model(GetParam());
    const std::uint64_t seed_ = seed_of(kFirstSeed + GetParam());
    Random random_ = Random::seeded(seed_);

private:
    testing::ScopedTrace trace_{__FILE__, __LINE__, model_.name + " seed " + std::to_string(seed_)};
};
/// True if L <= d <= U against every face of the source, and an open answer has a named reason.
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
    if (const Verdict verdict = unexplained(output))
    {
        return testing::AssertionFailure() << *verdict;
    }
    return testing::AssertionSuccess();
}

/// Place outside at this distance from the model, in a random direction.
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
