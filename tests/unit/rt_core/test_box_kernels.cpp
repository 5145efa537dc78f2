// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/cache/index_search.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

namespace tactus::test
{

namespace
{

/// Index page in some part of the space, with spheres near it.
struct IndexScene
{
    QuantumBox page_box;
    IndexPage page;
    std::vector<WantedSphere> spheres;

    explicit IndexScene(Random& random)
    {
        page.chunks = kChunksPerIndexPage;
        const double side = std::exp2(random.between(4.0, 24.0));
        std::array<double, 3> middle{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            middle[axis] = std::floor(random.between(-0x1p23, 0x1p23));
            page_box.low[axis] = static_cast<std::int32_t>(middle[axis] - 0.5 * side);
            page_box.high[axis] = static_cast<std::int32_t>(middle[axis] + 0.5 * side);
        }
        for (std::uint32_t i = 0; i < page.chunks; ++i)
        {
            InfluenceBox box;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                box.low[axis] = static_cast<std::uint16_t>(random.below(65'536U));
                const std::uint32_t room = 65'535U - box.low[axis];
                box.high[axis] = static_cast<std::uint16_t>(
                    box.low[axis] + random.below(room / (random.one_in(4) ? 1 : 20) + 1));
            }
            page.set_box(i, box);
        }
        for (std::uint32_t i = 0; i < 1 + random.below(6U); ++i)
        {
            WantedSphere wanted;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                wanted.sphere.center[axis] = middle[axis] + random.between(-0.7, 0.7) * side;
            }
            wanted.sphere.radius = random.between(0.0, 0.3) * side;
            spheres.push_back(wanted);
        }
        if (random.one_in(4))
        {
            touch(random.below(64U));
        }
    }

    /// Moves a sphere to a box so that they touch, or nearly.
    void touch(std::uint32_t chunk)
    {
        QuantumSphere& sphere = spheres[0].sphere;
        const auto off = static_cast<double>(gap_to(chunk, {spheres.data(), 1}));
        sphere.radius = std::max(sphere.radius + off, 0.0);
    }

    /// Least distance of the spheres from a box, in extended precision; negative inside one.
    [[nodiscard]] long double gap_to(std::uint32_t chunk) const { return gap_to(chunk, spheres); }
    [[nodiscard]] long double gap_to(std::uint32_t chunk, std::span<const WantedSphere> from) const
    {
        long double least = 1e30L;
        for (const WantedSphere& wanted : from)
        {
            long double sum = 0.0L;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const auto step =
                    static_cast<long double>(index_step(page_box.low[axis], page_box.high[axis]));
                const long double low = page_box.low[axis] + step * page.low[axis][chunk];
                const long double high = page_box.low[axis] + step * page.high[axis][chunk];
                const auto at = static_cast<long double>(wanted.sphere.center[axis]);
                const long double gap = std::max({low - at, at - high, 0.0L});
                sum += gap * gap;
            }
            const auto radius = static_cast<long double>(wanted.sphere.radius);
            least = std::min(least, std::sqrt(sum) - radius);
        }
        return least;
    }
};

TEST(BoxKernels, decide_rightly_or_not_at_all_and_bound_the_gap_to_the_rest)
{
    Random random(4'308);
    std::uint32_t met = 0;
    std::uint32_t open = 0;
    std::uint32_t bounds = 0;
    for (int round = 0; round < 3'000; ++round)
    {
        const IndexScene scene(random);
        const SphereLanes lanes(scene.spheres, 1.0);
        const KernelPage page = lanes.page(scene.page_box);
        const std::uint32_t first = 8 * random.below(8U);
        const auto known = random.one_in(2) ? 0U : random.below(256U);
        std::vector<NearBoxes> all;
        for (const Kernels* kernels : available_kernels())
        {
            all.push_back(kernels->near_boxes(&scene.page.low[0][first], page, lanes.from(0),
                                              static_cast<std::uint32_t>(scene.spheres.size()),
                                              known));
            ASSERT_EQ(all.back().met, all[0].met) << kernels->name << " round " << round;
            ASSERT_EQ(all.back().open, all[0].open) << kernels->name << " round " << round;
            ASSERT_EQ(std::bit_cast<std::uint32_t>(all.back().gap),
                      std::bit_cast<std::uint32_t>(all[0].gap))
                << kernels->name << " round " << round;
        }
        const NearBoxes& near = all[0];
        ASSERT_EQ((near.met | near.open) & known, 0U);
        ASSERT_EQ(near.met & near.open, 0U);
        long double least = 1e30L;
        for (std::uint32_t i = 0; i < 8; ++i)
        {
            const long double gap = scene.gap_to(first + i);
            const auto slack = static_cast<long double>(page.slack);
            ASSERT_TRUE((near.met >> i & 1U) == 0 || gap <= 0.0L) << "round " << round;
            ASSERT_TRUE((near.open >> i & 1U) == 0 || std::abs(gap) <= 2.0L * slack)
                << "round " << round << ": too much is open";
            if (((near.met | near.open | known) >> i & 1U) == 0)
            {
                ASSERT_GT(gap, 0.0L) << "round " << round;
                least = std::min(least, gap);
            }
        }
        if (least < 1e30L)
        {
            ++bounds;
            ASSERT_LE(static_cast<long double>(near.gap), least) << "round " << round;
            ASSERT_GE(static_cast<long double>(near.gap),
                      least - 3.0L * static_cast<long double>(page.slack))
                << "round " << round;
        }
        met += near.met;
        open += near.open;
    }
    EXPECT_GT(met, 1'000U);
    EXPECT_GT(open, 0U);
    EXPECT_GT(bounds, 1'000U);
}

TEST(BoxKernels, decide_nothing_where_squares_are_no_numbers)
{
    Random random(4'309);
    IndexScene scene(random);
    scene.spheres.resize(1);
    for (const double far : {1e19, 1e30})
    {
        scene.spheres[0].sphere.radius = far;
        const SphereLanes lanes(scene.spheres, 1.0);
        const KernelPage page = lanes.page(scene.page_box);
        for (const Kernels* kernels : available_kernels())
        {
            const NearBoxes near =
                kernels->near_boxes(scene.page.low[0].data(), page, lanes.from(0), 1, 0x0FU);
            EXPECT_EQ(near.met, 0U) << kernels->name;
            EXPECT_EQ(near.open, 0xF0U) << kernels->name;
        }
    }
}

} // namespace

} // namespace tactus::test
