// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/triangle_triangle.hpp"
#include "rt_core/query/box_view.hpp"
#include "tests/unit/rt_core/kernel_scenes.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr float kUnlimited = std::numeric_limits<float>::infinity();

Mat3 random_rotation(Random& random)
{
    if (random.one_in(4))
    {
        return Mat3::Identity();
    }
    const Vec3 axis = (random.in_cube(1.0) + Vec3(2.0, 0.0, 0.0)).normalized();
    return Eigen::AngleAxisd(random.between(-4.0, 4.0), axis).toRotationMatrix();
}

Aabb random_box(Random& random, double size)
{
    Aabb box;
    for (int i = 0; i < 2; ++i)
    {
        box.add(to_float(random.in_cube(size)));
    }
    return box;
}

/// A point of the box, often a corner, an edge's or a side's.
Vec3 point_in(Random& random, const Aabb& box)
{
    Vec3 point(0.0, 0.0, 0.0);
    for (int axis = 0; axis < 3; ++axis)
    {
        const auto at = static_cast<std::size_t>(axis);
        const double share = random.one_in(3) ? random.between(0.0, 1.0) : random.below(2);
        point[axis] = static_cast<double>(box.low[at]) * (1.0 - share) +
                      static_cast<double>(box.high[at]) * share;
    }
    return point;
}

/// A node's boxes, and a turned box that a known distance parts from one of them at most.
struct BoxScene
{
    AabbVolume::Rows boxes;
    Aabb other;
    MeshPlacement place;
    double units_per_m{1.0};
    std::uint32_t touched{0};
    double apart_units{0.0}; ///< From the touched box, at most.

    explicit BoxScene(Random& random)
    {
        const double size = std::exp2(random.between(-8.0, 8.0));
        const double away = random.one_in(2) ? 0.0 : std::exp2(random.between(-8.0, 18.0));
        const Vec3 from = random.in_cube(away);
        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            Aabb box = random_box(random, size * random.between(0.01, 1.0));
            Aabb moved;
            moved.add(to_float(to_vec3(box.low) + from));
            moved.add(to_float(to_vec3(box.high) + from));
            boxes.set(child, moved);
        }
        other = random_box(random, size * std::exp2(random.between(-6.0, 6.0)));
        units_per_m = std::exp2(random.between(-3.0, 20.0));
        touched = random.below(kNodeChildren);
        place = {{random_rotation(random), Vec3(0.0, 0.0, 0.0), random.between(0.3, 3.0)},
                 random.in_cube(size)};
        const double gap = random.one_in(3) ? 0.0 : size * std::exp2(-random.between(0.0, 20.0));
        const Vec3 way = gap * random.in_cube(1.0).normalized();
        place.place.translation_m =
            point_in(random, boxes.get(touched)) + way - place.to_there(point_in(random, other));
        apart_units = gap * units_per_m;
    }

    /// What placing may round.
    [[nodiscard]] double slack_units() const
    {
        return units_per_m * (place.place.translation_m.norm() + 1e3) * 1e-13;
    }
    [[nodiscard]] KernelBox seen() const
    {
        return BoxView(place, units_per_m, static_cast<float>(slack_units())).of(other);
    }
};

/// Least and greatest of a box's corners along a direction, placed.
std::array<double, 2> extent(const Aabb& box, const MeshPlacement& place, const Vec3& direction)
{
    std::array<double, 2> ends{1e300, -1e300};
    for (unsigned corner = 0; corner < 8; ++corner)
    {
        Vec3 at(0.0, 0.0, 0.0);
        for (unsigned axis = 0; axis < 3; ++axis)
        {
            at[static_cast<int>(axis)] =
                static_cast<double>((corner >> axis & 1U) != 0 ? box.high[axis] : box.low[axis]);
        }
        const double height = direction.dot(place.to_there(at));
        ends = {std::min(ends[0], height), std::max(ends[1], height)};
    }
    return ends;
}

/// Along the widest of six directions.
double separation(const BoxScene& scene, std::uint32_t child)
{
    double widest = 0.0;
    for (int i = 0; i < 6; ++i)
    {
        const Vec3 direction =
            i < 3 ? Vec3(Mat3::Identity().col(i)) : Vec3(scene.place.place.rotation.col(i - 3));
        const auto here = extent(scene.boxes.get(child), MeshPlacement{}, direction);
        const auto there = extent(scene.other, scene.place, direction);
        widest = std::max({widest, here[0] - there[1], there[0] - here[1]});
    }
    return widest * scene.units_per_m;
}

/// Two blocks that are near each other, around a point near both.
struct FacesScene
{
    KernelScene first;
    BlockGeometry other;
    KernelProbe probe{};
    TriangleRows rows;
    TriangleRows other_rows;

    FacesScene(Random& random, const FaceShape& shape, const FaceShape& other_shape)
        : first(make_scene(random, shape, probe_places()[0]))
    {
        const double size = std::exp2(random.between(1.0, 20.0));
        first.block = block_of(random, shape, size, random.one_in(2), first.quantum_m);
        other = block_of(random, other_shape, size * std::exp2(random.between(-4.0, 1.0)),
                         random.one_in(2), first.quantum_m);
        probe = make_probe(size * static_cast<double>(first.quantum_m) * random.in_cube(1.0),
                           first.quantum_m);
        place(portable_kernels());
    }

    void place(const Kernels& kernels)
    {
        kernels.place_triangles(first.coordinates(), first.corners(), probe, rows);
        kernels.place_triangles(other.coordinates.front().data(), other.corners.front().data(),
                                probe, other_rows);
    }
};

template <typename Check>
void for_each_pair_of_shapes(std::uint64_t own_seed, int rounds, const Check& check)
{
    Random random(own_seed);
    for (const FaceShape& shape : face_shapes())
    {
        for (const FaceShape& other : face_shapes())
        {
            for (int round = 0; round < rounds; ++round)
            {
                check(random, FacesScene(random, shape, other));
            }
        }
    }
}

/// Of all rows but those of vertices that are no face's.
std::vector<std::uint32_t> row_bits(const TriangleRows& rows)
{
    std::vector<std::uint32_t> bits;
    for (std::size_t lane = 0; lane < kBlockFaces; ++lane)
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            for (const float value :
                 {rows.low[axis][lane], rows.high[axis][lane], rows.normal[axis][lane]})
            {
                bits.push_back(bits_of(value));
            }
            bits.push_back(rows.corners[axis][lane]);
            bits.push_back(lane < 15 ? bits_of(rows.vertex[axis][lane]) : 0);
        }
        bits.push_back(bits_of(rows.plane_low[lane]));
        bits.push_back(bits_of(rows.plane_high[lane]));
    }
    return bits;
}

/// All that the sets say of two blocks.
std::vector<std::uint32_t> answer_bits(const Kernels& kernels, const FacesScene& scene,
                                       const KernelBox& box, std::uint32_t mask, float bound)
{
    std::vector<std::uint32_t> bits{kernels.near_faces(scene.rows, box, mask, bound),
                                    kernels.near_lanes(scene.rows, scene.other_rows, mask | 1U,
                                                       mask, bound, scene.probe.slack)};
    for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
    {
        alignas(64) std::array<float, kBlockFaces> gaps{};
        const std::uint32_t near = kernels.triangle_gaps(scene.rows, scene.other_rows, lane, mask,
                                                         bound, scene.probe.slack, gaps.data());
        bits.push_back(near);
        for (std::uint32_t lanes = near; lanes != 0; lanes &= lanes - 1)
        {
            bits.push_back(bits_of(gaps[static_cast<std::size_t>(std::countr_zero(lanes))]));
        }
    }
    return bits;
}

Aabb box_of(const BlockGeometry& block, std::uint32_t lanes)
{
    Aabb box;
    for (; lanes != 0; lanes &= lanes - 1)
    {
        for (const Vec3f& corner :
             block_triangle(block, static_cast<std::uint32_t>(std::countr_zero(lanes))))
        {
            box.add(corner);
        }
    }
    return box;
}

/// In metres.
double distance(const Aabb& a, const Aabb& b)
{
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double gap =
            std::max({static_cast<double>(a.low[axis]) - static_cast<double>(b.high[axis]),
                      static_cast<double>(b.low[axis]) - static_cast<double>(a.high[axis]), 0.0});
        sum += gap * gap;
    }
    return std::sqrt(sum);
}

} // namespace

TEST(PairKernels, give_the_same_bits_in_every_set)
{
    for_each_pair_of_shapes(
        81, 12,
        [](Random& random, FacesScene scene)
        {
            const BoxScene boxes(random);
            const KernelBox box = boxes.seen();
            const KernelBox round_other =
                BoxView({}, 1.0 / static_cast<double>(scene.first.quantum_m), 0.0F)
                    .of(box_of(scene.other, 0xFFFF));
            const std::uint32_t mask = random_mask(random, 16);
            const float bound = random.one_in(3)
                                    ? kUnlimited
                                    : static_cast<float>(std::exp2(random.between(-2.0, 20.0)));
            alignas(32) std::array<float, kNodeChildren> expected_gaps{};
            const std::uint32_t expected_near = portable_kernels().box_gaps(
                boxes.boxes.low.front().data(), box, mask & 0xFFU, bound, expected_gaps.data());
            const auto expected_rows = row_bits(scene.rows);
            const auto expected = answer_bits(portable_kernels(), scene, round_other, mask, bound);
            for (const Kernels* kernels : available_kernels())
            {
                alignas(32) std::array<float, kNodeChildren> gaps{};
                ASSERT_EQ(kernels->box_gaps(boxes.boxes.low.front().data(), box, mask & 0xFFU,
                                            bound, gaps.data()),
                          expected_near)
                    << kernels->name;
                for (std::size_t child = 0; child < kNodeChildren; ++child)
                {
                    ASSERT_EQ(bits_of(gaps[child]), bits_of(expected_gaps[child]));
                }
                scene.place(*kernels);
                ASSERT_EQ(row_bits(scene.rows), expected_rows) << kernels->name;
                ASSERT_EQ(answer_bits(*kernels, scene, round_other, mask, bound), expected)
                    << kernels->name;
            }
        });
}

TEST(PairKernels, bound_the_distance_of_turned_boxes_from_below_and_closely)
{
    Random random(82);
    for (int round = 0; round < 20'000; ++round)
    {
        const BoxScene scene(random);
        alignas(32) std::array<float, kNodeChildren> gaps{};
        const KernelBox box = scene.seen();
        static_cast<void>(portable_kernels().box_gaps(scene.boxes.low.front().data(), box, 0xFF,
                                                      kUnlimited, gaps.data()));
        // Two points are known that are so far apart.
        ASSERT_LE(static_cast<double>(gaps[scene.touched]), scene.apart_units + scene.slack_units())
            << round;
        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            const Aabb own = scene.boxes.get(child);
            const double sum =
                (to_vec3(own.low) - scene.place.to_there(to_vec3(scene.other.low))).lpNorm<1>() +
                (to_vec3(own.high) - to_vec3(own.low)).lpNorm<1>() +
                5.0 * scene.place.place.scale *
                    (to_vec3(scene.other.high) - to_vec3(scene.other.low)).lpNorm<1>();
            ASSERT_GE(static_cast<double>(gaps[child]),
                      separation(scene, child) * (1.0 - 0x1p-18) -
                          4.0 * static_cast<double>(kPairMargin) * sum * scene.units_per_m -
                          4.0 * scene.slack_units())
                << round;
        }
    }
}

TEST(PairKernels, leave_out_no_child_within_the_bound)
{
    Random random(83);
    std::uint32_t left_out = 0;
    for (int round = 0; round < 5'000; ++round)
    {
        const BoxScene scene(random);
        const KernelBox box = scene.seen();
        const std::uint32_t mask = random_mask(random, 8);
        const auto bound = static_cast<float>(scene.apart_units + 2.0 * scene.slack_units());
        alignas(32) std::array<float, kNodeChildren> gaps{};
        const std::uint32_t near = portable_kernels().box_gaps(scene.boxes.low.front().data(), box,
                                                               mask, bound, gaps.data());
        ASSERT_EQ(near & ~mask, 0U);
        ASSERT_EQ(near >> scene.touched & 1U, mask >> scene.touched & 1U);
        left_out += static_cast<std::uint32_t>(std::popcount(mask & ~near));
    }
    EXPECT_GT(left_out, 5'000U);
}

TEST(PairKernels, bound_the_distance_of_faces_from_below_and_no_worse_than_their_boxes)
{
    std::uint32_t by_planes = 0;
    for_each_pair_of_shapes(
        84, 8,
        [&by_planes](Random& random, const FacesScene& scene)
        {
            const auto quantum = static_cast<double>(scene.first.quantum_m);
            const std::uint32_t lane = random.below(kBlockFaces);
            alignas(64) std::array<float, kBlockFaces> gaps{};
            ASSERT_EQ(portable_kernels().triangle_gaps(scene.rows, scene.other_rows, lane, 0xFFFF,
                                                       kUnlimited, scene.probe.slack, gaps.data()),
                      0xFFFFU);
            const Triangle other = to_triangle(block_triangle(scene.other, lane));
            const Aabb box = box_of(scene.other, 1U << lane);
            for (std::uint32_t own = 0; own < kBlockFaces; ++own)
            {
                const ClosestPoints closest =
                    closest_points(to_triangle(block_triangle(scene.first.block, own)), other);
                const double gap = static_cast<double>(gaps[own]) * quantum;
                ASSERT_LE(gap, closest.distance + closest.distance_error)
                    << scene.first.shape << " " << own;
                const double boxes = distance(box_of(scene.first.block, 1U << own), box);
                const double size = 8.0 * 0x1p21 * quantum;
                ASSERT_GE(gap, boxes - 2.0 * static_cast<double>(kPairMargin) * size);
                by_planes += gap > boxes + 0.01 * closest.distance ? 1U : 0U;
            }
        });
    EXPECT_GT(by_planes, 500U);
}

TEST(PairKernels, leave_out_no_face_within_the_bound)
{
    std::uint32_t left_out = 0;
    for_each_pair_of_shapes(
        85, 8,
        [&left_out](Random& random, const FacesScene& scene)
        {
            const std::uint32_t mask = random_mask(random, 16);
            const std::uint32_t lane = random.below(kBlockFaces);
            const Triangle other = to_triangle(block_triangle(scene.other, lane));
            const std::uint32_t asked = random.below(kBlockFaces);
            const ClosestPoints closest =
                closest_points(to_triangle(block_triangle(scene.first.block, asked)), other);
            const float bound = round_up_to_float((closest.distance + closest.distance_error) /
                                                  static_cast<double>(scene.first.quantum_m));
            alignas(64) std::array<float, kBlockFaces> gaps{};
            const std::uint32_t near = portable_kernels().triangle_gaps(
                scene.rows, scene.other_rows, lane, mask, bound, scene.probe.slack, gaps.data());
            const std::uint32_t by_box = portable_kernels().near_lanes(
                scene.rows, scene.other_rows, 1U << lane, mask, bound, scene.probe.slack);
            ASSERT_EQ(near & ~mask, 0U);
            ASSERT_EQ(near & ~by_box, 0U);
            ASSERT_EQ(near >> asked & 1U, mask >> asked & 1U) << scene.first.shape;
            left_out += static_cast<std::uint32_t>(std::popcount(mask & ~near));
        });
    EXPECT_GT(left_out, 200U);
}

TEST(PairKernels, a_box_round_several_faces_leaves_out_what_is_far_of_all)
{
    std::uint32_t left_out = 0;
    for_each_pair_of_shapes(
        86, 8,
        [&left_out](Random& random, const FacesScene& scene)
        {
            const auto quantum = static_cast<double>(scene.first.quantum_m);
            const std::uint32_t others = random_mask(random, 16) | 1U << random.below(kBlockFaces);
            const Aabb box = box_of(scene.other, others);
            const auto bound = static_cast<float>(std::exp2(random.between(-4.0, 18.0)));
            const std::uint32_t near = portable_kernels().near_lanes(
                scene.rows, scene.other_rows, others, 0xFFFF, bound, scene.probe.slack);
            for (std::uint32_t own = 0; own < kBlockFaces; ++own)
            {
                const double apart = distance(box_of(scene.first.block, 1U << own), box) / quantum;
                ASSERT_TRUE((near >> own & 1U) != 0 || apart > static_cast<double>(bound));
                left_out += (near >> own & 1U) != 0 ? 0U : 1U;
            }
        });
    EXPECT_GT(left_out, 100U);
}

} // namespace tactus::test
