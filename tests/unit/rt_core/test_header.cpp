// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/infinity.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/index_page.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kTwoPages = 64 * 64 + 1;

/// Refusal of the header after `change`, with sizes and checksum corrected.
SpmRefusal refusal_after(const std::function<void(HeaderFields&)>& change)
{
    HeaderParts parts = sound_header(kTwoPages);
    change(parts.fields);
    const auto result = ModelHeader::parse(parts.write());
    return result ? SpmRefusal{255} : result.error();
}

} // namespace

TEST(ModelHeader, a_sound_header_gives_its_fields_back)
{
    HeaderParts parts = sound_header(kTwoPages);
    parts.entries[1].box = {{-5, 6, 7}, {8, 9, 10}};
    parts.entries[1].chunks_offset = 1ULL << 40U;
    const auto bytes = parts.write();

    const ModelHeader sut = parsed(bytes);

    EXPECT_EQ(sut.counts().base_vertices, 4U);
    EXPECT_EQ(sut.counts().base_faces, 4U);
    EXPECT_EQ(sut.counts().records, kTwoPages);
    EXPECT_EQ(sut.quantum_m(), std::ldexp(1.0F, -10));
    EXPECT_NEAR(sut.diagonal_m(), std::sqrt(1e6 + 4e6 + 9e6) / 1024.0, 1e-12);
    EXPECT_EQ(sut.fields().origin_m[2], 100.0);
    EXPECT_EQ(sut.index_entry({1}).box, parts.entries[1].box);
    EXPECT_EQ(sut.index_entry({1}).chunks_offset, 1ULL << 40U);
    EXPECT_EQ(sut.region_count(), 6U);
}

TEST(ModelHeader, a_model_without_records_needs_no_index)
{
    HeaderParts parts = sound_header(0);
    EXPECT_TRUE(ModelHeader::parse(parts.write()).has_value());
    parts.fields.max_depth = 1;
    EXPECT_FALSE(ModelHeader::parse(parts.write()).has_value());
}

TEST(ModelHeader, a_foreign_file_is_named_so)
{
    EXPECT_EQ(refusal_after([](HeaderFields& f) { f.magic[7] = '\r'; }), SpmRefusal::wrong_magic);
}

TEST(ModelHeader, counts_out_of_range_are_refused)
{
    const std::vector<std::function<void(HeaderFields&)>> changes{
        [](HeaderFields& f) { f.base_faces = 0; },
        [](HeaderFields& f) { f.base_faces = kMaxBaseFaces + 1; },
        [](HeaderFields& f) { f.base_faces = 0xFFFF'FFFFU; },
        [](HeaderFields& f) { f.base_vertices = 2; },
        [](HeaderFields& f) { f.base_vertices = kMaxBaseVertices + 1; },
        [](HeaderFields& f) { f.records = kMaxRecords + 1; },
        [](HeaderFields& f) { f.records = 0xFFFF'FFFFU; },
        [](HeaderFields& f) { f.records = 0; },
        [](HeaderFields& f) { f.max_depth = 0; },
        [](HeaderFields& f) { f.max_depth = kMaxDepth + 1; },
    };
    for (std::size_t i = 0; i < changes.size(); ++i)
    {
        EXPECT_EQ(refusal_after(changes[i]), SpmRefusal::count_out_of_range) << "change " << i;
    }
}

TEST(ModelHeader, values_out_of_range_are_refused)
{
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::function<void(HeaderFields&)>> changes{
        [](HeaderFields& f) { f.position_bits = kMinPositionBits - 1; },
        [](HeaderFields& f) { f.position_bits = kMaxPositionBits + 1; },
        [](HeaderFields& f) { f.position_bits = 0xFFFFU; },
        [](HeaderFields& f) { f.topology = 2; },
        [](HeaderFields& f) { f.quantum_log2 = kMinQuantumLog2 - 1; },
        [](HeaderFields& f) { f.quantum_log2 = kMaxQuantumLog2 + 1; },
        [](HeaderFields& f) {
            f.extent_quanta = {0, 0, 0};
        },
        [](HeaderFields& f) { f.extent_quanta[1] = 1U << 16U; },
        [](HeaderFields& f) { f.quantisation_m = kNaN; },
        [](HeaderFields& f) { f.quantisation_m = kInfinity; },
        [](HeaderFields& f) { f.quantisation_m = -1e-9; },
        [](HeaderFields& f) { f.quantisation_m = 1e3; }, // Beyond the diagonal.
        [](HeaderFields& f) { f.region_grid[0] = 0; },
        [](HeaderFields& f) {
            f.region_grid = {0xFFFF'FFFFU, 0xFFFF'FFFFU, 0xFFFF'FFFFU};
        },
        [](HeaderFields& f) {
            f.region_grid = {65'536, 65'536, 65'536};
        },
        [](HeaderFields& f) {
            f.region_grid = {1, 2, 2};
        },
        [](HeaderFields& f) { f.region_cell_quanta = 0; },
        [](HeaderFields& f) { f.region_cell_quanta = 1'025; },
        [](HeaderFields& f) { f.occupied_regions = 0; },
        [](HeaderFields& f) { f.occupied_regions = 7; },
        [](HeaderFields& f) { f.occupied_regions ^= 1U; }, // Contradicts the bits.
    };
    for (std::size_t i = 0; i < changes.size(); ++i)
    {
        EXPECT_EQ(refusal_after(changes[i]), SpmRefusal::value_out_of_range) << "change " << i;
    }
}

TEST(ModelHeader, what_can_be_touched_nowhere_is_refused)
{
    for (const double far_m : {std::numeric_limits<double>::quiet_NaN(), -kInfinity, 1e300, 1e9,
                               std::nextafter(-kModelReachMax_m, -kInfinity), kModelReachMax_m})
    {
        EXPECT_EQ(refusal_after([=](HeaderFields& f) { f.origin_m[1] = far_m; }),
                  SpmRefusal::too_far)
            << far_m;
    }
    EXPECT_EQ(refusal_after([](HeaderFields& f) { f.quantum_log2 = kMaxQuantumLog2; }),
              SpmRefusal::too_far); // The far corner is out of range.
}

TEST(ModelHeader, the_ends_of_each_range_are_accepted)
{
    EXPECT_EQ(refusal_after(
                  [](HeaderFields& f)
                  {
                      f.quantum_log2 = kMinQuantumLog2;
                      f.quantisation_m = 0.0;
                  }),
              SpmRefusal{255});
    EXPECT_EQ(refusal_after(
                  [](HeaderFields& f)
                  {
                      f.quantum_log2 = kMaxQuantumLog2;
                      f.extent_quanta = {0, 0, 1};
                  }),
              SpmRefusal{255});
    for (const std::uint32_t bits : {kMinPositionBits, kMaxPositionBits})
    {
        EXPECT_EQ(refusal_after([bits](HeaderFields& f)
                                { f.position_bits = static_cast<std::uint16_t>(bits); }),
                  SpmRefusal{255});
    }
    EXPECT_EQ(refusal_after([](HeaderFields& f) { f.origin_m[1] = -kModelReachMax_m; }),
              SpmRefusal{255});
    EXPECT_EQ(refusal_after([](HeaderFields& f) { f.extent_quanta = {0, 0, 1}; }), SpmRefusal{255});
    EXPECT_EQ(refusal_after([](HeaderFields& f) { f.base_faces = kMaxBaseFaces; }),
              SpmRefusal{255});
    EXPECT_EQ(refusal_after([](HeaderFields& f) { f.max_depth = kMaxDepth; }), SpmRefusal{255});
}

TEST(ModelHeader, as_many_regions_as_the_limit_are_accepted_and_no_more)
{
    HeaderParts parts = sound_header(kTwoPages);
    parts.fields.region_grid = {kMaxRegions / 16, 4, 4};
    parts.region_bits.assign(kMaxRegions / 8, 0);
    parts.region_bits[0] = 0b111;
    EXPECT_EQ(parsed(parts.write()).region_count(), kMaxRegions);
    ++parts.fields.region_grid[0];
    parts.region_bits.resize(kMaxRegions / 8 + 2);
    EXPECT_EQ(ModelHeader::parse(parts.write()).error(), SpmRefusal::value_out_of_range);
}

TEST(ModelHeader, a_stated_size_that_does_not_match_is_refused)
{
    HeaderParts parts = sound_header(kTwoPages);
    static_cast<void>(parts.write());
    parts.fields.header_bytes += 1;
    EXPECT_EQ(ModelHeader::parse(parts.write_as_is()).error(), SpmRefusal::wrong_size);
    parts.fields.header_bytes = 0xFFFF'FFFFU;
    EXPECT_EQ(ModelHeader::parse(parts.write_as_is()).error(), SpmRefusal::wrong_size);
}

TEST(ModelHeader, every_refusal_has_words_of_its_own)
{
    std::set<std::string> texts;
    for (unsigned refusal = 0; refusal <= static_cast<unsigned>(SpmRefusal::wrong_identity);
         ++refusal)
    {
        EXPECT_TRUE(texts.insert(refusal_text(static_cast<SpmRefusal>(refusal))).second);
    }
}

TEST(ModelHeader, a_point_lies_in_the_region_that_division_gives)
{
    HeaderParts parts = sound_header(1);
    const auto bytes = parts.write();
    const ModelHeader sut = parsed(bytes);
    // Cells of 1024 quanta of 2^-10 m: one metre. The grid is 1 x 2 x 3, x first.
    Random random(5);
    for (int i = 0; i < 10'000; ++i)
    {
        const Vec3 p{random.between(0.0, 1.0), random.between(0.0, 2.0), random.between(0.0, 3.0)};
        const int y = p.y() >= 1.0 ? 1 : 0;
        const int z = p.z() >= 2.0 ? 2 : p.z() >= 1.0 ? 1 : 0;
        ASSERT_EQ(sut.region_at({p.x(), p.y(), p.z()}).value,
                  static_cast<std::uint32_t>(2 * z + y));
    }
}

TEST(ModelHeader, points_outside_take_the_nearest_region)
{
    HeaderParts parts = sound_header(1);
    const auto bytes = parts.write();
    const ModelHeader sut = parsed(bytes);
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

    EXPECT_EQ(sut.region_at({-1.0, -1e300, -kInfinity}).value, 0U);
    EXPECT_EQ(sut.region_at({5.0, 1e300, kInfinity}).value, 5U);
    EXPECT_EQ(sut.region_at({0.5, -3.0, 9.0}).value, 4U);
    EXPECT_LT(sut.region_at({kNaN, kNaN, kNaN}).value, 6U);
    EXPECT_EQ(sut.region_at({0.5, 2.0, 3.0}).value, 5U);
}

TEST(ModelHeader, occupied_regions_are_the_set_bits)
{
    HeaderParts parts = sound_header(1);
    const auto bytes = parts.write();
    const ModelHeader sut = parsed(bytes);
    const std::array<bool, 6> expected{true, false, false, true, false, true};
    for (std::uint32_t region = 0; region < 6; ++region)
    {
        EXPECT_EQ(sut.is_occupied({region}), expected[region]) << region;
    }
    EXPECT_DEATH(static_cast<void>(sut.is_occupied({6})), "");
    EXPECT_DEATH(static_cast<void>(sut.index_entry({1})), "");
}

TEST(IndexStep, is_the_least_step_that_spans_the_box_in_16_bits)
{
    Random random(6);
    const auto check = [](std::int32_t low, std::int32_t high)
    {
        const auto extent = static_cast<double>(high) - static_cast<double>(low);
        const auto step = static_cast<double>(index_step(low, high));
        ASSERT_GE(step, 1.0);
        ASSERT_GE(step * 65'535.0, extent) << low << " " << high;
        ASSERT_LE((step - 1.0) * 65'535.0, extent) << low << " " << high;
    };
    check(0, 0);
    check(0, 65'534);
    check(0, 65'535);
    check(0, 65'536);
    check(std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max());
    for (int i = 0; i < 10'000; ++i)
    {
        const auto a = static_cast<std::int32_t>(random.bits() >> 32U);
        const auto b = static_cast<std::int32_t>(random.bits() >> 32U);
        check(std::min(a, b), std::max(a, b));
    }
}

} // namespace tactus::test
