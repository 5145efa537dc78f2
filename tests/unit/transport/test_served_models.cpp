// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/frame/frame.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/inside_test.hpp"
#include "transport/pool_plan.hpp"
#include "transport/store/store_link.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace tactus::test
{
namespace
{

/// Queries by places of the source mesh.
struct InsideRig
{
    InsideRig(const std::string& name, const TriangleMesh& mesh)
        : served_(serve_from_file(test_model(name, mesh, 2'000).path, name, {}).value())
        , header_(ModelHeader::parse(served_.header).value())
        , sut_(header_, served_.base)
    {
    }
    /// Distance from the surface beyond which the answer is right.
    [[nodiscard]] double sure_m() const
    {
        return 2.0 * static_cast<double>(header_.quantum_m()) * header_.fields().max_error_quanta;
    }
    [[nodiscard]] bool holds(const Vec3& source_m) const
    {
        return sut_.holds(source_m - header_.origin_m());
    }

private:
    ServedModel served_;
    ModelHeader header_;
    InsideTest sut_;
};

/// The oracle is the shape's formula.
TEST(InsideTest, knows_the_inside_of_a_torus_from_its_hole)
{
    constexpr double kRing_m = 0.05;
    constexpr double kTube_m = 0.02;
    const InsideRig rig("inside_torus", make_shape(Shape::torus, 5'000).value());
    Random random(481);
    int inside = 0;
    for (int i = 0; i < 2'000; ++i)
    {
        const Vec3 place_m = random.in_cube(0.09);
        const double off_ring_m =
            std::hypot(std::hypot(place_m.x(), place_m.y()) - kRing_m, place_m.z());
        if (std::abs(off_ring_m - kTube_m) < rig.sure_m())
        {
            continue;
        }
        inside += off_ring_m < kTube_m ? 1 : 0;
        EXPECT_EQ(rig.holds(place_m), off_ring_m < kTube_m) << place_m.transpose();
    }
    EXPECT_LT(rig.sure_m(), 0.5 * kTube_m);
    EXPECT_GT(inside, 10);
}

TEST(InsideTest, finds_nothing_inside_an_open_mesh)
{
    const InsideRig rig("inside_terrain", make_shape(Shape::terrain, 2'000).value());
    for (const double height_m : {-0.01, 0.0, 0.005, 0.02})
    {
        EXPECT_FALSE(rig.holds(Vec3(0.0, 0.0, height_m)));
    }
}

TEST(InsideTest, finds_nothing_inside_a_model_whose_base_mesh_is_not_here)
{
    const TestModel& model = test_model("inside_sphere", make_shape(Shape::sphere, 2'000).value());
    const ServedModel served = serve_from_file(model.path, "ball", {}).value();
    const ModelHeader header = ModelHeader::parse(served.header).value();
    const Vec3 middle_m = -header.origin_m();
    EXPECT_TRUE(InsideTest(header, served.base).holds(middle_m));
    EXPECT_FALSE(InsideTest(header, {}).holds(middle_m));
}

struct PlannedScene
{
    /// Scene of models, each with `more_records` more records than the one before.
    explicit PlannedScene(std::size_t models, std::uint32_t more_records = 700)
    {
        for (std::uint32_t i = 0; i < models; ++i)
        {
            tiny.push_back(make_tiny_model({.seed = i + 1, .records = 200 + more_records * i}));
            objects.push_back({ModelId{i}, {}});
        }
        for (const TinyModel& model : tiny)
        {
            headers.push_back(ModelHeader::parse(model.header).value());
        }
        poses.resize(models);
        setup.objects = objects;
        setup.poses = poses;
        setup.tools = tools;
        capacities.resize(models);
    }

    std::vector<TinyModel> tiny;
    std::vector<ModelHeader> headers;
    std::vector<ObjectSpec> objects;
    std::vector<ObjectPose> poses;
    std::vector<ToolSpec> tools{3};
    FrameSetup setup;
    std::vector<ModelCapacities> capacities;
};

/// Frame and loader take their memory from an arena of exactly that size.
void expect_room_for_all(PlannedScene& scene, std::size_t bytes)
{
    std::vector<ModelSource> sources;
    for (std::size_t i = 0; i < scene.tiny.size(); ++i)
    {
        sources.push_back({scene.tiny[i].header, scene.tiny[i].base, scene.capacities[i]});
    }
    scene.setup.models = sources;
    std::vector<std::byte> memory(bytes + Arena::kAlignment);
    const auto misplaced = reinterpret_cast<std::uintptr_t>(memory.data()) % Arena::kAlignment;
    const std::span<std::byte> all = memory;
    Arena arena(all.subspan(Arena::kAlignment - misplaced, bytes));
    std::optional<Frame> frame;
    ASSERT_TRUE(Frame::start(frame, arena, scene.setup).has_value()) << bytes;
    ModelPools& pools = frame->pools();
    const ChunkLoader chunk_loader(arena, pools.slots, pools.cache.queues, {});
    EXPECT_LE(arena.used(), bytes);
    scene.setup.models = {};
}

TEST(PoolPlan, leaves_room_for_frame_and_chunk_loader_in_what_it_plans_for)
{
    for (const std::size_t models : {1U, 2U, 5U})
    {
        PlannedScene scene(models);
        const std::size_t least = least_pool_bytes(scene.setup, scene.headers, 0);
        ASSERT_GT(least, 0U);
        for (const std::size_t bytes : {least, least + 4'096, 2 * least, 4 * least})
        {
            ASSERT_TRUE(try_plan_pools(scene.setup, scene.headers, bytes, 0, scene.capacities))
                << models << " models, " << bytes << " bytes, the least " << least;
            expect_room_for_all(scene, bytes);
        }
    }
}

TEST(PoolPlan, keeps_the_rooms_for_added_faces_in_the_least_and_in_more)
{
    PlannedScene scene(2);
    constexpr std::array<std::uint32_t, 2> kRooms{0, 20'000};
    const std::size_t without = least_pool_bytes(scene.setup, scene.headers, 0);
    const std::size_t least = least_pool_bytes(scene.setup, scene.headers, 0, kRooms);
    EXPECT_GT(least, without);
    for (const std::size_t bytes : {least, 2 * least})
    {
        for (std::size_t i = 0; i < kRooms.size(); ++i)
        {
            scene.capacities[i].edit_faces = kRooms[i];
        }
        ASSERT_TRUE(try_plan_pools(scene.setup, scene.headers, bytes, 0, scene.capacities));
        EXPECT_EQ(scene.capacities[0].edit_faces, kRooms[0]);
        EXPECT_EQ(scene.capacities[1].edit_faces, kRooms[1]);
        expect_room_for_all(scene, bytes);
    }
}

/// Memory that one model does not need is for the others, for any size; with enough each is
/// complete.
TEST(PoolPlan, of_as_many_models_as_there_may_be_gives_each_its_part)
{
    PlannedScene scene(kMaxModels, 1);
    const std::size_t least = least_pool_bytes(scene.setup, scene.headers, 0);
    ASSERT_GT(least, 0U);
    std::uint32_t pages_before = 0;
    for (const std::size_t bytes : {least, least + (least >> 1U), 2 * least, 4 * least})
    {
        ASSERT_TRUE(try_plan_pools(scene.setup, scene.headers, bytes, 0, scene.capacities));
        for (std::size_t i = 0; i < kMaxModels; ++i)
        {
            const ModelCounts counts = scene.headers[i].counts();
            EXPECT_GE(scene.capacities[i].pages, 1U);
            EXPECT_LE(scene.capacities[i].pages, counts.chunks());
            EXPECT_GT(scene.capacities[i].faces, counts.base_faces);
        }
        const std::uint32_t pages = sum_of(scene.capacities).pages;
        EXPECT_GE(pages, pages_before);
        pages_before = pages;
        expect_room_for_all(scene, bytes);
    }
    for (std::size_t i = 0; i < kMaxModels; ++i)
    {
        EXPECT_EQ(scene.capacities[i].pages, scene.headers[i].counts().chunks()) << i;
    }
}

TEST(PoolPlan, knows_the_least_that_would_do)
{
    PlannedScene scene(3);
    const std::size_t least = least_pool_bytes(scene.setup, scene.headers, 0);
    EXPECT_TRUE(try_plan_pools(scene.setup, scene.headers, least, 0, scene.capacities));
    EXPECT_FALSE(try_plan_pools(scene.setup, scene.headers, least - (std::size_t{64} << 10U), 0,
                                scene.capacities));
    EXPECT_FALSE(try_plan_pools(scene.setup, scene.headers, 0, 0, scene.capacities));
    const std::size_t cache = std::size_t{1} << 20U;
    EXPECT_GT(least_pool_bytes(scene.setup, scene.headers, cache), 0U);
}

/// A frame is a part of the memory of `hrtc --pool-mib`, 2 by default.
TEST(PoolPlan, of_eight_models_of_200_000_faces_and_four_tools_takes_2_mib_at_most)
{
    HeaderParts parts = sound_header((200'000 - 500) / 2);
    parts.fields.base_vertices = 252;
    parts.fields.base_faces = 500;
    const std::vector<std::byte> bytes = parts.write();
    const std::vector headers(8, ModelHeader::parse(bytes).value());
    std::vector<ObjectSpec> objects;
    for (std::uint32_t i = 0; i < headers.size(); ++i)
    {
        objects.push_back({ModelId{i}, {}});
    }
    const std::vector<ObjectPose> poses(objects.size());
    const std::vector<ToolSpec> tools(4);
    FrameSetup setup;
    setup.objects = objects;
    setup.poses = poses;
    setup.tools = tools;

    const std::size_t least = least_pool_bytes(setup, headers, 0);
    EXPECT_GT(least, 0U);
    EXPECT_LE(least + sizeof(Frame), std::size_t{2} << 20U);
}

} // namespace
} // namespace tactus::test
