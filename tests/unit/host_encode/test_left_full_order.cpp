// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/model_pieces.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace tactus
{

namespace
{

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

TEST(LeftFullOrder, fills_every_bucket_but_the_last_with_eight_faces)
{
    for (const auto& model : sample_models())
    {
        const std::vector<std::uint32_t> sut = left_full_buckets(model->prepared.mesh);
        std::vector<std::uint32_t> fill((sut.size() + 7) / 8);
        for (const std::uint32_t bucket : sut)
        {
            ASSERT_LT(bucket, fill.size()) << model->name;
            ++fill[bucket];
        }
        for (std::size_t bucket = 0; bucket + 1 < fill.size(); ++bucket)
        {
            EXPECT_EQ(fill[bucket], 8U) << model->name << ", bucket " << bucket;
        }
    }
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
