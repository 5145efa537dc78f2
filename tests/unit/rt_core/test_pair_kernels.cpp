// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/crossing.hpp"
#include "rt_core/query/box_view.hpp"
#include "rt_core/query/face_pair_queue.hpp"
#include "rt_core/query/pair_walk.hpp"
#include "rt_core/query/placed_blocks.hpp"
#include "tests/unit/rt_core/kernel_scenes.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
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

/// Point of the box, often at a corner, an edge or a side.
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

/// Boxes of a node, and a rotated box within a known distance of one of them.
struct NodeScene
{
    AabbVolume::Rows boxes;
    Aabb other;
    MeshPlacement place;
    double units_per_m{1.0};
    std::uint32_t touched{0};
    double apart_units{0.0}; ///< Upper bound of the distance from the touched box.

    explicit NodeScene(Random& random)
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
        const Vec3 to = point_in(random, boxes.get(touched)) + way;
        place.place.translation_m = to - place.local_to_world(point_in(random, other));
        apart_units = gap * units_per_m;
    }

    /// Rounding of the placement.
    [[nodiscard]] double slack_units() const
    {
        return units_per_m * (place.place.translation_m.norm() + 1e3) * 1e-13;
    }
    [[nodiscard]] KernelBox seen() const
    {
        return BoxView(place, units_per_m, static_cast<float>(slack_units())).of(other);
    }
};

/// Least and greatest projection of a placed box's corners on a direction.
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
        const double height = direction.dot(place.local_to_world(at));
        ends = {std::min(ends[0], height), std::max(ends[1], height)};
    }
    return ends;
}

/// Greatest separation along six directions.
double separation(const NodeScene& scene, std::uint32_t child)
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

/// Block of the object with a rotated and placed block of the tool near it.
struct BlocksScene
{
    KernelScene object;
    BlockGeometry tool;
    MeshPlacement place;
    KernelBox tool_box{};
    std::array<float, kBlockFaces> errors{}; ///< Errors of the tool's faces, in quanta.
    PlacedBlock placed;
    VertexRows rows;
    float slack{0.0F};

    BlocksScene(Random& random, const FaceShape& shape, const FaceShape& tool_shape)
        : object(make_scene(random, shape, probe_places()[0]))
    {
        const double size = std::exp2(random.between(1.0, 20.0));
        const bool is_whole = random.one_in(2);
        const auto quantum = static_cast<double>(object.quantum_m);
        object.block = block_of(random, shape, size, is_whole, object.quantum_m);
        tool = block_of(random, tool_shape, size * std::exp2(random.between(-4.0, 1.0)), is_whole,
                        object.quantum_m);
        place.place.rotation = random_rotation(random);
        place.place.scale = random.one_in(2) ? 1.0 : random.between(0.5, 2.0);
        place.place.translation_m =
            random.in_cube(size * quantum * std::exp2(random.between(-8.0, 1.0)));
        if (is_whole && random.one_in(2)) // Many faces only touch.
        {
            place = {};
        }
        for (float& error : errors)
        {
            error = random.one_in(2)
                        ? 0.0F
                        : static_cast<float>(size * std::exp2(-random.between(0.0, 10.0)));
        }
        slack = static_cast<float>(
            (place.place.translation_m.norm() / quantum + 4.0 * size) * 0x1p-45 + 0x1p-40);
        look(portable_kernels());
    }

    [[nodiscard]] double units_per_m() const { return 1.0 / static_cast<double>(object.quantum_m); }

    /// Places the blocks like PlacedBlocks.
    void look(const Kernels& kernels)
    {
        const Aabb own = box_of(tool, 0xFFFF);
        const Vec3 middle = 0.5 * (to_vec3(own.low) + to_vec3(own.high));
        const Vec3f from = to_float(middle);
        tool_box = BoxView(place, units_per_m(), slack).of(own);
        std::array<float, 9> turn{};
        for (std::size_t i = 0; i < 9; ++i)
        {
            turn[i] = static_cast<float>(units_per_m() * place.place.scale *
                                         place.place.rotation(static_cast<Eigen::Index>(i / 3),
                                                              static_cast<Eigen::Index>(i % 3)));
        }
        kernels.place_turned(tool.coordinates.front().data(), tool.corners.front().data(),
                             from.data(), turn.data(), placed.rows);
        const double moved = (middle - to_vec3(from)).lpNorm<1>() * units_per_m();
        const float half = tool_box.half_along[0] + tool_box.half_along[1] + tool_box.half_along[2];
        std::ranges::copy(errors, std::begin(placed.rows.error));
        placed.off = half * 0x1p-21F + round_up_to_float(4.0 * moved) + slack;
        static_cast<void>(kernels.near_block(object.coordinates(), object.corners(), tool_box,
                                             0xFFFF, kUnlimited, rows));
    }

    [[nodiscard]] Triangle tool_face(std::uint32_t lane) const
    {
        Triangle triangle = to_triangle(block_triangle(tool, lane));
        for (Vec3& corner : triangle)
        {
            corner = place.local_to_world(corner);
        }
        return triangle;
    }
    [[nodiscard]] Triangle face(std::uint32_t lane) const
    {
        return to_triangle(block_triangle(object.block, lane));
    }
    /// Distance between two faces, in quanta.
    [[nodiscard]] double apart(std::uint32_t tool_lane, std::uint32_t lane) const
    {
        const ClosestPoints closest = closest_points(tool_face(tool_lane), face(lane));
        return (closest.distance + closest.distance_error) * units_per_m();
    }
};

std::vector<BlocksScene> pairs_of_shapes(Random& random, int rounds)
{
    std::vector<BlocksScene> all;
    for (const FaceShape& shape : face_shapes())
    {
        for (const FaceShape& tool : face_shapes())
        {
            for (int round = 0; round < rounds; ++round)
            {
                all.emplace_back(random, shape, tool);
            }
        }
    }
    return all;
}

/// Direction of length at most 1.
Vec3f random_way(Random& random)
{
    return to_float((1.0 - 0x1p-20) * random.in_cube(1.0).normalized());
}

std::array<float, 6> ends_of(const Aabb& box)
{
    return {box.low[0], box.low[1], box.low[2], box.high[0], box.high[1], box.high[2]};
}

/// Bits of all rows that a face uses.
std::vector<std::uint32_t> row_bits(const BlocksScene& scene)
{
    const TriangleRows& rows = scene.placed.rows;
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
            bits.push_back(lane < 15 ? bits_of(scene.rows.at[axis][lane]) : 0);
        }
        bits.push_back(bits_of(rows.plane_low[lane]));
        bits.push_back(bits_of(rows.plane_high[lane]));
        bits.push_back(lane < 15 ? bits_of(scene.rows.size[lane]) : 0);
    }
    return bits;
}

using NearPairs = std::array<std::uint32_t, kBlockFaces>;

NearPairs near_pairs(const Kernels& kernels, const BlocksScene& scene, std::uint32_t mask,
                     std::uint32_t tool_mask, float bound, const float* way)
{
    NearPairs near{};
    kernels.near_pairs(scene.rows, scene.object.corners(), mask, scene.placed.rows, tool_mask,
                       bound, 2.0F * scene.placed.off, way, near.data());
    return near;
}

std::uint32_t near_rows(const Kernels& kernels, const BlocksScene& scene, const Aabb& box,
                        std::uint32_t mask, float bound, float& least_gap)
{
    return kernels.near_rows(scene.placed.rows, ends_of(box).data(), scene.tool_box.center, mask,
                             bound, 2.0F * scene.placed.off, least_gap);
}

/// Eight random pairs of faces.
FacePairQueue queue_of(Random& random, const BlocksScene& scene)
{
    FacePairQueue queue;
    while (!queue.is_full())
    {
        const FacePair pair{0, 0, random.below(kBlockFaces), random.below(kBlockFaces)};
        queue.add(pair, scene.placed, scene.object.block, scene.rows, scene.slack);
    }
    return queue;
}

/// Face close to another one in one of the configurations that are hard to decide.
Triangle near_tie(Random& random, const Triangle& face, double size)
{
    // A corner, the middle of an edge, or a place in the face.
    const auto point_of = [&]
    {
        const double s = random.below(3) * 0.5;
        const double t = random.below(3) * 0.5 * (1.0 - s);
        return Vec3(face[0] + s * (face[1] - face[0]) + t * (face[2] - face[0]));
    };
    Triangle other{point_of(), point_of(), random.in_cube(size)};
    const Vec3 at = other[0];
    const Vec3 way = random.in_cube(size);
    const Vec3 across = random.in_cube(size);
    switch (random.below(4))
    {
    case 0: // An edge through the place.
        other = {at + way, at - random.between(0.1, 1.0) * way, at + across};
        break;
    case 1: // The plane, with the place inside.
        other = {at + way, at + across, at - 0.7 * (way + across)};
        break;
    case 2: // All in one plane.
        other[2] = point_of();
        break;
    default: // Two corners.
        break;
    }
    const double off = random.one_in(3) ? 0.0 : size * std::exp2(-random.between(8.0, 30.0));
    for (Vec3& corner : other)
    {
        corner += random.in_cube(off);
    }
    return other;
}

void expect_true_sides(const PairSides& sides, std::uint32_t lane, bool do_meet)
{
    ASSERT_EQ(sides.meet & sides.apart, 0U);
    ASSERT_TRUE((sides.meet >> lane & 1U) == 0 || do_meet);
    ASSERT_TRUE((sides.apart >> lane & 1U) == 0 || !do_meet);
}

void expect_true_bounds(const PairDistances& distances, std::uint32_t lane,
                        const ClosestPoints& closest, double quantum)
{
    ASSERT_LE(static_cast<double>(distances.lower[lane]) * quantum,
              closest.distance + closest.distance_error);
    ASSERT_GE(static_cast<double>(distances.upper[lane]) * quantum,
              closest.distance + closest.distance_error);
    double length_sq = 0.0;
    for (const auto& row : distances.way)
    {
        length_sq += static_cast<double>(row[lane]) * static_cast<double>(row[lane]);
    }
    ASSERT_LE(length_sq, 1.0 + 0x1p-20);
}

} // namespace

TEST(PairKernels, give_the_same_bits_in_every_set)
{
    Random random(81);
    for (BlocksScene scene : pairs_of_shapes(random, 12))
    {
        const NodeScene boxes(random);
        const KernelBox box = boxes.seen();
        const float* const node = boxes.boxes.low.front().data();
        const std::uint32_t mask = random_mask(random, 16);
        const std::uint32_t tool_mask = random_mask(random, 16);
        const Vec3f way = random_way(random);
        const float bound = random.one_in(3)
                                ? kUnlimited
                                : static_cast<float>(std::exp2(random.between(-2.0, 20.0)));
        const FacePairQueue queue = queue_of(random, scene);
        const std::uint32_t count = 1 + random.below(kPairLanes);
        const auto answers = [&](const Kernels& kernels)
        {
            scene.look(kernels);
            std::vector<std::uint32_t> bits = row_bits(scene);
            alignas(32) std::array<float, kNodeChildren> gaps{};
            bits.push_back(kernels.box_gaps(node, box, mask & 0xFFU, bound, gaps.data()));
            bits.push_back(
                kernels.boxes_along(node, box, way.data(), mask & 0xFFU, bound, gaps.data()));
            for (const float gap : gaps)
            {
                bits.push_back(bits_of(gap));
            }
            bits.push_back(bits_of(kernels.highest_along(scene.object.coordinates(),
                                                         mask & 0x7FFFU ? mask & 0x7FFFU : 1U,
                                                         scene.tool_box.center, way.data())));
            float least_gap = 0.0F;
            bits.push_back(near_rows(kernels, scene, box_of(scene.object.block, mask | 1U),
                                     tool_mask, bound, least_gap));
            bits.push_back(bits_of(least_gap));
            VertexRows rows;
            bits.push_back(kernels.near_block(scene.object.coordinates(), scene.object.corners(),
                                              scene.tool_box, mask, bound, rows));
            for (const float* way_or_none : {way.data(), static_cast<const float*>(nullptr)})
            {
                const NearPairs near =
                    near_pairs(kernels, scene, mask, tool_mask, bound, way_or_none);
                bits.insert(bits.end(), near.begin(), near.end());
            }
            const PairSides sides = kernels.decide_pairs(queue.rows(), count);
            bits.push_back(sides.meet);
            bits.push_back(sides.apart);
            PairDistances distances{};
            kernels.pair_distances(queue.rows(), count, distances);
            for (std::uint32_t lane = 0; lane < count; ++lane)
            {
                for (const float value :
                     {distances.lower[lane], distances.upper[lane], distances.way[0][lane],
                      distances.way[1][lane], distances.way[2][lane]})
                {
                    bits.push_back(bits_of(value));
                }
            }
            return bits;
        };
        const std::vector<std::uint32_t> expected = answers(portable_kernels());
        for (const Kernels* kernels : available_kernels())
        {
            ASSERT_EQ(answers(*kernels), expected) << kernels->name;
        }
    }
}

TEST(PairKernels, bound_the_distance_of_turned_boxes_from_below_and_closely)
{
    Random random(82);
    for (int round = 0; round < 20'000; ++round)
    {
        const NodeScene scene(random);
        alignas(32) std::array<float, kNodeChildren> gaps{};
        const KernelBox box = scene.seen();
        static_cast<void>(portable_kernels().box_gaps(scene.boxes.low.front().data(), box, 0xFF,
                                                      kUnlimited, gaps.data()));
        // Two points at this distance are known.
        ASSERT_LE(static_cast<double>(gaps[scene.touched]), scene.apart_units + scene.slack_units())
            << round;
        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            const Aabb own = scene.boxes.get(child);
            const double sum =
                (to_vec3(own.low) - scene.place.local_to_world(to_vec3(scene.other.low)))
                    .lpNorm<1>() +
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
        const NodeScene scene(random);
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

TEST(PairKernels, bound_boxes_along_a_way_from_below)
{
    Random random(84);
    std::uint32_t raised = 0;
    for (int round = 0; round < 20'000; ++round)
    {
        const NodeScene scene(random);
        const Vec3f way = random_way(random);
        const Vec3 direction = to_vec3(way);
        const KernelBox box = scene.seen();
        alignas(32) std::array<float, kNodeChildren> gaps{};
        const auto bound = static_cast<float>(scene.apart_units + 2.0 * scene.slack_units());
        const std::uint32_t near = portable_kernels().boxes_along(
            scene.boxes.low.front().data(), box, way.data(), 0xFF, bound, gaps.data());
        ASSERT_NE(near >> scene.touched & 1U, 0U);
        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            const auto here = extent(scene.boxes.get(child), MeshPlacement{}, direction);
            const auto there = extent(scene.other, scene.place, direction);
            const double truth = (there[0] - here[1]) * scene.units_per_m;
            ASSERT_LE(static_cast<double>(gaps[child]), std::max(truth, 0.0) + scene.slack_units())
                << round;
            raised += static_cast<double>(gaps[child]) > 0.9 * truth && truth > 0.0 ? 1U : 0U;
        }
    }
    EXPECT_GT(raised, 10'000U);
}

TEST(PairKernels, find_the_highest_vertex_along_a_way)
{
    Random random(90);
    for (const BlocksScene& scene : pairs_of_shapes(random, 12))
    {
        const std::uint32_t one = 1U << random.below(15);
        const std::uint32_t mask = one | random_mask(random, 15);
        const Vec3f way = random_way(random);
        const KernelProbe& center = scene.tool_box.center;
        double highest = -1e300;
        double farthest = 0.0;
        for (std::uint32_t left = mask; left != 0; left &= left - 1)
        {
            const auto row = static_cast<std::size_t>(std::countr_zero(left));
            Vec3 from(0.0, 0.0, 0.0);
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                from[static_cast<Eigen::Index>(axis)] =
                    (static_cast<double>(scene.object.block.coordinates[axis][row]) -
                     static_cast<double>(center.high[axis]) -
                     static_cast<double>(center.low[axis])) *
                    scene.units_per_m();
            }
            highest = std::max(highest, from.dot(to_vec3(way)));
            farthest = std::max(farthest, from.lpNorm<1>());
        }
        const auto told = static_cast<double>(
            portable_kernels().highest_along(scene.object.coordinates(), mask, center, way.data()));
        ASSERT_GE(told, highest);
        ASSERT_LE(told, highest + 2.0 * static_cast<double>(kPairMargin) * farthest);
    }
}

TEST(PairKernels, place_turned_vertices_where_they_are)
{
    Random random(85);
    for (const BlocksScene& scene : pairs_of_shapes(random, 8))
    {
        for (std::size_t row = 0; row < 15; ++row)
        {
            const Vec3 at = scene.place.local_to_world(
                to_vec3(Vec3f{scene.tool.coordinates[0][row], scene.tool.coordinates[1][row],
                              scene.tool.coordinates[2][row]}));
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const KernelProbe& center = scene.tool_box.center;
                const double from =
                    static_cast<double>(center.high[axis]) + static_cast<double>(center.low[axis]);
                ASSERT_NEAR(static_cast<double>(scene.placed.rows.vertex[axis][row]),
                            (at[static_cast<Eigen::Index>(axis)] - from) * scene.units_per_m(),
                            static_cast<double>(scene.placed.off));
            }
        }
    }
}

TEST(PairKernels, leave_out_no_pair_of_faces_within_the_bound)
{
    std::uint32_t left_out = 0;
    Random random(86);
    int number = 0;
    for (const BlocksScene& scene : pairs_of_shapes(random, 12))
    {
        SCOPED_TRACE(testing::Message() << scene.object.shape << ", scene " << number++);
        const Kernels& kernels = portable_kernels();
        const std::uint32_t tool_lane = random.below(kBlockFaces);
        const std::uint32_t lane = random.below(kBlockFaces);
        const double apart = scene.apart(tool_lane, lane);
        const double error = static_cast<double>(scene.errors[tool_lane]);
        const float bound = round_up_to_float(std::max(0.0, apart - error));
        const std::uint32_t mask = 1U << lane;
        const Aabb box = box_of(scene.object.block, mask);
        float least_gap = 0.0F;
        ASSERT_NE(near_rows(kernels, scene, box, 0xFFFF, bound, least_gap) >> tool_lane & 1U, 0U);
        ASSERT_LE(static_cast<double>(least_gap), std::max(0.0, apart - error));
        ASSERT_EQ(near_rows(kernels, scene, box, 0, bound, least_gap), 0U);
        VertexRows rows;
        ASSERT_NE(kernels.near_block(scene.object.coordinates(), scene.object.corners(),
                                     scene.tool_box, 0xFFFF, round_up_to_float(apart), rows) &
                      mask,
                  0U);
        // The direction between the two, any other, and none.
        const ClosestPoints closest = closest_points(scene.tool_face(tool_lane), scene.face(lane));
        const Vec3 between = -(1.0 - 0x1p-20) * closest.gap.normalized();
        const Vec3f along = to_float(closest.distance > 0.0 ? between : Vec3(0.0, 0.0, 0.0));
        const Vec3f any = random_way(random);
        for (const float* way : {along.data(), any.data(), static_cast<const float*>(nullptr)})
        {
            const NearPairs near = near_pairs(kernels, scene, 0xFFFF, 0xFFFF, bound, way);
            ASSERT_NE(near[tool_lane] & mask, 0U);
            for (const std::uint32_t lanes : near)
            {
                left_out += static_cast<std::uint32_t>(std::popcount(0xFFFFU & ~lanes));
            }
        }
    }
    EXPECT_GT(left_out, 50'000U);
}

TEST(PairKernels, decide_no_pair_otherwise_than_exact_arithmetic)
{
    std::uint32_t plain = 0;
    std::uint32_t separated = 0;
    Random random(87);
    for (const BlocksScene& scene : pairs_of_shapes(random, 12))
    {
        const FacePairQueue queue = queue_of(random, scene);
        const PairSides sides = portable_kernels().decide_pairs(queue.rows(), queue.size());
        for (std::uint32_t i = 0; i < queue.size(); ++i)
        {
            const Triangle tool = scene.tool_face(queue[i].tool_lane);
            const Triangle face = scene.face(queue[i].lane);
            expect_true_sides(sides, i, meet(tool, face));
        }
        if (std::string_view(scene.object.shape) == face_shapes()[0].name)
        {
            plain += queue.size();
            separated += static_cast<std::uint32_t>(std::popcount(sides.meet | sides.apart));
        }
    }
    EXPECT_GT(separated, plain / 2);
}

TEST(PairKernels, decide_and_bound_near_ties_needles_and_faces_in_one_plane)
{
    Random random(88);
    std::array<std::uint32_t, 3> count{}; // Open, separate, meeting.
    for (int round = 0; round < 40'000; ++round)
    {
        const FaceShape& shape = face_shapes()[random.below(6)];
        const double size = std::exp2(random.between(0.0, 20.0));
        const bool is_on_grid = random.one_in(3);
        Triangle face;
        for (std::size_t i = 0; i < 3; ++i)
        {
            for (double& coordinate : face[i])
            {
                coordinate = is_on_grid ? random.below(4) : 0.0;
            }
        }
        face = is_on_grid ? face : shape.make(random, size);
        Triangle tool = near_tie(random, face, size);
        for (Vec3& corner : tool)
        {
            corner = is_on_grid ? Vec3(corner.array().round()) : corner;
        }
        FacePairQueue queue;
        queue.add({}, tool, face, 1.0);
        const PairSides sides = portable_kernels().decide_pairs(queue.rows(), 1);
        const ClosestPoints closest = closest_points(tool, face);
        expect_true_sides(sides, 0, closest.meet);
        ++count[(sides.apart & 1U) + 2 * (sides.meet & 1U)];
        PairDistances distances{};
        portable_kernels().pair_distances(queue.rows(), 1, distances);
        expect_true_bounds(distances, 0, closest, 1.0);
    }
    for (const std::uint32_t some : count)
    {
        EXPECT_GT(some, 1'000U);
    }
}

TEST(PairKernels, bound_distances_of_faces_from_both_sides_and_closely)
{
    std::uint32_t plain = 0;
    std::uint32_t close = 0;
    Random random(89);
    for (const BlocksScene& scene : pairs_of_shapes(random, 12))
    {
        const FacePairQueue queue = queue_of(random, scene);
        PairDistances distances{};
        portable_kernels().pair_distances(queue.rows(), queue.size(), distances);
        for (std::uint32_t i = 0; i < queue.size(); ++i)
        {
            const ClosestPoints closest =
                closest_points(scene.tool_face(queue[i].tool_lane), scene.face(queue[i].lane));
            const auto quantum = static_cast<double>(scene.object.quantum_m);
            expect_true_bounds(distances, i, closest, quantum);
            const double apart = closest.distance / quantum;
            const bool counts =
                std::string_view(scene.object.shape) == face_shapes()[0].name && apart > 0.0;
            plain += counts ? 1U : 0U;
            close += counts && static_cast<double>(distances.lower[i]) > 0.99 * apart &&
                             static_cast<double>(distances.upper[i]) < 1.01 * apart
                         ? 1U
                         : 0U;
        }
    }
    EXPECT_GT(plain, 200U);
    EXPECT_GT(close, plain * 9 / 10);
}

} // namespace tactus::test
