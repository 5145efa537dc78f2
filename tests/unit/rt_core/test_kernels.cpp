// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/probe.hpp"
#include "tests/unit/rt_core/kernel_laws.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace tactus::test
{

namespace
{

std::string name_of(const KernelScene& scene)
{
    return std::string(scene.shape) + ", probe " + scene.place;
}

/// Answer of face_bounds(): the faces, the limit and the bounds' bits of the lanes in `mask`.
std::vector<std::uint32_t> face_bits(const Kernels& kernels, const KernelScene& scene,
                                     std::uint32_t mask, std::uint32_t exact, float floor,
                                     float limit)
{
    FaceBounds bounds;
    std::vector<std::uint32_t> bits{kernels.face_bounds(
        scene.coordinates(), scene.corners(), scene.probe, mask, exact, floor, limit, bounds)};
    bits.push_back(bits_of(limit));
    for (std::uint32_t lanes = mask; lanes != 0; lanes &= lanes - 1)
    {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        bits.push_back(bits_of(bounds.lower[lane]));
        bits.push_back(((exact >> lane) & 1U) == 0 ? bits_of(bounds.corner[lane]) : 0);
    }
    return bits;
}

/// Answer of child_gaps() and of both boxes.
std::vector<std::uint32_t> box_bits(const Kernels& kernels, const KernelScene& scene,
                                    std::uint32_t vertices, std::uint32_t children, float bound)
{
    alignas(32) std::array<float, kNodeChildren> gaps{};
    std::array<float, 6> block{};
    std::array<float, 6> node{};
    std::vector<std::uint32_t> bits{
        kernels.child_gaps(scene.box_rows(), scene.probe, children, bound, gaps.data())};
    kernels.block_box(scene.coordinates(), vertices, block.data());
    kernels.node_box(scene.box_rows(), children, node.data());
    for (std::uint32_t lanes = children; lanes != 0; lanes &= lanes - 1)
    {
        bits.push_back(bits_of(gaps[static_cast<std::size_t>(std::countr_zero(lanes))]));
    }
    for (std::size_t i = 0; i < 6; ++i)
    {
        bits.push_back(bits_of(block[i]));
        bits.push_back(bits_of(node[i]));
    }
    return bits;
}

/// Bound near the scene's distances, so that some lanes are near and others not; or none.
float random_bound(Random& random, const KernelScene& scene)
{
    const FaceTruth truth(scene, random.below(16));
    return random.one_in(4) ? std::numeric_limits<float>::infinity()
                            : static_cast<float>(truth.distance * 2.0L) *
                                  static_cast<float>(random.between(0.0, 1.0));
}

/// Distance to a child's box in quanta.
long double box_distance(const KernelScene& scene, std::uint32_t child)
{
    const Aabb box = scene.boxes.get(child);
    long double sum = 0.0L;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto at = static_cast<long double>(scene.point_m[static_cast<Eigen::Index>(axis)]);
        const long double gap = std::max({static_cast<long double>(box.low[axis]) - at,
                                          at - static_cast<long double>(box.high[axis]), 0.0L});
        sum += gap * gap;
    }
    return std::sqrt(sum) / static_cast<long double>(scene.quantum_m);
}

} // namespace

TEST(Kernels, are_the_portable_ones_first_and_each_set_has_its_name)
{
    ASSERT_FALSE(available_kernels().empty());
    EXPECT_EQ(available_kernels().front(), &portable_kernels());
    EXPECT_EQ(&best_kernels(), available_kernels().back());
    for (std::size_t i = 1; i < available_kernels().size(); ++i)
    {
        EXPECT_STRNE(available_kernels()[i]->name, available_kernels()[i - 1]->name);
    }
}

TEST(Kernels, of_every_set_give_the_same_bits_on_faces_and_boxes)
{
    Random random(70);
    for (const KernelScene& scene : scenes(random, 300))
    {
        const std::uint32_t mask = random_mask(random, 16);
        const std::uint32_t exact = random_mask(random, 16);
        const float floor = random.one_in(2) ? 0.0F : random_bound(random, scene);
        const float limit = random_bound(random, scene);
        ASSERT_NO_FATAL_FAILURE(expect_same_of_every_set(
            scene, [&](const Kernels& kernels)
            { return face_bits(kernels, scene, mask, exact, floor, limit); }));
        const std::uint32_t vertices = random_mask(random, 15);
        const std::uint32_t children = random_mask(random, 8);
        ASSERT_NO_FATAL_FAILURE(expect_same_of_every_set(
            scene, [&](const Kernels& kernels)
            { return box_bits(kernels, scene, vertices, children, limit); }));
    }
}

TEST(Kernels, bound_the_distance_to_faces_by_the_stated_law)
{
    Random random(72);
    for (const KernelScene& scene : scenes(random, 60))
    {
        for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
        {
            const LaneAnswer answer = ask_lane(portable_kernels(), scene, lane);
            ASSERT_EQ(law_fault(answer, FaceTruth(scene, lane), scene.probe), "")
                << name_of(scene) << ", lane " << lane << ", slack " << scene.probe.slack;
        }
    }
}

TEST(Kernels, law_would_tell_a_bound_that_is_off_by_a_thousandth_of_the_local_length)
{
    std::uint32_t tried = 0;
    Random random(73);
    for (const KernelScene& scene : scenes(random, 10))
    {
        const std::uint32_t lane = random.below(kBlockFaces);
        const FaceTruth truth(scene, lane);
        const float off = static_cast<float>(1e-3L * truth.local);
        const LaneAnswer right = ask_lane(portable_kernels(), scene, lane);
        if (truth.may_be_thin() || off <= 4.0F * scene.probe.slack)
        {
            continue; // These bounds are looser than a thousandth.
        }
        ++tried;
        const std::array<LaneAnswer, 6> wrong{{{right.lower + off, right.upper, right.corner},
                                               {right.lower - off, right.upper, right.corner},
                                               {right.lower, right.upper + off, right.corner},
                                               {right.lower, right.upper - off, right.corner},
                                               {right.lower, right.upper, right.corner + off},
                                               {right.lower, right.upper, right.corner - off}}};
        for (std::size_t i = 0; i < wrong.size(); ++i)
        {
            ASSERT_NE(law_fault(wrong[i], truth, scene.probe), "") << name_of(scene) << " " << i;
        }
    }
    EXPECT_GT(tried, 50U);
}

TEST(Kernels, name_the_faces_whose_lower_bound_is_within_limit_or_floor)
{
    Random random(74);
    for (const KernelScene& scene : scenes(random, 60))
    {
        const std::uint32_t mask = random_mask(random, 16);
        const std::uint32_t exact = random_mask(random, 16);
        const float floor = random.one_in(2) ? 0.0F : random_bound(random, scene);
        float limit = random_bound(random, scene);
        // After any face there is a limit, at most the greatest float.
        float expected_limit =
            mask == 0 ? limit : std::min(limit, std::numeric_limits<float>::max());
        std::uint32_t expected = 0;
        for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
        {
            const float upper = ask_lane(portable_kernels(), scene, lane).upper;
            const bool counts = ((mask & exact) >> lane & 1U) != 0;
            expected_limit = counts ? std::min(expected_limit, upper) : expected_limit;
        }
        for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
        {
            const float lower = ask_lane(portable_kernels(), scene, lane).lower;
            expected |= lower <= std::max(floor, expected_limit) ? 1U << lane : 0U;
        }

        FaceBounds bounds;
        const std::uint32_t near = portable_kernels().face_bounds(
            scene.coordinates(), scene.corners(), scene.probe, mask, exact, floor, limit, bounds);

        ASSERT_EQ(limit, expected_limit) << name_of(scene);
        ASSERT_EQ(near, expected & mask) << name_of(scene);
    }
}

TEST(Kernels, leave_out_no_face_whose_squares_are_beyond_float)
{
    Random random(75);
    for (KernelScene scene : scenes(random, 10))
    {
        const std::uint32_t mask = random_mask(random, 16);
        scene.probe.scale *= 0x1p96F;
        for (const Kernels* kernels : available_kernels())
        {
            FaceBounds bounds;
            float limit = 0.0F;
            ASSERT_EQ(kernels->face_bounds(scene.coordinates(), scene.corners(), scene.probe, mask,
                                           mask, 0.0F, limit, bounds),
                      mask)
                << kernels->name << ": " << name_of(scene);
        }
    }
}

TEST(Kernels, bound_the_distance_to_boxes_from_below_and_closely)
{
    Random random(76);
    for (const KernelScene& scene : scenes(random, 200))
    {
        const std::uint32_t mask = random_mask(random, 8);
        const float bound = random_bound(random, scene);
        alignas(32) std::array<float, kNodeChildren> gaps{};
        const std::uint32_t near =
            portable_kernels().child_gaps(scene.box_rows(), scene.probe, mask, bound, gaps.data());
        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            const long double truth = box_distance(scene, child);
            const auto gap = static_cast<long double>(gaps[child]);
            const auto slack = static_cast<long double>(scene.probe.slack);
            ASSERT_LE(gap, truth) << name_of(scene);
            ASSERT_GE(gap, truth * (1.0L - 0x1p-19L) - 2.0L * slack) << name_of(scene);
            const bool is_near = ((mask >> child) & 1U) != 0 && gaps[child] <= bound;
            ASSERT_EQ((near >> child) & 1U, is_near ? 1U : 0U) << name_of(scene);
        }
    }
}

TEST(Kernels, boxes_are_exact_whatever_stands_in_rows_that_do_not_count)
{
    Random random(77);
    for (const KernelScene& scene : scenes(random, 100))
    {
        const std::uint32_t vertices = random_mask(random, 15);
        const std::uint32_t children = random_mask(random, 8);
        Aabb of_vertices;
        Aabb of_children;
        for (std::size_t i = 0; i < 15; ++i)
        {
            const auto& rows = scene.block.coordinates;
            of_vertices.add(((vertices >> i) & 1U) == 0
                                ? Aabb{}
                                : Aabb{{rows[0][i], rows[1][i], rows[2][i]},
                                       {rows[0][i], rows[1][i], rows[2][i]}});
        }
        for (std::uint32_t i = 0; i < kNodeChildren; ++i)
        {
            of_children.add(((children >> i) & 1U) == 0 ? Aabb{} : scene.boxes.get(i));
        }
        for (const Kernels* kernels : available_kernels())
        {
            ASSERT_EQ(AabbVolume::of_vertices(*kernels, scene.coordinates(), vertices), of_vertices)
                << kernels->name << ": " << name_of(scene);
            ASSERT_EQ(AabbVolume::of_children(*kernels, scene.boxes, children), of_children)
                << kernels->name << ": " << name_of(scene);
        }
    }
}

} // namespace tactus::test

namespace tactus
{
namespace
{

constexpr float kQuantum_m = 0x1p-20F;
constexpr double kLimit_m = kFarQuanta * 0x1p-20;

TEST(Probe, is_within_the_kernels_range_below_the_limit_alone)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        for (const double sign : {-1.0, 1.0})
        {
            Vec3 point(0.1, -0.2, 0.3);
            point[axis] = sign * std::nextafter(kLimit_m, 0.0);
            EXPECT_FALSE(is_beyond_kernels(point, kQuantum_m)) << axis;
            for (const double beyond : {kLimit_m, std::numeric_limits<double>::infinity(),
                                        std::numeric_limits<double>::quiet_NaN()})
            {
                point[axis] = sign * beyond;
                EXPECT_TRUE(is_beyond_kernels(point, kQuantum_m)) << axis << ' ' << beyond;
            }
        }
    }
}

} // namespace
} // namespace tactus
