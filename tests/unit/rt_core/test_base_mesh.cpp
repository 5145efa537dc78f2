// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/page.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

namespace
{

struct CodedFace
{
    std::array<std::uint32_t, 3> corners{};
    std::uint32_t bucket{0};
    std::uint8_t error{0};
};

/// Tetrahedron that fills the header's extent, and a vertex without faces: with five vertices an id
/// has three bits, so that some ids are invalid.
struct CodedBase
{
    std::array<std::array<std::uint32_t, 3>, 5> vertices{
        {{0, 0, 0}, {1'000, 0, 0}, {0, 2'000, 0}, {0, 0, 3'000}, {1, 2, 3}}};
    std::array<CodedFace, 4> faces{
        {{{0, 2, 1}, 7, 0}, {{0, 1, 3}, 8, 200}, {{0, 3, 2}, 9, 1}, {{1, 2, 3}, 10, 255}}};

    [[nodiscard]] std::vector<std::byte> write() const
    {
        CodedBytes bytes;
        for (const auto& vertex : vertices)
        {
            bytes.bits(10, vertex[0]).bits(11, vertex[1]).bits(12, vertex[2]);
        }
        for (const CodedFace& face : faces)
        {
            for (const std::uint32_t corner : face.corners)
            {
                bytes.bits(3, corner);
            }
            bytes.bits(4, face.bucket).bits(8, face.error); // Ranks below 100, so buckets up to 12.
        }
        return bytes.with_checksum();
    }
};

class BaseMeshTest : public ::testing::Test
{
protected:
    Result<Done, SpmRefusal> parse(std::span<const std::byte> bytes)
    {
        return parse_base_mesh(bytes, header_, {positions_, faces_, next_});
    }

    static std::vector<std::byte> header_of_five_vertices()
    {
        HeaderParts parts = sound_header(0);
        parts.fields.base_vertices = 5;
        return parts.write();
    }

    std::vector<std::byte> header_bytes_{header_of_five_vertices()};
    ModelHeader header_{parsed(header_bytes_)};
    std::array<Vec3f, 5> positions_{};
    std::array<BaseFace, 4> faces_{};
    std::array<std::uint32_t, 4> next_{};
};

} // namespace

TEST_F(BaseMeshTest, a_sound_mesh_gives_its_content_back)
{
    ASSERT_TRUE(parse(CodedBase().write()).has_value());

    EXPECT_EQ(positions_[3], (Vec3f{0.0F, 0.0F, 3'000.0F / 1'024.0F}));
    EXPECT_EQ(faces_[1].corners, (std::array<VertexId, 3>{{{0}, {1}, {3}}}));
    EXPECT_EQ(faces_[2].bucket, 9U);
    EXPECT_EQ(faces_[3].error, 255);
    EXPECT_EQ(next_,
              (std::array<std::uint32_t, 4>{kNextExact, kNextPending, kNextPending, kNextPending}));
}

TEST_F(BaseMeshTest, a_vertex_outside_the_extent_is_refused)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        CodedBase base;
        base.vertices[2][axis] = header_.fields().extent_quanta[axis] + 1;
        EXPECT_EQ(parse(base.write()).error(), SpmRefusal::value_out_of_range);
    }
}

TEST_F(BaseMeshTest, a_face_over_a_missing_or_repeated_vertex_is_refused)
{
    for (const std::array<std::uint32_t, 3>& corners :
         {std::array<std::uint32_t, 3>{0, 1, 5}, {0, 7, 1}, {1, 1, 2}, {1, 2, 2}, {2, 1, 2}})
    {
        CodedBase base;
        base.faces[3].corners = corners;
        EXPECT_EQ(parse(base.write()).error(), SpmRefusal::id_out_of_range);
    }
}

} // namespace tactus::test
