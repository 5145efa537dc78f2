// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/piece_coding.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstring>

namespace tactus
{

namespace
{

/// Any record that parse accepts, edges of the ranges included.
VsplitRecord arbitrary_record(RecordId id, const ModelHeader& header)
{
    const ModelCounts counts = header.counts();
    const auto below = [](std::uint32_t end) { return *rc::gen::inRange<std::uint32_t>(0, end); };
    VsplitRecord record;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::uint32_t extent = header.fields().extent_quanta[axis];
        const std::uint32_t quanta = *rc::gen::element(0U, extent, below(extent + 1));
        record.position_m[axis] = static_cast<float>(quanta) * header.quantum_m();
    }
    do
    {
        record.parent = {below(counts.vertices())};
    } while (record.parent == counts.vertex_of(id));
    record.depth = static_cast<std::uint16_t>(1 + below(header.fields().max_depth));
    record.fan_size = static_cast<std::uint8_t>(1 + below(kMaxFanFaces));
    record.reach = static_cast<std::uint8_t>(1 + below(255));
    const std::uint32_t sides = 1 + below(3);
    const std::uint32_t first_fan_face = below(counts.base_faces - kMaxStarFaces);
    for (std::uint32_t place = 0; place < record.star_end(); ++place)
    {
        const bool is_there = place >= 2 || (sides >> place & 1U) != 0;
        if (!is_there)
        {
            continue;
        }
        record.star[place] = place < 2 ? counts.face_of(id, place) : FaceId{first_fan_face + place};
        record.error[place] = static_cast<std::uint8_t>(below(256));
        record.next[place] = record.error[place] == 0 ? kNextExact : kNextPending;
        if (place < 2)
        {
            record.bucket[place] = *rc::gen::arbitrary<std::uint32_t>();
        }
        else if (const RecordId owner{below(counts.records)}; owner != id && below(2) == 0)
        {
            record.before[place - 2] = FaceState::after(owner, below(kMaxStarFaces));
        }
    }
    return record;
}

TEST(PieceCoding, parse_chunk_gives_back_what_encode_chunk_wrote)
{
    const ModelHeader& header = sample_models()[1]->store->header();
    ASSERT_GT(header.counts().chunks(), 2U);
    const bool holds = rc::check(
        [&]
        {
            const ChunkId id{*rc::gen::inRange<std::uint32_t>(0, header.counts().chunks())};
            auto written = std::make_unique<Page>();
            const std::uint32_t count = records_in_chunk(header.counts(), id);
            for (std::uint32_t place = 0; place < count; ++place)
            {
                written->records[place] =
                    arbitrary_record({(id.value << kRecordsPerChunkLog2) + place}, header);
            }
            const auto coded =
                encode_chunk(id, std::span(written->records).first(count), header.quantum_m());
            auto parsed = std::make_unique<Page>();
            RC_ASSERT(parse_chunk(coded, header, id, *parsed).has_value());
            RC_ASSERT(std::memcmp(written.get(), parsed.get(), sizeof(Page)) == 0);
        });
    EXPECT_TRUE(holds);
}

TEST(PieceCoding, the_largest_records_fit_the_buffer_that_readers_lend)
{
    VsplitRecord record;
    record.depth = kMaxDepth;
    record.fan_size = kMaxFanFaces;
    record.parent = {0xFFFF'FFFEU};
    record.star.fill({0xFFFF'FFFEU});
    record.before.fill({0xFFFF'FFFDU});
    record.bucket.fill(0xFFFF'FFFFU);
    std::array<VsplitRecord, kRecordsPerChunk> records;
    records.fill(record);
    for (std::size_t i = 0; i < records.size(); i += 2)
    {
        records[i].position_m.fill(0x1p24F - 1.0F);
    }
    EXPECT_LE(encode_chunk({kMaxChunks - 1}, records, 1.0F).size(), kMaxCodedChunkBytes);
}

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
    EXPECT_EQ(encode_base_mesh(positions, faces), coded);
}

} // namespace

} // namespace tactus
