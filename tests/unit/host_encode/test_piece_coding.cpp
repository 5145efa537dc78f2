// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/piece_coding.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>

namespace tactus
{

namespace
{

TEST(PieceCoding, parse_base_mesh_gives_back_what_encode_base_mesh_wrote)
{
    const EncodedModel& model = *sample_models()[2];
    const ModelHeader& header = model.store->header();
    const ModelCounts counts = header.counts();
    std::vector<std::byte> coded;
    ASSERT_TRUE(model.store->read({ContentKind::base, 0}, coded));
    std::vector<Vec3f> positions_m(counts.base_vertices);
    std::vector<BaseFace> faces(counts.base_faces);
    std::vector<std::uint32_t> next(counts.base_faces);
    ASSERT_TRUE(parse_base_mesh(coded, header, {positions_m, faces, next}));
    std::vector<GridPosition> positions;
    for (const Vec3f& p : positions_m)
    {
        GridPosition& position = positions.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            position[axis] = static_cast<std::int32_t>(p[axis] / header.quantum_m());
        }
    }
    EXPECT_EQ(encode_base_mesh(positions, faces, BaseLayout(header.fields())), coded);
}

} // namespace

} // namespace tactus
