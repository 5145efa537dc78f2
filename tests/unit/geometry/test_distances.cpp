// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/kernel_trial.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <tuple>

namespace tactus::test
{

namespace
{

using Case = std::tuple<std::size_t, std::size_t>;

class ClosestPointsTest : public ::testing::TestWithParam<Case>
{
protected:
    [[nodiscard]] static const KernelTrial& kernel()
    {
        return kernel_trials()[std::get<0>(GetParam())];
    }
    [[nodiscard]] static const PairClass& kind() { return pair_classes()[std::get<1>(GetParam())]; }
    /// Cases; the oracles of boxes and round shapes are slow.
    [[nodiscard]] static int cases()
    {
        const std::string name = kernel().name;
        return name == "segment" || name == "triangle" ? cases_per_class() : cases_per_class() / 4;
    }
};

} // namespace

TEST_P(ClosestPointsTest, keep_the_error_law_and_lie_on_their_shapes)
{
    Random random(40 + std::get<0>(GetParam()));
    const TrialFigures sut = kernel().run(kind(), cases(), random);
    std::printf("%s\n", sut.summary().c_str());
    EXPECT_TRUE(sut.holds());
}

INSTANTIATE_TEST_SUITE_P(Kernels, ClosestPointsTest,
                         ::testing::Combine(::testing::Range<std::size_t>(0, kKernelTrials),
                                            ::testing::Range<std::size_t>(0, kPairClasses)),
                         [](const auto& one)
                         {
                             return std::string(kernel_trials()[std::get<0>(one.param)].name) +
                                    "_" + pair_classes()[std::get<1>(one.param)].name;
                         });

} // namespace tactus::test
