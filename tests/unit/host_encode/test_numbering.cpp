// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/numbering.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>

#include <set>

namespace tactus
{

namespace
{

/// Tier, written separately from the code under test: tiers end at 64, 320, 1600, 8000, ...
std::uint32_t tier_of(std::uint32_t record)
{
    std::uint32_t tier = 0;
    for (std::uint64_t end = 64; record >= end; end *= 5)
    {
        ++tier;
    }
    return tier;
}

/// Comparison bit by bit, all 24 bits of each coordinate, highest first.
bool is_before_in_morton_order(const std::array<std::int32_t, 3>& a,
                               const std::array<std::int32_t, 3>& b)
{
    for (int bit = 23; bit >= 0; --bit)
    {
        for (const std::size_t axis : {2U, 1U, 0U})
        {
            const int in_a = (a[axis] >> bit) & 1;
            const int in_b = (b[axis] >> bit) & 1;
            if (in_a != in_b)
            {
                return in_a < in_b;
            }
        }
    }
    return false;
}

TEST(Numbering, gives_every_vertex_and_face_one_id)
{
    for (const auto& model : sample_models())
    {
        const Numbering sut = number_model(model->prepared.mesh, model->simplification);
        std::set<VertexId> vertices(sut.vertex_ids.begin(), sut.vertex_ids.end());
        EXPECT_EQ(vertices.size(), model->prepared.mesh.positions.size()) << model->name;
        EXPECT_LT(vertices.rbegin()->value, sut.counts.vertices()) << model->name;
        std::set<FaceId> faces(sut.face_ids.begin(), sut.face_ids.end());
        EXPECT_EQ(faces.size(), model->prepared.mesh.faces.size()) << model->name;
        EXPECT_LT(faces.rbegin()->value, sut.counts.face_ids()) << model->name;
    }
}

TEST(Numbering, numbers_the_base_first_in_source_order)
{
    for (const auto& model : sample_models())
    {
        const Numbering sut = number_model(model->prepared.mesh, model->simplification);
        std::uint32_t next_vertex = 0;
        for (const VertexId id : sut.vertex_ids)
        {
            if (sut.counts.is_base(id))
            {
                EXPECT_EQ(id.value, next_vertex++) << model->name;
            }
        }
        EXPECT_EQ(next_vertex, sut.counts.base_vertices) << model->name;
        std::uint32_t next_face = 0;
        for (const FaceId id : sut.face_ids)
        {
            if (sut.counts.is_base(id))
            {
                EXPECT_EQ(id.value, next_face++) << model->name;
            }
        }
        EXPECT_EQ(next_face, sut.counts.base_faces) << model->name;
    }
}

TEST(Numbering, a_record_never_depends_on_a_finer_tier)
{
    for (const auto& model : sample_models())
    {
        const ModelCounts counts = model->store->header().counts();
        for (std::uint32_t id = 0; id < counts.records; ++id)
        {
            const VsplitRecord& record = model->decoded->record({id});
            for (std::uint32_t i = 0; i < record.fan_size; ++i)
            {
                if (!record.before[i].is_base())
                {
                    EXPECT_LE(tier_of(record.before[i].record().value), tier_of(id))
                        << model->name << ", record " << id;
                }
            }
        }
    }
}

TEST(Numbering, a_tier_follows_the_morton_order_of_its_vertices)
{
    for (const auto& model : sample_models())
    {
        const Numbering sut = number_model(model->prepared.mesh, model->simplification);
        for (std::uint32_t id = 1; id < sut.counts.records; ++id)
        {
            const auto position = [&](std::uint32_t record)
            {
                return model->prepared.mesh.positions
                    [model->simplification.collapses[sut.collapse_of_record[record]].vertex];
            };
            if (tier_of(id) == tier_of(id - 1))
            {
                EXPECT_FALSE(is_before_in_morton_order(position(id), position(id - 1)))
                    << model->name << ", record " << id;
            }
        }
    }
}

TEST(Numbering, a_model_without_records_is_all_base)
{
    const QuantisedMesh triangle{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, {{0, 1, 2}}};
    const Simplification nothing{{}, 0, {0}, {{0, 1, 2}}, {0.0}};
    const Numbering sut = number_model(triangle, nothing);
    EXPECT_EQ(sut.counts.base_vertices, 3U);
    EXPECT_EQ(sut.counts.base_faces, 1U);
    EXPECT_EQ(sut.counts.records, 0U);
}

} // namespace

} // namespace tactus
