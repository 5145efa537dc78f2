// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/replay.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace tactus
{

namespace
{

using Point = std::array<double, 3>;

/// Faces by corner positions, each rotated to its least corner: independent of ids.
std::multiset<std::array<Point, 3>> faces_by_position(const TriangleMesh& mesh)
{
    std::multiset<std::array<Point, 3>> faces;
    for (const auto& face : mesh.faces)
    {
        std::array<Point, 3> corners{mesh.positions[face[0]], mesh.positions[face[1]],
                                     mesh.positions[face[2]]};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        faces.insert(corners);
    }
    return faces;
}

TriangleMesh source_of(const PreparedMesh& prepared)
{
    TriangleMesh mesh;
    mesh.faces = prepared.mesh.faces;
    for (const auto& position : prepared.mesh.positions)
    {
        Point& p = mesh.positions.emplace_back(prepared.origin_m);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            p[axis] += position[axis] * prepared.quantum_m;
        }
    }
    return mesh;
}

/// True if directed edges are unique, so that no two faces are on the same side of an edge.
bool is_manifold(const TriangleMesh& mesh)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& face : mesh.faces)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            if (!edges.emplace(face[i], face[(i + 1) % 3]).second)
            {
                return false;
            }
        }
    }
    return true;
}

TEST(Replay, full_refinement_gives_the_quantised_mesh_face_for_face)
{
    for (const auto& model : sample_models())
    {
        Replay sut(*model->decoded);
        for (const RecordId id : coarsest_first(*model->decoded))
        {
            const auto fault = sut.split(id);
            ASSERT_FALSE(fault) << model->name << ": " << *fault;
        }
        EXPECT_EQ(sut.face_count(), model->prepared.mesh.faces.size()) << model->name;
        EXPECT_EQ(faces_by_position(sut.mesh()), faces_by_position(source_of(model->prepared)))
            << model->name;
    }
}

TEST(Replay, any_order_that_respects_dependencies_gives_the_same_mesh)
{
    constexpr unsigned kSeed = 4711;
    for (const auto& model : sample_models())
    {
        Replay expected(*model->decoded);
        std::vector<RecordId> order = in_dependency_order(*model->decoded);
        for (const RecordId id : order)
        {
            ASSERT_FALSE(expected.split(id)) << model->name;
        }
        std::mt19937 random(kSeed);
        std::shuffle(order.begin(), order.end(), random);
        Replay sut(*model->decoded);
        while (!order.empty())
        {
            const auto waiting = std::stable_partition(
                order.begin(), order.end(), [&](RecordId id) { return sut.split(id).has_value(); });
            ASSERT_NE(waiting, order.end()) << model->name << ", seed " << kSeed;
            order.erase(waiting, order.end());
        }
        const ModelCounts counts = model->decoded->header().counts();
        for (std::uint32_t face = 0; face < counts.face_ids(); ++face)
        {
            EXPECT_EQ(sut.is_active({face}), expected.is_active({face})) << model->name;
            EXPECT_EQ(sut.corners({face}), expected.corners({face})) << model->name;
            EXPECT_EQ(sut.state({face}), expected.state({face})) << model->name;
        }
    }
}

TEST(Replay, refuses_a_record_before_its_dependencies_and_changes_nothing)
{
    const EncodedModel& model = *sample_models()[0];
    const RecordId deepest = in_dependency_order(*model.decoded).back();
    ASSERT_GT(model.decoded->record(deepest).depth, 1U);
    Replay sut(*model.decoded);
    const auto before = faces_by_position(sut.mesh());
    EXPECT_TRUE(sut.split(deepest));
    EXPECT_EQ(faces_by_position(sut.mesh()), before);
    EXPECT_EQ(sut.face_count(), model.fields.base_faces);
}

TEST(Replay, refuses_to_split_a_record_twice)
{
    const EncodedModel& model = *sample_models()[0];
    const RecordId first = in_dependency_order(*model.decoded).front();
    Replay sut(*model.decoded);
    ASSERT_FALSE(sut.split(first));
    EXPECT_TRUE(sut.split(first));
}

TEST(Replay, every_cut_of_the_coarsest_first_order_is_manifold)
{
    for (const auto& model : sample_models())
    {
        Replay sut(*model->decoded);
        EXPECT_TRUE(is_manifold(sut.mesh())) << model->name;
        std::size_t splits = 0;
        for (const RecordId id : coarsest_first(*model->decoded))
        {
            ASSERT_FALSE(sut.split(id)) << model->name;
            if (++splits % 97 == 0)
            {
                EXPECT_TRUE(is_manifold(sut.mesh())) << model->name << " after " << splits;
            }
        }
    }
}

} // namespace

} // namespace tactus
