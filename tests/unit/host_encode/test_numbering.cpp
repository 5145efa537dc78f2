// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/face_history.hpp"
#include "host_tools/encode/model_pieces.hpp"
#include "host_tools/encode/numbering.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

/// Errors of faces, and the greatest depth.
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

TEST(FaceHistory, only_faces_of_the_source_have_error_zero)
{
    for (const auto& model : sample_models())
    {
        const QuantisedMesh& mesh = model->prepared.mesh;
        const Numbering numbering = number_model(mesh, model->simplification);
        const FaceHistory sut = trace_faces(mesh, model->simplification, numbering);
        // Collapses replayed on corners: a face is original while it has its own corners.
        std::set<std::uint32_t> changed;
        for (const Collapse& collapse : model->simplification.collapses)
        {
            const StarHistory& star = sut.stars[numbering.record_of(collapse).value];
            for (std::uint32_t place = 0; place < 2 + collapse.fan_size; ++place)
            {
                if (collapse.star[place] == Collapse::kNoFace)
                {
                    continue;
                }
                EXPECT_EQ(star.error_after[place] == 0, changed.count(collapse.star[place]) == 0)
                    << model->name << ", face " << collapse.star[place];
                if (changed.count(collapse.star[place]) != 0)
                {
                    EXPECT_GE(static_cast<double>(error_in_quanta(star.error_after[place])),
                              collapse.error[place]);
                }
                if (place >= 2)
                {
                    changed.insert(collapse.star[place]);
                    EXPECT_NE(star.error_before[place - 2], 0) << model->name;
                }
            }
        }
        for (std::uint32_t id = 0; id < numbering.counts.base_faces; ++id)
        {
            const std::uint32_t at = numbering.base_faces[id];
            const bool is_changed = changed.count(model->simplification.base_faces[at]) != 0;
            EXPECT_EQ(sut.base_error[id] != 0, is_changed) << model->name << ", base face " << id;
            EXPECT_GE(static_cast<double>(error_in_quanta(sut.base_error[id])),
                      model->simplification.base_error[at] * (is_changed ? 1.0F : 0.0F));
        }
    }
}

TEST(FaceHistory, names_the_greatest_bound_and_depth_of_all)
{
    for (const auto& model : sample_models())
    {
        const Numbering numbering = number_model(model->prepared.mesh, model->simplification);
        const FaceHistory sut = trace_faces(model->prepared.mesh, model->simplification, numbering);
        std::uint32_t depth = 0;
        ErrorCode error = 0;
        for (const StarHistory& star : sut.stars)
        {
            depth = std::max(depth, star.depth);
            for (const ErrorCode code : star.error_before)
            {
                error = std::max(error, code);
            }
        }
        for (const ErrorCode code : sut.base_error)
        {
            error = std::max(error, code);
        }
        EXPECT_EQ(sut.max_depth, depth) << model->name;
        EXPECT_EQ(sut.max_error, error) << model->name;
        EXPECT_LE(depth, model->simplification.rounds) << model->name;
    }
}

std::int64_t centroid_sum(const QuantisedMesh& mesh, std::uint32_t face, std::size_t axis)
{
    std::int64_t sum = 0;
    for (const std::uint32_t corner : mesh.faces[face])
    {
        sum += mesh.positions[corner][axis];
    }
    return sum;
}

/// Checks by sorting, where the code under test selects the same cells.
void check_cell(const QuantisedMesh& mesh, const std::vector<std::uint32_t>& buckets,
                std::vector<std::uint32_t> faces, std::uint32_t first_rank)
{
    if (faces.size() <= 8)
    {
        for (const std::uint32_t face : faces)
        {
            ASSERT_EQ(buckets[face], first_rank / 8) << "face " << face;
        }
        return;
    }
    std::array<std::int64_t, 3> extents{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const auto [low, high] = std::minmax_element(
            faces.begin(), faces.end(),
            [&](std::uint32_t a, std::uint32_t b)
            { return centroid_sum(mesh, a, axis) < centroid_sum(mesh, b, axis); });
        extents[axis] = centroid_sum(mesh, *high, axis) - centroid_sum(mesh, *low, axis);
    }
    const auto axis = static_cast<std::size_t>(std::max_element(extents.begin(), extents.end()) -
                                               extents.begin());
    std::sort(faces.begin(), faces.end(),
              [&](std::uint32_t a, std::uint32_t b) {
                  return std::pair(centroid_sum(mesh, a, axis), a) <
                         std::pair(centroid_sum(mesh, b, axis), b);
              });
    std::size_t left = 1;
    while (left * 2 < faces.size())
    {
        left *= 2;
    }
    const auto middle = faces.begin() + static_cast<std::ptrdiff_t>(left);
    check_cell(mesh, buckets, {faces.begin(), middle}, first_rank);
    check_cell(mesh, buckets, {middle, faces.end()}, first_rank + static_cast<std::uint32_t>(left));
}

TEST(LeftFullOrder, agrees_with_sorting_every_cell)
{
    for (const auto& model : sample_models())
    {
        const QuantisedMesh& mesh = model->prepared.mesh;
        const std::vector<std::uint32_t> sut = left_full_buckets(mesh);
        std::vector<std::uint32_t> all(mesh.faces.size());
        std::iota(all.begin(), all.end(), 0U);
        check_cell(mesh, sut, all, 0);
    }
}

TEST(LeftFullOrder, a_single_face_is_in_bucket_zero)
{
    const QuantisedMesh triangle{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(left_full_buckets(triangle), std::vector<std::uint32_t>{0});
}

} // namespace
} // namespace tactus
