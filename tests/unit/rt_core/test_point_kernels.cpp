// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/triangle.hpp"
#include "tests/unit/rt_core/kernel_laws.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr float kNoLimit = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kNoRef = 0xFFFF'FFFFU;
/// Limit of the aspect; thinner faces may have looser bounds.
constexpr long double kTightAspect = 8.0L;

std::string name_of(const Kernels& kernels, const KernelScene& scene)
{
    return std::string(kernels.name) + ": " + scene.shape + ", probe " + scene.place;
}

/// Children of a node.
struct ChildRefs
{
    std::array<std::uint32_t, kNodeChildren> refs{};
    std::uint32_t mask{0};
    std::uint32_t coarse{0};

    explicit ChildRefs(Random& random)
        : mask(random_mask(random, kNodeChildren)), coarse(random_mask(random, kNodeChildren))
    {
        for (std::uint32_t child = 0; child < kNodeChildren; ++child)
        {
            const std::uint32_t index = 100 * child + random.below(100);
            refs[child] =
                (random.one_in(2) ? TreeRef::to_block(index) : TreeRef::to_node(index)).value;
        }
    }
    [[nodiscard]] bool is_batched(std::uint32_t child) const
    {
        return TreeRef{refs[child]}.is_block() && ((coarse >> child) & 1U) == 0;
    }
};

/// Frontier and batch with this number of items each.
struct Found
{
    std::unique_ptr<Frontier> frontier{std::make_unique<Frontier>()};
    std::unique_ptr<BlockBatch> batch{std::make_unique<BlockBatch>()};

    explicit Found(std::uint32_t nodes = 0, std::uint32_t blocks = 0)
    {
        frontier->count = nodes;
        batch->count = blocks;
    }
};

Found enter(const Kernels& kernels, const KernelScene& scene, const ChildRefs& children,
            float bound, std::uint32_t nodes, std::uint32_t blocks)
{
    Found found(nodes, blocks);
    kernels.enter_node(scene.box_rows(), children.refs.data(), scene.probe, children.mask,
                       children.coarse, bound, *found.frontier, *found.batch);
    return found;
}

/// Bits of all bounds and near flags, of lanes with a face.
std::vector<std::uint32_t> bits_of_batch(const BlockBatch& batch,
                                         const std::vector<BlockGeometry>& blocks, float limit)
{
    std::vector<std::uint32_t> bits{bits_of(limit), batch.count};
    for (std::uint32_t i = 0; i < batch.count; ++i)
    {
        const BlockGeometry& block = blocks[TreeRef{batch.blocks[i]}.index()];
        bits.push_back(batch.near[i]);
        for (std::uint32_t lanes = block.faces; lanes != 0; lanes &= lanes - 1)
        {
            bits.push_back(bits_of(batch.lower_sq[i][std::countr_zero(lanes)]));
        }
    }
    return bits;
}

/// Blocks of the scene with the faces in `masks`, one block each.
std::vector<BlockGeometry> blocks_with(const KernelScene& scene,
                                       const std::vector<std::uint32_t>& masks)
{
    std::vector<BlockGeometry> blocks;
    for (const std::uint32_t mask : masks)
    {
        blocks.push_back(scene.block);
        blocks.back().faces = static_cast<std::uint16_t>(mask);
    }
    return blocks;
}

/// Batch of all blocks, with the boxes' direction towards them.
std::unique_ptr<BlockBatch> batch_of(const std::vector<BlockGeometry>& blocks, const Vec3& toward)
{
    auto batch = std::make_unique<BlockBatch>();
    batch->count = static_cast<std::uint32_t>(blocks.size());
    for (std::uint32_t i = 0; i < batch->count; ++i)
    {
        batch->blocks[i] = TreeRef::to_block(i).value;
        batch->gaps[i] = static_cast<float>(i);
        for (int axis = 0; axis < 3; ++axis)
        {
            batch->toward[axis][i] = static_cast<float>(toward[axis]);
        }
    }
    return batch;
}

/// Direction from the probe to the block's middle, in quanta, sometimes another one.
Vec3 random_way(Random& random, const KernelScene& scene)
{
    Vec3 middle(0.0, 0.0, 0.0);
    for (std::size_t row = 0; row < 15; ++row)
    {
        const auto& rows = scene.block.coordinates;
        middle += to_vec3({rows[0][row], rows[1][row], rows[2][row]}) / 15.0;
    }
    const Vec3 way = (middle - scene.point_m) / static_cast<double>(scene.quantum_m);
    return random.one_in(4) ? Vec3(random.in_cube(way.norm() + 1.0)) : way;
}

long double farthest_corner(const KernelScene& scene, std::uint32_t lane)
{
    long double far = 0.0L;
    for (const Vec3f& corner : block_triangle(scene.block, lane))
    {
        long double sum = 0.0L;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const long double gap =
                static_cast<long double>(corner[axis]) -
                static_cast<long double>(scene.point_m[static_cast<Eigen::Index>(axis)]);
            sum += gap * gap;
        }
        far = std::max(far, std::sqrt(sum));
    }
    return far / static_cast<long double>(scene.quantum_m);
}

} // namespace

TEST(PointKernels, enter_nodes_as_the_gaps_of_their_children_say)
{
    Random random(80);
    for (const KernelScene& scene : scenes(random, 100))
    {
        const ChildRefs children(random);
        alignas(32) std::array<float, kNodeChildren> gaps{};
        float bound = kNoLimit;
        portable_kernels().child_gaps(scene.box_rows(), scene.probe, 0xFF, bound, gaps.data());
        bound = random.one_in(4) ? bound : gaps[random.below(kNodeChildren)];
        const std::uint32_t nodes = random.below(Frontier::kRoom - 7);
        const std::uint32_t blocks = random.below(BlockBatch::kRoom - 7);
        for (const Kernels* kernels : available_kernels())
        {
            const Found sut = enter(*kernels, scene, children, bound, nodes, blocks);
            std::uint32_t node = nodes;
            std::uint32_t block = blocks;
            for (std::uint32_t child = 0; child < kNodeChildren; ++child)
            {
                if (((children.mask >> child) & 1U) == 0 || gaps[child] > bound)
                {
                    continue;
                }
                const bool batched = children.is_batched(child);
                ASSERT_EQ(batched ? sut.batch->blocks[block] : sut.frontier->refs[node],
                          children.refs[child])
                    << name_of(*kernels, scene);
                ASSERT_EQ(bits_of(batched ? sut.batch->gaps[block] : sut.frontier->gaps[node]),
                          bits_of(gaps[child]))
                    << name_of(*kernels, scene);
                (batched ? block : node) += 1;
            }
            ASSERT_EQ(sut.frontier->count, node) << name_of(*kernels, scene);
            ASSERT_EQ(sut.batch->count, block) << name_of(*kernels, scene);
        }
    }
}

TEST(PointKernels, of_every_set_see_the_same_way_to_a_box_and_that_is_to_its_middle)
{
    Random random(81);
    for (const KernelScene& scene : scenes(random, 60))
    {
        ChildRefs children(random);
        children.coarse = 0;
        const Found portable = enter(portable_kernels(), scene, children, kNoLimit, 0, 0);
        for (const Kernels* kernels : available_kernels())
        {
            const Found sut = enter(*kernels, scene, children, kNoLimit, 0, 0);
            for (std::uint32_t i = 0; i < portable.batch->count; ++i)
            {
                const std::uint32_t child = portable.batch->blocks[i] / 200;
                const Aabb box = scene.boxes.get(child);
                for (std::size_t axis = 0; axis < 3; ++axis)
                {
                    ASSERT_EQ(bits_of(sut.batch->toward[axis][i]),
                              bits_of(portable.batch->toward[axis][i]))
                        << name_of(*kernels, scene);
                    const double at = scene.point_m[static_cast<Eigen::Index>(axis)];
                    const double low = static_cast<double>(box.low[axis]) - at;
                    const double high = static_cast<double>(box.high[axis]) - at;
                    const auto quantum = static_cast<double>(scene.quantum_m);
                    ASSERT_NEAR(static_cast<double>(sut.batch->toward[axis][i]),
                                (low + high) / quantum,
                                0x1p-20 * (std::abs(low) + std::abs(high)) / quantum +
                                    static_cast<double>(scene.probe.slack))
                        << name_of(*kernels, scene);
                }
            }
        }
    }
}

TEST(PointKernels, sort_out_only_blocks_whose_faces_are_all_beyond_and_the_known_one)
{
    std::uint32_t sorted_out = 0;
    std::uint32_t kept = 0;
    Random random(82);
    for (const KernelScene& scene : scenes(random, 60))
    {
        const auto blocks = blocks_with(scene, {0xFFFF, 0xFFFF, 0xFFFF});
        const Vec3 way = random_way(random, scene);
        long double nearest = 1e30L;
        for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
        {
            nearest = std::min(nearest, FaceTruth(scene, lane).distance);
        }
        // Near-ties are included: bounds a few roundings beside the distance.
        const auto bound = static_cast<float>(
            nearest * (random.one_in(2)
                           ? 1.0L + static_cast<long double>(random.between(-1e-6, 1e-6))
                           : static_cast<long double>(random.between(0.0, 2.0))));
        const std::uint32_t known =
            random.one_in(3) ? kNoRef : TreeRef::to_block(random.below(3)).value;
        const auto expected = batch_of(blocks, way);
        portable_kernels().sort_out(blocks.data(), scene.probe, known, bound, *expected);
        for (const Kernels* kernels : available_kernels())
        {
            const auto sut = batch_of(blocks, way);
            kernels->sort_out(blocks.data(), scene.probe, known, bound, *sut);
            ASSERT_EQ(sut->count, expected->count) << name_of(*kernels, scene);
            for (std::uint32_t i = 0; i < sut->count; ++i)
            {
                ASSERT_NE(sut->blocks[i], known) << name_of(*kernels, scene);
                ASSERT_EQ(sut->blocks[i], expected->blocks[i]) << name_of(*kernels, scene);
                ASSERT_EQ(sut->gaps[i], expected->gaps[i]) << name_of(*kernels, scene);
            }
        }
        const std::uint32_t asked = known == kNoRef ? 3 : 2;
        ASSERT_TRUE(expected->count == asked || expected->count == 0) << scene.shape;
        if (expected->count == 0)
        {
            ASSERT_GT(nearest, static_cast<long double>(bound))
                << scene.shape << ", probe " << scene.place;
        }
        sorted_out += expected->count == 0 ? 1U : 0U;
        kept += expected->count != 0 ? 1U : 0U;
    }
    EXPECT_GT(sorted_out, 100U);
    EXPECT_GT(kept, 200U);
}

TEST(PointKernels, keep_blocks_without_a_way)
{
    Random random(83);
    for (const KernelScene& scene : scenes(random, 5))
    {
        const auto blocks = blocks_with(scene, {0xFFFF});
        const auto sut = batch_of(blocks, Vec3(0.0, 0.0, 0.0));
        portable_kernels().sort_out(blocks.data(), scene.probe, kNoRef, 0.0F, *sut);
        ASSERT_EQ(sut->count, 1U) << scene.shape;
    }
}

TEST(PointKernels, of_every_set_give_the_same_bits_on_batches)
{
    Random random(84);
    for (const KernelScene& scene : scenes(random, 100))
    {
        std::vector<std::uint32_t> masks(1 + random.below(5));
        std::ranges::generate(masks, [&] { return random_mask(random, 16); });
        const auto blocks = blocks_with(scene, masks);
        const auto at = static_cast<float>(FaceTruth(scene, random.below(16)).distance);
        const float floor = random.one_in(2) ? 0.0F : at;
        const float first = random.one_in(2) ? kNoLimit : at;
        ASSERT_NO_FATAL_FAILURE(expect_same_of_every_set(
            scene,
            [&](const Kernels& kernels)
            {
                float limit = first;
                const auto sut = batch_of(blocks, Vec3(0.0, 0.0, 0.0));
                kernels.test_blocks(blocks.data(), scene.probe, floor, limit, *sut);
                return bits_of_batch(*sut, blocks, limit);
            }));
    }
}

TEST(PointKernels, bound_squared_distances_by_the_stated_law)
{
    Random random(85);
    for (const KernelScene& scene : scenes(random, 60))
    {
        for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
        {
            const auto blocks = blocks_with(scene, {1U << lane});
            const auto sut = batch_of(blocks, Vec3(0.0, 0.0, 0.0));
            float limit = kNoLimit;
            portable_kernels().test_blocks(blocks.data(), scene.probe, 0.0F, limit, *sut);
            const FaceTruth truth(scene, lane);
            const long double far = farthest_corner(scene, lane);
            const auto slack = static_cast<long double>(scene.probe.slack);
            const long double margin = 2.0L * static_cast<long double>(kSquareMargin) * far * far +
                                       4.0L * slack * (far + slack);
            const auto lower_sq = static_cast<long double>(sut->lower_sq[0][lane]);
            const long double lower = std::sqrt(std::max(lower_sq, 0.0L)) - slack;
            const auto upper = static_cast<long double>(limit);
            const auto where = [&]
            {
                std::ostringstream text;
                text << scene.shape << ", probe " << scene.place << ", lane " << lane
                     << ", distance " << truth.distance << ", far " << far << ", aspect "
                     << truth.aspect;
                return text.str();
            };
            ASSERT_LE(lower, truth.distance) << where();
            ASSERT_GE(upper, truth.distance) << where();
            if (truth.aspect <= kTightAspect)
            {
                const long double truth_sq = truth.distance * truth.distance;
                ASSERT_GE(lower_sq, truth_sq - margin) << where();
                ASSERT_LE(upper * upper * (1.0L - 0x1p-18L), truth_sq + margin) << where();
            }
            ASSERT_EQ(sut->near[0], 1U << lane) << where();
        }
    }
}

TEST(PointKernels, leave_out_no_face_that_may_be_nearest_or_within_the_floor)
{
    std::uint32_t left_out = 0;
    Random random(86);
    for (const KernelScene& scene : scenes(random, 60))
    {
        const auto blocks = blocks_with(scene, {0x00FF, 0xFF00});
        std::array<long double, kBlockFaces> distances{};
        for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
        {
            distances[lane] = FaceTruth(scene, lane).distance;
        }
        const long double nearest = *std::ranges::min_element(distances);
        const auto floor =
            random.one_in(2) ? 0.0F : static_cast<float>(distances[random.below(kBlockFaces)]);
        float limit = random.one_in(2) ? kNoLimit : static_cast<float>(nearest * 1.001L);
        const auto sut = batch_of(blocks, Vec3(0.0, 0.0, 0.0));
        portable_kernels().test_blocks(blocks.data(), scene.probe, floor, limit, *sut);
        const std::uint32_t near = sut->near[0] | std::uint32_t{sut->near[1]};
        for (std::uint32_t lane = 0; lane < kBlockFaces; ++lane)
        {
            if (distances[lane] <= nearest || distances[lane] <= static_cast<long double>(floor))
            {
                ASSERT_NE(near & (1U << lane), 0U)
                    << scene.shape << ", probe " << scene.place << ", lane " << lane;
            }
        }
        left_out += 16U - static_cast<std::uint32_t>(std::popcount(near));
    }
    EXPECT_GT(left_out, 5'000U);
}

TEST(PointKernels, leave_out_no_face_whose_squares_are_beyond_float)
{
    Random random(87);
    for (KernelScene scene : scenes(random, 10))
    {
        scene.probe.scale *= 0x1p96F;
        const auto blocks = blocks_with(scene, {0xFFFF});
        for (const Kernels* kernels : available_kernels())
        {
            const auto sut = batch_of(blocks, Vec3(0.0, 0.0, 0.0));
            float limit = 0.0F;
            kernels->test_blocks(blocks.data(), scene.probe, 0.0F, limit, *sut);
            ASSERT_EQ(sut->near[0], 0xFFFF) << name_of(*kernels, scene);
        }
    }
}

TEST(PointKernels, of_every_set_see_triangles_with_the_same_bits)
{
    Random random(88);
    for (const KernelScene& scene : scenes(random, 100))
    {
        const Triangle triangle = to_triangle(block_triangle(scene.block, random.below(16)));
        const auto bits_seen = [](const SeenTriangle& seen)
        {
            std::vector<std::uint64_t> bits{seen.is_inside ? 1U : 0U};
            const auto add = [&bits](double value)
            { bits.push_back(std::bit_cast<std::uint64_t>(value)); };
            for (std::size_t i = 0; i < 3; ++i)
            {
                for (std::size_t axis = 0; axis < 3; ++axis)
                {
                    add(seen.foot[axis][i]);
                    add(seen.corner[axis][i]);
                    add(seen.edge[axis][i]);
                }
                add(seen.parameter[i]);
                for (const double value :
                     {seen.corner_sq[i], seen.edge_sq[i], seen.foot_sq[i], seen.normal[i]})
                {
                    add(value + 0.0); // A set may differ in the sign of a zero.
                }
            }
            return bits;
        };
        SeenTriangle expected{};
        see_triangle(scene.point_m.data(), triangle[0].data(), expected);
        for (const Kernels* kernels : available_kernels())
        {
            SeenTriangle seen{};
            kernels->see_triangle(scene.point_m.data(), triangle[0].data(), seen);
            ASSERT_EQ(bits_seen(seen), bits_seen(expected)) << name_of(*kernels, scene);
        }
    }
}

} // namespace tactus::test
