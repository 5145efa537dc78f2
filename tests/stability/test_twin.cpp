// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I4: within the certified radius everything equals the full mesh bit for bit. Most frames are
/// certified, so that the claim is not empty.

#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/random.hpp"
#include "tests/stability/twin_trial.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace tactus::test
{

namespace
{

class Twin : public testing::TestWithParam<std::size_t>
{
};

TEST_P(Twin, certified_answers_are_those_of_the_full_mesh_to_the_last_bit)
{
    constexpr std::uint32_t kFrames = 1'500;
    const TestModel& model = small_model(GetParam());
    const FaceTree tree(model.faces);
    const TwinFigures sut =
        run_twin_trial({model, tree, seed_of(20'261'300 + GetParam()), kFrames});
    std::printf("%s\n%s\n%s\n", sut.identity.summary().c_str(), sut.cores.summary().c_str(),
                sut.uncertified.summary().c_str());
    EXPECT_GT(sut.identity.trials, kFrames / 2);
    EXPECT_TRUE(sut.identity.holds());
    EXPECT_GT(sut.cores.trials, kFrames / 4);
    EXPECT_TRUE(sut.cores.holds());
    EXPECT_TRUE(sut.uncertified.holds());
}

// Smooth, round, open and sharp models; needles never fit the pools as a whole.
INSTANTIATE_TEST_SUITE_P(small_models, Twin, testing::Range<std::size_t>(0, 4));

TEST(TwinOfALiar, is_told_apart_from_the_full_mesh)
{
    const TestModel& model =
        lying_model("liar", make_shape(Shape::bumpy_sphere, 4'000).value(), 0.0);
    const FaceTree tree(model.faces);
    const TwinFigures sut = run_twin_trial({model, tree, seed_of(20'261'310), 1'500});
    EXPECT_GT(sut.identity.violations, 10U);
    EXPECT_GT(sut.cores.violations, 10U);
}

} // namespace

} // namespace tactus::test
